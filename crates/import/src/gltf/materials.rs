//! The materials of a file, and their copies for colours of vertices.

use super::color::{Several, Tint};
use super::container::Document;
use super::gloss;
use super::material::{Converter, uv_set};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Material, ScalarParam};
use gltf::json::material::{AlphaMode, Material as Json};
use std::collections::HashMap;
use std::rc::Rc;

/// The materials met so far.
#[derive(Default)]
pub(super) struct Materials {
    known: HashMap<Option<usize>, Rc<Known>>,
    /// Scene indices by material and tint.
    added: HashMap<(Option<usize>, [u32; 4]), u32>,
    made: gloss::Pictures,
}

/// A material of the file.
pub(super) struct Known {
    pub index: Option<usize>,
    /// All but what is cut out of it.
    pub material: Material,
    /// The texture coordinate set that its textures use.
    pub uv_set: u32,
    pub opacity: ScalarParam,
    pub alpha_mode: AlphaMode,
    pub cutoff: f32,
    /// True when colours of vertices show; they multiply the diffuse colour, which some materials do not have.
    pub has_color: bool,
}

impl Materials {
    /// Material `index`; `None` is glTF's default material.
    pub(super) fn read(
        &mut self,
        document: &Document,
        index: Option<usize>,
        place: &str,
        a: &mut Assembly,
    ) -> Result<Rc<Known>, ImportError> {
        if let Some(known) = self.known.get(&index) {
            return Ok(Rc::clone(known));
        }
        let materials = &document.root.materials;
        let default = Json::default();
        let json = match index {
            Some(i) => materials
                .get(i)
                .ok_or_else(|| a.malformed(place, format!("it refers to material {i}, but there are only {}", materials.len())))?,
            None => {
                a.warn(place, "no material; glTF's default, a rough white metal, was used");
                &default
            }
        };
        let fallback = || index.map_or("default".to_string(), |i| format!("material_{i}"));
        let name = json.name.clone().filter(|n| !n.trim().is_empty()).unwrap_or_else(fallback);
        let uv_set = uv_set(json, &name, a);
        let mut converter = Converter { document, user: format!("material {name:?}"), made: &mut self.made, a };
        let known = Rc::new(Known { index, uv_set, ..converter.material(name, json)? });
        self.known.insert(index, Rc::clone(&known));
        Ok(known)
    }

    /// The scene index of a material whose base colour, and opacity where it has one, is multiplied by a tint.
    pub(super) fn tinted(&mut self, known: &Known, tint: Tint, a: &mut Assembly) -> u32 {
        let tint = Tint {
            color: if known.has_color { tint.color } else { Rgb::WHITE },
            opacity: if known.alpha_mode == AlphaMode::Opaque { 1.0 } else { tint.opacity },
        };
        *self.added.entry((known.index, tint.to_array().map(f32::to_bits))).or_insert_with(|| a.push_material(known.tinted(tint)))
    }
}

impl Known {
    /// True when the material shows colours or opacities of vertices, of which there are `several`.
    pub(super) fn shows(&self, several: Several) -> bool {
        several.colors && self.has_color || several.opacities && self.alpha_mode != AlphaMode::Opaque
    }

    fn tinted(&self, tint: Tint) -> Material {
        let mut material = self.material.clone();
        if tint != Tint::NONE {
            let Tint { color, opacity } = tint;
            multiply(&mut material.bsdf, color);
            material.name += &format!(" {:.3} {:.3} {:.3}", color.r, color.g, color.b);
            if opacity != 1.0 {
                material.name += &format!(" {opacity:.3}");
            }
        }
        let opacity = ScalarParam { factor: self.opacity.factor * tint.opacity, ..self.opacity };
        let transparent = opacity.factor < 1.0 || opacity.texture.is_some();
        material.alpha = match self.alpha_mode {
            AlphaMode::Mask if transparent => Alpha::Mask { opacity, cutoff: self.cutoff },
            AlphaMode::Blend if transparent => Alpha::Blend { opacity },
            _ => Alpha::Opaque,
        };
        material
    }
}

/// Multiplies the base colour; beside a metal of its own colour that of the dielectric.
fn multiply(bsdf: &mut Bsdf, color: Rgb) {
    match bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.factor *= color,
        Bsdf::Principled(p) => p.base_color.factor *= color,
        Bsdf::Blend { second, .. } => multiply(second, color),
        _ => {}
    }
}

//! The materials of a file, and their copies for colours of vertices.

use super::color::Tint;
use super::container::Document;
use super::file_material::FileMaterial;
use super::gloss_pictures::GlossPictures;
use super::material::{Converter, uv_set};
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use gltf::json::material::{AlphaMode, Material as Json};
use std::collections::HashMap;
use std::rc::Rc;

/// A material of the file, a tint of four floats, and a picture of colours.
type Look = (Option<usize>, [u32; 4], Option<u32>);

/// The materials met so far.
#[derive(Default)]
pub(super) struct Materials {
    known: HashMap<Option<usize>, Rc<FileMaterial>>,
    /// Scene indices.
    added: HashMap<Look, u32>,
    made: GlossPictures,
}

impl Materials {
    /// Material `index`; `None` is glTF's default material.
    pub(super) fn read(
        &mut self,
        document: &Document,
        index: Option<usize>,
        place: &str,
        a: &mut Assembly,
    ) -> Result<Rc<FileMaterial>, ImportError> {
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
        let known = Rc::new(FileMaterial { index, uv_set, ..converter.material(name, json)? });
        self.known.insert(index, Rc::clone(&known));
        Ok(known)
    }

    /// The scene index of a material whose base colour, and opacity where it has one, is multiplied by a tint and a picture.
    pub(super) fn tinted(&mut self, known: &FileMaterial, tint: Tint, picture: Option<u32>, a: &mut Assembly) -> u32 {
        let tint = Tint {
            color: if known.has_color { tint.color } else { Rgb::WHITE },
            opacity: if known.alpha_mode == AlphaMode::Opaque { 1.0 } else { tint.opacity },
        };
        let key = (known.index, tint.to_array().map(f32::to_bits), picture);
        *self.added.entry(key).or_insert_with(|| a.push_material(known.tinted(tint, picture)))
    }
}

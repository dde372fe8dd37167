//! A material as the file has it, before colours and opacities of vertices multiply it.

use super::color::{Several, Tint};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Material, ScalarParam};
use gltf::json::material::AlphaMode;

/// A material of the file.
pub(super) struct FileMaterial {
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

impl FileMaterial {
    /// True when the material shows colours or opacities of vertices, of which there are `several`.
    pub(super) fn shows(&self, several: Several) -> bool {
        several.colors && self.has_color || several.opacities && self.alpha_mode != AlphaMode::Opaque
    }

    /// The material with its colour and opacity multiplied by a tint, and what is cut out of it.
    pub(super) fn tinted(&self, tint: Tint) -> Material {
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

//! A material as the file has it, before colours and opacities of vertices multiply it.

use super::color::{Several, Tint};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Material, ScalarParam, TextureRef, Wrap};
use gltf::json::material::AlphaMode;

/// A material of the file.
pub(super) struct FileMaterial {
    pub index: Option<usize>,
    /// The material without its cut-outs.
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

    /// True when the material reads pictures, so that texture coordinates are theirs.
    pub(super) fn is_textured(&self) -> bool {
        let mut textured = self.opacity.texture.is_some();
        self.material.textures(|_| textured = true);
        textured
    }

    /// The material with its colour and opacity multiplied by a tint and a picture of colours, and what is cut out of it.
    pub(super) fn tinted(&self, tint: Tint, picture: Option<u32>) -> Material {
        let mut material = self.material.clone();
        if let Some(picture) = picture {
            paint(&mut material.bsdf, TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::new(picture) });
            material.name += &format!(" colours {picture}");
        }
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

/// Gives the base colour a texture, where [`multiply`] would multiply it.
fn paint(bsdf: &mut Bsdf, texture: TextureRef) {
    match bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.texture = Some(texture),
        Bsdf::Principled(p) => p.base_color.texture = Some(texture),
        Bsdf::Blend { second, .. } => paint(second, texture),
        _ => {}
    }
}

/// Multiplies the base colour; in a blend with a metal of its own colour, only the dielectric's.
fn multiply(bsdf: &mut Bsdf, color: Rgb) {
    match bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.factor *= color,
        Bsdf::Principled(p) => p.base_color.factor *= color,
        Bsdf::Blend { second, .. } => multiply(second, color),
        _ => {}
    }
}

//! Surfaces of other renderers and of MaterialX, as far as the names of their inputs identify them.

use super::material::index_of_refraction;
use super::mtlx::{default_strength, first, is_solid, named};
use super::shader::{Source, id, source};
use super::stage::Prim;
use super::texture::Textures;
use super::value::Value;
use crate::ImportError;
use crate::images::Use;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Principled, TextureRef};
use std::rc::Rc;

/// Roughness of the coat of a standard surface that states none.
const STANDARD_COAT_ROUGHNESS: f32 = 0.1;

/// Opacity below which a glTF surface of mode "mask" is not there, where it states none.
const GLTF_CUTOFF: f32 = 0.5;

impl Textures<'_, '_, '_> {
    /// A surface of another renderer, by the names that its inputs usually have.
    pub(super) fn foreign(&mut self, name: &str, shader: &Rc<Prim>) -> Result<Material, ImportError> {
        let kind = id(shader);
        self.warn(format!(
            "its surface is {kind:?}, of which base colour, opacity, roughness, metallic, coat, emission and transmission were guessed by name"
        ));
        let first = |names: &[&'static str]| first(shader, names);
        let base = first(named::BASE);
        let roughness = first(&["inputs:specular_roughness", "inputs:reflection_roughness_constant", "inputs:roughness"]);
        let metallic = first(&["inputs:metalness", "inputs:base_metalness", "inputs:metallic_constant", "inputs:metallic"]);
        let coat = first(&["inputs:coat", "inputs:coat_weight", "inputs:clearcoat"]);
        let coat_roughness = first(&["inputs:coat_roughness", "inputs:clearcoat_roughness"]);
        let default_coat = if kind.contains("standard_surface") { STANDARD_COAT_ROUGHNESS } else { 0.0 };
        let ior = self.scalar(shader, first(&["inputs:specular_ior", "inputs:specular_IOR", "inputs:ior"]), 1.5)?.factor;
        let mut p = Principled {
            base_color: self.color(shader, base, Rgb::splat(0.5))?,
            roughness: self.scalar(shader, roughness, 0.5)?,
            metallic: self.scalar(shader, metallic, 0.0)?,
            transmission: self.scalar(shader, first(named::TRANSMISSION), 0.0)?,
            clearcoat: self.scalar(shader, coat, 0.0)?,
            clearcoat_roughness: self.scalar(shader, coat_roughness, default_coat)?,
            ior: index_of_refraction(ior),
            ..Principled::default()
        };
        p.solid = p.transmission.factor > 0.0 && is_solid(shader);
        let picture = first(&["inputs:diffuse_texture", "inputs:base_color_texture"]);
        if let (false, Source::Value(value, layer)) = (picture.is_empty(), source(self.stage, shader, picture, self.a)?)
            && let Some(asset) = value.as_text().filter(|t| !t.is_empty()).map(str::to_string)
        {
            let image = self.picture(&asset, &layer, Use::Color)?;
            p.base_color = ColorParam { factor: Rgb::WHITE, texture: image.map(TextureRef::new) };
        }
        p.base_color.factor *= self.factor(shader, first(&["inputs:base", "inputs:base_weight"]), 1.0)?;
        let (emission, alpha) = (self.foreign_emission(shader)?, self.foreign_alpha(shader)?);
        Ok(Material { emission, alpha, ..Material::new(name, Bsdf::Principled(Box::new(p))) })
    }

    fn foreign_emission(&mut self, shader: &Rc<Prim>) -> Result<ColorParam, ImportError> {
        // Either a colour that emits by itself and is black unless stated, or one that needs a strength or a switch to emit.
        let alone = first(shader, &["inputs:emissive", "inputs:emissiveColor", "inputs:emissive_factor"]);
        let color = first(shader, &["inputs:emission_color", "inputs:emissive_color"]);
        let strength = first(shader, named::GLOW_STRENGTH);
        let enabled = match source(self.stage, shader, "inputs:enable_emission", self.a)? {
            Source::Value(value, _) => value.as_bool(),
            _ => None,
        };
        if !enabled.unwrap_or(!strength.is_empty() || !alone.is_empty()) {
            return Ok(Rgb::BLACK.into());
        }
        let is_alone = color.is_empty() && !alone.is_empty();
        let mut emission = if is_alone { self.color(shader, alone, Rgb::BLACK)? } else { self.color(shader, color, Rgb::WHITE)? };
        emission.factor *= self.factor(shader, strength, default_strength(shader, strength))?;
        Ok(emission)
    }

    fn foreign_alpha(&mut self, shader: &Rc<Prim>) -> Result<Alpha, ImportError> {
        let opacity = first(shader, &["inputs:geometry_opacity", "inputs:opacity"]);
        if !opacity.is_empty() {
            return self.alpha(shader, opacity, "inputs:opacityThreshold");
        }
        // glTF's surface: opaque, a mask or blended, by number.
        let mode = self.scalar(shader, "inputs:alpha_mode", 0.0)?.factor;
        if mode == 0.0 {
            return Ok(Alpha::Opaque);
        }
        let alpha = self.alpha(shader, "inputs:alpha", "")?;
        Ok(match alpha {
            Alpha::Blend { opacity } if mode == 1.0 => {
                Alpha::Mask { opacity, cutoff: self.factor(shader, "inputs:alpha_cutoff", GLTF_CUTOFF)? }
            }
            other => other,
        })
    }

    /// A number that is the same everywhere on the surface.
    pub(super) fn factor(&mut self, shader: &Rc<Prim>, name: &str, default: f32) -> Result<f32, ImportError> {
        let number = self.scalar(shader, name, default)?;
        if number.texture.is_some() {
            let what = name.trim_start_matches("inputs:");
            self.warn(format!("the texture of its {what} was left out: it has one number everywhere"));
        }
        Ok(number.factor)
    }
}

/// A number, or the mean of a colour.
pub(super) fn number(value: &Value) -> Option<f32> {
    let mean = || value.as_tuple::<3>().map(|c| c.iter().sum::<f64>() / 3.0);
    value.as_number().or_else(mean).map(|v| v as f32)
}

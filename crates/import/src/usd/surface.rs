//! The surface of a prim: its bound material or its display colour, and the texture coordinates that it needs.

use super::constants::Constants;
use super::layer::field;
use super::material::Surface;
use super::primvar::{Primvar, Sizes};
use super::stage::Prim;
use super::value::Value;
use super::walk::Walk;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, ColorParam, Material};

impl Walk<'_> {
    /// The bound material.
    pub(super) fn material_of(&mut self, prim: &Prim, path: Option<&str>, a: &mut Assembly) -> Result<Option<Surface>, ImportError> {
        let Some(path) = path else { return Ok(None) };
        let double_sided = prim.value("doubleSided").and_then(Value::as_bool).unwrap_or(false);
        let found = self.materials.get(self.stage, path, double_sided, a)?;
        if found.is_none() {
            a.warn(&prim.path, format!("its material <{path}> is not there; its display colour stands in"));
        }
        Ok(found)
    }

    /// A material of the display colour of a prim without a material.
    pub(super) fn display_color(&mut self, prim: &Prim, sizes: Sizes, constants: &Constants, a: &mut Assembly) -> u32 {
        let color = constants.value(prim, "primvars:displayColor", sizes, a).map_or(Rgb::splat(0.5), rgb);
        let opacity = constants.value(prim, "primvars:displayOpacity", sizes, a).map_or(1.0, |[v]| v as f32);
        self.materials.plain(color, opacity, a)
    }

    /// The material of a surface in the colour of a prim, where that is the prim's.
    pub(super) fn colored(&mut self, surface: &Surface, prim: &Prim, sizes: Sizes, constants: &Constants, a: &mut Assembly) -> u32 {
        let Some(color) = surface.color_name.as_ref().and_then(|name| constants.value(prim, name, sizes, a)).map(rgb) else {
            return surface.material;
        };
        *self.colored.entry((surface.material, [color.r, color.g, color.b].map(f32::to_bits))).or_insert_with(|| {
            let mut own = a.material_at(surface.material).clone();
            if let Bsdf::Principled(p) = &mut own.bsdf {
                p.base_color = color.map(|c| c.clamp(0.0, 1.0)).into();
            }
            own.name = format!("{} {:.3} {:.3} {:.3}", own.name, color.r, color.g, color.b);
            a.push_material(own)
        })
    }

    /// A material with the emission of a mesh light; one that glows by itself keeps its own strength, tinted.
    pub(super) fn glowing(&mut self, material: u32, radiance: Rgb, a: &mut Assembly) -> u32 {
        let key = (material, [radiance.r, radiance.g, radiance.b].map(f32::to_bits));
        if let Some(&known) = self.glowing.get(&key) {
            return known;
        }
        let mut lit: Material = a.material_at(material).clone();
        let own = lit.emission;
        let tinted = ColorParam { factor: own.factor * radiance, texture: own.texture };
        lit.emission = if own.factor.is_black() { radiance.into() } else { tinted };
        lit.name = format!("{} (light)", lit.name);
        let index = a.push_material(lit);
        self.glowing.insert(key, index);
        index
    }
}

fn rgb(color: [f64; 3]) -> Rgb {
    Rgb::from(color.map(|v| v as f32))
}

/// Texture coordinates by the name that the material asks for, else `st`, else the first that there are.
pub(super) fn uvs(prim: &Prim, wanted: &str, sizes: Sizes, a: &mut Assembly) -> Option<Primvar<2>> {
    let is_pair = |property: &str| {
        let kind = prim.property(property, field::TYPE).and_then(|v| v.as_text()).unwrap_or("");
        kind.starts_with("texCoord2") || kind.starts_with("float2") && property.to_ascii_lowercase().contains("uv")
    };
    let properties = prim.properties();
    let has = |name: &&str| properties.iter().any(|p| &**p == *name);
    let wanted = format!("primvars:{wanted}");
    let first = properties.iter().map(|p| &**p).filter(|p| p.starts_with("primvars:") && !p.ends_with(":indices")).find(|p| is_pair(p));
    let name = [wanted.as_str(), "primvars:st"].into_iter().find(has).or(first)?;
    Primvar::read(prim, name, "constant", sizes, a)
}

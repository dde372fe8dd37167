//! What a prim's surface is: its bound material or its display colour, and which texture coordinates that asks for.

use super::bind::Binding;
use super::layer::field;
use super::primvar::{Primvar, Sizes};
use super::stage::Prim;
use super::value::Value;
use super::walk::Walk;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use enfilade_scene::{ColorParam, Material};

impl Walk<'_> {
    /// Scene index of the bound material, and the primvar of its texture coordinates.
    pub(super) fn material_of(
        &mut self,
        prim: &Prim,
        binding: Option<&Binding>,
        a: &mut Assembly,
    ) -> Result<Option<(u32, String)>, ImportError> {
        let Some(binding) = binding else { return Ok(None) };
        let double_sided = prim.value("doubleSided").and_then(Value::as_bool).unwrap_or(false);
        let found = self.materials.get(self.stage, &binding.material, double_sided, a)?;
        if found.is_none() {
            a.warn(&prim.path, format!("its material <{}> is not there; its display colour stands in", binding.material));
        }
        Ok(found)
    }

    /// A material of the display colour of a prim without a material.
    pub(super) fn display_color(&mut self, prim: &Prim, sizes: Sizes, a: &mut Assembly) -> Result<u32, ImportError> {
        let color = Primvar::<3>::read(prim, "primvars:displayColor", "constant", sizes, a)?;
        if color.as_ref().is_some_and(|c| !c.is_constant()) {
            a.warn(&prim.path, "its display colours vary over the surface; their mean was taken");
        }
        let color = color.map_or(Rgb::splat(0.5), |c| Rgb::from(c.mean().map(|v| v as f32)));
        Ok(self.materials.plain(color, a))
    }

    /// A material that emits as a mesh light says; one that glows by itself keeps its own strength, tinted.
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

/// Texture coordinates by the name that the material asks for, else `st`, else the first that there are.
pub(super) fn uvs(prim: &Prim, wanted: &str, sizes: Sizes, a: &mut Assembly) -> Result<Option<Primvar<2>>, ImportError> {
    let is_pair = |property: &str| {
        let kind = prim.property(property, field::TYPE).and_then(|v| v.as_text()).unwrap_or("");
        kind.starts_with("texCoord2") || kind.starts_with("float2") && property.to_ascii_lowercase().contains("uv")
    };
    let properties = prim.properties();
    let has = |name: &&str| properties.iter().any(|p| &**p == *name);
    let wanted = format!("primvars:{wanted}");
    let first = properties.iter().map(|p| &**p).filter(|p| p.starts_with("primvars:") && !p.ends_with(":indices")).find(|p| is_pair(p));
    let Some(name) = [wanted.as_str(), "primvars:st"].into_iter().find(has).or(first) else { return Ok(None) };
    Primvar::read(prim, name, "constant", sizes, a)
}

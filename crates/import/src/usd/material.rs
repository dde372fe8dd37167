//! Materials: `UsdPreviewSurface`, and what can be known of other surfaces.

use super::mtlx::{first, is_solid, named};
use super::shader::{Source, id, source};
use super::stage::{Prim, Stage};
use super::texture::Textures;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Principled, ScalarParam};
use std::collections::HashMap;
use std::rc::Rc;

/// Outputs of a material that may hold a surface: for every renderer first, then for particular ones.
const CONTEXTS: [&str; 7] = [
    "outputs:surface",
    "outputs:glslfx:surface",
    "outputs:mtlx:surface",
    "outputs:mdl:surface",
    "outputs:ri:surface",
    "outputs:arnold:surface",
    "outputs:cycles:surface",
];

/// Above this reflectance at normal incidence a specular colour is a metal's.
const METAL_F0: f32 = 0.5;

/// The materials met so far.
#[derive(Default)]
pub(super) struct Materials {
    known: HashMap<(String, bool), (u32, String)>,
    colors: HashMap<[u32; 3], u32>,
    pub(super) baked: HashMap<String, u32>,
}

impl Materials {
    /// Scene index of the material at a path, and the primvar of its texture coordinates. `None` when there is no material there.
    pub(super) fn get(
        &mut self,
        stage: &mut Stage,
        path: &str,
        double_sided: bool,
        a: &mut Assembly,
    ) -> Result<Option<(u32, String)>, ImportError> {
        let Some(prim) = stage.at(path, a)?.filter(|p| p.kind() == "Material") else { return Ok(None) };
        let key = (prim.identity(), double_sided);
        if let Some(known) = self.known.get(&key) {
            return Ok(Some(known.clone()));
        }
        let mut reader = Textures { stage, a, user: format!("material <{path}>"), uv_name: None, baked: &mut self.baked };
        let mut material = reader.material(&prim)?;
        material.emits_both_sides = double_sided && !material.emission.factor.is_black();
        let uv_name = reader.uv_name.unwrap_or_else(|| "st".into());
        let found = (a.push_material(material), uv_name);
        self.known.insert(key, found.clone());
        Ok(Some(found))
    }

    /// A plain material of a colour, for prims that have nothing but that.
    pub(super) fn plain(&mut self, color: Rgb, a: &mut Assembly) -> u32 {
        *self.colors.entry([color.r, color.g, color.b].map(f32::to_bits)).or_insert_with(|| {
            let base_color = color.map(|c| c.clamp(0.0, 1.0)).into();
            let bsdf = Bsdf::Principled(Box::new(Principled { base_color, roughness: 0.5.into(), ..Principled::default() }));
            a.push_material(Material::new(format!("displayColor {:.3} {:.3} {:.3}", color.r, color.g, color.b), bsdf))
        })
    }
}

impl Textures<'_, '_, '_> {
    fn material(&mut self, prim: &Rc<Prim>) -> Result<Material, ImportError> {
        let mut other = None;
        for output in CONTEXTS {
            if let Source::Shader(shader, _) = source(self.stage, prim, output, self.a)? {
                if id(&shader) == "UsdPreviewSurface" {
                    return self.preview_or_mtlx(prim, &shader);
                }
                other.get_or_insert(shader);
            }
        }
        match other {
            Some(shader) => self.foreign(prim.name(), &shader),
            None => {
                self.warn("the material has no surface; a plain grey stands in");
                Ok(Material::diffuse(prim.name(), Rgb::splat(0.5)))
            }
        }
    }

    /// The surface of a material that has a preview surface, and perhaps one of MaterialX beside it.
    fn preview_or_mtlx(&mut self, prim: &Rc<Prim>, preview: &Rc<Prim>) -> Result<Material, ImportError> {
        let Some(mtlx) = self.mtlx_surface(prim)? else { return self.preview_surface(prim.name(), preview) };
        if self.stands_in(preview, &mtlx)? {
            return self.foreign(prim.name(), &mtlx);
        }
        let mut material = self.preview_surface(prim.name(), preview)?;
        self.complete(&mut material, &mtlx)?;
        Ok(material)
    }

    /// UsdPreviewSurface 2.6 as the metallic-roughness model.
    fn preview_surface(&mut self, name: &str, shader: &Rc<Prim>) -> Result<Material, ImportError> {
        let ior = self.scalar(shader, "inputs:ior", 1.5)?.factor;
        let mut p = Principled {
            base_color: self.color(shader, "inputs:diffuseColor", Rgb::splat(0.18))?,
            roughness: self.scalar(shader, "inputs:roughness", 0.5)?,
            clearcoat: self.scalar(shader, "inputs:clearcoat", 0.0)?,
            clearcoat_roughness: self.scalar(shader, "inputs:clearcoatRoughness", 0.01)?,
            ior: index_of_refraction(ior),
            ..Principled::default()
        };
        if self.scalar(shader, "inputs:useSpecularWorkflow", 0.0)?.factor != 0.0 {
            self.specular_workflow(shader, &mut p)?;
        } else {
            p.metallic = self.scalar(shader, "inputs:metallic", 0.0)?;
        }
        let emission = self.color(shader, "inputs:emissiveColor", Rgb::BLACK)?;
        let alpha = self.alpha(shader, "inputs:opacity")?;
        let normal_map = self.normal(shader, "inputs:normal")?;
        for (input, what) in [("inputs:displacement", "displacement"), ("inputs:occlusion", "occlusion")] {
            let used = match source(self.stage, shader, input, self.a)? {
                Source::Shader(..) => true,
                Source::Value(value, _) => what == "displacement" && value.as_number() != Some(0.0),
                Source::Default => false,
            };
            if used && what == "displacement" {
                self.warn("its displacement was left out; the surface stays as it is");
            }
        }
        Ok(Material { emission, alpha, normal_map, ..Material::new(name, Bsdf::Principled(Box::new(p))) })
    }

    /// The specular workflow states reflectance at normal incidence as a colour, instead of metallic and index of refraction.
    fn specular_workflow(&mut self, shader: &Rc<Prim>, p: &mut Principled) -> Result<(), ImportError> {
        let specular = self.color(shader, "inputs:specularColor", Rgb::BLACK)?;
        let f0 = specular.factor.max_component();
        if specular.texture.is_none() && f0 > METAL_F0 {
            self.warn("its specular colour is that of a metal; it was made one, and its diffuse colour left out");
            (p.metallic, p.base_color) = (1.0.into(), specular);
        } else if specular.texture.is_none() {
            let root = f0.max(0.0).sqrt();
            p.ior = ((1.0 + root) / (1.0 - root)).max(1.000_1);
            p.specular_color = if f0 > 0.0 { (specular.factor * (1.0 / f0)).into() } else { Rgb::BLACK.into() };
        } else {
            let own = ((p.ior - 1.0) / (p.ior + 1.0)).powi(2);
            self.warn(format!("its specular colour from a texture counts up to {own:.3}, the reflectance by its ior"));
            p.specular_color = ColorParam { factor: specular.factor * (1.0 / own), texture: specular.texture };
        }
        Ok(())
    }

    fn alpha(&mut self, shader: &Rc<Prim>, opacity: &str) -> Result<Alpha, ImportError> {
        let opacity = self.scalar(shader, opacity, 1.0)?;
        let cutoff = self.scalar(shader, "inputs:opacityThreshold", 0.0)?.factor;
        let opaque = |t: &(enfilade_scene::TextureRef, u8)| t.1 == 3 && crate::images::is_opaque(self.a.image_at(t.0.image));
        let opacity = ScalarParam { texture: opacity.texture.filter(|t| !opaque(t)), ..opacity };
        if opacity.texture.is_none() && opacity.factor >= 1.0 {
            return Ok(Alpha::Opaque);
        }
        Ok(if cutoff > 0.0 { Alpha::Mask { opacity, cutoff } } else { Alpha::Blend { opacity } })
    }

    /// A surface of another renderer, by the names that its inputs usually have.
    fn foreign(&mut self, name: &str, shader: &Rc<Prim>) -> Result<Material, ImportError> {
        let kind = id(shader);
        self.warn(format!(
            "its surface is {kind:?}, of which base colour, opacity, roughness, metallic, emission and transmission were guessed by name"
        ));
        let first = |names: &[&'static str]| first(shader, names);
        let base = first(named::BASE);
        let picture = first(&["inputs:diffuse_texture", "inputs:base_color_texture"]);
        let roughness = first(&["inputs:specular_roughness", "inputs:reflection_roughness_constant", "inputs:roughness"]);
        let metallic = first(&["inputs:metalness", "inputs:base_metalness", "inputs:metallic_constant", "inputs:metallic"]);
        let glow = first(&["inputs:emission_color", "inputs:emissive_color", "inputs:emissive"]);
        let strength = first(named::GLOW_STRENGTH);
        let ior = self.scalar(shader, first(&["inputs:specular_ior", "inputs:specular_IOR"]), 1.5)?.factor;
        let mut p = Principled {
            base_color: self.color(shader, base, Rgb::splat(0.5))?,
            roughness: self.scalar(shader, roughness, 0.5)?,
            metallic: self.scalar(shader, metallic, 0.0)?,
            transmission: self.scalar(shader, first(named::TRANSMISSION), 0.0)?,
            ior: index_of_refraction(ior),
            ..Principled::default()
        };
        p.solid = p.transmission.factor > 0.0 && is_solid(shader);
        if let (false, Source::Value(value, layer)) = (picture.is_empty(), source(self.stage, shader, picture, self.a)?)
            && let Some(asset) = value.as_text().filter(|t| !t.is_empty()).map(str::to_string)
        {
            let image = self.picture(&asset, &layer, crate::images::Use::Color)?;
            p.base_color = ColorParam { factor: Rgb::WHITE, texture: image.map(enfilade_scene::TextureRef::new) };
        }
        let enabled = shader.value("inputs:enable_emission").and_then(|v| v.as_bool()).unwrap_or(!strength.is_empty());
        let mut emission = ColorParam::from(Rgb::BLACK);
        if enabled {
            emission = self.color(shader, glow, Rgb::WHITE)?;
            emission.factor *= self.scalar(shader, strength, 1.0)?.factor;
        }
        let alpha = self.alpha(shader, first(&["inputs:geometry_opacity"]))?;
        Ok(Material { emission, alpha, ..Material::new(name, Bsdf::Principled(Box::new(p))) })
    }
}

/// An index of refraction, where it is one; else that of glass.
fn index_of_refraction(found: f32) -> f32 {
    if found > 1.0 && found.is_finite() { found } else { 1.5 }
}

//! Materials: which surface of a material is read, and `UsdPreviewSurface`.

use super::shader::{Source, id, source};
use super::stage::{Prim, Stage};
use super::texture::Textures;
use crate::ImportError;
use crate::assembly::Assembly;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Principled, ScalarParam};
use std::collections::HashMap;
use std::rc::Rc;

/// Outputs of a material that may have a surface: for every renderer first, then for particular ones.
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
    known: HashMap<(String, bool), Surface>,
    colors: HashMap<[u32; 4], u32>,
    pub(super) baked: HashMap<String, u32>,
}

/// A material as the prims that bind it need it.
#[derive(Clone)]
pub(super) struct Surface {
    /// Scene index of the material.
    pub material: u32,
    /// Primvar of its texture coordinates.
    pub uv_name: String,
    /// The primvar of each prim that is its base colour, where one is.
    pub color_name: Option<String>,
}

impl Materials {
    /// The material at a path. `None` when there is none.
    pub(super) fn get(
        &mut self,
        stage: &mut Stage,
        path: &str,
        double_sided: bool,
        a: &mut Assembly,
    ) -> Result<Option<Surface>, ImportError> {
        let Some(prim) = stage.at(path, a)?.filter(|p| p.kind() == "Material") else { return Ok(None) };
        let key = (prim.identity(), double_sided);
        if let Some(known) = self.known.get(&key) {
            return Ok(Some(known.clone()));
        }
        let mut reader = Textures { stage, a, user: format!("material <{path}>"), uv_name: None, color_name: None, baked: &mut self.baked };
        let mut material = reader.material(&prim)?;
        material.emits_both_sides = double_sided && !material.emission.factor.is_black();
        let (uv_name, color_name) = (reader.uv_name.unwrap_or_else(|| "st".into()), reader.color_name);
        let found = Surface { material: a.push_material(material), uv_name, color_name };
        self.known.insert(key, found.clone());
        Ok(Some(found))
    }

    /// A plain material of a colour, for prims that have nothing but that.
    pub(super) fn plain(&mut self, color: Rgb, opacity: f32, a: &mut Assembly) -> u32 {
        *self.colors.entry([color.r, color.g, color.b, opacity].map(f32::to_bits)).or_insert_with(|| {
            let base_color = color.map(|c| c.clamp(0.0, 1.0)).into();
            let bsdf = Bsdf::Principled(Box::new(Principled { base_color, roughness: 0.5.into(), ..Principled::default() }));
            let mut name = format!("displayColor {:.3} {:.3} {:.3}", color.r, color.g, color.b);
            let mut alpha = Alpha::Opaque;
            if opacity < 1.0 {
                name += &format!(" {opacity:.3}");
                alpha = Alpha::Blend { opacity: opacity.max(0.0).into() };
            }
            a.push_material(Material { alpha, ..Material::new(name, bsdf) })
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
        let alpha = self.alpha(shader, "inputs:opacity", "inputs:opacityThreshold")?;
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

    /// Opacity by the inputs for it and for the threshold below which the surface is absent. Without a threshold, light is blended.
    pub(super) fn alpha(&mut self, shader: &Rc<Prim>, opacity: &str, threshold: &str) -> Result<Alpha, ImportError> {
        let opacity = self.scalar(shader, opacity, 1.0)?;
        let cutoff = self.scalar(shader, threshold, 0.0)?.factor;
        let opaque = |t: &(enfilade_scene::TextureRef, u8)| t.1 == 3 && crate::images::is_opaque(self.a.image_at(t.0.image));
        let opacity = ScalarParam { texture: opacity.texture.filter(|t| !opaque(t)), ..opacity };
        if opacity.texture.is_none() && opacity.factor >= 1.0 {
            return Ok(Alpha::Opaque);
        }
        Ok(if cutoff > 0.0 { Alpha::Mask { opacity, cutoff } } else { Alpha::Blend { opacity } })
    }
}

/// An index of refraction, if it is valid; else glass's.
pub(super) fn index_of_refraction(found: f32) -> f32 {
    if found > 1.0 && found.is_finite() { found } else { 1.5 }
}

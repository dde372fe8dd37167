//! Material plugins to materials: lists by id, and what is inside those that only add to another one.

use super::plugins::Handle;
use super::reader::{MAX_CHAIN, MAX_LAYERS, Made, Reader};
use crate::ImportError;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap};

/// Replaces surfaces that have no counterpart.
pub(super) const MID_GREY: f32 = 0.5;

/// The surface of a material or BRDF plugin.
#[derive(Clone)]
pub(super) struct Surface {
    pub bsdf: Bsdf,
    pub emission: ColorParam,
    pub emits_both_sides: bool,
    pub alpha: Alpha,
    pub normal_map: Option<NormalMap>,
}

impl From<Bsdf> for Surface {
    fn from(bsdf: Bsdf) -> Self {
        Self { bsdf, emission: Rgb::BLACK.into(), emits_both_sides: false, alpha: Alpha::Opaque, normal_map: None }
    }
}

/// Materials that add to another one something that is not supported, and the parameter that names the other one.
const AROUND: [(&str, &str); 7] = [
    ("Mtl2Sided", "front"),
    ("MtlDoubleSided", "front"),
    ("MtlOverride", "base_mtl"),
    ("MtlWrapper", "base_material"),
    ("MtlRenderStats", "base_mtl"),
    ("MtlMaterialID", "base_mtl"),
    ("MtlRoundEdges", "base_mtl"),
];

impl<'n> Reader<'n, '_> {
    /// The materials of a node with their ids; a single one has id 0. Never empty.
    pub(super) fn materials_of(&mut self, node: Handle<'n>) -> Result<Vec<(i32, Made)>, ImportError> {
        let Some(material) = node.reference("material")? else {
            self.warn(node, "it has no material; a mid grey stands in");
            return Ok(vec![(0, self.grey())]);
        };
        let material = self.innermost(material)?;
        if material.kind() != "MtlMulti" {
            return Ok(vec![(0, self.material(material)?)]);
        }
        let list = material.references("mtls_list")?;
        let ids = material.ints("ids_list")?;
        if !ids.is_empty() && ids.len() != list.len() {
            let problem = format!("found {} ids, expected one for each of the {} materials; correct the list", ids.len(), list.len());
            return Err(material.error("ids_list", problem));
        }
        let mut made = Vec::new();
        for (i, plugin) in list.into_iter().enumerate() {
            made.push((ids.get(i).copied().unwrap_or(i as i32), self.material(plugin)?));
        }
        if made.is_empty() {
            self.warn(material, "it has no materials; a mid grey stands in");
            made.push((0, self.grey()));
        }
        Ok(made)
    }

    /// The material within materials that only add to it.
    fn innermost(&mut self, material: Handle<'n>) -> Result<Handle<'n>, ImportError> {
        let mut at = material;
        for _ in 0..MAX_CHAIN {
            let Some((kind, parameter)) = AROUND.iter().find(|(kind, _)| *kind == at.kind()) else { return Ok(at) };
            let Some(within) = at.reference(parameter)? else { return Ok(at) };
            if !matches!(*kind, "MtlRenderStats" | "MtlMaterialID") {
                self.warn(at, format!("{kind} is not supported; the material in {parameter} was used alone"));
            }
            at = within;
        }
        Err(material.error("base_mtl", "materials refer to each other in a circle; refer to a material with a BRDF"))
    }

    fn grey(&mut self) -> Made {
        // Plugins have indices below this one.
        if let Some(made) = self.materials.get(&usize::MAX) {
            return made.clone();
        }
        let name = "no_material".to_string();
        let index = self.a.push_material(Material::diffuse(&name, Rgb::splat(MID_GREY)));
        let made = Made { index, name, channel: None };
        self.materials.insert(usize::MAX, made.clone());
        made
    }

    /// The material of a plugin, made at first use.
    fn material(&mut self, plugin: Handle<'n>) -> Result<Made, ImportError> {
        if let Some(made) = self.materials.get(&plugin.index) {
            return Ok(made.clone());
        }
        self.channel = None;
        self.layers = 0;
        let surface = self.surface(plugin, 0)?;
        let name = plugin.name();
        let mut material = Material::new(&name, surface.bsdf);
        material.emission = surface.emission;
        material.emits_both_sides = surface.emits_both_sides;
        material.alpha = surface.alpha;
        material.normal_map = surface.normal_map;
        let made = Made { index: self.a.push_material(material), name, channel: self.channel };
        self.materials.insert(plugin.index, made.clone());
        Ok(made)
    }

    /// The surface of a material or BRDF plugin; `depth` counts the plugins on the way to it.
    pub(super) fn surface(&mut self, plugin: Handle<'n>, depth: usize) -> Result<Surface, ImportError> {
        self.layers += 1;
        if self.layers > MAX_LAYERS {
            return Err(plugin.error("brdf", format!("the material has more than {MAX_LAYERS} BRDFs; use fewer layers")));
        }
        if depth > MAX_CHAIN {
            return Err(plugin.error("brdf", "materials refer to each other in a circle; correct the reference that closes it"));
        }
        let plugin = self.innermost(plugin)?;
        match plugin.kind() {
            "MtlSingleBRDF" => match plugin.reference("brdf")? {
                Some(brdf) => self.surface(brdf, depth + 1),
                None => {
                    self.warn(plugin, "it has no brdf; a mid grey stands in");
                    Ok(Bsdf::Diffuse { reflectance: Rgb::splat(MID_GREY).into() }.into())
                }
            },
            "MtlMulti" => match plugin.references("mtls_list")?.first() {
                Some(first) => {
                    self.warn(plugin, "a list of materials within another material is not supported; its first one was used");
                    self.surface(*first, depth + 1)
                }
                None => self.substitute(plugin),
            },
            "BRDFVRayMtl" => self.vray_mtl(plugin),
            "BRDFLayered" => self.layered(plugin, depth),
            "BRDFBump" => {
                let Some(base) = plugin.reference("base_brdf")? else { return self.substitute(plugin) };
                let mut surface = self.surface(base, depth + 1)?;
                surface.normal_map = self.bump(plugin, "bump_tex_color", "bump_tex_mult", "map_type")?.or(surface.normal_map);
                Ok(surface)
            }
            _ => self.brdf(plugin),
        }
    }

    /// A diffuse surface of the colour that an unsupported plugin has, as far as it can be known.
    pub(super) fn substitute(&mut self, plugin: Handle<'n>) -> Result<Surface, ImportError> {
        const COLORS: [&str; 7] = ["diffuse", "diffuse_color", "base_color", "color", "overall_color", "diffuse_tex", "paint_color"];
        let found = COLORS.iter().find(|c| plugin.plugin.parameter(c).is_some());
        let reflectance = found.map_or(Ok(Rgb::splat(MID_GREY).into()), |c| self.color(plugin, c, Rgb::splat(MID_GREY)))?;
        let of = found.map_or("of mid grey".to_string(), |c| format!("of its {c}"));
        self.warn(plugin, format!("{} is not supported; a diffuse surface {of} stands in", plugin.kind()));
        Ok(Bsdf::Diffuse { reflectance }.into())
    }
}

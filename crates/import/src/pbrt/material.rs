//! Materials, and how they come together with emission and masks.

use super::definition::MaterialDefinition;
use super::made::{Emission, Surface};
use super::params::{Params, Values};
use super::reader::{MAX_REFERENCES, Reader};
use super::version::Version;
use crate::ImportError;
use crate::assembly::Source;
use crate::images::Use;
use crate::roughness::oren_nayar;
use crate::spectrum::Kind;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap, TextureRef};

/// A mix consists of at most this many materials, those within its parts counted.
const MAX_MIXED: usize = 64;

impl Reader<'_> {
    /// Notes a material; returns its index.
    pub(super) fn define_material(&mut self, definition: MaterialDefinition) -> usize {
        self.materials.push(definition);
        self.materials.len() - 1
    }

    /// The name that parts of a material begin with.
    pub(super) fn material_name(&self, index: usize) -> String {
        self.materials[index].name.clone().unwrap_or_else(|| "inline".to_string())
    }

    /// The scene's material for a surface with an emission, a mask and a medium inside. `None` where there is nothing to see.
    pub(super) fn material(&mut self, index: usize, emission: Option<Emission>, mask: Alpha) -> Result<Option<u32>, ImportError> {
        let inside = self.state.inside.clone();
        let key = format!("{index} {emission:?} {mask:?} {inside}");
        if let Some(&known) = self.finished.get(&key) {
            return Ok(known);
        }
        let Surface { bsdf, alpha, normal_map } = self.surface(index, 0)?;
        let bsdf = match bsdf {
            Some(Bsdf::Dielectric { eta, alpha, transmittance, .. }) => {
                let absorption = self.media.get(&*inside).copied().unwrap_or(Rgb::BLACK) * (1.0 / self.a.meters_per_unit()) as f32;
                Some(Bsdf::Dielectric { eta, alpha, transmittance, absorption })
            }
            None if emission.is_some() => Some(Bsdf::Diffuse { reflectance: Rgb::BLACK.into() }),
            other => other,
        };
        let material = bsdf.map(|bsdf| Material {
            name: format!("{}{}", self.material_name(index), if emission.is_some() { "_emitter" } else { "" }),
            bsdf,
            emission: emission.map_or(Rgb::BLACK.into(), |e| e.radiance),
            two_sided: true,
            emits_both_sides: emission.is_some_and(|e| e.both_sides),
            alpha: if mask == Alpha::Opaque { alpha } else { mask },
            normal_map,
        });
        let made = material.map(|m| self.a.push_material(m));
        self.finished.insert(key, made);
        Ok(made)
    }

    fn surface(&mut self, index: usize, depth: usize) -> Result<Surface, ImportError> {
        if let Some(known) = self.surfaces.get(&index) {
            return Ok(known.clone());
        }
        let MaterialDefinition { class, params, .. } = self.materials[index].clone();
        if depth > MAX_REFERENCES {
            return Err(params.place.error("materials are mixed in a circle; remove one of the mixes"));
        }
        let mut surface = match class.as_str() {
            "" | "none" | "interface" => Surface { bsdf: None, ..Bsdf::Diffuse { reflectance: Rgb::BLACK.into() }.into() },
            "mix" => self.mix(&params, depth)?,
            _ => self.scattering(&class, &params)?,
        };
        if surface.normal_map.is_none() {
            surface.normal_map = self.relief(&params)?;
        }
        self.report_unused(&params, &["type", "thickness", "maxdepth", "nsamples", "regularize"]);
        self.surfaces.insert(index, surface.clone());
        Ok(surface)
    }

    /// Bump and normal maps.
    fn relief(&mut self, params: &Params) -> Result<Option<NormalMap>, ImportError> {
        if let Some(path) = params.string("normalmap")? {
            let image = self.a.image(&Source::File(path), Use::Data, &params.place.text())?;
            return Ok(image.map(|i| NormalMap::Normal { texture: TextureRef::new(i), scale: 1.0 }));
        }
        let Some(name) = ["displacement", "bumpmap"].into_iter().find(|n| params.has(n)) else { return Ok(None) };
        let heights = self.color_param(params, name, Rgb::BLACK)?;
        let scale = heights.factor.luminance() * self.a.meters_per_unit() as f32;
        Ok(heights.texture.map(|texture| NormalMap::Bump { texture, scale }))
    }

    /// Two materials by name. Version 3 states the share of the first, version 4 the share of the second.
    fn mix(&mut self, params: &Params, depth: usize) -> Result<Surface, ImportError> {
        let names: Vec<String> = match params.get("materials").map(|p| &p.values) {
            Some(Values::Strings(names)) => names.clone(),
            _ => ["namedmaterial1", "namedmaterial2"]
                .iter()
                .filter_map(|n| params.string(n).transpose())
                .collect::<Result<Vec<_>, _>>()?
                .into_iter()
                .map(String::from)
                .collect(),
        };
        let [first, second] = &names[..] else {
            return Err(params.place.error(format!("found the names of {} materials to mix, expected two", names.len())));
        };
        let find = |name: &String| {
            self.material_names.get(name).copied().ok_or_else(|| params.place.error(format!("there is no material {name:?}")))
        };
        let (mut first, mut second) = (find(first)?, find(second)?);
        if self.version == Version::V3 {
            (first, second) = (second, first);
        }
        let weight = self.scalar(params, "amount", 0.5)?;
        let (a, b) = (self.surface(first, depth + 1)?, self.surface(second, depth + 1)?);
        if [&a, &b].iter().filter_map(|s| s.bsdf.as_ref()).map(count_of).sum::<usize>() > MAX_MIXED {
            return Err(params.place.error(format!("mixes within mixes come to more than {MAX_MIXED} materials; simplify them")));
        }
        if a.alpha != b.alpha || a.normal_map != b.normal_map {
            self.warn(&params.place, "masks and relief within a mix are not mixed; those of the first were used");
        }
        let (alpha, normal_map) = (a.alpha, a.normal_map);
        Ok(match (a.bsdf, b.bsdf) {
            (Some(a), Some(b)) => {
                Surface { bsdf: Some(Bsdf::Blend { first: Box::new(a), second: Box::new(b), weight }), alpha, normal_map }
            }
            // Nothing in part of the surface is an opacity.
            (None, bsdf) => Surface { bsdf, alpha: Alpha::Blend { opacity: weight }, normal_map },
            (bsdf, None) => {
                let opacity = self.mapped(weight, "the rest to one", |w| 1.0 - w);
                Surface { bsdf, alpha: Alpha::Blend { opacity }, normal_map }
            }
        })
    }

    /// The materials that scatter light themselves.
    fn scattering(&mut self, class: &str, params: &Params) -> Result<Surface, ImportError> {
        Ok(match class {
            "matte" => self.matte(params)?.into(),
            "diffuse" => Bsdf::Diffuse { reflectance: self.color_param(params, "reflectance", Rgb::splat(0.5))? }.into(),
            "coateddiffuse" => self.coated_diffuse(params)?.into(),
            "plastic" => self.glossy(params, Rgb::splat(0.25), 0.1)?.into(),
            "substrate" => self.substrate(params)?.into(),
            "uber" => self.uber(params)?,
            "disney" => self.disney(params)?.into(),
            "metal" | "conductor" => self.conductor(params)?.into(),
            "coatedconductor" => self.coated_conductor(params)?.into(),
            "mirror" => {
                let reflectance = self.color_param(params, "Kr", Rgb::splat(0.9))?;
                Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance, alpha: 0.0.into() }.into()
            }
            "glass" | "dielectric" => self.glass(params)?.into(),
            "thindielectric" => Bsdf::ThinDielectric { eta: self.index_of_refraction(params)?, transmittance: Rgb::WHITE.into() }.into(),
            "translucent" | "diffusetransmission" => self.translucent(class, params)?.into(),
            other => {
                self.warn(
                    &params.place,
                    format!("{other} materials are not supported; a diffuse one of its colour, or mid grey, stands in"),
                );
                let name = ["Kd", "reflectance", "color"].into_iter().find(|n| params.has(n)).unwrap_or("reflectance");
                let reflectance = self.color_param(params, name, Rgb::splat(0.5))?;
                params.ignore_all();
                Bsdf::Diffuse { reflectance }.into()
            }
        })
    }

    fn matte(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        let reflectance = self.color_param(params, "Kd", Rgb::splat(0.5))?;
        let sigma = self.scalar(params, "sigma", 0.0)?;
        if sigma.texture.is_none() && sigma.factor <= 0.0 {
            return Ok(Bsdf::Diffuse { reflectance });
        }
        // pbrt's sigma is the deviation of the facets' angles in degrees.
        let roughness = self.mapped(sigma, "roughness of sigma", |s| oren_nayar(s.clamp(0.0, 90.0).to_radians().powi(2)));
        Ok(Bsdf::RoughDiffuse { reflectance, roughness })
    }

    /// Fully rough light goes through the interface and comes back changed by what happens within, hence `nonlinear`.
    fn coated_diffuse(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        if !self.color(params, "albedo", Kind::Factor, Rgb::BLACK)?.is_black() {
            self.warn(&params.place, "scattering within the coat is not supported; the coat is clear");
        }
        params.ignore(&["g"]);
        Ok(Bsdf::Plastic {
            diffuse: self.color_param(params, "reflectance", Rgb::splat(0.5))?,
            eta: self.index_of_refraction(params)?,
            alpha: self.alpha(params, "", 0.0)?.into(),
            specular: Rgb::WHITE.into(),
            nonlinear: true,
        })
    }

    fn glass(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        let white = ColorParam::from(Rgb::WHITE);
        if self.color_param(params, "Kr", Rgb::WHITE)? != white {
            self.warn(&params.place, "the reflectance of glass was set to one");
        }
        let transmittance = self.color_param(params, "Kt", Rgb::WHITE)?;
        let (eta, alpha) = (self.index_of_refraction(params)?, self.alpha_of_glass(params)?);
        Ok(Bsdf::Dielectric { eta, alpha: alpha.into(), transmittance, absorption: Rgb::BLACK })
    }

    /// Only what is reflected is kept.
    fn translucent(&mut self, class: &str, params: &Params) -> Result<Bsdf, ImportError> {
        self.warn(&params.place, "diffuse transmission is not supported; only what the surface reflects was kept");
        if class == "diffusetransmission" {
            params.ignore(&["transmittance"]);
            let mut reflectance = self.color_param(params, "reflectance", Rgb::splat(0.25))?;
            reflectance.factor *= params.float_or("scale", 1.0)? as f32;
            return Ok(Bsdf::Diffuse { reflectance });
        }
        params.ignore(&["transmit"]);
        let share = self.color_param(params, "reflect", Rgb::splat(0.5))?;
        if share.texture.is_some() {
            self.warn(&params.place, "the textured share of what is reflected was dropped");
        }
        let glossy = self.glossy(params, Rgb::splat(0.25), 0.1)?;
        Ok(match glossy {
            Bsdf::Principled(mut p) => {
                p.base_color.factor *= share.factor;
                p.specular.factor *= share.factor.max_component();
                Bsdf::Principled(p)
            }
            other => other,
        })
    }
}

/// Number of materials in a mix.
fn count_of(bsdf: &Bsdf) -> usize {
    match bsdf {
        Bsdf::Blend { first, second, .. } => count_of(first) + count_of(second),
        _ => 1,
    }
}

//! BSDFs to materials.

use super::reader::{Reader, spelling};
use super::spectrum;
use super::texture::Texture;
use super::xml::Node;
use crate::ImportError;
use crate::images::Use;
use crate::roughness::oren_nayar;
use crate::spectrum::{Kind, metal};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, NormalMap, Principled, ScalarParam};

/// GGX roughness where a rough bsdf does not state one.
const DEFAULT_ALPHA: f32 = 0.1;

/// Exponent of Phong's lobe where the bsdf does not state one.
const DEFAULT_EXPONENT: f64 = 30.0;

/// A bsdf in the making: what it scatters, and what the adapters around it add.
pub(super) struct Surface {
    /// `None` for `null`, which scatters nothing.
    bsdf: Option<Bsdf>,
    two_sided: bool,
    pub alpha: Alpha,
    normal_map: Option<NormalMap>,
}

impl Surface {
    fn plain(bsdf: Bsdf) -> Self {
        Self { bsdf: Some(bsdf), two_sided: false, alpha: Alpha::Opaque, normal_map: None }
    }
}

impl<'n> Reader<'n, '_> {
    /// The material of a bsdf and an area emitter, and its name. `None` where there is nothing to see.
    pub(super) fn material(&mut self, bsdf: Option<&'n Node>, emitter: Option<&'n Node>) -> Result<Option<u32>, ImportError> {
        let key = (bsdf.map(std::ptr::from_ref), emitter.map(std::ptr::from_ref), self.attributes.current);
        if let Some(&known) = self.materials.get(&key) {
            return Ok(Some(known));
        }
        let surface = match bsdf {
            Some(node) => self.surface(node, 0)?,
            // A lamp without a bsdf of its own is black.
            None => Surface::plain(Bsdf::Diffuse { reflectance: Rgb::splat(if emitter.is_some() { 0.0 } else { 0.5 }).into() }),
        };
        let emission: ColorParam = match emitter {
            Some(emitter) => self.color(emitter, "radiance", Kind::Emission, Rgb::WHITE)?,
            None => Rgb::BLACK.into(),
        };
        let bsdf_itself = match surface.bsdf {
            Some(bsdf) => bsdf,
            None if emitter.is_some() => Bsdf::Diffuse { reflectance: Rgb::BLACK.into() },
            None => return Ok(None),
        };
        let suffix = if emitter.is_some() { "_emitter" } else { "" };
        let material = Material {
            name: format!("{}{suffix}", name(bsdf)),
            bsdf: bsdf_itself,
            emission,
            two_sided: surface.two_sided,
            emits_both_sides: false,
            alpha: surface.alpha,
            normal_map: surface.normal_map,
        };
        let index = self.a.push_material(material);
        self.materials.insert(key, index);
        Ok(Some(index))
    }

    fn surface(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.visit(node, depth, "bsdfs")?;
        match node.plugin.as_str() {
            "twosided" => {
                self.report_unknown(node, &[], &["bsdf"]);
                if self.objects(node, "bsdf")?.len() > 1 {
                    self.warn(node, "the second bsdf, for the back, was dropped; the first one is on both sides");
                }
                Ok(Surface { two_sided: true, ..self.inner(node, depth)? })
            }
            "mask" => self.mask(node, depth),
            "bumpmap" | "bump" => self.bump_map(node, depth),
            "normalmap" => self.normal_map(node, depth),
            "blendbsdf" | "mixturebsdf" => self.blend(node, depth),
            "coating" | "roughcoating" => self.coating(node, depth),
            "null" => Ok(Surface { bsdf: None, ..Surface::plain(Bsdf::Diffuse { reflectance: Rgb::BLACK.into() }) }),
            _ => Ok(Surface::plain(self.scattering(node)?)),
        }
    }

    /// The bsdf within an adapter.
    pub(super) fn inner(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        let inner = self.objects(node, "bsdf")?.first().copied();
        let inner = inner.ok_or_else(|| node.error(format!("there is no bsdf within the {}", node.plugin)))?;
        self.surface(inner, depth + 1)
    }

    fn bump_map(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["scale"], &["bsdf", "texture"]);
        let surface = self.inner(node, depth)?;
        let Some(texture) = self.objects(node, "texture")?.first().copied() else {
            return Err(node.error("there is no texture within the bump map"));
        };
        let Texture { factor, picture, .. } = self.texture(texture, Use::Color, 0)?;
        let scale = factor.g * (node.float_or("scale", 1.0)? * self.a.meters_per_unit()) as f32;
        Ok(Surface { normal_map: picture.map(|texture| NormalMap::Bump { texture, scale }), ..surface })
    }

    fn normal_map(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["normalmap"], &["bsdf", "texture"]);
        let surface = self.inner(node, depth)?;
        let Some(texture) = self.objects(node, "texture")?.first().copied() else {
            return Err(node.error("there is no texture within the normal map"));
        };
        let picture = self.texture(texture, Use::Data, 0)?.picture;
        Ok(Surface { normal_map: picture.map(|texture| NormalMap::Normal { texture, scale: 1.0 }), ..surface })
    }

    /// Two bsdfs by a weight, or several by a list of weights.
    fn blend(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        self.report_unknown(node, &["weight", "weights"], &["bsdf", "texture"]);
        let inner = self.objects(node, "bsdf")?;
        let weights = match node.child("weights") {
            Some(list) => list.numbers("value")?.into_iter().map(|w| w.max(0.0) as f32).collect(),
            None => vec![0.5; 2],
        };
        if inner.len() < 2 || inner.len() != weights.len() {
            return Err(node.error(format!(
                "found {} bsdfs and {} weights, expected as many of each, and two at least",
                inner.len(),
                weights.len()
            )));
        }
        let total: f32 = weights.iter().sum();
        if node.child("weights").is_some() && (total - 1.0).abs() > 1e-3 {
            self.warn(node, format!("the weights add up to {total}; they were scaled to 1"));
        }
        // The last two first: each step blends one more in front of them.
        let mut blended = self.surface(inner[inner.len() - 1], depth + 1)?;
        let mut weight_behind = weights[weights.len() - 1];
        for i in (0..inner.len() - 1).rev() {
            let first = self.surface(inner[i], depth + 1)?;
            let sum = weights[i] + weight_behind;
            let weight = match node.child("weights") {
                Some(_) => if sum > 0.0 { weight_behind / sum } else { 0.5 }.into(),
                None => self.scalar(node, "weight", 0.5)?,
            };
            blended = self.blend_two(node, first, blended, weight);
            if blended.bsdf.as_ref().is_some_and(|bsdf| bsdf.depth() > Bsdf::DEEPEST) {
                return Err(node.error(format!("bsdfs are blended more than {} deep; blend fewer", Bsdf::DEEPEST)));
            }
            weight_behind = sum;
        }
        Ok(blended)
    }

    /// `weight` is the share of the second.
    fn blend_two(&mut self, node: &'n Node, first: Surface, second: Surface, weight: ScalarParam) -> Surface {
        if first.normal_map != second.normal_map || first.alpha != second.alpha {
            self.warn(node, "normal maps and masks within a blend are not blended; those of the heavier bsdf are on both");
        }
        let second_is_heavier = weight.texture.is_none() && weight.factor > 0.5;
        let (alpha, normal_map) = if second_is_heavier { (second.alpha, second.normal_map) } else { (first.alpha, first.normal_map) };
        let two_sided = first.two_sided || second.two_sided;
        let surface = |bsdf, alpha| Surface { bsdf, two_sided, alpha, normal_map };
        match (first.bsdf, second.bsdf) {
            (Some(first), Some(second)) => surface(Some(Bsdf::Blend { first: Box::new(first), second: Box::new(second), weight }), alpha),
            // Nothing in part of the surface is an opacity.
            (None, bsdf) if bsdf.is_some() => surface(bsdf, Alpha::Blend { opacity: weight }),
            (bsdf, _) if weight.texture.is_none() => surface(bsdf, Alpha::Blend { opacity: (1.0 - weight.factor).into() }),
            (bsdf, _) => {
                self.warn(node, "a textured blend towards null is not supported; the first bsdf was used");
                surface(bsdf, alpha)
            }
        }
    }

    fn coating(&mut self, node: &'n Node, depth: usize) -> Result<Surface, ImportError> {
        let known = ["int_ior", "ext_ior", "alpha", "distribution", "specular_reflectance", "thickness", "sigma_a", "nonlinear"];
        self.report_unknown(node, &known, &["bsdf"]);
        let surface = self.inner(node, depth)?;
        let Some(Bsdf::Diffuse { reflectance }) = surface.bsdf else {
            self.warn(node, "a coat over anything but a diffuse base is not supported; the coat was dropped");
            return Ok(surface);
        };
        self.warn(node, "a coat over a diffuse base was taken for plastic");
        let alpha = if node.plugin == "roughcoating" { self.scalar(node, "alpha", DEFAULT_ALPHA)? } else { 0.0.into() };
        let eta = eta(node, "bk7")? as f32;
        let bsdf = Bsdf::Plastic { diffuse: reflectance, eta, alpha, specular: Rgb::WHITE.into(), nonlinear: false };
        Ok(Surface { bsdf: Some(bsdf), ..surface })
    }

    /// The bsdfs that scatter light themselves.
    fn scattering(&mut self, node: &'n Node) -> Result<Bsdf, ImportError> {
        let white = Rgb::WHITE;
        match node.plugin.as_str() {
            "diffuse" | "lambertian" | "roughdiffuse" | "difftrans" => {
                self.report_unknown(node, &["reflectance", "diffuse_reflectance", "transmittance", "alpha", "use_fast_approx"], &[]);
                if node.plugin == "difftrans" {
                    self.warn(node, "difftrans treated as a diffuse reflector");
                }
                let name = ["reflectance", "diffuse_reflectance", "transmittance"].into_iter().find(|n| node.child(n).is_some());
                let reflectance = self.color(node, name.unwrap_or("reflectance"), Kind::Factor, Rgb::splat(0.5))?;
                if node.plugin != "roughdiffuse" {
                    return Ok(Bsdf::Diffuse { reflectance });
                }
                // Mitsuba takes alpha/√2 for the deviation of the facets' angles.
                let roughness = self.scalar(node, "alpha", 0.2)?;
                if roughness.texture.is_some() {
                    self.warn(node, "a textured roughness of a diffuse reflector is read as that of Oren and Nayar in Portsmouth's form");
                    return Ok(Bsdf::RoughDiffuse { reflectance, roughness });
                }
                Ok(Bsdf::RoughDiffuse { reflectance, roughness: oren_nayar(0.5 * roughness.factor * roughness.factor).into() })
            }
            "plastic" | "roughplastic" | "pplastic" => {
                const KNOWN: [&str; 9] = [
                    "diffuse_reflectance",
                    "specular_reflectance",
                    "int_ior",
                    "ext_ior",
                    "nonlinear",
                    "alpha",
                    "distribution",
                    "sample_visible",
                    "specular_sampling_weight",
                ];
                self.report_unknown(node, &KNOWN, &[]);
                let diffuse = self.color(node, "diffuse_reflectance", Kind::Factor, Rgb::splat(0.5))?;
                let specular = self.color(node, "specular_reflectance", Kind::Factor, white)?;
                let alpha = self.alpha(node)?;
                let nonlinear = node.flag("nonlinear", false);
                Ok(Bsdf::Plastic { diffuse, eta: eta(node, "polypropylene")? as f32, alpha, specular, nonlinear })
            }
            "conductor" | "roughconductor" => self.conductor(node),
            "dielectric" | "roughdielectric" | "thindielectric" => {
                const KNOWN: [&str; 9] = [
                    "int_ior",
                    "ext_ior",
                    "specular_reflectance",
                    "specular_transmittance",
                    "alpha",
                    "alpha_u",
                    "alpha_v",
                    "distribution",
                    "sample_visible",
                ];
                self.report_unknown(node, &KNOWN, &[]);
                if self.color(node, "specular_reflectance", Kind::Factor, white)? != white.into() {
                    self.warn(node, "the reflectance of a dielectric was set to one");
                }
                let transmittance = self.color(node, "specular_transmittance", Kind::Factor, white)?;
                let eta = eta(node, "bk7")? as f32;
                if node.plugin == "thindielectric" {
                    return Ok(Bsdf::ThinDielectric { eta, transmittance });
                }
                Ok(Bsdf::Dielectric { eta, alpha: self.alpha(node)?, transmittance, absorption: Rgb::BLACK })
            }
            "phong" | "ward" => {
                self.report_unknown(
                    node,
                    &["diffuse_reflectance", "specular_reflectance", "exponent", "alpha_u", "alpha_v", "variant"],
                    &[],
                );
                self.warn(node, format!("{} treated as plastic of the same roughness", node.plugin));
                let exponent = self.plain(node, "exponent")?.or((node.plugin == "phong").then_some(DEFAULT_EXPONENT));
                let alpha_of_exponent = exponent.map(|n| (2.0 / (n.max(0.0) + 2.0)).sqrt());
                let alpha = alpha_of_exponent.or(self.plain(node, "alpha_u")?).unwrap_or(f64::from(DEFAULT_ALPHA)) as f32;
                let diffuse = self.color(node, "diffuse_reflectance", Kind::Factor, Rgb::splat(0.5))?;
                let specular = self.color(node, "specular_reflectance", Kind::Factor, Rgb::splat(0.2))?;
                Ok(Bsdf::Plastic { diffuse, eta: 1.5, alpha: alpha.into(), specular, nonlinear: false })
            }
            "principled" | "principledthin" => self.principled(node),
            other => {
                self.warn(node, format!("{other} bsdfs are not supported{}; a diffuse mid grey stands in", spelling(other)));
                Ok(Bsdf::Diffuse { reflectance: Rgb::splat(0.5).into() })
            }
        }
    }

    fn conductor(&mut self, node: &'n Node) -> Result<Bsdf, ImportError> {
        const KNOWN: [&str; 10] =
            ["material", "eta", "k", "ext_eta", "specular_reflectance", "alpha", "alpha_u", "alpha_v", "distribution", "sample_visible"];
        self.report_unknown(node, &KNOWN, &[]);
        let material = node.raw_text("material").unwrap_or(if self.version < 2 { "Cu" } else { "none" });
        let (mut eta, mut k) = match metal(material) {
            Some(known) => known,
            None => {
                self.warn(node, format!("the metal {material:?} is not known; aluminium stands in"));
                metal("al").unwrap_or_default()
            }
        };
        // Mitsuba's `none` has eta 0 and k 1, which is as perfect a mirror as ours until another eta is stated.
        if material.trim().eq_ignore_ascii_case("none") && node.child("eta").is_some() {
            k = Rgb::WHITE;
        }
        for (name, value) in [("eta", &mut eta), ("k", &mut k)] {
            if let Some(property) = self.property(node, name)? {
                if property.tag == "texture" {
                    self.warn(property, "textured indices of refraction are not supported; the metal's own was kept");
                } else {
                    *value = spectrum::color(property, Kind::Factor)?;
                }
            }
        }
        // Version 0.x takes air where nothing is stated, which is 0.03 % from nothing.
        let outside = index(node, "ext_eta", "vacuum")? as f32;
        (eta, k) = (eta * (1.0 / outside), k * (1.0 / outside));
        let reflectance = self.color(node, "specular_reflectance", Kind::Factor, Rgb::WHITE)?;
        Ok(Bsdf::Conductor { eta, k, reflectance, alpha: self.alpha(node)? })
    }

    /// Mitsuba's Disney-like model by glTF's parameters.
    fn principled(&mut self, node: &'n Node) -> Result<Bsdf, ImportError> {
        const KNOWN: [&str; 13] = [
            "base_color",
            "roughness",
            "metallic",
            "specular",
            "eta",
            "spec_trans",
            "clearcoat",
            "clearcoat_gloss",
            "sheen",
            "sheen_tint",
            "spec_tint",
            "diffuse_reflectance_sampling_rate",
            "specular_sampling_rate",
        ];
        self.report_unknown(node, &KNOWN, &[]);
        let specular = self.plain(node, "specular")?.unwrap_or(0.5).clamp(0.0, 0.999);
        let from_specular = 2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0;
        let ior = self.plain(node, "eta")?.unwrap_or(from_specular);
        let base_color = self.color(node, "base_color", Kind::Factor, Rgb::splat(0.5))?;
        let mut share = |name: &str| Ok::<f64, ImportError>(self.plain(node, name)?.unwrap_or(0.0).clamp(0.0, 1.0));
        let (gloss, sheen_tint, specular_tint) = (share("clearcoat_gloss")?, share("sheen_tint")?, share("spec_tint")?);
        let sheen = self.plain(node, "sheen")?.unwrap_or(0.0);
        if base_color.texture.is_some() && (specular_tint > 0.0 || sheen_tint * sheen > 0.0) {
            self.warn(node, "a tint by a textured base colour is not supported; that by the texture's factor was used");
        }
        // Tints are by the base colour at a luminance of one.
        let luminance = base_color.factor.luminance();
        let hue = if luminance > 0.0 { base_color.factor * (1.0 / luminance) } else { Rgb::WHITE };
        let clearcoat = self.scalar(node, "clearcoat", 0.0)?;
        let p = Principled {
            base_color,
            metallic: self.scalar(node, "metallic", 0.0)?,
            roughness: self.scalar(node, "roughness", 0.5)?,
            ior: ior.max(1.0) as f32,
            specular_color: Rgb::WHITE.lerp(hue, specular_tint as f32).into(),
            transmission: self.scalar(node, "spec_trans", 0.0)?,
            solid: node.plugin == "principled",
            // The model's coat has a quarter of a dielectric's strength, and its alpha runs from 0.1 to 0.001.
            clearcoat: ScalarParam { factor: 0.25 * clearcoat.factor, ..clearcoat },
            clearcoat_roughness: ((0.1 + (0.001 - 0.1) * gloss).sqrt() as f32).into(),
            sheen_color: (Rgb::WHITE.lerp(hue, sheen_tint as f32) * sheen as f32).into(),
            sheen_roughness: 0.5.into(),
            ..Principled::default()
        };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// GGX alpha: zero for smooth bsdfs, the mean of both directions for anisotropic ones.
    fn alpha(&mut self, node: &'n Node) -> Result<ScalarParam, ImportError> {
        if !node.plugin.starts_with("rough") {
            return Ok(0.0.into());
        }
        let distribution = node.text("distribution").unwrap_or_else(|| "beckmann".to_string());
        if distribution != "ggx" {
            self.warn(node, format!("the {distribution} distribution was replaced by GGX of the same alpha"));
        }
        if node.child("alpha_u").is_none() && node.child("alpha_v").is_none() {
            return self.scalar(node, "alpha", DEFAULT_ALPHA);
        }
        let (u, v) = (self.scalar(node, "alpha_u", DEFAULT_ALPHA)?, self.scalar(node, "alpha_v", DEFAULT_ALPHA)?);
        self.warn(node, "anisotropic roughness was replaced by its mean");
        Ok(ScalarParam { factor: 0.5 * (u.factor + v.factor), texture: u.texture.or(v.texture) })
    }
}

/// The name of a bsdf's material: its id, or `inline`.
pub(super) fn name(bsdf: Option<&Node>) -> &str {
    bsdf.and_then(|b| b.id.as_deref()).unwrap_or("inline")
}

/// Interior over exterior index of refraction.
fn eta(node: &Node, default_interior: &str) -> Result<f64, ImportError> {
    Ok(index(node, "int_ior", default_interior)? / index(node, "ext_ior", "air")?)
}

/// An index of refraction, a number or the name of a substance; that of the substance `default` where there is none.
fn index(node: &Node, name: &str, default: &str) -> Result<f64, ImportError> {
    let Some(property) = node.child(name) else { return Ok(spectrum::substance(default).unwrap_or(1.5)) };
    let text = property.attribute("value").unwrap_or_default();
    let value = spectrum::substance(text).or_else(|| text.trim().parse().ok()).filter(|v: &f64| v.is_finite() && *v > 0.0);
    value.ok_or_else(|| property.error(format!("found {text:?}, expected an index of refraction above zero or the name of a substance")))
}

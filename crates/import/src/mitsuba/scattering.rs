//! The bsdfs that scatter light themselves: diffuse ones, plastics, conductors, dielectrics and the principled model.

use super::reader::{Reader, spelling};
use super::spectrum;
use super::xml::Node;
use crate::ImportError;
use crate::roughness::oren_nayar;
use crate::spectrum::{Kind, metal};
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, Disney, Distribution, Roughness, ScalarParam};

/// Roughness where a rough bsdf does not state one.
const DEFAULT_ALPHA: f32 = 0.1;

/// Exponent of Phong's lobe where the bsdf does not state one.
const DEFAULT_EXPONENT: f64 = 30.0;

impl<'n> Reader<'n, '_> {
    /// The bsdfs that scatter light themselves.
    pub(super) fn scattering(&mut self, node: &'n Node) -> Result<Bsdf, ImportError> {
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

    /// Disney's model.
    fn principled(&mut self, node: &'n Node) -> Result<Bsdf, ImportError> {
        const KNOWN: [&str; 21] = [
            "base_color",
            "roughness",
            "anisotropic",
            "metallic",
            "specular",
            "eta",
            "spec_trans",
            "diff_trans",
            "clearcoat",
            "clearcoat_gloss",
            "sheen",
            "sheen_tint",
            "spec_tint",
            "flatness",
            "diffuse_reflectance_sampling_rate",
            "diffuse_transmittance_sampling_rate",
            "specular_reflectance_sampling_rate",
            "specular_transmittance_sampling_rate",
            "main_specular_sampling_rate",
            "clearcoat_sampling_rate",
            "specular_sampling_rate",
        ];
        self.report_unknown(node, &KNOWN, &[]);
        let thin = node.plugin == "principledthin";
        // What Mitsuba's other plugin has would be an error there.
        let absent: &[&str] = if thin { &["metallic", "specular", "clearcoat", "clearcoat_gloss"] } else { &["diff_trans"] };
        for child in node.children.iter().filter(|child| absent.contains(&child.name.as_str())) {
            self.warn(child, format!("ignored in {}", node.plugin));
        }
        let anisotropic = self.scalar(node, "anisotropic", 0.0)?;
        if anisotropic.factor != 0.0 {
            self.warn(node, format!("anisotropic is not supported in {}; roughness is the same in all directions", node.plugin));
        }
        let spec_trans = self.scalar(node, "spec_trans", 0.0)?;
        let mut share = |name: &str, default: f32| self.scalar(node, name, default);
        let disney = Disney {
            roughness: share("roughness", 0.5)?,
            metallic: share("metallic", 0.0)?,
            spec_tint: share("spec_tint", 0.0)?,
            sheen: share("sheen", 0.0)?,
            sheen_tint: share("sheen_tint", 0.0)?,
            flatness: share("flatness", 0.0)?,
            clearcoat: share("clearcoat", 0.0)?,
            clearcoat_gloss: share("clearcoat_gloss", 0.0)?,
            diff_trans: share("diff_trans", 0.0)?,
            base_color: self.color(node, "base_color", Kind::Factor, Rgb::splat(0.5))?,
            eta: self.principled_eta(node, thin, spec_trans.factor > 0.0)?,
            spec_trans,
            thin,
        };
        Ok(Bsdf::Disney(Box::new(disney)))
    }

    /// The index of refraction, stated or by `specular`; an index of one is none where light is refracted.
    fn principled_eta(&mut self, node: &'n Node, thin: bool, refracts: bool) -> Result<f32, ImportError> {
        if let Some(eta) = self.plain(node, "eta")? {
            let eta = if eta.is_finite() && eta > 0.0 { eta } else { 1.0 };
            return Ok(if refracts && eta == 1.0 { 1.001 } else { eta as f32 });
        }
        if thin {
            return Ok(1.5);
        }
        let specular = self.plain(node, "specular")?.unwrap_or(0.5).clamp(0.0, 12.0);
        let specular = if refracts && specular == 0.0 { 1e-3 } else { specular };
        Ok((2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0) as f32)
    }

    /// Roughness: zero for smooth bsdfs, the mean of both directions for anisotropic ones.
    pub(super) fn alpha(&mut self, node: &'n Node) -> Result<Roughness, ImportError> {
        if !node.plugin.starts_with("rough") {
            return Ok(0.0.into());
        }
        let distribution = match node.text("distribution").as_deref() {
            Some("ggx") => Distribution::Ggx,
            None | Some("beckmann") => Distribution::Beckmann,
            Some(other) => {
                self.warn(node, format!("the {other} distribution was replaced by Beckmann's of the same alpha"));
                Distribution::Beckmann
            }
        };
        if node.child("alpha_u").is_none() && node.child("alpha_v").is_none() {
            return Ok(Roughness { param: self.scalar(node, "alpha", DEFAULT_ALPHA)?, distribution });
        }
        let (u, v) = (self.scalar(node, "alpha_u", DEFAULT_ALPHA)?, self.scalar(node, "alpha_v", DEFAULT_ALPHA)?);
        self.warn(node, "anisotropic roughness was replaced by its mean");
        let param = ScalarParam { factor: 0.5 * (u.factor + v.factor), texture: u.texture.or(v.texture) };
        Ok(Roughness { param, distribution })
    }
}

/// Interior over exterior index of refraction.
pub(super) fn eta(node: &Node, default_interior: &str) -> Result<f64, ImportError> {
    Ok(index(node, "int_ior", default_interior)? / index(node, "ext_ior", "air")?)
}

/// An index of refraction, a number or the name of a substance; the substance `default` if there is none.
fn index(node: &Node, name: &str, default: &str) -> Result<f64, ImportError> {
    let Some(property) = node.child(name) else { return Ok(spectrum::substance(default).unwrap_or(1.5)) };
    let text = property.attribute("value").unwrap_or_default();
    let value = spectrum::substance(text).or_else(|| text.trim().parse().ok()).filter(|v: &f64| v.is_finite() && *v > 0.0);
    value.ok_or_else(|| property.error(format!("found {text:?}, expected an index of refraction above zero or the name of a substance")))
}

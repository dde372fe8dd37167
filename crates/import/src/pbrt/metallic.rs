//! Metals, and the materials of several layers as glTF's metallic-roughness model, whose layers share the light as pbrt's lobes do.

use super::made::Surface;
use super::params::Params;
use super::reader::Reader;
use super::spectra::copper;
use crate::ImportError;
use crate::spectrum::Kind;
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, ColorParam, Principled, ScalarParam};

/// Index of refraction of the coats that do not state theirs.
const COAT: f32 = 1.5;

impl Reader<'_> {
    /// A conductor by its index of refraction, or in version 4 by its reflectance.
    pub(super) fn conductor(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        let alpha = self.alpha(params, "", if params.has("reflectance") || self.is_fourth() { 0.0 } else { 0.01 })?;
        let white = ColorParam::from(Rgb::WHITE);
        if params.has("reflectance") {
            let reflectance = self.color_param(params, "reflectance", Rgb::WHITE)?;
            return Ok(match reflectance.texture {
                None => {
                    let (eta, k) = index_of_reflectance(reflectance.factor);
                    Bsdf::Conductor { eta, k, reflectance: white, alpha: alpha.into() }
                }
                Some(_) => Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance, alpha: alpha.into() },
            });
        }
        let (eta, k) = self.index_of_metal(params, "")?;
        Ok(Bsdf::Conductor { eta, k, reflectance: white, alpha: alpha.into() })
    }

    fn is_fourth(&self) -> bool {
        self.version == super::version::Version::V4
    }

    /// `eta` and `k`, copper's by default.
    fn index_of_metal(&mut self, params: &Params, prefix: &str) -> Result<(Rgb, Rgb), ImportError> {
        let mut found = copper();
        for (name, value) in [("eta", &mut found.0), ("k", &mut found.1)] {
            *value = self.index_param(params, &format!("{prefix}{name}"), *value)?;
        }
        Ok(found)
    }

    /// A spectrum that is the same everywhere, or a default.
    fn index_param(&mut self, params: &Params, name: &str, default: Rgb) -> Result<Rgb, ImportError> {
        if params.get(name).is_some_and(|p| p.kind == "texture") {
            let value = self.color_param(params, name, default)?;
            if value.texture.is_some() {
                self.warn(&params.place, "textured indices of refraction are not supported; copper's was used");
                return Ok(default);
            }
            return Ok(value.factor);
        }
        self.color(params, name, Kind::Factor, default)
    }

    /// A metal under a clear coat: its reflectance within the coat as base colour, and glTF's coat.
    pub(super) fn coated_conductor(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        let coat = params.float("interface.eta")?.map_or(COAT, |e| e as f32);
        let base_color = if params.has("reflectance") {
            self.color_param(params, "reflectance", Rgb::WHITE)?
        } else {
            let (eta, k) = self.index_of_metal(params, "conductor.")?;
            let channel = |eta: f32, k: f32| normal_reflectance(eta / coat, k / coat);
            Rgb::new(channel(eta.r, k.r), channel(eta.g, k.g), channel(eta.b, k.b)).into()
        };
        if !self.color(params, "albedo", Kind::Factor, Rgb::BLACK)?.is_black() {
            self.warn(&params.place, "scattering within the coat is not supported; the coat is clear");
        }
        params.ignore(&["g"]);
        if (coat - COAT).abs() > 1e-3 {
            self.warn(&params.place, format!("the coat's index of refraction, {coat}, was taken for {COAT}"));
        }
        let (metal, coat) = (self.alpha(params, "conductor.", 0.0)?, self.alpha(params, "interface.", 0.0)?);
        let p = Principled {
            base_color,
            metallic: 1.0.into(),
            roughness: self.perceptual(metal),
            clearcoat: 1.0.into(),
            clearcoat_roughness: self.perceptual(coat),
            ..Principled::default()
        };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// The roughness whose square is `alpha`.
    fn perceptual(&mut self, alpha: ScalarParam) -> ScalarParam {
        self.mapped(alpha, "perceptual roughness", |a| a.max(0.0).sqrt())
    }

    /// `Kd` under a coat that reflects `Ks` times Fresnel's term.
    pub(super) fn glossy(&mut self, params: &Params, default: Rgb, roughness: f32) -> Result<Bsdf, ImportError> {
        let diffuse = self.color_param(params, "Kd", default)?;
        let specular = self.color_param(params, "Ks", default)?;
        let eta = self.index_of_refraction(params)?;
        if specular.factor.is_black() {
            params.ignore(&["roughness", "uroughness", "vroughness", "remaproughness"]);
            return Ok(Bsdf::Diffuse { reflectance: diffuse });
        }
        let alpha = self.alpha(params, "", roughness)?;
        let strength = specular.factor.max_component();
        let p = Principled {
            base_color: diffuse,
            roughness: self.perceptual(alpha),
            ior: eta,
            specular: strength.into(),
            specular_color: ColorParam { factor: specular.factor * (1.0 / strength), ..specular },
            ..Principled::default()
        };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// Ashikhmin and Shirley's blend: `Ks` is the reflectance at normal incidence, rising to one.
    pub(super) fn substrate(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        let specular = self.color_param(params, "Ks", Rgb::splat(0.5))?;
        let base_color = self.color_param(params, "Kd", Rgb::splat(0.5))?;
        let strength = specular.factor.max_component().clamp(0.0, 0.99);
        if strength == 0.0 {
            return Ok(Bsdf::Diffuse { reflectance: base_color });
        }
        let alpha = self.alpha(params, "", 0.1)?;
        let p = Principled {
            base_color,
            roughness: self.perceptual(alpha),
            // The index whose reflectance at normal incidence is the strength.
            ior: (1.0 + strength.sqrt()) / (1.0 - strength.sqrt()),
            specular_color: ColorParam { factor: specular.factor * (1.0 / specular.factor.max_component()), ..specular },
            ..Principled::default()
        };
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// Diffuse, glossy, mirrored and refracted light side by side, and an opacity.
    pub(super) fn uber(&mut self, params: &Params) -> Result<Surface, ImportError> {
        let (mirror, through) = (self.color_param(params, "Kr", Rgb::BLACK)?, self.color_param(params, "Kt", Rgb::BLACK)?);
        let opacity = self.color_param(params, "opacity", Rgb::WHITE)?;
        let glossy = self.glossy(params, Rgb::splat(0.25), 0.1)?;
        let bsdf = self.with_mirror_and_refraction(params, glossy, mirror, through)?;
        let o = opacity.factor;
        if o.r != o.g || o.g != o.b {
            self.warn(&params.place, "the coloured opacity was replaced by its luminance");
        }
        let factor = if o.r == o.g && o.g == o.b { o.r } else { o.luminance() };
        let opaque = opacity.texture.is_none() && factor >= 1.0;
        let opacity = ScalarParam { factor, texture: opacity.texture.map(|t| (t, 0)) };
        Ok(Surface { alpha: if opaque { Alpha::Opaque } else { Alpha::Blend { opacity } }, ..bsdf.into() })
    }

    fn with_mirror_and_refraction(
        &mut self,
        params: &Params,
        glossy: Bsdf,
        mirror: ColorParam,
        through: ColorParam,
    ) -> Result<Bsdf, ImportError> {
        if mirror.factor.is_black() && through.factor.is_black() {
            return Ok(glossy);
        }
        let eta = self.index_of_refraction(params)?;
        let mut p = match glossy {
            Bsdf::Principled(p) => *p,
            Bsdf::Diffuse { reflectance } => {
                Principled { base_color: reflectance, ior: eta, specular: 0.0.into(), ..Principled::default() }
            }
            other => return Ok(other),
        };
        if p.base_color.factor.is_black() && !through.factor.is_black() {
            return Ok(Bsdf::Dielectric { eta, alpha: 0.0.into(), transmittance: through, absorption: Rgb::BLACK });
        }
        if !through.factor.is_black() {
            self.warn(&params.place, "diffuse and refracted light together were approximated by a share that is refracted");
            let share = through.factor.luminance() / (through.factor.luminance() + p.base_color.factor.luminance());
            p.transmission = share.into();
            p.solid = true;
            p.base_color.factor += through.factor;
        }
        if !mirror.factor.is_black() {
            // The mirror-like part is a smooth coat of its strength.
            p.clearcoat = mirror.factor.max_component().min(1.0).into();
        }
        Ok(Bsdf::Principled(Box::new(p)))
    }

    /// Burley's model by glTF's parameters.
    pub(super) fn disney(&mut self, params: &Params) -> Result<Bsdf, ImportError> {
        let base_color = self.color_param(params, "color", Rgb::splat(0.5))?;
        let sheen = self.scalar(params, "sheen", 0.0)?.factor;
        let tint = self.scalar(params, "sheentint", 0.5)?.factor.clamp(0.0, 1.0);
        let specular_tint = self.scalar(params, "speculartint", 0.0)?.factor.clamp(0.0, 1.0);
        let gloss = self.scalar(params, "clearcoatgloss", 1.0)?.factor.clamp(0.0, 1.0);
        let luminance = base_color.factor.luminance().max(1e-6);
        let hue = base_color.factor * (1.0 / luminance);
        let p = Principled {
            base_color,
            metallic: self.scalar(params, "metallic", 0.0)?,
            roughness: self.scalar(params, "roughness", 0.5)?,
            ior: self.index_of_refraction(params)?,
            specular_color: Rgb::WHITE.lerp(hue, specular_tint).into(),
            transmission: self.scalar(params, "spectrans", 0.0)?,
            solid: !params.flag("thin", false)?,
            // The model's coat has a quarter of a dielectric's strength, and its alpha runs from 0.1 to 0.001.
            clearcoat: (0.25 * self.scalar(params, "clearcoat", 0.0)?.factor).into(),
            clearcoat_roughness: (0.1 + (0.001 - 0.1) * gloss).sqrt().into(),
            sheen_color: (Rgb::WHITE.lerp(hue, tint) * sheen).into(),
            sheen_roughness: 0.5.into(),
            ..Principled::default()
        };
        Ok(Bsdf::Principled(Box::new(p)))
    }
}

/// An index of refraction of real part one with a reflectance at normal incidence, as pbrt-v4 makes it.
fn index_of_reflectance(reflectance: Rgb) -> (Rgb, Rgb) {
    let k = reflectance.map(|r| {
        let r = r.clamp(0.0, 0.9999);
        2.0 * r.sqrt() / (1.0 - r).sqrt()
    });
    (Rgb::WHITE, k)
}

/// Fresnel's reflectance at normal incidence.
fn normal_reflectance(eta: f32, k: f32) -> f32 {
    ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metal_by_its_reflectance_reflects_that_much() {
        let (eta, k) = index_of_reflectance(Rgb::new(0.9, 0.5, 0.1));
        for (eta, k, expected) in [(eta.r, k.r, 0.9), (eta.g, k.g, 0.5), (eta.b, k.b, 0.1)] {
            assert!((normal_reflectance(eta, k) - expected).abs() < 1e-6);
        }
    }
}

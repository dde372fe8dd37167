//! Lights: those without a surface, and the emission of area lights.

use super::made::Emission;
use super::params::Params;
use super::reader::Reader;
use super::version::Version;
use crate::ImportError;
use crate::assembly::Source;
use crate::images::Use;
use crate::spectrum::Kind;
use enfilade_math::{DAffine3, DVec3, Rgb};
use enfilade_scene::{ColorParam, Light, SpotFalloff, TextureRef};
use std::f64::consts::PI;

impl Reader<'_> {
    /// Adds a light without a surface.
    pub(super) fn light(&mut self, class: &str, params: &Params) -> Result<(), ImportError> {
        self.next_light += 1;
        let name = format!("{class}_light_{}", self.next_light);
        let file_from_light = self.file_from_world * self.state.ctm;
        match class {
            "infinite" | "exinfinite" => self.infinite(params)?,
            "distant" => {
                let (from, to) = (params.point_or("from", DVec3::ZERO)?, params.point_or("to", DVec3::Z)?);
                let illuminance = params.float_or("illuminance", -1.0)?;
                let factor = if illuminance > 0.0 { illuminance } else { 1.0 };
                let irradiance = self.emitted(params, "L")? * factor as f32;
                let direction = file_from_light.transform_vector3(to - from).normalize_or_zero().as_vec3();
                self.a.push_light(Light::Directional { name, direction, irradiance, angular_radius_rad: 0.0 });
            }
            "spot" => self.spot(name, file_from_light, params)?,
            "point" | "goniometric" => {
                if class == "goniometric" {
                    self.warn(&params.place, "the picture of intensities was dropped; the light shines alike in all directions");
                    params.ignore(&["filename", "mapname"]);
                }
                let at = file_from_light.transform_point3(params.point_or("from", DVec3::ZERO)?);
                let intensity = self.emitted(params, "I")? * power_factor(params, 4.0 * PI)?;
                self.a.push_light_at(at, Light::Point { name, position: at.as_vec3(), intensity });
            }
            _ => {
                self.warn(&params.place, format!("{class} lights are not supported; it was left out"));
                return Ok(());
            }
        }
        self.report_unused(params, &["samples", "nsamples"]);
        Ok(())
    }

    /// A light's colour times its `scale`, which is a number or in version 3 a colour.
    pub(super) fn emitted(&mut self, params: &Params, name: &str) -> Result<Rgb, ImportError> {
        Ok(self.color(params, name, Kind::Emission, Rgb::WHITE)? * self.color(params, "scale", Kind::Factor, Rgb::WHITE)?)
    }

    fn spot(&mut self, name: String, file_from_light: DAffine3, params: &Params) -> Result<(), ImportError> {
        let (from, to) = (params.point_or("from", DVec3::ZERO)?, params.point_or("to", DVec3::Z)?);
        let outer = params.float_or("coneangle", 30.0)?.clamp(0.0, 180.0);
        let inner = (outer - params.float_or("conedeltaangle", 5.0)?).clamp(0.0, outer);
        let cosines = [inner, outer].map(|angle| angle.to_radians().cos());
        let solid_angle = 2.0 * PI * ((1.0 - cosines[0]) + 0.5 * (cosines[0] - cosines[1]));
        let intensity = self.emitted(params, "I")? * power_factor(params, solid_angle)?;
        let falloff = if self.version == Version::V4 { SpotFalloff::SmoothCosine } else { SpotFalloff::CosineSquare };
        if inner < outer && self.version == Version::V3 {
            self.warn(
                &params.place,
                "between its two angles the light dims by the second power of a line in the cosine, not by the fourth",
            );
        }
        let at = file_from_light.transform_point3(from);
        let light = Light::Spot {
            name,
            position: at.as_vec3(),
            direction: file_from_light.transform_vector3(to - from).normalize_or_zero().as_vec3(),
            intensity,
            inner_rad: inner.to_radians() as f32,
            outer_rad: outer.to_radians() as f32,
            falloff,
        };
        self.a.push_light_at(at, light);
        Ok(())
    }

    /// The emission of a shape that is an area light; pbrt counts it as `pieces` shapes and gives `power` to each.
    pub(super) fn area_emission(&mut self, params: &Params, area: f64, pieces: usize) -> Result<Emission, ImportError> {
        let both_sides = params.flag("twosided", false)?;
        let sides = if both_sides { 2.0 } else { 1.0 };
        let mut radiance = ColorParam::from(self.emitted(params, "L")?);
        let mut mean = 1.0;
        if let Some(path) = params.string("filename")?.filter(|_| self.version == Version::V4) {
            let image = self.a.image(&Source::File(path), Use::Color, &params.place.text())?;
            radiance.texture = image.map(TextureRef::new);
            mean = radiance.texture.map_or(1.0, |t| f64::from(self.mean(t.into()).luminance()));
        }
        if params.float_or("power", -1.0)? > 0.0 && pieces > 1 {
            self.warn(&params.place, "pbrt gives each triangle of a mesh the whole power; all have the radiance of the mean one here");
        }
        radiance.factor *= power_factor(params, sides * area * PI * mean / pieces as f64)?;
        self.report_unused(params, &["samples", "nsamples"]);
        Ok(Emission { radiance, both_sides })
    }
}

/// The factor by which a strength that gives the flux `flux` gives the flux of the parameter `power`; one where that is absent.
fn power_factor(params: &Params, flux: f64) -> Result<f32, ImportError> {
    let power = params.float_or("power", -1.0)?;
    Ok(if power > 0.0 && flux > 0.0 { power / flux } else { 1.0 } as f32)
}

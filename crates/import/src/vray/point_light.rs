//! Lights without a surface: points, spots, photometric profiles and distant light. All that have a direction shine along −z.

use super::light::Strength;
use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use crate::assembly::mat3_f32;
use crate::ies;
use enfilade_math::{DMat3, DVec3, Rgb};
use enfilade_scene::{Light, SpotFalloff};
use std::f64::consts::PI;

impl<'n> Reader<'n, '_> {
    pub(super) fn point_light(&mut self, light: Handle<'n>) -> Result<(), ImportError> {
        let placement = light.transform("transform")?;
        let position = placement.translation.as_vec3();
        let direction = placement.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
        let name = light.name();
        match light.kind() {
            "LightDirect" | "LightDirectMax" | "MayaLightDirect" => {
                let Strength::Image(color) = self.strength(light, false)? else {
                    self.warn(light, "distant light in photometric units is not supported and was left out; give it in default units");
                    return Ok(());
                };
                let irradiance = color * PI as f32;
                self.a.push_light(Light::Directional { name, direction, irradiance, angular_radius_rad: 0.0 });
            }
            "LightIES" => self.profile(light)?,
            kind if kind.starts_with("LightOmni") => {
                let intensity = self.intensity(light, 4.0 * PI)?;
                self.a.push_light_at(placement.translation, Light::Point { name, position, intensity });
            }
            _ => {
                let (inner, outer) = self.cone(light)?;
                let intensity = self.intensity(light, 2.0 * PI * (1.0 - outer.cos()))?;
                let (inner_rad, outer_rad, falloff) = (inner as f32, outer as f32, SpotFalloff::Angle);
                self.a.push_light_at(
                    placement.translation,
                    Light::Spot { name, position, direction, intensity, inner_rad, outer_rad, falloff },
                );
            }
        }
        Ok(())
    }

    /// Intensity, in units of the file, of a point that shines into a solid angle.
    fn intensity(&mut self, light: Handle<'n>, solid_angle_sr: f64) -> Result<Rgb, ImportError> {
        if light.number("decay", 2.0)? != 2.0 {
            self.warn(light, "light that does not fall off with the square of the distance is not supported; it does here");
        }
        if light.number("shadowRadius", 0.0)? > 0.0 {
            self.warn(light, "soft shadows of point lights (shadowRadius) are not supported; they are sharp");
        }
        // Photometric intensities are per metre, and the assembly scales intensities that are per unit.
        let scale = self.photometric_scale / self.a.meters_per_unit().powi(2);
        Ok(match self.strength(light, false)? {
            Strength::Image(color) => color * PI as f32,
            Strength::Power(lumens, hue) => hue * (lumens / solid_angle_sr * scale) as f32,
            Strength::PerSteradian(candela, hue) => hue * (candela * scale) as f32,
        })
    }

    /// Angles from the axis where a spot begins to dim and where it ends.
    fn cone(&mut self, light: Handle<'n>) -> Result<(f64, f64), ImportError> {
        let (inner, outer) = if light.kind() == "LightSpotMax" {
            (0.5 * light.number("hotspot", PI / 6.0)?, 0.5 * light.number("fallsize", PI / 4.0)?)
        } else {
            let (half, penumbra) = (0.5 * light.number("coneAngle", PI / 4.0)?, light.number("penumbraAngle", 0.0)?);
            // A penumbra below zero is within the cone.
            (half + penumbra.min(0.0), half + penumbra.max(0.0))
        };
        if light.number("dropOff", 0.0)? != 0.0 {
            self.warn(light, "a spot that is brighter in its middle (dropOff) is not supported; it is even within its cone");
        }
        let limit = 0.5 * PI;
        if outer > limit || outer <= 0.0 {
            self.warn(light, format!("a spot of {:.1} degrees from its axis is not supported; it was limited to 90", outer.to_degrees()));
        }
        let outer = outer.clamp(1e-3, limit);
        Ok((inner.clamp(0.0, outer), outer))
    }

    fn profile(&mut self, light: Handle<'n>) -> Result<(), ImportError> {
        let Some(path) = light.text("ies_file")? else {
            self.warn(light, "it names no ies_file and was left out");
            return Ok(());
        };
        let (file, bytes) = self.a.read_from(light.file, &path)?;
        let profile = ies::parse(&bytes, &file, "")?;
        for warning in profile.warnings {
            self.warn(light, warning);
        }
        if light.int("soft_shadows", 0)? != 0 {
            self.warn(light, "soft shadows of the luminaire's shape are not supported; it is a point");
        }
        if light.number("power", 0.0)? > 0.0 {
            self.warn(light, "its power in lumens was not used: the light is as strong as measured");
        }
        let filtered = light.plugin.parameter("filter_color").is_some();
        let tint = if filtered { "filter_color" } else { light.overriding("color", "color_tex")? };
        let color = self.plain_color(light, tint, Rgb::WHITE)? * self.light_level * light.number("intensity", 1.0)?.max(0.0) as f32;
        let placement = light.transform("transform")?;
        let m = placement.matrix3;
        let (Some(x), Some(z)) = (m.x_axis.try_normalize(), m.z_axis.try_normalize()) else {
            self.warn(light, "its placement makes no sense, so it was left out");
            return Ok(());
        };
        let file_from_web = DMat3::from_cols(x, z.cross(x).normalize_or_zero(), z);
        let intensity = color * (self.photometric_scale / self.a.meters_per_unit().powi(2)) as f32;
        self.a.push_light(Light::Profile {
            name: light.name(),
            position: placement.translation.as_vec3(),
            web_from_world: mat3_f32(file_from_web.transpose()),
            intensity,
            web: Box::new(profile.web),
        });
        Ok(())
    }
}

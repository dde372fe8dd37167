//! `SunLight` and `TexSky`, by our own model of the atmosphere in V-Ray's units.

use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use enfilade_math::{DVec3, Rgb};
use enfilade_scene::sky::{Daylight, SUN_RADIUS_RAD};
use enfilade_scene::{Environment, Light};

/// Width of the sky's picture, texels.
const SKY_WIDTH: u32 = 1024;

/// Candela in a kilo-candela.
const KILO: f64 = 1000.0;

impl<'n> Reader<'n, '_> {
    /// Adds the lights of all suns.
    pub(super) fn suns(&mut self) -> Result<(), ImportError> {
        for sun in self.plugins.of_kind("SunLight") {
            if !self.is_on(sun)? {
                continue;
            }
            let daylight = self.daylight(sun)?;
            if daylight.to_sun.z <= 0.0 {
                self.warn(sun, "the sun is below the horizon and gives no light");
                continue;
            }
            let strength = sun.number("intensity_multiplier", 1.0)? as f32;
            let tint = sun.color("filter_color", Rgb::WHITE)? * self.light_level;
            let irradiance = daylight.sun_irradiance() * tint * (strength * (KILO * self.photometric_scale) as f32);
            let angular_radius_rad = SUN_RADIUS_RAD * sun.number("size_multiplier", 1.0)?.clamp(0.0, 100.0) as f32;
            let direction = -daylight.to_sun;
            self.a.push_world_light(Light::Directional { name: sun.name(), direction, irradiance, angular_radius_rad });
        }
        Ok(())
    }

    /// Sets the sky of a `TexSky` as the environment.
    pub(super) fn sky(&mut self, sky: Handle<'n>, scale: Rgb) -> Result<(), ImportError> {
        let source = match sky.reference("sun")? {
            Some(sun) => sun,
            None => self.plugins.of_kind("SunLight").next().unwrap_or(sky),
        };
        let daylight = self.daylight(source)?;
        let strength = source.number("intensity_multiplier", 1.0)? as f32;
        let image = self.a.next_image();
        let (picture, environment, _) = daylight.lights(SKY_WIDTH, (KILO * self.photometric_scale) as f32, image);
        self.a.push_image(picture);
        if let Environment::Map { image, rows, map_from_world, .. } = environment {
            let scale = scale * strength;
            self.a.set_environment(Environment::Map { image, rows, scale, map_from_world }, &sky.place());
        }
        Ok(())
    }

    /// The daylight of a sun, which shines along its −z.
    fn daylight(&mut self, sun: Handle<'n>) -> Result<Daylight, ImportError> {
        self.warn_of_animation(sun, &["transform"]);
        let to_sun = self.a.world_from_file().transform_vector3(sun.transform("transform")?.transform_vector3(DVec3::Z));
        let Some(to_sun) = to_sun.try_normalize() else {
            return Err(sun.error("transform", "it flattens the z axis, which points to the sun; correct the matrix"));
        };
        let turbidity = sun.number("turbidity", 3.0)?.clamp(1.7, 10.0) as f32;
        let ground_albedo = sun.color("ground_albedo", Rgb::splat(0.2))?.luminance().clamp(0.0, 1.0);
        self.warn(sun, "daylight was computed by the atmosphere of Hillaire 2020; expect other colours than V-Ray's");
        Ok(Daylight { to_sun: to_sun.as_vec3(), turbidity, ground_albedo })
    }
}

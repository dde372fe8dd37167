//! Sun and sky from clear to overcast, by day and by night.

use super::outside::{Outside, Surroundings};
use enfilade_math::{Rgb, Vec3, warp};
use enfilade_scene::sky::{Daylight, Overcast};
use std::f32::consts::PI;

/// Directions that sum up the light of the sky on the ground.
const DIRECTIONS: u32 = 256;
/// Luminance of the night sky over a city at the zenith, kcd/m² (0.06 cd/m²; without towns it is some hundred times darker).
const NIGHT: Rgb = Rgb::new(5.2e-5, 5.8e-5, 8.5e-5);

/// Sun and sky of a moment.
pub struct Weather {
    /// Unit direction to the sun.
    pub(super) to_sun: Vec3,
    cloud: f32,
    clear: Box<dyn Fn(Vec3) -> Rgb + Send + Sync>,
    /// Illuminance by the sun's disk through the clouds, on a surface that faces it, kilo-lux.
    pub(super) sun: Rgb,
    /// Illuminance by the whole sky on level ground, kilo-lux.
    sky: Rgb,
}

impl Weather {
    /// With the unit direction to the sun (z up), the clear sky's turbidity and the share of clouds on `[0,1]`.
    pub fn new(to_sun: Vec3, turbidity: f32, cloud: f32) -> Self {
        let cloud = cloud.clamp(0.0, 1.0);
        let day = Daylight { to_sun, turbidity, ground_albedo: 0.2 };
        let sun = day.sun_irradiance() * (1.0 - cloud);
        let mut weather = Self { to_sun, cloud, clear: Box::new(day.sky_radiance()), sun, sky: Rgb::BLACK };
        let direction = |k| warp::cosine_hemisphere(warp::hammersley(k, DIRECTIONS));
        weather.sky = (0..DIRECTIONS).map(|k| weather.radiance(direction(k))).sum::<Rgb>() * (PI / DIRECTIONS as f32);
        weather
    }

    /// Radiance of the sky in the unit direction `d`, kcd/m²; directions below the horizon see it mirrored.
    ///
    /// Clear sky and the CIE's overcast sky are mixed by their shares, and the glow of the night is added.
    pub fn radiance(&self, d: Vec3) -> Rgb {
        let up = Vec3::new(d.x, d.y, d.z.abs());
        let overcast = Overcast { to_sun: self.to_sun }.radiance(up);
        let night = NIGHT * (1.0 + 3.0 * (1.0 - up.z).powi(4));
        (self.clear)(up) * (1.0 - self.cloud) + overcast * self.cloud + night
    }

    /// The surroundings in this light; `seed` decides trees and houses.
    pub(super) fn surroundings(&self, kind: Outside, seed: u32) -> Surroundings {
        Surroundings { kind, to_sun: self.to_sun, sun_klx: self.sun, sky_klx: self.sky, seed }
    }

    /// Illuminance of level ground by the sky, kilo-lux.
    pub fn sky_klx(&self) -> f32 {
        self.sky.luminance()
    }

    /// Illuminance by the sun of a surface that faces it, kilo-lux.
    pub fn sun_klx(&self) -> f32 {
        self.sun.luminance()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(elevation_deg: f32, cloud: f32) -> Weather {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        Weather::new(Vec3::new(0.0, -cos, sin), 3.0, cloud)
    }

    #[test]
    fn the_overcast_sky_is_that_of_the_standard() {
        let sky = at(40.0, 1.0);
        assert!((sky.radiance(Vec3::Z).luminance() / sky.radiance(Vec3::X).luminance() - 3.0).abs() < 0.02);
        assert!((sky.sky_klx() / (0.3 + 21.0 * 40f32.to_radians().sin()) - 1.0).abs() < 0.03, "{}", sky.sky_klx());
        assert_eq!(sky.sun_klx(), 0.0);
    }

    #[test]
    fn light_falls_from_noon_over_dusk_to_night() {
        for cloud in [0.0, 0.5, 1.0] {
            let levels = [60.0, 20.0, 2.0, -4.0, -30.0].map(|e| at(e, cloud).sky_klx());
            assert!(levels.windows(2).all(|p| p[1] < p[0]), "{cloud}: {levels:?}");
            // Dusk has some lux to some tens of lux, a night in town a tenth of a lux.
            assert!((0.001..0.1).contains(&levels[3]) && (5e-5..1e-3).contains(&levels[4]), "{cloud}: {levels:?}");
        }
    }
}

//! Sky and sun by day, at dusk and at dawn, as an environment map and a directional light.

mod overcast;
mod solar_moment;

pub use overcast::Overcast;
pub use solar_moment::SolarMoment;

use crate::atmosphere::Atmosphere;
use crate::{Environment, Image, Light, MapRows, Pixels, direction_from_uv};
use enfilade_math::{Mat3, Rgb, Vec2, Vec3};
use std::f32::consts::PI;

/// Angular radius of the sun seen from the earth, radians.
pub const SUN_RADIUS_RAD: f32 = 0.004_65;

/// Illuminance of the sun above the atmosphere, kilo-lux (Darula, Kittler & Gueymard 2005, "Reference luminous solar constant").
const SOLAR_KLX: f32 = 133.3;

/// Directions that sum up the light of the sky on the ground.
const SKY_DIRECTIONS: u32 = 256;

/// Daylight: the sun's position and the haze of the air.
///
/// The atmosphere is computed as Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", does it.
#[derive(Clone, Copy, Debug)]
pub struct Daylight {
    /// Unit direction towards the sun, z up. Below the horizon it is dusk.
    pub to_sun: Vec3,
    /// Haze, as Preetham, Shirley & Smits 1999 count it: 1 pure air, 2 very clear, 6 warm and moist, 10 hazy.
    pub turbidity: f32,
    /// Share of the light that the ground reflects.
    pub ground_albedo: f32,
}

impl Daylight {
    /// Irradiance of the sun's disk on a surface facing it, at the ground, in kilo-lux as linear RGB.
    pub fn sun_irradiance(&self) -> Rgb {
        self.sun_through(&self.atmosphere())
    }

    /// Radiance of the sky in unit directions (z up), in kilo-candela per square metre as linear RGB; below the horizon the radiance of the
    /// ground, a Lambert surface lit by sun and sky.
    pub fn sky_radiance(&self) -> impl Fn(Vec3) -> Rgb + Sync + use<> {
        let air = self.atmosphere();
        let sun = self.sun_through(&air);
        let dome = air.dome(self.to_sun.as_dvec3());
        let above = move |d: Vec3| dome.radiance(d.as_dvec3()) * SOLAR_KLX;
        let by_sky = (0..SKY_DIRECTIONS)
            .map(|k| above(enfilade_math::warp::cosine_hemisphere(enfilade_math::warp::hammersley(k, SKY_DIRECTIONS))))
            .sum::<Rgb>()
            * (PI / SKY_DIRECTIONS as f32);
        let ground = (sun * self.to_sun.z.max(0.0) + by_sky) * (self.ground_albedo / PI);
        move |d: Vec3| if d.z < 0.0 { ground } else { above(d) }
    }

    fn atmosphere(&self) -> Atmosphere {
        Atmosphere::new(f64::from(self.turbidity), f64::from(self.ground_albedo))
    }

    fn sun_through(&self, air: &Atmosphere) -> Rgb {
        air.sun_transmittance(f64::from(self.to_sun.z), f64::from(SUN_RADIUS_RAD)) * SOLAR_KLX
    }

    /// The sky as an equirectangular environment of `width` × `width`/2 texels, and the sun as a light; both multiplied by
    /// `exposure`. `image` is the index that the picture will have in the scene.
    pub fn lights(&self, width: u32, exposure: f32, image: u32) -> (Image, Environment, Light) {
        let radiance = self.sky_radiance();
        let (picture, environment) = environment(width, image, |d| radiance(d) * exposure);
        let sun = Light::Directional {
            name: "sun".into(),
            direction: -self.to_sun,
            irradiance: self.sun_irradiance() * exposure,
            angular_radius_rad: SUN_RADIUS_RAD,
        };
        (picture, environment, sun)
    }
}

impl Overcast {
    /// The sky as an equirectangular environment of `width` × `width`/2 texels, multiplied by `exposure`, over a ground that reflects
    /// this share of its light. `image` is the index that the picture will have in the scene.
    pub fn lights(&self, width: u32, exposure: f32, ground_albedo: f32, image: u32) -> (Image, Environment) {
        let ground = Rgb::splat(self.ground_klx() * ground_albedo / PI);
        environment(width, image, |d| if d.z < 0.0 { ground * exposure } else { self.radiance(d) * exposure })
    }
}

/// The picture of a sky by its radiance in unit directions (z up), and the environment that shows it.
fn environment(width: u32, image: u32, radiance: impl Fn(Vec3) -> Rgb) -> (Image, Environment) {
    let height = width / 2;
    let map_from_world = Mat3::from_cols(Vec3::X, Vec3::NEG_Z, Vec3::Y); // the map's up is y
    let world_from_map = map_from_world.transpose();
    let texels = (0..width * height)
        .map(|i| {
            let uv = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / Vec2::new(width as f32, height as f32);
            radiance(world_from_map * direction_from_uv(uv)).to_array()
        })
        .collect();
    let picture = Image { name: "sky".into(), width, height, pixels: Pixels::RgbF32(texels) };
    (picture, Environment::Map { image, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn day(elevation_deg: f32, turbidity: f32) -> Daylight {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        Daylight { to_sun: Vec3::new(cos, 0.0, sin), turbidity, ground_albedo: 0.2 }
    }

    /// Illuminance of the sky on the ground, kilo-lux.
    fn diffuse_klx(day: &Daylight) -> f32 {
        let radiance = day.sky_radiance();
        let n = 1024;
        let direction = |k| enfilade_math::warp::cosine_hemisphere(enfilade_math::warp::hammersley(k, n));
        (0..n).map(|k| radiance(direction(k)).luminance()).sum::<f32>() * PI / n as f32
    }

    #[test]
    fn sun_and_clear_sky_are_as_bright_as_measured() {
        // Gillette & Pierpoint 1984 for clear skies: direct normal 127.5 exp(−0.21/sin h), diffuse 0.8 + 15.5 √sin h, kilo-lux.
        for elevation in [15.0f32, 30.0, 60.0, 80.0] {
            let sin = elevation.to_radians().sin();
            let day = day(elevation, 2.2);
            let (sun, sky) = (day.sun_irradiance().luminance(), diffuse_klx(&day));
            let (expected_sun, expected_sky) = (127.5 * (-0.21 / sin).exp(), 0.8 + 15.5 * sin.sqrt());
            assert!((sun / expected_sun - 1.0).abs() < 0.25, "{elevation}°: sun {sun} klx, expected about {expected_sun}");
            assert!((sky / expected_sky - 1.0).abs() < 0.5, "{elevation}°: sky {sky} klx, expected about {expected_sky}");
        }
    }

    #[test]
    fn clear_noon_sky_is_blue_and_brightest_near_the_sun() {
        let day = day(60.0, 3.0);
        let sky = day.sky_radiance();
        let away = sky(Vec3::new(-0.6, 0.0, 0.8));
        assert!(away.b > 1.5 * away.r && away.r > 0.0, "{away:?}");
        assert!(sky(day.to_sun).luminance() > 2.0 * away.luminance());
        // The horizon is whiter and brighter than the zenith, whose luminance is a few thousand cd/m².
        let (zenith, horizon) = (sky(Vec3::Z), sky(Vec3::new(-0.999, 0.0, 0.045).normalize()));
        assert!((1.0..12.0).contains(&zenith.luminance()), "{zenith:?} kcd/m²");
        assert!(horizon.luminance() > zenith.luminance() && horizon.b / horizon.r < zenith.b / zenith.r);
        let sun = day.sun_irradiance();
        assert!(sun.r > sun.b && (60.0..125.0).contains(&sun.luminance()), "{sun:?}");
    }

    #[test]
    fn at_sunset_the_sun_is_red_and_the_zenith_stays_blue() {
        let day = day(1.0, 2.5);
        let sun = day.sun_irradiance();
        assert!(sun.r > 4.0 * sun.g.max(1e-6) / 2.0 && sun.g > 2.0 * sun.b, "{sun:?}");
        let sky = day.sky_radiance();
        let (zenith, glow) = (sky(Vec3::Z), sky(Vec3::new(0.998, 0.0, 0.06).normalize()));
        assert!(zenith.b > zenith.r, "{zenith:?}");
        assert!(glow.r > glow.b && glow.luminance() > 5.0 * zenith.luminance(), "{glow:?} {zenith:?}");
    }

    #[test]
    fn daylight_fades_when_the_sun_sinks_and_ends_with_it() {
        let levels: Vec<f32> = [20.0, 5.0, 0.0, -4.0].map(|elevation| diffuse_klx(&day(elevation, 2.5))).to_vec();
        assert!(levels.windows(2).all(|pair| pair[1] < pair[0]) && levels[3] > 0.0, "{levels:?}");
        assert_eq!(day(-4.0, 2.5).sun_irradiance(), Rgb::BLACK);
        // Civil twilight at −4°: tens of lux, not thousands.
        assert!(levels[3] < 0.3, "{levels:?}");
    }

    #[test]
    fn haze_whitens_the_sky_and_dims_the_sun() {
        let (clear, hazy) = (day(40.0, 2.0), day(40.0, 8.0));
        assert!(hazy.sun_irradiance().luminance() < 0.8 * clear.sun_irradiance().luminance());
        assert!(diffuse_klx(&hazy) > 1.3 * diffuse_klx(&clear));
        let (a, b) = (clear.sky_radiance()(Vec3::Z), hazy.sky_radiance()(Vec3::Z));
        assert!(b.b / b.r < a.b / a.r, "{a:?} {b:?}");
    }
}

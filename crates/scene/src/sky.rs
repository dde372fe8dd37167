//! The clear sky and the sun of Preetham, Shirley & Smits 1999, "A Practical Analytic Model for Daylight".

use enfilade_math::{Mat3, Rgb, Vec2, Vec3};

use crate::{Environment, Image, Light, Pixels, direction_from_uv};

/// Angular radius of the sun seen from the earth, radians.
pub const SUN_RADIUS_RAD: f32 = 0.004_65;

/// Daylight: where the sun stands and how hazy the air is.
#[derive(Clone, Copy, Debug)]
pub struct Daylight {
    /// Unit direction towards the sun, z up.
    pub to_sun: Vec3,
    /// Haze: 2 very clear … 10 hazy. The model holds from 1.7 to 10.
    pub turbidity: f32,
    /// Radiance of the lower hemisphere relative to the zenith's.
    pub ground_albedo: f32,
}

impl Daylight {
    /// Radiance of the sky in the unit direction `d` (z up), in kilo-candela per square metre as linear RGB. Below the horizon: the ground, lit by the
    /// zenith.
    pub fn sky_radiance(&self, d: Vec3) -> Rgb {
        if d.z < 0.0 {
            return self.sky_radiance(Vec3::Z) * self.ground_albedo;
        }
        let t = self.turbidity;
        let theta_s = self.to_sun.z.clamp(0.0, 1.0).acos();
        let cos_theta = d.z.max(0.01);
        let gamma = d.dot(self.to_sun).clamp(-1.0, 1.0).acos();
        let perez = |c: [f32; 5], cos_theta: f32, gamma: f32| {
            (1.0 + c[0] * (c[1] / cos_theta).exp()) * (1.0 + c[2] * (c[3] * gamma).exp() + c[4] * gamma.cos().powi(2))
        };
        let distribution = |c: [f32; 5], zenith: f32| zenith * perez(c, cos_theta, gamma) / perez(c, 1.0, theta_s);
        let chi = (4.0 / 9.0 - t / 120.0) * (std::f32::consts::PI - 2.0 * theta_s);
        let zenith_y = ((4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192).max(0.0);
        let (s1, s2, s3) = (theta_s, theta_s * theta_s, theta_s * theta_s * theta_s);
        let chromaticity = |m: [[f32; 4]; 3]| {
            let row = |r: [f32; 4]| r[0] * s3 + r[1] * s2 + r[2] * s1 + r[3];
            t * t * row(m[0]) + t * row(m[1]) + row(m[2])
        };
        let zenith_x_chroma = chromaticity([
            [0.00166, -0.00375, 0.00209, 0.0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ]);
        let zenith_y_chroma = chromaticity([
            [0.00275, -0.00610, 0.00317, 0.0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ]);
        let luminance = distribution(
            [0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703],
            zenith_y,
        );
        let x = distribution(
            [-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452],
            zenith_x_chroma,
        );
        let y = distribution(
            [-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529],
            zenith_y_chroma,
        );
        rgb_from_xyy(x, y, luminance)
    }

    /// Irradiance of the sun's disk on a surface facing it, in kilo-lux as linear RGB: 133 klx outside the atmosphere, dimmed and
    /// reddened by Rayleigh scattering and haze along the optical path.
    pub fn sun_irradiance(&self) -> Rgb {
        let theta = self.to_sun.z.clamp(0.0, 1.0).acos();
        let air_mass = 1.0 / (theta.cos() + 0.15 * (93.885 - theta.to_degrees()).powf(-1.253));
        let haze = 0.046_08 * self.turbidity - 0.045_86;
        let transmittance = |wavelength_um: f32| {
            let rayleigh = (-0.008_735 * air_mass * wavelength_um.powf(-4.08)).exp();
            let aerosol = (-haze * air_mass * wavelength_um.powf(-1.3)).exp();
            rayleigh * aerosol
        };
        Rgb::new(transmittance(0.612), transmittance(0.549), transmittance(0.465)) * 133.0
    }

    /// The sky as an equirectangular environment of `width` × `width`/2 texels, and the sun as a light; both multiplied by
    /// `exposure`. `image` is the index that the picture will have in the scene.
    pub fn lights(&self, width: u32, exposure: f32, image: u32) -> (Image, Environment, Light) {
        let height = width / 2;
        let map_from_world = Mat3::from_cols(Vec3::X, Vec3::NEG_Z, Vec3::Y); // the map's up is y
        let world_from_map = map_from_world.transpose();
        let texels = (0..width * height)
            .map(|i| {
                let uv = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / Vec2::new(width as f32, height as f32);
                (self.sky_radiance(world_from_map * direction_from_uv(uv)) * exposure).to_array()
            })
            .collect();
        let picture = Image { name: "sky".into(), width, height, pixels: Pixels::RgbF32(texels) };
        let environment = Environment::Map { image, scale: Rgb::WHITE, map_from_world };
        let sun = Light::Directional {
            name: "sun".into(),
            direction: -self.to_sun,
            irradiance: self.sun_irradiance() * exposure,
            angular_radius_rad: SUN_RADIUS_RAD,
        };
        (picture, environment, sun)
    }
}

/// Linear Rec. 709 RGB of CIE chromaticity (x, y) and luminance; negative components (outside the gamut) become zero.
fn rgb_from_xyy(x: f32, y: f32, luminance: f32) -> Rgb {
    let (cx, cz) = (x / y * luminance, (1.0 - x - y) / y * luminance);
    Rgb::new(
        3.240_97 * cx - 1.537_38 * luminance - 0.498_61 * cz,
        -0.969_24 * cx + 1.875_97 * luminance + 0.041_56 * cz,
        0.055_63 * cx - 0.203_98 * luminance + 1.056_97 * cz,
    )
    .map(|c| c.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clear_noon_sky_is_blue_and_brightest_near_the_sun() {
        let day = Daylight { to_sun: Vec3::new(0.5, 0.0, 0.866).normalize(), turbidity: 3.0, ground_albedo: 0.2 };
        let away = day.sky_radiance(Vec3::new(-0.6, 0.0, 0.8));
        assert!(away.b > away.r && away.r > 0.0, "{away:?}");
        assert!(day.sky_radiance(day.to_sun).luminance() > 2.0 * away.luminance());
        // Zenith luminance of a clear sky is a few thousand cd/m².
        let zenith = day.sky_radiance(Vec3::Z).luminance();
        assert!((1.0..20.0).contains(&zenith), "{zenith} kcd/m²");
        let sun = day.sun_irradiance();
        assert!(sun.r > sun.b && (60.0..125.0).contains(&sun.luminance()), "{sun:?}");
    }
}

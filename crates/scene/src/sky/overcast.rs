//! The overcast sky of the CIE standard.

use enfilade_math::{Rgb, Vec3};
use std::f32::consts::PI;

/// White of clouds: daylight of 6500 K.
const CLOUD_TINT: Rgb = Rgb::new(0.975, 1.0, 1.07);

/// An even layer of cloud over the whole sky: three times as bright at the zenith as at the horizon, from no side brighter than from
/// another (Moon & Spencer 1942, "Illumination from a non-uniform sky"; the CIE's standard overcast sky).
///
/// ```
/// use enfilade_math::Vec3;
/// use enfilade_scene::sky::Overcast;
///
/// let sky = Overcast { to_sun: Vec3::new(0.6, 0.0, 0.8) };
/// assert_eq!(sky.radiance(Vec3::Z).g / sky.radiance(Vec3::X).g, 3.0);
/// // On level ground, kilo-lux.
/// assert!((sky.ground_klx() - 17.1).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Overcast {
    /// Unit direction towards the sun above the clouds, z up; the sun's elevation decides how bright the clouds are.
    pub to_sun: Vec3,
}

impl Overcast {
    /// Radiance in the unit direction `d`, kilo-candela per square metre as linear RGB; directions below the horizon see it mirrored.
    pub fn radiance(&self, d: Vec3) -> Rgb {
        let zenith_kcd = 9.0 / (7.0 * PI) * self.ground_klx();
        CLOUD_TINT * (zenith_kcd * (1.0 + 2.0 * d.z.abs()) / 3.0)
    }

    /// Illuminance of level ground, kilo-lux: 0.3 + 21 sin h (Krochmann 1963), and in twilight a tenth for every 2.4 degrees that the
    /// sun sinks, as measured by Kimball 1938 for all skies.
    pub fn ground_klx(&self) -> f32 {
        if self.to_sun.z > 0.0 { 0.3 + 21.0 * self.to_sun.z } else { 0.3 * 10f32.powf(self.to_sun.z.asin().to_degrees() / 2.4) }
    }
}

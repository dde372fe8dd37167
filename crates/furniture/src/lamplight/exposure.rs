//! The brightness at which a home is shown, and its white: exposure and white balance of a camera.

use super::blackbody;
use enfilade_math::Rgb;

/// Conversion of luminance to scene radiance: its level, and the white that a camera adapts to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    per_kcd: f32,
    /// Factor of linear RGB, of luminance one for the white.
    balance: Rgb,
}

/// Radiance at which white walls are shown.
const WALL_RADIANCE: f32 = 0.5;
/// Average daylight factor of a room with good windows (CIBSE LG10: 2 to 5 %).
const DAYLIGHT_FACTOR: f32 = 0.025;
/// Share of the sun's own light that falls into such a room and is spread by its floor.
const SUN_SHARE: f32 = 0.012;
/// Illuminance of the darkest room that is still shown as bright as others, kilo-lux: a night without lamps stays dark.
const DARKEST_KLX: f32 = 4e-4;
/// Reflectance of white walls.
const WALL_REFLECTANCE: f32 = 0.8;
/// White by day, and where there are lamps alone: half-way from daylight to theirs, so that they stay warm. Reciprocal megakelvin.
const WHITE_MIRED: [f32; 2] = [154.0, 262.0];

impl Exposure {
    /// Illuminance of the walls by all lamps of a home, kilo-lux.
    pub const LAMPS_KLX: f32 = 0.09;

    /// A given exposure, balanced for daylight.
    pub fn new(per_kcd: f32) -> Self {
        Self { per_kcd, balance: Rgb::WHITE }
    }

    /// The exposure that shows white walls at a radiance of one half.
    ///
    /// `sky_klx` and `sun_klx` are the illuminances outside, of level ground and of what faces the sun, in kilo-lux; `lamps` is the share of
    /// the lamps of a home that are lit, 0 to 1.
    pub fn of(sky_klx: f32, sun_klx: f32, lamps: f32) -> Self {
        Self::with_lamps(sky_klx, sun_klx, Self::LAMPS_KLX * lamps)
    }

    /// The exposure as [`Exposure::of`] gives it, where lamps light the walls with `lamps_klx` kilo-lux.
    pub fn with_lamps(sky_klx: f32, sun_klx: f32, lamps_klx: f32) -> Self {
        let inside_klx = (DAYLIGHT_FACTOR * sky_klx + SUN_SHARE * sun_klx + lamps_klx).max(DARKEST_KLX);
        let wall_kcd = WALL_REFLECTANCE * inside_klx / std::f32::consts::PI;
        let mired = WHITE_MIRED[0] + (WHITE_MIRED[1] - WHITE_MIRED[0]) * lamps_klx / inside_klx;
        Self { per_kcd: WALL_RADIANCE / wall_kcd, balance: Rgb::WHITE / blackbody(1e6 / mired) }
    }

    /// Scene radiance, or irradiance, of one in kcd/m² or kilo-lux.
    pub fn expose(self, photometric: Rgb) -> Rgb {
        photometric * self.balance * self.per_kcd
    }

    /// Radiance in kcd/m², or irradiance in kilo-lux, of one of the scene: the inverse of [`Exposure::expose`].
    pub fn measure(self, scene: Rgb) -> Rgb {
        scene / self.balance * (1.0 / self.per_kcd)
    }

    /// Scene radiance per kcd/m².
    pub fn per_kcd(self) -> f32 {
        self.per_kcd
    }
}

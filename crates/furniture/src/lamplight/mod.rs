//! The light of lamps: how much each gives, which of them are lit, and how bright the home is shown.
//!
//! Light is computed in kilo-candela per square metre and kilo-lux. The scene's radiance is that times an [`Exposure`].

mod blackbody;
mod exposure;
mod glow;

pub use blackbody::blackbody;
pub use exposure::Exposure;
pub use glow::{Glow, area_m2};

use enfilade_math::Rng;

/// The brightness of lights in a home: the exposure, and which of the lamps are lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LampLight {
    /// The exposure at which the home is shown.
    pub exposure: Exposure,
    /// Share of the lamps that are lit, 0 to 1.
    pub lit: f32,
    /// Decides which lamps are lit.
    pub seed: u64,
}

impl Default for LampLight {
    /// Half of the lamps are lit, and a scene's radiance is the luminance in kcd/m².
    fn default() -> Self {
        Self { exposure: Exposure::new(1.0), lit: 0.5, seed: 0 }
    }
}

impl LampLight {
    /// True when the lamp of this name is lit.
    pub fn is_lit(&self, name: &str) -> bool {
        let key = name.bytes().fold(0u64, |key, byte| key.wrapping_mul(0x0100_0000_01b3) ^ u64::from(byte));
        Rng::new(self.seed).fork(key).next_f32() < self.lit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_lamps_are_lit_as_asked_for() {
        let light = LampLight { lit: 0.3, seed: 5, ..LampLight::default() };
        let lit = (0..1000).filter(|k| light.is_lit(&format!("lamp_{k}"))).count();
        assert!((250..350).contains(&lit), "{lit}");
    }
}

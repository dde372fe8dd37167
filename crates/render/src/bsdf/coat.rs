//! How much light a dielectric coat lets through to the diffuse base beneath it, tabulated once per index of refraction.

use super::{fresnel, ggx};

const COSINES: usize = 32;
const ALPHAS: usize = 16;

/// Transmittance of a GGX dielectric coat from outside, over the cosine of the direction and the roughness, and its mean.
///
/// Transmittance is one minus the single-bounce reflection, so that a white base under a coat reflects all light.
#[derive(Debug)]
pub struct CoatTable {
    /// Index of refraction of the coat.
    pub eta: f32,
    /// `transmittance[a][c]`: cosine (c + ½)/32, alpha (a/15)².
    transmittance: [[f32; COSINES]; ALPHAS],
    /// Cosine-weighted mean over the hemisphere for each alpha.
    mean: [f32; ALPHAS],
}

impl CoatTable {
    /// Tabulates the coat of index `eta` > 1.
    pub fn new(eta: f32) -> Self {
        let mut transmittance = [[0.0; COSINES]; ALPHAS];
        let mut mean = [0.0; ALPHAS];
        for (a, row) in transmittance.iter_mut().enumerate() {
            let alpha = (a as f32 / (ALPHAS - 1) as f32).powi(2);
            for (c, t) in row.iter_mut().enumerate() {
                let cos = (c as f32 + 0.5) / COSINES as f32;
                *t = 1.0 - ggx::directional_albedo(cos, alpha, 512, |cos| fresnel::dielectric(cos, eta).0);
                mean[a] += 2.0 * cos * *t / COSINES as f32;
            }
        }
        Self { eta, transmittance, mean }
    }

    /// Transmittance from outside at `cos` > 0 for roughness `alpha`.
    #[inline]
    pub fn transmittance(&self, cos: f32, alpha: f32) -> f32 {
        let (a, fa) = Self::alpha_cell(alpha);
        let x = (cos * COSINES as f32 - 0.5).clamp(0.0, (COSINES - 1) as f32);
        let c = (x as usize).min(COSINES - 2);
        let fc = x - c as f32;
        let row = |a: usize| self.transmittance[a][c] * (1.0 - fc) + self.transmittance[a][c + 1] * fc;
        row(a) * (1.0 - fa) + row(a + 1) * fa
    }

    /// Share of diffuse light from the base that the coat reflects back inside.
    ///
    /// From energy balance and reciprocity: 1 − mean transmittance from outside / eta².
    #[inline]
    pub fn inner_reflectance(&self, alpha: f32) -> f32 {
        let (a, fa) = Self::alpha_cell(alpha);
        1.0 - (self.mean[a] * (1.0 - fa) + self.mean[a + 1] * fa) / (self.eta * self.eta)
    }

    #[inline]
    fn alpha_cell(alpha: f32) -> (usize, f32) {
        let x = (alpha.max(0.0).sqrt() * (ALPHAS - 1) as f32).min((ALPHAS - 1) as f32);
        let a = (x as usize).min(ALPHAS - 2);
        (a, x - a as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_coat_of_glass_has_the_known_inner_reflectance() {
        // 0.5963 for eta = 1.5 (Egan & Hilgeman 1973).
        let table = CoatTable::new(1.5);
        assert!((table.inner_reflectance(0.0) - 0.5963).abs() < 2e-3, "{}", table.inner_reflectance(0.0));
        assert!((table.transmittance(1.0, 0.0) - 0.96).abs() < 1e-3);
        assert!(table.transmittance(0.02, 0.0) < 0.5);
    }
}

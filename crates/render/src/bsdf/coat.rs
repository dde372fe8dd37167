//! How much light a dielectric coat lets through to the diffuse base beneath it.

use super::ggx::Facets;
use super::{fresnel, ggx};
use enfilade_math::{Vec3, warp};
use enfilade_scene::Distribution;

/// Cosines i/63 of the table; the first one counts as 10⁻⁶.
const COSINES: usize = 64;
/// Roughnesses (i/15)² where the roughness varies over the surface.
const ALPHAS: usize = 16;
/// The highest index of refraction: such a coat reflects all but 0.04 %, and float32 cannot represent what a higher one lets through.
const MAX_ETA: f32 = 1e4;
/// The smallest fraction of the base's light that a coat lets out.
const MIN_ESCAPE: f32 = 1e-12;

/// How light that meets several facets of the coat in a row counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounces {
    /// Nothing is lost: light that is not reflected in one bounce reaches the base, so that a white base under a coat reflects all light.
    All,
    /// Only single bounces count and the rest is lost, with separable masking: the model of Mitsuba's `roughplastic`.
    Single,
}

/// Parameters of a coat table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoatSpec {
    /// Index of refraction, > 1.
    pub eta: f32,
    /// Roughness, where it is the same all over the surface.
    pub alpha: Option<f32>,
    /// Slopes of the coat's facets.
    pub distribution: Distribution,
    /// Multiple bounces at the facets.
    pub bounces: Bounces,
}

/// A dielectric coat over a diffuse base.
#[derive(Debug)]
pub struct CoatTable {
    spec: CoatSpec,
    rows: Vec<Row>,
}

/// The coat at one roughness.
#[derive(Debug)]
struct Row {
    transmittance: [f32; COSINES],
    /// Cosine-weighted mean transmittance over the hemisphere.
    mean: f32,
    /// Fraction of the base's light that comes out through the coat; the rest is reflected back inside. Small where the index is high.
    escapes: f32,
}

/// A coat at the roughness of a point.
#[derive(Clone, Copy, Debug)]
pub struct Coat<'a> {
    low: &'a Row,
    high: &'a Row,
    /// Weight of `high` in the interpolation; `low` has the rest.
    fraction: f32,
    smooth: bool,
    /// Index of refraction of the coat.
    pub eta: f32,
    /// The slopes of its facets.
    pub distribution: Distribution,
    /// Multiple bounces at the facets.
    pub bounces: Bounces,
}

impl CoatTable {
    /// Tabulates a coat, for its roughness or, without one, for all.
    pub fn new(spec: CoatSpec) -> Self {
        let rows = match spec.alpha {
            Some(alpha) => vec![Row::new(&spec, alpha)],
            None => (0..ALPHAS).map(|a| Row::new(&spec, (a as f32 / (ALPHAS - 1) as f32).powi(2))).collect(),
        };
        Self { spec, rows }
    }

    /// The parameters of the coat.
    pub fn spec(&self) -> CoatSpec {
        self.spec
    }

    /// The coat at the roughness `alpha`, which must be the table's if it was made for one.
    #[inline]
    pub fn at(&self, alpha: f32) -> Coat<'_> {
        let CoatSpec { bounces, distribution, .. } = self.spec;
        let eta = self.spec.eta.min(MAX_ETA);
        let smooth = alpha < ggx::SMOOTH_ALPHA;
        if let [row] = &self.rows[..] {
            return Coat { low: row, high: row, fraction: 0.0, smooth, eta, distribution, bounces };
        }
        let x = (alpha.max(0.0).sqrt() * (ALPHAS - 1) as f32).min((ALPHAS - 1) as f32);
        let a = (x as usize).min(ALPHAS - 2);
        Coat { low: &self.rows[a], high: &self.rows[a + 1], fraction: x - a as f32, smooth, eta, distribution, bounces }
    }
}

impl Row {
    fn new(spec: &CoatSpec, alpha: f32) -> Self {
        let eta = spec.eta.min(MAX_ETA);
        let cosine = |i: usize| (i as f32 / (COSINES - 1) as f32).max(1e-6);
        let bounces = if alpha < ggx::SMOOTH_ALPHA { Bounces::All } else { spec.bounces };
        let transmittance: [f32; COSINES] = std::array::from_fn(|i| match bounces {
            Bounces::All => 1.0 - ggx::directional_albedo(cosine(i), alpha, POINTS, |cos| fresnel::dielectric(cos, eta).0),
            Bounces::Single => once(cosine(i), alpha, spec.distribution, eta).1,
        });
        // Exact for the table's linear interpolation: ∫ 2c T(c) dc, piece by piece.
        let step = 1.0 / (COSINES - 1) as f32;
        let piece = |i: usize| {
            let (c, a, b) = (i as f32 * step, transmittance[i], transmittance[i + 1]);
            step * (c * (a + b) + step * (a + 2.0 * b) / 3.0)
        };
        let mean: f32 = (0..COSINES - 1).map(piece).sum();
        let escapes = match bounces {
            // By energy balance and reciprocity.
            Bounces::All => mean / (eta * eta),
            // The sum that Mitsuba takes; it falls short of the integral by 1/64.
            Bounces::Single => {
                1.0 - (0..COSINES).map(|i| 2.0 * cosine(i) * once(cosine(i), alpha, spec.distribution, 1.0 / eta).0).sum::<f32>()
                    / COSINES as f32
            }
        };
        Self { transmittance, mean, escapes: escapes.max(MIN_ESCAPE) }
    }

    #[inline]
    fn at(&self, cell: usize, fraction: f32) -> f32 {
        self.transmittance[cell] * (1.0 - fraction) + self.transmittance[cell + 1] * fraction
    }
}

impl Coat<'_> {
    /// Transmittance from outside at `cos` ≥ 0.
    #[inline]
    pub fn transmittance(&self, cos: f32) -> f32 {
        if self.smooth {
            return 1.0 - fresnel::dielectric(cos, self.eta).0;
        }
        let x = cos.clamp(0.0, 1.0) * (COSINES - 1) as f32;
        let cell = (x as usize).min(COSINES - 2);
        let fraction = x - cell as f32;
        let low = self.low.at(cell, fraction);
        if self.fraction == 0.0 { low } else { low * (1.0 - self.fraction) + self.high.at(cell, fraction) * self.fraction }
    }

    /// Cosine-weighted mean of the transmittance.
    #[inline]
    pub fn mean_transmittance(&self) -> f32 {
        self.low.mean * (1.0 - self.fraction) + self.high.mean * self.fraction
    }

    /// Fraction of diffuse light from the base that the coat lets out; it reflects the rest back inside.
    #[inline]
    pub fn inner_transmittance(&self) -> f32 {
        self.low.escapes * (1.0 - self.fraction) + self.high.escapes * self.fraction
    }
}

/// Quadrature points of a table entry.
const POINTS: u32 = 512;

/// Fractions of light from the cosine `cos_o` that a rough interface reflects and transmits in a single bounce, with separable masking.
fn once(cos_o: f32, alpha: f32, distribution: Distribution, eta: f32) -> (f32, f32) {
    let wo = Vec3::new((1.0 - cos_o * cos_o).max(0.0).sqrt(), 0.0, cos_o);
    let facets = single(distribution, alpha, cos_o);
    // Masking of the reflected or transmitted direction, over the density of sampled facets.
    let kept = |m: Vec3, w: Vec3| match distribution {
        Distribution::Ggx => ggx::g1(w, alpha),
        Distribution::Beckmann => facets.d(m) * facets.masking(wo, w) / (ggx::d(m, alpha) * ggx::g1(wo, alpha)).max(f32::MIN_POSITIVE),
    };
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    for i in 0..POINTS {
        let m = ggx::sample_visible(wo, alpha, warp::hammersley(i, POINTS));
        let cos = wo.dot(m).max(0.0);
        let (f, cos_t) = fresnel::dielectric(cos, eta);
        let up = ggx::reflect(wo, m);
        if up.z > 0.0 {
            reflected += f * kept(m, up);
        }
        let down = ggx::refract(wo, m, eta, cos_t);
        if down.z < 0.0 {
            transmitted += (1.0 - f) * kept(m, down);
        }
    }
    (reflected / POINTS as f32, transmitted / POINTS as f32)
}

/// Facets of which single bounces count.
#[inline]
pub fn single(distribution: Distribution, alpha: f32, cos_o: f32) -> Facets {
    match distribution {
        Distribution::Ggx => Facets::separable(alpha, cos_o),
        Distribution::Beckmann => Facets::beckmann(alpha, cos_o),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(alpha: Option<f32>, bounces: Bounces) -> CoatTable {
        CoatTable::new(CoatSpec { eta: 1.5, alpha, distribution: Distribution::Ggx, bounces })
    }

    #[test]
    fn smooth_coat_of_glass_has_the_known_inner_reflectance() {
        // 0.5963 for eta = 1.5 (Egan & Hilgeman 1973).
        for bounces in [Bounces::All, Bounces::Single] {
            let table = table(Some(0.0), bounces);
            let coat = table.at(0.0);
            assert!((coat.inner_transmittance() - 0.4037).abs() < 1e-3, "{}", coat.inner_transmittance());
            assert!((coat.transmittance(1.0) - 0.96).abs() < 1e-5);
            assert!(coat.transmittance(0.02) < 0.5);
        }
    }

    #[test]
    fn the_table_of_all_roughnesses_agrees_with_that_of_one() {
        let all = table(None, Bounces::All);
        for alpha in [0.02, 0.1, 0.2, 0.5, 0.9] {
            let one = table(Some(alpha), Bounces::All);
            for cos in [0.1, 0.3, 0.6, 1.0] {
                let (a, b) = (all.at(alpha).transmittance(cos), one.at(alpha).transmittance(cos));
                assert!((a - b).abs() < 4e-3, "alpha {alpha}, cos {cos}: {a} against {b}");
            }
        }
    }

    /// Quadrature over microfacet slopes on a fine grid, done apart from this code.
    #[test]
    fn transmittance_has_known_values() {
        for (alpha, cos, expected) in [(0.05, 0.1, 0.5721), (0.05, 0.3, 0.8033), (0.2, 0.1, 0.7978), (0.5, 0.5, 0.9561)] {
            let t = table(Some(alpha), Bounces::All).at(alpha).transmittance(cos);
            assert!((t - expected).abs() < 2e-3, "alpha {alpha}, cos {cos}: {t}, expected {expected}");
        }
    }
}

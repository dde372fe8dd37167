//! Light that bounces several times between the facets of a rough surface.
//!
//! A microfacet lobe counts one bounce and loses the rest. The tables here have the fraction E that one bounce keeps, and lobes are scaled
//! up by the missing part: white metals and clear glasses then keep all light at every roughness and angle. Turquin 2019, "Practical
//! multiple scattering compensation for microfacet models"; the colour that metals gain by further bounces from Kulla & Conty 2017. The
//! scale depends only on the viewing direction, so such lobes are not reciprocal: the two directions differ by the ratio of their E, a few
//! percent below a roughness of 0.3. Paths here are traced from the camera only and never need it.

use super::{fresnel, ggx};
use enfilade_math::{Rgb, Vec3, warp};
use std::sync::LazyLock;

/// Cosines (c/31)².
const COSINES: usize = 32;
/// Roughnesses (a/23)².
const ALPHAS: usize = 24;
/// Quadrature points of an entry.
const POINTS: u32 = 512;

/// The fraction of light that one bounce keeps, over roughness and cosine.
#[derive(Debug)]
struct Kept {
    kept: [[f32; COSINES]; ALPHAS],
    /// Cosine-weighted means.
    mean: [f32; ALPHAS],
}

impl Kept {
    fn new(kept: impl Fn(f32, f32) -> f32) -> Self {
        let root = |i: usize, n: usize| (i as f32 / (n - 1) as f32).powi(2);
        let kept = std::array::from_fn(|a| std::array::from_fn(|c| kept(root(c, COSINES).max(1e-4), root(a, ALPHAS))));
        let mean = std::array::from_fn(|a| {
            let row: &[f32; COSINES] = &kept[a];
            // ∫ 2c E dc by trapezoids.
            let node = |i: usize| root(i, COSINES);
            (1..COSINES).map(|i| (node(i) - node(i - 1)) * (node(i) * row[i] + node(i - 1) * row[i - 1])).sum()
        });
        Self { kept, mean }
    }

    #[inline]
    fn cell(v: f32, n: usize) -> (usize, f32) {
        let x = v.clamp(0.0, 1.0).sqrt() * (n - 1) as f32;
        let i = (x as usize).min(n - 2);
        (i, x - i as f32)
    }

    #[inline]
    fn at(&self, cos: f32, alpha: f32) -> f32 {
        let ((a, fa), (c, fc)) = (Self::cell(alpha, ALPHAS), Self::cell(cos, COSINES));
        let row = |a: usize| self.kept[a][c] * (1.0 - fc) + self.kept[a][c + 1] * fc;
        row(a) * (1.0 - fa) + row(a + 1) * fa
    }

    #[inline]
    fn mean(&self, alpha: f32) -> f32 {
        let (a, fa) = Self::cell(alpha, ALPHAS);
        self.mean[a] * (1.0 - fa) + self.mean[a + 1] * fa
    }
}

/// Factor for a metal's lobe of roughness `alpha`, seen at the cosine `cos_o`. `mean_fresnel` is the cosine-weighted mean
/// of its reflectance.
#[inline]
pub fn of_metal(cos_o: f32, alpha: f32, mean_fresnel: Rgb) -> Rgb {
    static KEPT: LazyLock<Kept> = LazyLock::new(|| Kept::new(|cos, alpha| ggx::directional_albedo(cos, alpha, POINTS, |_| 1.0)));
    if alpha < ggx::SMOOTH_ALPHA {
        return Rgb::WHITE;
    }
    let (kept, mean) = (KEPT.at(cos_o, alpha), KEPT.mean(alpha));
    let lost = (1.0 - kept) / kept;
    mean_fresnel.map(|f| 1.0 + lost * f * mean / (1.0 - f * (1.0 - mean)))
}

/// The fraction that one bounce keeps at the rough border of a transparent body.
#[derive(Debug)]
pub struct GlassTable {
    /// Index of refraction, inside over outside.
    pub eta: f32,
    outside: Kept,
    inside: Kept,
}

impl GlassTable {
    /// Tabulates glass of the index `eta`.
    pub fn new(eta: f32) -> Self {
        Self {
            eta,
            outside: Kept::new(|cos, alpha| kept_by_glass(cos, alpha, eta)),
            inside: Kept::new(|cos, alpha| kept_by_glass(cos, alpha, 1.0 / eta)),
        }
    }

    /// Factor for the lobe of roughness `alpha`, seen at the cosine `cos_o` from outside or inside.
    #[inline]
    pub fn scale(&self, cos_o: f32, alpha: f32, outside: bool) -> f32 {
        if alpha < ggx::SMOOTH_ALPHA {
            return 1.0;
        }
        1.0 / if outside { &self.outside } else { &self.inside }.at(cos_o, alpha)
    }
}

/// Fraction of the power from the cosine `cos_o` that one bounce reflects or transmits.
fn kept_by_glass(cos_o: f32, alpha: f32, eta: f32) -> f32 {
    if alpha < ggx::SMOOTH_ALPHA {
        return 1.0;
    }
    let wo = Vec3::new((1.0 - cos_o * cos_o).max(0.0).sqrt(), 0.0, cos_o);
    let sum: f32 = (0..POINTS)
        .map(|i| {
            let m = ggx::sample_visible(wo, alpha, warp::hammersley(i, POINTS));
            let cos = wo.dot(m).max(0.0);
            let (f, cos_t) = fresnel::dielectric(cos, eta);
            let (up, down) = (ggx::reflect(wo, m), ggx::refract(wo, m, eta, cos_t));
            let fraction = |w: Vec3, right_side: bool| if right_side { ggx::g2(wo, w, alpha) / ggx::g1(wo, alpha) } else { 0.0 };
            f * fraction(up, up.z > 0.0) + if f < 1.0 { (1.0 - f) * fraction(down, down.z < 0.0) } else { 0.0 }
        })
        .sum();
    sum / POINTS as f32
}

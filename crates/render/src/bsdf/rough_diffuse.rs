//! Diffuse reflection of rough surfaces such as plaster, cloth and clay.
//!
//! Portsmouth, Kutz & Hill 2024, "EON: A practical energy-preserving rough diffuse BRDF": Fujii's form of Oren & Nayar's model for the
//! first bounce, and a lobe that gives back what further bounces between the facets send out. Reciprocal; a white surface
//! reflects all light. The albedo is the paper's fit, within 10⁻³ of the exact one, and the lobes use its own mean, so no energy
//! is lost by the fit.

use enfilade_math::{INV_PI, Rgb, Vec3};

/// The lobe at one point, for one viewing direction.
#[derive(Clone, Copy, Debug)]
pub struct RoughDiffuse {
    /// 0 Lambert … 1.
    roughness: f32,
    /// Weight of the Lambertian part: 1/(1 + (1/2 − 2/(3π)) roughness).
    a: f32,
    /// Demodulated weight of further bounces, what the viewing direction contributes included.
    further: Rgb,
    /// Demodulated albedo towards the viewer.
    pub albedo: Rgb,
}

/// 1/2 − 2/(3π).
const C1: f32 = 0.287_793_4;

/// Coefficients of the fit to the angular part of the albedo, by powers of 1 − cosθ from the first.
const FIT: [f32; 4] = [0.057_108_53, 0.491_881_87, -0.332_181_44, 0.071_443];

/// Cosine-weighted mean of the fit.
const MEAN: f32 = FIT[0] / 3.0 + FIT[1] / 6.0 + FIT[2] / 10.0 + FIT[3] / 15.0;

impl RoughDiffuse {
    /// A surface of the given `reflectance` and `roughness`, both on [0,1], seen at the cosine `cos_o`.
    #[inline]
    pub fn new(reflectance: Rgb, roughness: f32, cos_o: f32) -> Self {
        let a = 1.0 / (1.0 + C1 * roughness);
        let once = a * (1.0 + roughness * fit(cos_o));
        let mean = a * (1.0 + roughness * MEAN);
        // The light that further bounces emit in total, over the reflectance.
        let color = reflectance.map(|r| r * mean / (1.0 - r * (1.0 - mean)));
        let lost = 1.0 - once;
        let further = if mean < 1.0 { color * (lost / (1.0 - mean)) } else { Rgb::BLACK };
        Self { roughness, a, further, albedo: Rgb::splat(once) + color * lost }
    }

    /// Demodulated value × cosine; `wi` is above the surface.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let s = wo.x * wi.x + wo.y * wi.y;
        let s_over_t = if s > 0.0 { s / wo.z.max(wi.z) } else { s };
        let once = self.a * (1.0 + self.roughness * s_over_t);
        let lost_i = 1.0 - self.a * (1.0 + self.roughness * fit(wi.z));
        (Rgb::splat(once) + self.further * lost_i) * (wi.z * INV_PI)
    }
}

/// The angular part of the single-bounce albedo, over π.
#[inline]
fn fit(cos: f32) -> f32 {
    let x = 1.0 - cos;
    x * (FIT[0] + x * (FIT[1] + x * (FIT[2] + x * FIT[3])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_is_near_the_exact_albedo() {
        for i in 1..=100 {
            let cos = i as f32 / 100.0;
            let (theta, sin) = (cos.acos(), (1.0 - cos * cos).sqrt());
            let exact = (sin * (theta - sin * cos - 2.0 / 3.0) + 2.0 / 3.0 * (sin / cos) * (1.0 - sin.powi(3))) * INV_PI;
            assert!((fit(cos) - exact).abs() < 7e-4, "cosine {cos}: {} against {exact}", fit(cos));
        }
    }

    #[test]
    fn without_roughness_it_is_lamberts_law() {
        let lobe = RoughDiffuse::new(Rgb::splat(0.7), 0.0, 0.5);
        let value = lobe.eval(Vec3::new(0.866, 0.0, 0.5), Vec3::new(-0.6, 0.0, 0.8));
        assert!((value.g - 0.8 * INV_PI).abs() < 1e-6 && lobe.albedo.g == 1.0);
    }
}

//! The GGX (Trowbridge–Reitz) microfacet distribution with Smith's height-correlated masking, isotropic.
//!
//! Walter et al. 2007; Heitz 2014, "Understanding the Masking-Shadowing Function". Directions are in shading space and above the surface (z
//! > 0) unless stated otherwise.

use super::{beckmann, fresnel};
use enfilade_math::{Vec3, angle, warp};
use enfilade_scene::Distribution;

/// Below this roughness a surface counts as smooth and scatters into single directions. At 1e-3 the lobe is narrower than
/// the sun's disk.
pub const SMOOTH_ALPHA: f32 = 1e-3;

/// Density of microfacet normals; ∫ D(m) cosθ dm = 1.
#[inline]
pub fn d(m: Vec3, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let c2 = m.z * m.z;
    // (1 − c²) written as x² + y² keeps its precision for narrow lobes.
    let t = c2 * a2 + (m.x * m.x + m.y * m.y);
    a2 / (std::f32::consts::PI * t * t)
}

/// Smith's Λ of a direction with the cosine `cos`, which may be on either side.
#[inline]
pub fn lambda(cos: f32, alpha: f32) -> f32 {
    let c2 = cos * cos;
    let tan2 = ((1.0 - c2).max(0.0) / c2).min(f32::MAX);
    0.5 * ((1.0 + alpha * alpha * tan2).sqrt() - 1.0)
}

/// Fraction of microfacets visible from `w`.
#[inline]
pub fn g1(w: Vec3, alpha: f32) -> f32 {
    1.0 / (1.0 + lambda(w.z, alpha))
}

/// Fraction of microfacets visible from both directions (on the same side or on opposite ones), height-correlated.
#[inline]
pub fn g2(wo: Vec3, wi: Vec3, alpha: f32) -> f32 {
    1.0 / (1.0 + lambda(wo.z, alpha) + lambda(wi.z, alpha))
}

/// A rough surface seen from one direction.
#[derive(Clone, Copy, Debug)]
pub struct Facets {
    /// Roughness.
    pub alpha: f32,
    /// Distribution of the facets' slopes. Directions are always sampled by GGX: its density is nowhere far below Beckmann's.
    distribution: Distribution,
    /// GGX's Λ of the viewing direction.
    lambda_o: f32,
    /// Constant and slope of the reciprocal of the masking, which is linear in Λ of the incident direction: 1 + Λ and 1 for
    /// height-correlated masking, 1 + Λ and 1 + Λ for separable masking, with Λ of the viewing direction.
    visible_o: f32,
    slope_i: f32,
}

/// The value and density of mirror reflection at the facets of a rough surface.
#[derive(Clone, Copy, Debug)]
pub struct Mirrored {
    /// Value × cosine for a reflectance of one.
    pub value: f32,
    /// Density per solid angle with which sampled normals mirror into this direction.
    pub pdf: f32,
    /// Cosine between either direction and the normal halfway.
    pub cos_half: f32,
}

impl Facets {
    /// GGX facets of roughness `alpha` seen at the cosine `cos_o` > 0.
    #[inline]
    pub fn new(alpha: f32, cos_o: f32) -> Self {
        let lambda_o = if alpha < SMOOTH_ALPHA { 0.0 } else { lambda(cos_o, alpha) };
        Self { alpha, distribution: Distribution::Ggx, lambda_o, visible_o: 1.0 + lambda_o, slope_i: 1.0 }
    }

    /// GGX facets with the masking of both directions independent, as in Mitsuba.
    #[inline]
    pub fn separable(alpha: f32, cos_o: f32) -> Self {
        let correlated = Self::new(alpha, cos_o);
        Self { slope_i: correlated.visible_o, ..correlated }
    }

    /// Beckmann's facets, as Mitsuba has them: masking of both directions is independent.
    #[inline]
    pub fn beckmann(alpha: f32, cos_o: f32) -> Self {
        let ggx = Self::new(alpha, cos_o);
        let visible_o = if ggx.smooth() { 1.0 } else { 1.0 + beckmann::lambda(cos_o, alpha) };
        Self { distribution: Distribution::Beckmann, visible_o, slope_i: visible_o, ..ggx }
    }

    /// True when the surface scatters into single directions.
    #[inline]
    pub fn smooth(&self) -> bool {
        self.alpha < SMOOTH_ALPHA
    }

    /// True for GGX's facets.
    #[inline]
    pub fn is_ggx(&self) -> bool {
        self.distribution == Distribution::Ggx
    }

    /// Fraction of the facets that are visible from the viewing direction `wo` and from `wi`, which may be on either side.
    #[inline]
    pub fn masking(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self.distribution {
            Distribution::Ggx if self.slope_i == 1.0 => g2(wo, wi, self.alpha),
            Distribution::Ggx => 1.0 / (self.visible_o + self.slope_i * lambda(wi.z, self.alpha)),
            Distribution::Beckmann => 1.0 / (self.visible_o + self.slope_i * beckmann::lambda(wi.z, self.alpha)),
        }
    }

    /// Density of the facets' normals.
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        match self.distribution {
            Distribution::Ggx => d(m, self.alpha),
            Distribution::Beckmann => beckmann::d(m, self.alpha),
        }
    }

    /// Reflection from `wi` to `wo`, both above a surface that is not smooth.
    #[inline]
    pub fn mirror(&self, wo: Vec3, wi: Vec3) -> Mirrored {
        // D of the normal h/|h|, without normalizing it.
        let h = wo + wi;
        let (z2, xy2) = (h.z * h.z, h.x * h.x + h.y * h.y);
        let length2 = z2 + xy2;
        let a2 = self.alpha * self.alpha;
        let t = length2 / (z2 * a2 + xy2);
        let d = a2 * t * t * (0.25 * enfilade_math::INV_PI) / wo.z;
        let value = match self.distribution {
            Distribution::Ggx => d / (self.visible_o + self.slope_i * lambda(wi.z, self.alpha)),
            Distribution::Beckmann => beckmann::d(h / length2.sqrt(), self.alpha) * self.masking(wo, wi) / (4.0 * wo.z),
        };
        Mirrored { value, pdf: d / (1.0 + self.lambda_o), cos_half: (0.5 * length2.sqrt()).min(1.0) }
    }

    /// Samples the direction from which a visible facet mirrors light to `wo`; it may be below the surface.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        reflect(wo, sample_visible(wo, self.alpha, u))
    }
}

/// Samples a microfacet normal in proportion to its projected visible area from `wo` (z > 0).
///
/// Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
#[inline]
pub fn sample_visible(wo: Vec3, alpha: f32, u: [f32; 2]) -> Vec3 {
    let stretched = Vec3::new(wo.x * alpha, wo.y * alpha, wo.z).normalize();
    let z = (1.0 - u[1]) * (1.0 + stretched.z) - stretched.z;
    let r = (1.0 - z * z).clamp(0.0, 1.0).sqrt();
    let (sin, cos) = angle::sin_cos_turns(u[0]);
    let h = Vec3::new(r * cos, r * sin, z) + stretched;
    Vec3::new(h.x * alpha, h.y * alpha, h.z.max(0.0)).try_normalize().unwrap_or(Vec3::Z)
}

/// Directional albedo of a GGX surface with reflectance `fresnel(cos)`: the fraction of light from `cos_o` that is reflected
/// in one bounce. Quadrature over `n` visible normals.
pub fn directional_albedo(cos_o: f32, alpha: f32, n: u32, fresnel: impl Fn(f32) -> f32) -> f32 {
    let cos_o = cos_o.max(1e-4);
    if alpha < SMOOTH_ALPHA {
        return fresnel(cos_o);
    }
    let wo = Vec3::new((1.0 - cos_o * cos_o).max(0.0).sqrt(), 0.0, cos_o);
    let mut sum = 0.0;
    for i in 0..n {
        let m = sample_visible(wo, alpha, warp::hammersley(i, n));
        let wi = reflect(wo, m);
        if wi.z > 0.0 {
            sum += fresnel(wo.dot(m).max(0.0)) * g2(wo, wi, alpha) / g1(wo, alpha);
        }
    }
    sum / n as f32
}

/// Mirror image of `w` about the normal `m`; both point away from the surface.
#[inline]
pub fn reflect(w: Vec3, m: Vec3) -> Vec3 {
    2.0 * w.dot(m) * m - w
}

/// `wo` bent at a facet with the normal `m`, on whose other side the index is `eta` times that on this one and the refracted direction's
/// cosine is `cos_t`. Of unit length up to rounding.
#[inline]
pub fn refract(wo: Vec3, m: Vec3, eta: f32, cos_t: f32) -> Vec3 {
    m * (wo.dot(m) / eta - cos_t) - wo / eta
}

/// The microfacet normal (z > 0) that takes `wo` to `wi` by reflection or refraction, the Fresnel reflectance there, and the Jacobian from
/// the normal's solid angle to the solid angle of `wi`. `None` if there is no such facet.
#[inline]
pub fn refraction_half_vector(wo: Vec3, wi: Vec3, eta: f32) -> Option<(Vec3, f32, f32)> {
    if wi.z > 0.0 {
        let m = (wo + wi).normalize();
        let cos = wo.dot(m);
        return Some((m, fresnel::dielectric(cos.clamp(0.0, 1.0), eta).0, 1.0 / (4.0 * cos)));
    }
    let m = (wo + wi * eta).try_normalize()?;
    let m = if m.z < 0.0 { -m } else { m };
    let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
    if cos_o <= 0.0 || cos_i >= 0.0 {
        return None;
    }
    let (f, cos_t) = fresnel::dielectric(cos_o.min(1.0), eta);
    if cos_t == 0.0 {
        return None;
    }
    let denominator = cos_o + eta * cos_i;
    Some((m, f, eta * eta * cos_i.abs() / (denominator * denominator)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projected_area_of_normals_is_one() {
        for alpha in [0.1, 0.4, 1.0] {
            let n = 2000;
            let mut integral = 0.0f64;
            for i in 0..n {
                let theta = (i as f64 + 0.5) / n as f64 * std::f64::consts::FRAC_PI_2;
                let m = Vec3::new(theta.sin() as f32, 0.0, theta.cos() as f32);
                integral +=
                    f64::from(d(m, alpha)) * theta.cos() * theta.sin() * std::f64::consts::TAU * std::f64::consts::FRAC_PI_2 / n as f64;
            }
            assert!((integral - 1.0).abs() < 1e-3, "alpha {alpha}: {integral}");
        }
    }

    #[test]
    fn a_white_surface_reflects_at_most_all_light_in_one_bounce() {
        for alpha in [0.05, 0.3, 0.6, 1.0] {
            for cos_o in [0.05, 0.3, 0.7, 1.0] {
                let albedo = directional_albedo(cos_o, alpha, 4096, |_| 1.0);
                assert!(albedo <= 1.001 && albedo > 0.3, "alpha {alpha}, cos {cos_o}: {albedo}");
            }
        }
        assert!(directional_albedo(0.7, 0.05, 4096, |_| 1.0) > 0.995);
    }
}

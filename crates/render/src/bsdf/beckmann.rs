//! Beckmann's microfacet distribution with Smith's masking, isotropic, as Mitsuba has it.
//!
//! Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces". Directions are sampled by GGX's visible normals
//! ([`super::ggx::Facets`]): Beckmann's density is at most 4/e times GGX's of the same roughness, and has no long tail.

use enfilade_math::Vec3;

/// Density of microfacet normals; ∫ D(m) cosθ dm = 1.
#[inline]
pub fn d(m: Vec3, alpha: f32) -> f32 {
    if m.z <= 0.0 {
        return 0.0;
    }
    let (a2, c2) = (alpha * alpha, m.z * m.z);
    (-(m.x * m.x + m.y * m.y) / (a2 * c2)).exp() / (std::f32::consts::PI * a2 * c2 * c2)
}

/// Smith's Λ of a direction with the cosine `cos`, which may be on either side; the rational fit of Walter et al., within 0.35 %.
#[inline]
pub fn lambda(cos: f32, alpha: f32) -> f32 {
    let sin2 = 1.0 - cos * cos;
    if sin2 <= 0.0 {
        return 0.0;
    }
    let a = cos.abs() / (alpha * sin2.sqrt());
    if a >= 1.6 { 0.0 } else { ((1.0 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a)).min(f32::MAX) }
}

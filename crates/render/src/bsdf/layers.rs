//! Layers on top of a material that dim what is beneath: glTF's clear-coat and sheen.

use super::{fresnel, sheen};

/// Index of refraction of glTF's clear-coat.
pub const CLEARCOAT_ETA: f32 = 1.5;

/// Layers above other lobes.
#[derive(Clone, Copy, Debug)]
pub struct Layers {
    /// Fraction of the surface under a clear-coat.
    pub clearcoat: f32,
    /// Largest component of the sheen's colour.
    pub sheen: f32,
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
}

impl Layers {
    /// Fraction of light that passes on the way in and out, at the cosines of both directions.
    #[inline]
    pub fn passes(&self, cos_o: f32, cos_i: f32) -> f32 {
        let coat = |cos: f32| 1.0 - self.clearcoat * fresnel::dielectric(cos.abs().min(1.0), CLEARCOAT_ETA).0;
        let sheen = |cos: f32| 1.0 - self.sheen * sheen::unit_albedo(cos.abs(), self.sheen_roughness).min(1.0);
        let clear = if self.clearcoat > 0.0 { coat(cos_o) * coat(cos_i) } else { 1.0 };
        // glTF's KHR_materials_sheen scales by the smaller of both directions, which keeps reciprocity.
        if self.sheen > 0.0 { clear * sheen(cos_o).min(sheen(cos_i)) } else { clear }
    }
}

//! One sample of what a surface mirrors or refracts, by which gathering rays and photons continue.

use crate::bsdf::{Bsdf, Sample};
use crate::surface::Surface;
use enfilade_math::{Rng, Vec3};

/// With the probability `chance`, a sample of a surface's mirroring or refraction and its unit direction in the world; `None` otherwise,
/// and where the shading and the geometric surface disagree about its side.
pub(super) fn mirrored(surface: &Surface<'_>, bsdf: &Bsdf<'_>, chance: f32, rng: &mut Rng) -> Option<(Sample, Vec3)> {
    if rng.next_f32() >= chance {
        return None;
    }
    let onb = surface.onb();
    let sample = bsdf.sample(onb.to_local(surface.wo), [rng.next_f32(), rng.next_f32(), rng.next_f32()])?;
    let direction = onb.to_world(sample.wi).normalize();
    (direction.dot(surface.ng) * sample.wi.z > 0.0).then_some((sample, direction))
}

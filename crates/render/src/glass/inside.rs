//! The state that a path keeps when it enters a body, so that it continues unbent where it leaves through a parallel border.

use crate::light::LightPoint;
use enfilade_math::{Rgb, Vec3};

/// Borders are parallel when the sine between their normals is at most this: what rounding leaves of equal normals.
const PARALLEL: f32 = 1e-4;

/// A path's segment before it entered a body through a flat border.
#[derive(Clone, Copy)]
pub(crate) struct Inside {
    /// Unit normal of that border.
    pub normal: Vec3,
    /// Unit direction of the segment.
    pub direction: Vec3,
    /// See [`crate::vertex::Segment`] for these three.
    pub sampled: Option<(LightPoint, f32)>,
    pub window: Option<u16>,
    pub sun: f32,
    /// True when nothing had scattered the light before.
    pub direct: bool,
}

/// Whether two unit normals are parallel, on whichever sides.
#[inline]
pub(crate) fn are_parallel(a: Vec3, b: Vec3) -> bool {
    a.cross(b).length_squared() <= PARALLEL * PARALLEL
}

/// The unit direction of `direction` beyond a border whose unit normal `n` faces where it came from; `eta` is the index beyond over the one
/// before. `None` where all light is reflected.
#[inline]
pub(crate) fn refracted(direction: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let ratio = 1.0 / eta;
    let cosine = -direction.dot(n);
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (square > 0.0).then(|| (direction * ratio + n * (ratio * cosine - square.sqrt())).normalize())
}

/// Factor by which reflections between two parallel borders, each of reflectance `r`, increase the light that passes directly; `inner` is
/// the body's transmittance for one crossing.
#[inline]
pub(crate) fn repeated(r: f32, inner: Rgb) -> Rgb {
    inner.map(|a| 1.0 / (1.0 - (r * a) * (r * a)).max(f32::MIN_POSITIVE))
}

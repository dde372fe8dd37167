//! Rays with a parameter range, and how to start one on a surface without hitting that surface again.

use glam::Vec3;

/// A half-line with a parameter range. `direction` need not be unit length; distances are in its units.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Point at which the parameter is zero.
    pub origin: Vec3,
    /// Unit length wherever a distance in metres is read from the hit.
    pub direction: Vec3,
    /// Hits at or before this parameter are ignored.
    pub t_min: f32,
    /// Hits at or beyond this parameter are ignored.
    pub t_max: f32,
}

impl Ray {
    /// A ray over (0, ∞).
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Moves a point off its surface along the geometric normal `n` (unit, on the side the new ray leaves to) by a few units in
/// the last place, so that the new ray does not hit the surface it starts on.
///
/// Wächter & Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, chapter 6.
#[inline]
pub fn offset_origin(p: Vec3, n: Vec3) -> Vec3 {
    const ORIGIN: f32 = 1.0 / 32.0;
    const FLOAT_SCALE: f32 = 1.0 / 65536.0;
    const INT_SCALE: f32 = 256.0;
    let axis = |p: f32, n: f32| {
        if p.abs() < ORIGIN {
            return p + FLOAT_SCALE * n;
        }
        let ulps = (INT_SCALE * n) as i32;
        f32::from_bits((p.to_bits() as i32).wrapping_add(if p < 0.0 { -ulps } else { ulps }) as u32)
    };
    Vec3::new(axis(p.x, n.x), axis(p.y, n.y), axis(p.z, n.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offset_moves_outward_by_a_little() {
        for p in [Vec3::new(1.0, -2.0, 3.0), Vec3::new(0.0, 0.01, -100.0)] {
            for n in [Vec3::X, Vec3::NEG_Y, Vec3::Z] {
                let moved = (offset_origin(p, n) - p).dot(n);
                assert!(moved > 0.0 && moved < 2e-5 * (1.0 + p.abs().max_element()), "{p} {n} {moved}");
            }
        }
    }
}

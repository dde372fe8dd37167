//! Finds pieces of the same geometry, at any position and orientation.
//!
//! Two pieces count as the same if they have equally many faces and agree in three lengths that rigid motion does not change: the sum of
//! all edges, the root of the area, and the root mean square distance of the corners from their mean. A mirrored piece counts as the same.

use enfilade_math::{DVec3, Vec3};
use enfilade_serve::area_m2;
use std::collections::HashMap;

/// Relative difference allowed between lengths: files store single precision.
const TOLERANCE: f64 = 1e-4;

/// Measures of a piece that do not change when it is moved and turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeInvariants {
    faces: usize,
    lengths_m: [f64; 3],
}

impl ShapeInvariants {
    /// Computed from the corners of faces.
    pub fn of<'a>(corners: impl Iterator<Item = &'a [Vec3; 3]> + Clone) -> Self {
        let points = || corners.clone().flatten().map(|p| p.as_dvec3());
        let faces = corners.clone().count();
        let mean = points().sum::<DVec3>() / (3 * faces).max(1) as f64;
        let spread = points().map(|p| p.distance_squared(mean)).sum::<f64>() / (3 * faces).max(1) as f64;
        let edges = |[a, b, c]: &[Vec3; 3]| f64::from(a.distance(*b)) + f64::from(b.distance(*c)) + f64::from(c.distance(*a));
        let area: f64 = corners.clone().map(area_m2).sum();
        Self { faces, lengths_m: [corners.map(edges).sum(), area.sqrt(), spread.sqrt()] }
    }

    /// The number of faces; and the sum of all edges, the root of the area, and the root mean square distance from the mean, metres.
    pub fn numbers(&self) -> (usize, [f64; 3]) {
        (self.faces, self.lengths_m)
    }

    /// From its numbers.
    pub fn of_numbers(faces: usize, lengths_m: [f64; 3]) -> Self {
        Self { faces, lengths_m }
    }

    /// True for the same geometry, at any position and orientation.
    pub fn is_like(&self, other: &Self) -> bool {
        let pairs = self.lengths_m.iter().zip(&other.lengths_m);
        self.faces == other.faces && pairs.into_iter().all(|(a, b)| (a - b).abs() <= TOLERANCE * a.max(*b))
    }
}

/// The shapes seen so far.
#[derive(Default)]
pub struct KnownShapes {
    by_faces: HashMap<usize, Vec<(ShapeInvariants, u32)>>,
    count: u32,
}

impl KnownShapes {
    /// A number for the shape, the same for all that are like it.
    pub fn key(&mut self, shape: ShapeInvariants) -> u32 {
        let alike = self.by_faces.entry(shape.faces).or_default();
        if let Some((_, key)) = alike.iter().find(|(known, _)| known.is_like(&shape)) {
            return *key;
        }
        let key = self.count;
        self.count += 1;
        alike.push((shape, key));
        key
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Quat;

    #[test]
    fn moved_and_turned_is_the_same_and_scaled_is_not() {
        let faces = [[Vec3::ZERO, Vec3::X, Vec3::new(0.0, 2.0, 0.5)], [Vec3::X, Vec3::Z, Vec3::ONE]];
        let placed = |scale: f32, turn: f32| {
            faces.map(|f| f.map(|p| scale * (Quat::from_rotation_z(turn) * Quat::from_rotation_x(0.3) * p) + Vec3::new(7.0, -3.0, 1.0)))
        };
        let mut shapes = KnownShapes::default();
        let mut key = |faces: &[[Vec3; 3]]| shapes.key(ShapeInvariants::of(faces.iter()));
        assert_eq!([key(&faces), key(&placed(1.0, 1.2)), key(&placed(1.0, 0.4)), key(&placed(1.001, 1.2))], [0, 0, 0, 1]);
        assert_eq!([key(&faces[..1]), key(&[]), key(&[])], [2, 3, 3]);
    }
}

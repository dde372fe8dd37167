//! The surface of a thing, for queries by rays and distances.

use enfilade_geometry::{Bvh, NearestTriangle};
use enfilade_math::{Bounds3, DVec3, OrientedBox, Ray, Rng, Vec3};

/// Number of sample points of a surface for queries of distance and direction, besides its corners.
const POINTS: usize = 512;
/// Corners of triangles that are looked at, at most, evenly among all.
const CORNERS: usize = 2048;

/// A surface in the world, metres.
pub struct Body {
    /// Number of the instance; −1 for walls, floors and ceilings.
    pub instance: i16,
    /// Class of the body.
    pub semantic: i16,
    /// Class of the body if it is one of NYU40, else −1; the rules use this one.
    pub class: i16,
    /// The least box with a level base around it, its longer horizontal side first.
    pub upright: OrientedBox,
    pub bounds: Bounds3,
    corners: Vec<[Vec3; 3]>,
    bvh: Bvh,
    nearest: NearestTriangle,
    /// Points spread evenly by area, with the unit normals of their triangles.
    pub points: Vec<(Vec3, Vec3)>,
}

impl Body {
    /// A body of triangles, with the box around them.
    pub fn new((instance, semantic): (i16, i16), upright: OrientedBox, corners: Vec<[Vec3; 3]>) -> Self {
        Self {
            instance,
            semantic,
            class: semantic,
            upright,
            bounds: Bounds3::from_points(corners.iter().flatten().copied()),
            bvh: Bvh::new(&corners, &|_| false),
            nearest: NearestTriangle::new(&corners),
            points: spread(&corners, &mut Rng::new(instance as u64)),
            corners,
        }
    }

    /// Whether it is an instance, and no wall, floor or ceiling, nor a part without labels.
    pub fn is_thing(&self) -> bool {
        self.instance >= 1
    }

    /// Whether a point is within its upright box, seen from above.
    pub fn holds_from_above(&self, p: DVec3) -> bool {
        let local = self.upright.world_from_box.transpose() * (p - self.upright.center);
        local.truncate().abs().cmple(0.5 * self.upright.extents.truncate()).all()
    }

    /// Whether the bounds of another overlap its own, seen from above.
    pub fn overlaps_from_above(&self, other: &Self) -> bool {
        let (a, b) = (&self.bounds, &other.bounds);
        a.min.truncate().cmple(b.max.truncate()).all() && b.min.truncate().cmple(a.max.truncate()).all()
    }

    /// First hit of a ray with it, between these distances from the origin along a unit direction, metres.
    pub fn hit(&self, origin: Vec3, direction: Vec3, [from, to]: [f32; 2]) -> Option<f32> {
        self.bvh.closest(&Ray { origin, direction, t_min: from, t_max: to }).map(|hit| hit.t)
    }

    /// Whether any part of it is between two points; a centimetre at each end is left out, for the points' own surfaces.
    pub fn is_between(&self, [a, b]: [DVec3; 2]) -> bool {
        let way = (b - a).as_vec3();
        let length = way.length();
        length > 0.02 && self.hit(a.as_vec3(), way / length, [0.01, length - 0.01]).is_some()
    }

    /// Corners of its triangles, not more than some thousand of them.
    pub fn some_corners(&self) -> impl Iterator<Item = Vec3> {
        let step = (3 * self.corners.len()).div_ceil(CORNERS).max(1);
        self.corners.iter().flatten().copied().step_by(step)
    }

    /// Corners and middles of the triangles that come within `reach_m` of its lowest point, or its highest; some thousand at most.
    pub fn ends(&self, top: bool, reach_m: f32) -> Vec<Vec3> {
        let is_end = |p: &Vec3| if top { p.z > self.bounds.max.z - reach_m } else { p.z < self.bounds.min.z + reach_m };
        let of_triangle = |t: &[Vec3; 3]| [t[0], t[1], t[2], (t[0] + t[1] + t[2]) / 3.0];
        let found: Vec<Vec3> = self.corners.iter().flat_map(of_triangle).filter(is_end).collect();
        let step = found.len().div_ceil(CORNERS).max(1);
        found.into_iter().step_by(step).collect()
    }

    /// The distance between the nearest points of two bodies, metres: an upper bound, and the distance itself where either is convex near its end.
    pub fn distance_m(&self, other: &Self) -> f64 {
        let starts = |body: &Self| body.points.iter().map(|(p, _)| *p).chain(body.some_corners()).map(Vec3::as_dvec3).collect::<Vec<_>>();
        self.nearest.distance_m(&other.nearest, &starts(self)).min(other.nearest.distance_m(&self.nearest, &starts(other)))
    }

    /// The distance between the bounds of two bodies, metres: no more than that between the bodies.
    pub fn bounds_distance_m(&self, other: &Self) -> f64 {
        f64::from(self.bounds.gap(&other.bounds).length())
    }

    /// The middle of its box.
    pub fn center(&self) -> DVec3 {
        self.upright.center
    }
}

/// Points spread evenly by area over triangles, with the normals of these.
fn spread(corners: &[[Vec3; 3]], rng: &mut Rng) -> Vec<(Vec3, Vec3)> {
    let cross = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
    let total: f64 = corners.iter().map(|t| f64::from(cross(*t).length())).sum();
    let (mut points, mut before) = (Vec::with_capacity(POINTS), 0.0);
    for triangle in corners {
        let normal = cross(*triangle);
        before += f64::from(normal.length()) / total.max(f64::MIN_POSITIVE) * POINTS as f64;
        while (points.len() as f64) + 0.5 < before {
            let (u, v) = (rng.next_f32().sqrt(), rng.next_f32());
            let [a, b, c] = *triangle;
            points.push((a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v), normal.normalize_or_zero()));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_rooms::boxed;

    #[test]
    fn distances_are_those_of_boxes_and_points_lie_on_them_evenly() {
        let a = boxed(1, 5, DVec3::ZERO, DVec3::ONE);
        // Beside, across an edge, across a corner, through each other.
        for (min, expected) in [
            (DVec3::new(1.5, 0.2, 0.1), 0.5),
            (DVec3::new(1.3, 1.4, 0.0), 0.5),
            (DVec3::new(2.0, 2.0, 2.0), 3.0f64.sqrt()),
            (DVec3::splat(0.5), 0.0),
        ] {
            let b = boxed(2, 5, min, min + DVec3::new(0.5, 0.5, 1.0));
            assert!((a.distance_m(&b) - expected).abs() < 1e-3, "{} {expected}", a.distance_m(&b));
            assert!(a.bounds_distance_m(&b) <= a.distance_m(&b) + 1e-6);
        }
        assert_eq!(a.points.len(), POINTS);
        let upper = a.points.iter().filter(|(_, normal)| normal.z > 0.9).count();
        assert!(upper.abs_diff(POINTS / 6) <= 2, "{upper}");
        assert!(a.points.iter().all(|(p, n)| ((*p - 0.5).dot(*n) - 0.5).abs() < 1e-5));
        assert!(
            a.is_between([DVec3::new(-1.0, 0.5, 0.5), DVec3::new(2.0, 0.5, 0.5)]) && !a.is_between([DVec3::Z * 2.0, DVec3::X * 2.0 + 2.0])
        );
    }

    #[test]
    fn ends_are_feet_and_tops() {
        let a = boxed(1, 5, DVec3::ZERO, DVec3::ONE);
        assert!(a.ends(false, 0.01).iter().all(|p| p.z == 0.0) && !a.ends(false, 0.01).is_empty());
        assert!(a.ends(true, 0.01).iter().all(|p| p.z == 1.0));
    }
}

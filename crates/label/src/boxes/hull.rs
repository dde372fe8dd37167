//! The convex hull of points in space: Quickhull (Barber, Dobkin & Huhdanpaa 1996).
//!
//! It serves to propose the orientations of boxes, whose sizes are then taken from all points. So it may leave out points within
//! [`TOLERANCE`] of its surface, and a point that rounding makes impossible to add.

use enfilade_math::DVec3;
use std::collections::HashMap;

/// Points are on a face when they are closer to it than this share of the whole: float32 vertices of a plane are.
pub(super) const TOLERANCE: f64 = 1e-7;

/// The convex hull of points, by its dimension.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Hull {
    /// At most one place.
    Point,
    /// A line of this direction.
    Line(DVec3),
    /// A plane of this unit normal.
    Plane(DVec3),
    /// A body: its corners, and its faces as unit normal and area.
    Body { corners: Vec<DVec3>, faces: Vec<(DVec3, f64)> },
}

/// A triangle of the hull in the making, counter-clockwise from outside.
struct Face {
    corners: [u32; 3],
    normal: DVec3,
    offset: f64,
    /// The face across the edge from corner i to corner i + 1.
    neighbors: [u32; 3],
    /// Points in front of it, which the hull still has to take in.
    outside: Vec<u32>,
    /// The last point that saw it.
    seen_from: u32,
    removed: bool,
}

impl Face {
    fn new(points: &[DVec3], corners: [u32; 3]) -> Self {
        let [a, b, c] = corners.map(|i| points[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Self { corners, normal, offset: normal.dot(a), neighbors: [u32::MAX; 3], outside: Vec::new(), seen_from: u32::MAX, removed: false }
    }

    fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// The convex hull of `points`.
pub(super) fn convex_hull(points: &[DVec3]) -> Hull {
    let (min, max) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| (min.min(p), max.max(p)));
    let tolerance = TOLERANCE * (max - min).max_element();
    let farthest = |distance: &dyn Fn(DVec3) -> f64| {
        let far = |i: usize| (i, distance(points[i]));
        (0..points.len()).map(far).fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
    };
    let longest = (max - min).max_position();
    let (a, _) = farthest(&|p| -p[longest]);
    let (b, length) = farthest(&|p| p[longest] - min[longest]);
    // NaN and an empty list included.
    if length.is_nan() || length <= 0.0 {
        return Hull::Point;
    }
    let along = (points[b] - points[a]).normalize();
    let (c, from_line) = farthest(&|p| along.cross(p - points[a]).length());
    if from_line <= tolerance {
        return Hull::Line(along);
    }
    let normal = along.cross(points[c] - points[a]).normalize();
    let (d, from_plane) = farthest(&|p| normal.dot(p - points[a]).abs());
    if from_plane <= tolerance {
        return Hull::Plane(normal);
    }
    let below = normal.dot(points[d] - points[a]) < 0.0;
    let [a, b, c, d] = [a, if below { b } else { c }, if below { c } else { b }, d].map(|i| i as u32);
    Growing::new(points, [a, b, c, d], tolerance).finish()
}

/// The hull as it grows point by point.
struct Growing<'a> {
    points: &'a [DVec3],
    faces: Vec<Face>,
    tolerance: f64,
}

impl<'a> Growing<'a> {
    /// Begins with a tetrahedron whose face a, b, c has d behind it.
    fn new(points: &'a [DVec3], [a, b, c, d]: [u32; 4], tolerance: f64) -> Self {
        let mut faces: Vec<Face> = [[a, b, c], [a, d, b], [b, d, c], [c, d, a]].map(|corners| Face::new(points, corners)).into();
        for (face, neighbors) in faces.iter_mut().zip([[1, 2, 3], [3, 2, 0], [1, 3, 0], [2, 1, 0]]) {
            face.neighbors = neighbors;
        }
        let mut hull = Self { points, faces, tolerance };
        hull.share(0..points.len() as u32, 0);
        hull
    }

    /// Gives each point to the first of the faces from `first` on that it lies in front of; points behind all are inside.
    fn share(&mut self, points: impl IntoIterator<Item = u32>, first: usize) {
        for i in points {
            let p = self.points[i as usize];
            if let Some(face) = self.faces[first..].iter_mut().find(|face| face.distance(p) > self.tolerance) {
                face.outside.push(i);
            }
        }
    }

    fn finish(mut self) -> Hull {
        let mut at = 0;
        while at < self.faces.len() {
            let face = &self.faces[at];
            if face.removed || face.outside.is_empty() {
                at += 1;
                continue;
            }
            let distance = |&(_, &i): &(usize, &u32)| face.distance(self.points[i as usize]);
            let farthest = face.outside.iter().enumerate().max_by(|a, b| distance(a).total_cmp(&distance(b)));
            let Some((place, &point)) = farthest else { continue };
            self.faces[at].outside.swap_remove(place);
            self.take_in(point, at as u32);
        }
        let kept: Vec<&Face> = self.faces.iter().filter(|face| !face.removed).collect();
        let mut corners: Vec<u32> = kept.iter().flat_map(|face| face.corners).collect();
        corners.sort_unstable();
        corners.dedup();
        let area = |face: &Face| {
            let [a, b, c] = face.corners.map(|i| self.points[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        Hull::Body {
            corners: corners.into_iter().map(|i| self.points[i as usize]).collect(),
            faces: kept.iter().map(|face| (face.normal, area(face))).collect(),
        }
    }

    /// Replaces the faces that see `point` by a fan from their border to it.
    fn take_in(&mut self, point: u32, first: u32) {
        let p = self.points[point as usize];
        let mut seen = vec![first];
        self.faces[first as usize].seen_from = point;
        let mut next = 0;
        while next < seen.len() {
            for neighbor in self.faces[seen[next] as usize].neighbors {
                let face = &mut self.faces[neighbor as usize];
                if face.seen_from != point && face.distance(p) > self.tolerance {
                    face.seen_from = point;
                    seen.push(neighbor);
                }
            }
            next += 1;
        }
        let mut border: Vec<([u32; 2], u32)> = Vec::new();
        for face in seen.iter().map(|&i| &self.faces[i as usize]) {
            let sides = (0..3).map(|side| ([face.corners[side], face.corners[(side + 1) % 3]], face.neighbors[side]));
            border.extend(sides.filter(|(_, behind)| self.faces[*behind as usize].seen_from != point));
        }
        let base = self.faces.len();
        let starting_at: HashMap<u32, usize> = border.iter().enumerate().map(|(i, ([start, _], _))| (*start, base + i)).collect();
        let closed = starting_at.len() == border.len() && border.iter().all(|([_, end], _)| starting_at.contains_key(end));
        if !closed {
            return;
        }
        for (i, &([start, end], behind)) in border.iter().enumerate() {
            let mut face = Face::new(self.points, [start, end, point]);
            face.neighbors[0] = behind;
            self.faces.push(face);
            let back = &mut self.faces[behind as usize];
            if let Some(side) = (0..3).find(|&side| back.corners[side] == end && back.corners[(side + 1) % 3] == start) {
                back.neighbors[side] = (base + i) as u32;
            }
        }
        for (i, ([_, end], _)) in border.iter().enumerate() {
            let after = starting_at[end];
            self.faces[base + i].neighbors[1] = after as u32;
            self.faces[after].neighbors[2] = (base + i) as u32;
        }
        for face in seen {
            self.faces[face as usize].removed = true;
            let orphans = std::mem::take(&mut self.faces[face as usize].outside);
            self.share(orphans, base);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{DMat3, Rng};

    fn cloud(count: usize, seed: u64, shape: impl Fn(&mut Rng) -> DVec3) -> Vec<DVec3> {
        let mut rng = Rng::new(seed);
        (0..count).map(|_| shape(&mut rng)).collect()
    }

    fn in_cube(rng: &mut Rng) -> DVec3 {
        DVec3::new(rng.next_f64(), rng.next_f64(), rng.next_f64())
    }

    /// No point lies in front of a face by more than a few tolerances.
    fn assert_encloses(points: &[DVec3]) {
        let Hull::Body { corners, faces } = convex_hull(points) else { panic!("no body") };
        for &(normal, _) in &faces {
            let reach = |points: &[DVec3]| points.iter().map(|p| p.dot(normal)).fold(f64::NEG_INFINITY, f64::max);
            assert!(reach(points) <= reach(&corners) + 1e-6);
        }
    }

    #[test]
    fn hulls_enclose_their_points() {
        assert_encloses(&cloud(2000, 1, in_cube));
        assert_encloses(&cloud(2000, 2, |rng| (in_cube(rng) - 0.5).normalize()));
        let grid: Vec<DVec3> = (0..1000).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100))).collect();
        assert_encloses(&grid);
        let turned = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(0.3);
        assert_encloses(&grid.iter().map(|&p| (turned * p).as_vec3().as_dvec3()).collect::<Vec<_>>());
    }

    #[test]
    fn a_cube_of_many_points_has_eight_corners_and_six_normals() {
        let grid: Vec<DVec3> = (0..1000).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100))).collect();
        let Hull::Body { corners, faces } = convex_hull(&grid) else { panic!("no body") };
        assert_eq!((corners.len(), faces.len()), (8, 12));
        assert!(faces.iter().all(|(normal, area)| normal.abs().max_element() == 1.0 && (area - 40.5).abs() < 1e-9));
    }

    #[test]
    fn planes_lines_and_points_are_told() {
        assert_eq!(convex_hull(&[]), Hull::Point);
        assert_eq!(convex_hull(&[DVec3::ONE; 4]), Hull::Point);
        let Hull::Line(along) = convex_hull(&cloud(50, 3, |rng| DVec3::ONE * rng.next_f64())) else { panic!("no line") };
        assert!(along.cross(DVec3::ONE).length() < 1e-12);
        let Hull::Plane(normal) = convex_hull(&cloud(50, 4, |rng| DVec3::new(rng.next_f64(), rng.next_f64(), 2.0))) else {
            panic!("no plane")
        };
        assert_eq!(normal.abs(), DVec3::Z);
    }
}

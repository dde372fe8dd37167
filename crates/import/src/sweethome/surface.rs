//! Flat faces with texture coordinates in centimetres, and holes in them.

use enfilade_geometry::Mesh;
use enfilade_math::{DVec2, DVec3, Vec2};

/// Pieces of less area are not worth a triangle, cm².
const SLIVER: f64 = 1e-4;

/// Faces being built; centimetres, y up.
#[derive(Default)]
pub(super) struct Surface {
    mesh: Mesh,
}

impl Surface {
    /// Adds a convex polygon of corners with texture coordinates, counter-clockwise seen from its front.
    pub(super) fn polygon(&mut self, corners: &[(DVec3, DVec2)]) {
        let first = self.mesh.positions.len() as u32;
        for (p, uv) in corners {
            self.mesh.positions.push(p.as_vec3());
            self.mesh.uvs.push(Vec2::new(uv.x as f32, uv.y as f32));
        }
        self.mesh.triangles.extend((2..corners.len() as u32).map(|i| [first, first + i - 1, first + i]));
    }

    /// The faces, if there are any.
    pub(super) fn finish(self) -> Option<Mesh> {
        Some(self.mesh).filter(|m| !m.triangles.is_empty())
    }
}

/// A point of the plan at a height: y up, the plan's y as z.
pub(super) fn lifted(p: DVec2, height: f64) -> DVec3 {
    DVec3::new(p.x, height, p.y)
}

/// A rectangular hole of an upright face: along it as a share of its length, and up, in centimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hole {
    pub along: [f64; 2],
    pub up: [f64; 2],
}

/// The rest, without the holes, of an upright face from `bottom` to a straight upper edge, which rises from `tops[0]` to `tops[1]`: convex
/// polygons of points (share along, height), counter-clockwise where along is to the right.
pub(crate) fn without_holes(bottom: f64, tops: [f64; 2], holes: &[Hole]) -> Vec<Vec<DVec2>> {
    let top = |s: f64| tops[0] + s * (tops[1] - tops[0]);
    let mut breaks = vec![0.0, 1.0];
    for hole in holes {
        breaks.extend(hole.along);
        // Where the upper edge crosses the hole's, so that between two breaks it is entirely above or below.
        breaks.extend(hole.up.map(|z| (z - tops[0]) / (tops[1] - tops[0])));
    }
    breaks.retain(|s| (0.0..=1.0).contains(s));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let mut polygons = Vec::new();
    for pair in breaks.windows(2) {
        let [p, q] = [pair[0], pair[1]];
        let middle = 0.5 * (p + q);
        let mut here: Vec<[f64; 2]> = holes.iter().filter(|h| h.along[0] <= middle && middle <= h.along[1]).map(|h| h.up).collect();
        here.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut z = bottom;
        for [from, to] in here.into_iter().filter(|[from, _]| *from < top(middle)) {
            if from > z {
                polygons.push(vec![DVec2::new(p, z), DVec2::new(q, z), DVec2::new(q, from), DVec2::new(p, from)]);
            }
            z = z.max(to);
        }
        if z < top(middle) {
            polygons.push(vec![DVec2::new(p, z), DVec2::new(q, z), DVec2::new(q, top(q).max(z)), DVec2::new(p, top(p).max(z))]);
        }
    }
    polygons
}

/// The parts of flat triangles outside a convex polygon; both may have either orientation.
pub(crate) fn subtract(triangles: Vec<[DVec2; 3]>, convex: &[DVec2]) -> Vec<[DVec2; 3]> {
    let turn = if area(convex) < 0.0 { -1.0 } else { 1.0 };
    let mut left = Vec::new();
    for triangle in triangles {
        let mut outside = Vec::new();
        let mut rest = triangle.to_vec();
        for (i, &a) in convex.iter().enumerate() {
            let edge = convex[(i + 1) % convex.len()] - a;
            let side = |p: DVec2| turn * edge.perp_dot(p - a);
            outside.push(clipped(&rest, &|p| -side(p)));
            rest = clipped(&rest, &side);
        }
        if area(&rest).abs() < SLIVER {
            left.push(triangle);
            continue;
        }
        for piece in outside.iter().filter(|p| area(p).abs() >= SLIVER) {
            left.extend((2..piece.len()).map(|i| [piece[0], piece[i - 1], piece[i]]));
        }
    }
    left
}

/// The part of a convex polygon where `side` is not negative.
fn clipped(polygon: &[DVec2], side: &dyn Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut out = Vec::new();
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (at_p, at_q) = (side(p), side(q));
        if at_p >= 0.0 {
            out.push(p);
        }
        if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
            out.push(p + (q - p) * (at_p / (at_p - at_q)));
        }
    }
    out
}

/// Signed area of a polygon.
pub(super) fn area(polygon: &[DVec2]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    0.5 * polygon.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(polygons: &[Vec<DVec2>]) -> f64 {
        polygons.iter().map(|p| area(p)).sum()
    }

    #[test]
    fn holes_take_their_area_from_faces_with_level_and_sloping_tops() {
        let hole = |along, up| Hole { along, up };
        assert_eq!(total(&without_holes(0.0, [2.0, 2.0], &[hole([0.25, 0.75], [0.5, 1.5])])), 1.5);
        // A door reaches the floor, one beyond the end takes the rest, overlapping ones count once.
        assert_eq!(total(&without_holes(0.0, [2.0, 2.0], &[hole([0.5, 3.0], [-1.0, 9.0])])), 1.0);
        let twice = [hole([0.2, 0.6], [0.0, 1.0]), hole([0.4, 0.8], [0.5, 1.0])];
        assert!((total(&without_holes(0.0, [1.0, 1.0], &twice)) - (1.0 - 0.4 - 0.1)).abs() < 1e-12);
        // The sloping edge cuts the hole's corner: 1.5 − ∫ of min(top, 1.5) − 0.5 over the hole.
        let sloping = total(&without_holes(0.0, [1.0, 2.0], &[hole([0.25, 0.75], [0.5, 1.5])]));
        assert!((sloping - (1.5 - (0.5 * 0.5 * (0.75 + 1.0) * 0.5 + 0.25))).abs() < 0.04 && sloping > 1.0, "{sloping}");
        assert!(without_holes(0.0, [1.0, 1.0], &[hole([0.0, 1.0], [0.0, 1.0])]).is_empty());
    }

    #[test]
    fn convex_polygons_are_cut_out_of_triangles() {
        let big = [DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 4.0)];
        let square = [DVec2::new(0.5, 0.5), DVec2::new(1.5, 0.5), DVec2::new(1.5, 1.5), DVec2::new(0.5, 1.5)];
        let sum = |triangles: &[[DVec2; 3]]| triangles.iter().map(|t| area(t).abs()).sum::<f64>();
        assert!((sum(&subtract(vec![big], &square)) - 7.0).abs() < 1e-12);
        let reversed: Vec<DVec2> = square.iter().rev().copied().collect();
        assert!((sum(&subtract(vec![big], &reversed)) - 7.0).abs() < 1e-12);
        let apart = square.map(|p| p + DVec2::splat(9.0));
        assert_eq!(subtract(vec![big], &apart), vec![big]);
        let around = square.map(|p| (p - 1.0) * 100.0);
        assert!(subtract(vec![big], &around).is_empty());
    }
}

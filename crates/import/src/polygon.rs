//! Polygons to triangles: convex ones as fans, concave ones by cutting off ears.

use enfilade_math::{DVec3, Vec2, Vec3};

/// At most this many corners are looked at, per corner of a polygon, while ears are cut off: very many corners could take hours.
/// Polygons of some thousand corners need fewer.
const LOOKS_PER_CORNER: usize = 4096;

/// The area of a triangle.
pub(crate) fn triangle_area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Triangles of a polygon as indices into its corners. A polygon of n corners gives n − 2 triangles, also when it is degenerate.
pub(crate) fn triangulate(corners: &[Vec3]) -> Vec<[usize; 3]> {
    let fan = || (1..corners.len().saturating_sub(1)).map(|i| [0, i, i + 1]).collect::<Vec<_>>();
    if corners.len() < 4 {
        return fan();
    }
    let normal = newell_normal(corners);
    let agrees = |t: &[usize; 3]| (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).dot(normal) > 0.0;
    let fan = fan();
    if fan.iter().all(agrees) || normal == Vec3::ZERO {
        return fan;
    }
    cut_ears(&project(corners, normal)).unwrap_or(fan)
}

/// Twice the area vector of a closed polygon; it points to the side from which the corners run counter-clockwise.
pub(crate) fn newell_normal(corners: &[Vec3]) -> Vec3 {
    let next = corners.iter().cycle().skip(1);
    let sum = corners.iter().zip(next).fold(Vec3::ZERO, |sum, (a, b)| sum + (*a - corners[0]).cross(*b - corners[0]));
    if sum.is_finite() { sum } else { Vec3::ZERO }
}

/// The polygon in the plane of its two largest extents, counter-clockwise.
fn project(corners: &[Vec3], normal: Vec3) -> Vec<Vec2> {
    let n = normal.abs();
    let (flat, sign): (fn(&Vec3) -> Vec2, f32) = if n.z >= n.x && n.z >= n.y {
        (|p| Vec2::new(p.x, p.y), normal.z)
    } else if n.x >= n.y {
        (|p| Vec2::new(p.y, p.z), normal.x)
    } else {
        (|p| Vec2::new(p.z, p.x), normal.y)
    };
    let turn = if sign < 0.0 { Vec2::new(-1.0, 1.0) } else { Vec2::ONE };
    corners.iter().map(|p| flat(p) * turn).collect()
}

/// Ear cutting in the plane; `None` when no ear is left, as in polygons that cross themselves, or when it takes too long.
fn cut_ears(points: &[Vec2]) -> Option<Vec<[usize; 3]>> {
    let area = |a: usize, b: usize, c: usize| (points[b] - points[a]).perp_dot(points[c] - points[a]);
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::with_capacity(points.len() - 2);
    let mut looks = LOOKS_PER_CORNER * points.len();
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|&i| {
            let (a, b, c) = (left[(i + n - 1) % n], left[i], left[(i + 1) % n]);
            let inside = |p: usize| {
                let coincides = [a, b, c].iter().any(|&q| points[p] == points[q]);
                !coincides && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0
            };
            if looks < n || area(a, b, c) <= 0.0 {
                return false;
            }
            looks -= n;
            !left.iter().any(|&p| inside(p))
        })?;
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[Vec3], triangles: &[[usize; 3]]) -> f32 {
        triangles.iter().map(|t| 0.5 * (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).length()).sum()
    }

    #[test]
    fn concave_polygons_keep_their_area_in_every_plane() {
        // An arrow head and an L, whose fans would cover more than the polygon.
        let arrow = [(0.0, 0.0), (2.0, -2.0), (0.0, 2.0), (-2.0, -2.0)];
        let ell = [(1.0, 1.0), (1.0, 2.0), (0.0, 2.0), (0.0, 0.0), (2.0, 0.0), (2.0, 1.0)];
        let planes: [fn((f32, f32)) -> Vec3; 4] =
            [|p| Vec3::new(p.0, p.1, 0.0), |p| Vec3::new(0.0, p.0, p.1), |p| Vec3::new(p.1, 0.0, p.0), |p| Vec3::new(p.1, p.0, 3.0)];
        for plane in planes {
            for (shape, expected) in [(&arrow[..], 4.0), (&ell[..], 3.0)] {
                let corners: Vec<Vec3> = shape.iter().map(|&p| plane(p)).collect();
                let triangles = triangulate(&corners);
                assert_eq!(triangles.len(), corners.len() - 2);
                assert!((area(&corners, &triangles) - expected).abs() < 1e-5, "{triangles:?}");
                let n = newell_normal(&corners);
                for t in &triangles {
                    assert!((corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).dot(n) > 0.0);
                }
            }
        }
    }

    #[test]
    fn degenerate_polygons_do_not_hang() {
        assert_eq!(triangulate(&[Vec3::ZERO; 5]).len(), 3);
        assert_eq!(triangulate(&[Vec3::NAN; 5]).len(), 3);
        assert!(triangulate(&[Vec3::ZERO; 2]).is_empty());
        // A comb, none of whose ears is found soon.
        let comb: Vec<Vec3> = (0..40_000).map(|i| Vec3::new((i / 2) as f32, if i % 2 == 0 { 0.0 } else { 1e-3 * i as f32 }, 0.0)).collect();
        assert_eq!(triangulate(&comb).len(), comb.len() - 2);
        let bow_tie = [Vec3::ZERO, Vec3::new(2.0, 2.0, 0.0), Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        assert_eq!(triangulate(&bow_tie).len(), 2);
    }
}

//! Signed distances to the surfaces of things, on a grid.

use crate::meet::Triangle;
use enfilade_math::{Bounds3, Vec3};

/// Edge of a cell, metres.
const CELL: f32 = 0.016;
/// Distances up to this one are exact, metres; greater ones are this one.
const REACH: f32 = 0.048;
/// Two distances that differ by less are one, metres: of triangles that share the nearest point, the one that faces it most decides the sign.
const SAME: f32 = 1e-4;

/// The surfaces of things in a window of the world.
pub struct Solid {
    min: Vec3,
    count: [usize; 3],
    distance: Vec<f32>,
}

impl Solid {
    /// The things with these triangles, whose winding is outward, in `window`.
    pub fn new<'a>(window: &Bounds3, triangles: impl Iterator<Item = &'a Triangle>) -> Self {
        let extent = window.extent();
        let count = extent.to_array().map(|length| (length / CELL).ceil() as usize + 2);
        let mut solid = Self { min: window.min, count, distance: vec![REACH; count.iter().product()] };
        let mut facing = vec![0.0f32; solid.distance.len()];
        for triangle in triangles {
            solid.add(triangle, &mut facing);
        }
        solid
    }

    fn add(&mut self, triangle: &Triangle, facing: &mut [f32]) {
        let [a, b, c] = *triangle;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal == Vec3::ZERO {
            return;
        }
        let bounds = Bounds3::from_points(*triangle);
        let low = ((bounds.min - REACH - self.min) / CELL).ceil().max(Vec3::ZERO);
        let high = ((bounds.max + REACH - self.min) / CELL).floor();
        let range = |axis: usize| low[axis] as usize..((high[axis] + 1.0).max(0.0) as usize).min(self.count[axis]);
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let p = self.min + CELL * Vec3::new(i as f32, j as f32, k as f32);
                    let height = normal.dot(p - a);
                    if height.abs() > REACH {
                        continue;
                    }
                    let away = p.distance(nearest(p, triangle));
                    let cell = (k * self.count[1] + j) * self.count[0] + i;
                    let known = self.distance[cell].abs();
                    let faces = height.abs() / away.max(1e-6);
                    if away < known - SAME || (away < known + SAME && faces > facing[cell]) {
                        self.distance[cell] = if height < 0.0 { -away } else { away };
                        facing[cell] = faces;
                    }
                }
            }
        }
    }

    /// Distance to the nearest surface, negative inside, and the direction away from it; `None` far from all.
    pub fn at(&self, p: Vec3) -> Option<(f32, Vec3)> {
        let q = (p - self.min) / CELL;
        if q.min_element() < 0.0 || (0..3).any(|axis| q[axis] as usize + 1 >= self.count[axis]) {
            return None;
        }
        let (base, f) = (q.floor(), q.fract());
        let corner = |dx: usize, dy: usize, dz: usize| {
            let [x, y, z] = [base.x as usize + dx, base.y as usize + dy, base.z as usize + dz];
            self.distance[(z * self.count[1] + y) * self.count[0] + x]
        };
        let v: [f32; 8] = std::array::from_fn(|n| corner(n & 1, n >> 1 & 1, n >> 2));
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let edge = |n: usize| mix(v[n], v[n + 1], f.x);
        let distance = mix(mix(edge(0), edge(2), f.y), mix(edge(4), edge(6), f.y), f.z);
        if distance >= 0.98 * REACH {
            return None;
        }
        let along = |of: [[usize; 2]; 4], s: f32, t: f32| {
            let d = of.map(|[a, b]| v[b] - v[a]);
            mix(mix(d[0], d[1], s), mix(d[2], d[3], s), t)
        };
        let gradient = Vec3::new(
            along([[0, 1], [2, 3], [4, 5], [6, 7]], f.y, f.z),
            along([[0, 2], [1, 3], [4, 6], [5, 7]], f.x, f.z),
            along([[0, 4], [1, 5], [2, 6], [3, 7]], f.x, f.y),
        );
        Some((distance, gradient.normalize_or(Vec3::Z)))
    }
}

/// The point of a triangle that is nearest to `p` (Ericson 2005, "Real-time collision detection", 5.1.5).
fn nearest(p: Vec3, [a, b, c]: &Triangle) -> Vec3 {
    let (ab, ac, ap) = (*b - *a, *c - *a, p - *a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - *b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return *a + ab * (d1 / (d1 - d3));
    }
    let cp = p - *c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return *a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return *b + (*c - *b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = 1.0 / (va + vb + vc);
    *a + ab * (vb * sum) + ac * (vc * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::rounded_box;

    #[test]
    fn distances_to_a_box_are_signed() {
        let mesh = rounded_box(Vec3::new(0.4, 0.3, 0.2), 0.001, 1);
        let triangles: Vec<Triangle> = (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect();
        let window = Bounds3 { min: Vec3::splat(-0.4), max: Vec3::splat(0.4) };
        let solid = Solid::new(&window, triangles.iter());
        for (p, expected, way) in [
            (Vec3::new(0.05, 0.02, 0.12), 0.02, Vec3::Z),
            (Vec3::new(0.05, 0.02, 0.085), -0.015, Vec3::Z),
            (Vec3::new(0.23, 0.0, 0.0), 0.03, Vec3::X),
        ] {
            let (distance, direction) = solid.at(p).unwrap();
            assert!((distance - expected).abs() < 0.002 && direction.dot(way) > 0.98, "{p}: {distance} {direction}");
        }
        assert_eq!(solid.at(Vec3::new(0.0, 0.0, 0.3)), None);
    }
}

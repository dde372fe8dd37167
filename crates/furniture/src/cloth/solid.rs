//! Signed distances to the surfaces of things, on a grid that is computed where it is asked for.

use crate::meet::{Triangle, around};
use enfilade_math::{Bounds3, Vec3};
use std::ops::Range;

/// Edge of a cell, metres.
const CELL: f32 = 0.016;
/// Distances up to this one are exact, metres; greater ones are this one.
const REACH: f32 = 0.048;
/// Two distances that differ by less are one, metres: of triangles that share the nearest point, the one that faces it most decides the sign.
const SAME: f32 = 1e-4;
/// Cells along an edge of a block, which is computed as a whole.
const BLOCK: usize = 6;
/// Corners of cells along an edge of a block.
const CORNERS: usize = BLOCK + 1;
/// Corners of cells in a block.
const SIZE: usize = CORNERS * CORNERS * CORNERS;
/// The block has not been computed.
const UNKNOWN: u32 = u32::MAX;
/// Nothing is near the block.
const EMPTY: u32 = u32::MAX - 1;

/// The surfaces of things in a window of the world.
pub struct Solid {
    min: Vec3,
    /// Number of blocks along each axis.
    count: [usize; 3],
    triangles: Vec<Triangle>,
    /// Where the triangles near each block begin in `near`; one more than there are blocks.
    first: Vec<u32>,
    near: Vec<u32>,
    /// Where the distances of each block are, or one of the two words above.
    block: Vec<u32>,
    distance: Vec<f32>,
}

impl Solid {
    /// The things with these triangles, whose winding is outward, in `window`.
    pub fn new(window: &Bounds3, triangles: Vec<Triangle>) -> Self {
        let count = window.extent().to_array().map(|length| (length / (BLOCK as f32 * CELL)).ceil() as usize + 1);
        let blocks: usize = count.iter().product();
        let mut solid = Self {
            min: window.min,
            count,
            triangles,
            first: vec![0; blocks + 1],
            near: Vec::new(),
            block: vec![EMPTY; blocks],
            distance: Vec::new(),
        };
        solid.sort();
        solid
    }

    /// True where all of a window is in its own, but for what is at most as wide as it reaches.
    pub fn covers(&self, window: &Bounds3) -> bool {
        let max = self.min + BLOCK as f32 * CELL * Vec3::from(self.count.map(|n| n as f32));
        self.min.cmple(window.min + REACH).all() && max.cmpge(window.max - REACH).all()
    }

    /// Finds the triangles that are near each block.
    fn sort(&mut self) {
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for (t, triangle) in (0..).zip(&self.triangles) {
            self.each_block(triangle, |block| pairs.push((block, t)));
        }
        for &(block, _) in &pairs {
            self.first[block as usize + 1] += 1;
            self.block[block as usize] = UNKNOWN;
        }
        for block in 0..self.block.len() {
            self.first[block + 1] += self.first[block];
        }
        let mut next = self.first.clone();
        self.near = vec![0; pairs.len()];
        for (block, t) in pairs {
            self.near[next[block as usize] as usize] = t;
            next[block as usize] += 1;
        }
    }

    /// Calls `f` for the blocks that a triangle may be near.
    fn each_block(&self, triangle: &Triangle, mut f: impl FnMut(u32)) {
        let [a, b, c] = *triangle;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal == Vec3::ZERO {
            return;
        }
        let edge = BLOCK as f32 * CELL;
        let bounds = around(triangle);
        let low = ((bounds.min - REACH - self.min) / edge).floor();
        let high = ((bounds.max + REACH - self.min) / edge).floor();
        let range = |axis: usize| span(low[axis], high[axis], self.count[axis]);
        // Half of the block's width along the normal.
        let reach = REACH + 0.5 * edge * normal.abs().element_sum();
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let middle = self.min + edge * (Vec3::new(i as f32, j as f32, k as f32) + 0.5);
                    if normal.dot(middle - a).abs() <= reach {
                        f(((k * self.count[1] + j) * self.count[0] + i) as u32);
                    }
                }
            }
        }
    }

    /// Computes the distances of a block.
    fn compute(&mut self, block: usize) {
        let [i, j, k] = [block % self.count[0], block / self.count[0] % self.count[1], block / self.count[0] / self.count[1]];
        let mut grid = Grid {
            min: self.min + BLOCK as f32 * CELL * Vec3::new(i as f32, j as f32, k as f32),
            distance: [REACH; SIZE],
            facing: [0.0; SIZE],
        };
        let near = self.first[block] as usize..self.first[block + 1] as usize;
        near.for_each(|n| grid.add(&self.triangles[self.near[n] as usize]));
        self.block[block] = if grid.distance.iter().all(|&d| d == REACH) { EMPTY } else { self.distance.len() as u32 };
        if self.block[block] != EMPTY {
            self.distance.extend(grid.distance);
        }
    }

    /// Distance to the nearest surface, negative inside, and the direction away from it; `None` far from all.
    pub fn at(&mut self, p: Vec3) -> Option<(f32, Vec3)> {
        let q = (p - self.min) / CELL;
        let cell = q.floor();
        if cell.min_element() < 0.0 {
            return None;
        }
        let cell = cell.to_array().map(|n| n as usize);
        if (0..3).any(|axis| cell[axis] >= BLOCK * self.count[axis]) {
            return None;
        }
        let of = cell.map(|n| n / BLOCK);
        let block = (of[2] * self.count[1] + of[1]) * self.count[0] + of[0];
        if self.block[block] == UNKNOWN {
            self.compute(block);
        }
        if self.block[block] == EMPTY {
            return None;
        }
        let [x, y, z] = cell.map(|n| n % BLOCK);
        let first = self.block[block] as usize + (z * CORNERS + y) * CORNERS + x;
        let corner = |offset: usize| self.distance[first + offset];
        let v = [
            corner(0),
            corner(1),
            corner(CORNERS),
            corner(CORNERS + 1),
            corner(CORNERS * CORNERS),
            corner(CORNERS * CORNERS + 1),
            corner(CORNERS * CORNERS + CORNERS),
            corner(CORNERS * CORNERS + CORNERS + 1),
        ];
        interpolated(&v, q.fract())
    }
}

/// The distances of one block while they are computed.
struct Grid {
    min: Vec3,
    distance: [f32; SIZE],
    /// How directly the triangle faces the corner that decides its distance.
    facing: [f32; SIZE],
}

impl Grid {
    fn add(&mut self, triangle: &Triangle) {
        let [a, b, c] = *triangle;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let bounds = around(triangle);
        let low = ((bounds.min - REACH - self.min) / CELL).ceil();
        let high = ((bounds.max + REACH - self.min) / CELL).floor();
        let range = |axis: usize| span(low[axis], high[axis], CORNERS);
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let p = self.min + CELL * Vec3::new(i as f32, j as f32, k as f32);
                    let cell = (k * CORNERS + j) * CORNERS + i;
                    let known = self.distance[cell].abs();
                    let height = normal.dot(p - a);
                    // Neither its plane nor its box is nearer than what is known.
                    let beside = p - p.clamp(bounds.min, bounds.max);
                    if height.abs() > known + SAME || beside.length_squared() > (known + SAME) * (known + SAME) {
                        continue;
                    }
                    let away = p.distance(nearest(p, triangle));
                    let faces = height.abs() / away.max(1e-6);
                    if away < known - SAME || (away < known + SAME && faces > self.facing[cell]) {
                        self.distance[cell] = if height < 0.0 { -away } else { away };
                        self.facing[cell] = faces;
                    }
                }
            }
        }
    }
}

/// Whole numbers from `low` to `high` that are below `count`.
fn span(low: f32, high: f32, count: usize) -> Range<usize> {
    low.max(0.0) as usize..((high + 1.0).max(0.0) as usize).min(count)
}

/// The distance in a cell with these distances at its corners, and its direction.
fn interpolated(v: &[f32; 8], f: Vec3) -> Option<(f32, Vec3)> {
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
        let mut solid = Solid::new(&window, triangles);
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

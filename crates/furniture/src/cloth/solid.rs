//! Signed distances to the surfaces of things, on a grid that is computed where it is asked for.

use super::block::{BLOCK, CELL, CORNERS, Grid, REACH, span};
use crate::meet::{Triangle, around};
use enfilade_math::{Bounds3, Vec3};

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
        let mut grid = Grid::new(self.min + BLOCK as f32 * CELL * Vec3::new(i as f32, j as f32, k as f32));
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

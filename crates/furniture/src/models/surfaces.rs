//! Surfaces of a model on which small things can stand, found from its triangles.
//!
//! Levels are heights at which much of the model is level. On each, the cells of a grid that carry (a ray down finds the level) and are
//! free (a ray up finds nothing near) are covered by the largest rectangles that contain only such cells. Enclosed cells are left out, such
//! as the inside of a cabinet with its doors shut.

use crate::surface::{CONTACT, Surface};
use enfilade_geometry::Bvh;
use enfilade_math::{Ray, Vec2, Vec3};

/// Edge of a cell, metres.
const CELL: f32 = 0.02;
/// Triangles are level whose normals differ from the vertical by less than six degrees: this is the cosine.
const LEVEL: f32 = 0.9945;
/// Greatest difference in height between triangles of one level, metres.
const SPAN: f32 = 0.003;
/// Rays start this far above a level, metres.
const LIFT: f32 = 0.004;
/// Minimum area of a level, and of a surface on it, square metres.
const MIN_AREA: f32 = 0.02;
/// Minimum edge of a surface, and minimum height of a level, metres.
const MIN_EDGE: f32 = 0.1;
/// Minimum free height above a surface, metres.
const MIN_HEADROOM: f32 = 0.12;
/// Levels that are looked at, those of the largest area first.
const MAX_LEVELS: usize = 8;
/// Surfaces on each of them.
const MAX_SURFACES: usize = 3;

/// The surfaces of a model that fills −½..½ of `size` in x and y and 0..1 of it in z, the highest first.
pub(super) fn surfaces(triangles: &[[Vec3; 3]], size: Vec3) -> Vec<Surface> {
    let levels = levels(triangles);
    if levels.is_empty() {
        return Vec::new();
    }
    let bvh = Bvh::new(triangles, &|_| false);
    levels.into_iter().flat_map(|z| Grid::new(&bvh, size, z).surfaces()).filter(|surface| !enclosed(&bvh, surface)).collect()
}

/// True where the model is on all sides of a surface: level rays from its middle, half-way up to what is above it, find it four times.
fn enclosed(bvh: &Bvh, surface: &Surface) -> bool {
    if surface.headroom.is_infinite() {
        return false;
    }
    let from = (0.5 * (surface.min + surface.max)).extend(surface.z + 0.5 * surface.headroom);
    [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y].into_iter().all(|way| bvh.occluded(&Ray::new(from, way)))
}

/// Heights at which the model is level, from the top down.
fn levels(triangles: &[[Vec3; 3]]) -> Vec<f32> {
    let mut flat: Vec<(f32, f32)> = triangles
        .iter()
        .filter_map(|[a, b, c]| {
            let doubled = (*b - *a).cross(*c - *a);
            let area = 0.5 * doubled.length();
            (area > 0.0 && doubled.z.abs() > LEVEL * 2.0 * area).then_some((a.z.max(b.z).max(c.z), area))
        })
        .collect();
    flat.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut levels: Vec<(f32, f32)> = Vec::new();
    for (z, area) in flat {
        match levels.last_mut() {
            Some(level) if level.0 - z < SPAN => level.1 += area,
            _ => levels.push((z, area)),
        }
    }
    levels.retain(|(z, area)| *area >= MIN_AREA && *z > MIN_EDGE);
    levels.sort_by(|a, b| b.1.total_cmp(&a.1));
    levels.truncate(MAX_LEVELS);
    let mut heights: Vec<f32> = levels.into_iter().map(|(z, _)| z).collect();
    heights.sort_by(|a, b| b.total_cmp(a));
    heights
}

/// The free height above each cell of a level, 0 where nothing can stand; and the distance below the level at which it is supported.
struct Grid {
    min: Vec2,
    z: f32,
    columns: usize,
    free: Vec<f32>,
    below: Vec<f32>,
}

impl Grid {
    fn new(bvh: &Bvh, size: Vec3, z: f32) -> Self {
        let count = (size.truncate() / CELL).floor().max(Vec2::ZERO);
        let (columns, rows) = (count.x as usize, count.y as usize);
        let mut grid = Self { min: -0.5 * CELL * count, z, columns, free: Vec::new(), below: Vec::new() };
        for cell in 0..columns * rows {
            let at = grid.place(cell % columns, cell / columns) + Vec2::splat(0.5 * CELL);
            let from = at.extend(z + LIFT);
            let reach = |way: Vec3| bvh.closest(&Ray::new(from, way)).map(|hit| hit.t);
            let below = reach(Vec3::NEG_Z).filter(|t| *t < LIFT + SPAN);
            let free = below.map_or(0.0, |_| reach(Vec3::Z).map_or(f32::INFINITY, |t| t + LIFT));
            grid.free.push(if free < MIN_HEADROOM { 0.0 } else { free });
            grid.below.push(below.map_or(f32::INFINITY, |t| t - LIFT));
        }
        grid
    }

    fn place(&self, column: usize, row: usize) -> Vec2 {
        self.min + CELL * Vec2::new(column as f32, row as f32)
    }

    /// The largest rectangles, one after another.
    fn surfaces(mut self) -> Vec<Surface> {
        let mut found = Vec::new();
        while let Some([x0, x1, y0, y1]) = self.largest() {
            let (min, max) = (self.place(x0, y0), self.place(x1, y1));
            let edges = max - min;
            if found.len() == MAX_SURFACES || edges.min_element() < MIN_EDGE || edges.x * edges.y < MIN_AREA {
                break;
            }
            let (mut headroom, mut below) = (f32::INFINITY, f32::INFINITY);
            for cell in (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))).map(|(x, y)| y * self.columns + x) {
                headroom = headroom.min(self.free[cell]);
                below = below.min(self.below[cell]);
                self.free[cell] = 0.0;
            }
            found.push(Surface { min, max, z: self.z - below + CONTACT, headroom: headroom - 0.01 });
        }
        found
    }

    /// First and last column and row of the largest rectangle of free cells, by the heights of the columns above each row.
    fn largest(&self) -> Option<[usize; 4]> {
        let mut best: Option<([usize; 4], usize)> = None;
        let mut heights = vec![0usize; self.columns];
        for row in 0..self.free.len() / self.columns.max(1) {
            for x in 0..self.columns {
                heights[x] = if self.free[row * self.columns + x] > 0.0 { heights[x] + 1 } else { 0 };
            }
            for x0 in 0..self.columns {
                let mut height = heights[x0];
                for x1 in x0..self.columns {
                    height = height.min(heights[x1]);
                    let area = height * (x1 + 1 - x0);
                    if height == 0 {
                        break;
                    }
                    if best.is_none_or(|(_, largest)| area > largest) {
                        best = Some(([x0, x1 + 1, row + 1 - height, row + 1], area));
                    }
                }
            }
        }
        best.map(|(rectangle, _)| rectangle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pieces::board;
    use enfilade_geometry::Mesh;

    fn triangles(meshes: &[Mesh]) -> Vec<[Vec3; 3]> {
        meshes.iter().flat_map(|m| (0..m.triangles.len()).map(|t| m.corners(t)).collect::<Vec<_>>()).collect()
    }

    #[test]
    fn a_shelf_has_its_boards_and_their_headroom() {
        let boards = [0.1, 0.5, 0.9].map(|z| board([-0.4, -0.15, z], [0.4, 0.15, z + 0.02], 0.0));
        let found = surfaces(&triangles(&boards), Vec3::new(0.8, 0.3, 0.92));
        let heights: Vec<f32> = found.iter().map(|s| (s.z * 100.0).round()).collect();
        assert_eq!(heights, [92.0, 52.0, 12.0]);
        assert!(found[0].headroom.is_infinite() && (found[1].headroom - 0.37).abs() < 0.01, "{found:?}");
        assert!((found[2].max - found[2].min - Vec2::new(0.8, 0.3)).abs().max_element() < 0.03);
    }

    #[test]
    fn nothing_stands_inside_of_what_is_closed() {
        let closed = triangles(&[board([-0.25, -0.2, 0.15], [0.25, 0.2, 0.6], 0.0)]);
        let heights = |triangles: &[[Vec3; 3]]| -> Vec<f32> {
            surfaces(triangles, Vec3::new(0.5, 0.4, 0.6)).iter().map(|s| (s.z * 100.0).round()).collect()
        };
        assert_eq!(heights(&closed), [60.0]);
        let open: Vec<_> = closed.iter().copied().filter(|corners| corners.iter().any(|p| p.y < 0.199)).collect();
        assert_eq!(heights(&open), [60.0, 15.0]);
    }

    #[test]
    fn what_slants_or_is_small_carries_nothing() {
        let slanted = board([-0.3, -0.3, 0.0], [0.3, 0.3, 0.02], 0.0);
        let tilt = |p: Vec3| Vec3::new(p.x, p.y, p.z + 0.3 + 0.3 * p.x);
        let slanted = Mesh { positions: slanted.positions.into_iter().map(tilt).collect(), ..slanted };
        assert!(surfaces(&triangles(&[slanted]), Vec3::new(0.6, 0.6, 0.5)).is_empty());
        assert!(surfaces(&triangles(&[board([-0.04; 3], [0.04, 0.04, 0.3], 0.0)]), Vec3::new(0.08, 0.08, 0.34)).is_empty());
    }
}

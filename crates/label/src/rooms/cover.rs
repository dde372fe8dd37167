//! Areas with floor and ceiling, seen from above, on a grid.

use super::grid::Grid;
use super::storeys::Storey;
use super::surfaces::LabelledTriangle;
use enfilade_math::{DVec2, DVec3};

/// Side of a square of the grid, metres; larger where a side of the storey would have more than `MOST` of them.
const STEP_M: f64 = 0.05;
const MOST: f64 = 2e3;

/// Which squares of a storey are covered by floor and by ceiling.
pub struct Cover {
    grid: Grid,
    floor: Vec<bool>,
    /// `None` where no ceiling is labelled.
    ceiling: Option<Vec<bool>>,
    /// Corners of the surfaces of floors, and of ceilings.
    corners: [Vec<DVec2>; 2],
}

impl Cover {
    /// The cover of a storey; `None` where it has no walls and no ceilings.
    pub fn new(storey: &Storey<'_>) -> Option<Self> {
        // Not of floors: the ground around a house may be large.
        let all = [&storey.walls, &storey.ceilings];
        let corners = || all.into_iter().flatten().flat_map(|t| t.corners).map(DVec3::truncate).filter(|p| p.is_finite());
        let (low, high) = (corners().reduce(DVec2::min)?, corners().reduce(DVec2::max)?);
        let grid = Grid::new(low, high, DVec2::splat(STEP_M.max((high - low).max_element() / MOST)));
        let ceiling = (!storey.ceilings.is_empty()).then(|| drawn(&grid, &storey.ceilings));
        let flat = |list: &[&LabelledTriangle]| list.iter().flat_map(|t| t.corners).map(DVec3::truncate).collect();
        Some(Self { floor: drawn(&grid, &storey.floors), ceiling, grid, corners: [flat(&storey.floors), flat(&storey.ceilings)] })
    }

    /// Lower and upper bounds of the storey.
    pub fn bounds(&self) -> [DVec2; 2] {
        [self.grid.low, self.grid.low + self.grid.step * DVec2::new(self.grid.columns as f64, self.grid.rows as f64)]
    }

    /// The range along a direction in which there are both floor and ceiling; only floor, where no ceiling is labelled.
    pub fn extent(&self, direction: DVec2) -> [f64; 2] {
        let own = |list: &Vec<DVec2>| {
            let along = || list.iter().map(|p| direction.dot(*p));
            [along().reduce(f64::min), along().reduce(f64::max)]
        };
        let ends = self.corners.iter().map(own).filter_map(|[low, high]| Some([low?, high?]));
        ends.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])]).unwrap_or_default()
    }

    /// The mean of the shares of a convex polygon that floor and ceiling cover; the share of floor alone, where no ceiling is labelled.
    pub fn share(&self, polygon: &[DVec2]) -> f64 {
        let (mut squares, mut covered) = (0.0, 0.0);
        self.grid.each_in(polygon, |i| {
            let one = |list: &[bool]| f64::from(u8::from(list[i]));
            squares += 1.0;
            covered += self.ceiling.as_ref().map_or(one(&self.floor), |ceiling| 0.5 * (one(&self.floor) + one(ceiling)));
        });
        // A polygon that contains no square's centre is too small to be a room.
        if squares > 0.0 { covered / squares } else { 0.0 }
    }
}

fn drawn(grid: &Grid, triangles: &[&LabelledTriangle]) -> Vec<bool> {
    let mut found = vec![false; grid.count()];
    for triangle in triangles {
        grid.each_in_triangle(triangle.corners.map(DVec3::truncate), |i| found[i] = true);
    }
    found
}

//! Where something can lie: on a grid over a thing or a floor, the height of its upper side, and the free height over that.

use crate::room::Footprint;
use enfilade_furniture::meet::{Body, Triangle};
use enfilade_math::{Bounds3, Vec2, Vec3};

/// Edge of a cell, metres.
const CELL: f32 = 0.02;
/// Free height that is looked at, metres.
const OVER: f32 = 0.9;
/// What reaches less far above the upper side is part of what lies on it, metres.
const SUNK: f32 = 0.004;
/// Cells of the largest grid: of a hall of 20 m by 20 m.
const MOST: usize = 1_000_000;

/// The upper side of something, seen from above.
pub struct Ground {
    min: Vec2,
    columns: usize,
    rows: usize,
    /// Height of the upper side; −∞ where there is none.
    top: Vec<f32>,
    /// Height of the lowest thing above it.
    clear: Vec<f32>,
    /// Least and greatest height of the upper side.
    levels: [f32; 2],
}

/// A level place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// The greatest height in it.
    pub top: f32,
    /// How much higher that is than its smallest.
    pub spread: f32,
}

impl Ground {
    /// The upper side below `limit` of `carriers` in the rectangle from `min` to `max`, with all of `others` above it.
    pub fn new<'a>([min, max]: [Vec2; 2], carriers: &[&'a Body], others: impl Iterator<Item = &'a Body>, limit: f32) -> Self {
        let count = ((max - min) / CELL).ceil().max(Vec2::ONE);
        let (columns, rows) = (count.x as usize, count.y as usize);
        let cells = if columns * rows > MOST { 0 } else { columns * rows };
        let (top, clear) = (vec![f32::NEG_INFINITY; cells], vec![f32::INFINITY; cells]);
        let mut ground = Self { min, columns, rows, top, clear, levels: [f32::INFINITY, f32::NEG_INFINITY] };
        if cells == 0 {
            return ground;
        }
        for body in carriers {
            ground.each(body, [f32::NEG_INFINITY, limit], |ground, cell, z| {
                if z <= limit {
                    ground.top[cell] = ground.top[cell].max(z);
                }
            });
        }
        let tops = || ground.top.iter().copied().filter(|top| top.is_finite());
        ground.levels = [tops().fold(f32::INFINITY, f32::min), tops().fold(f32::NEG_INFINITY, f32::max)];
        carriers.iter().for_each(|body| ground.cover(body, SUNK));
        others.for_each(|body| ground.cover(body, -SUNK));
        ground
    }

    /// Records a body that is above the upper side, by `margin` at least.
    fn cover(&mut self, body: &Body, margin: f32) {
        let [lowest, highest] = self.levels;
        self.each(body, [lowest + margin, highest + OVER], |ground, cell, z| {
            let top = ground.top[cell];
            if z > top + margin && z < top + OVER {
                ground.clear[cell] = ground.clear[cell].min(z);
            }
        });
    }

    /// Records a body that has been put there.
    pub fn put(&mut self, body: &Body) {
        self.cover(body, -SUNK);
    }

    /// Calls `f` for the cells that triangles of a body between two heights cover, with heights of the triangles there.
    fn each(&mut self, body: &Body, [low, high]: [f32; 2], f: impl Fn(&mut Self, usize, f32)) {
        if self.top.is_empty() || low > high {
            return;
        }
        let [min, max] = self.window();
        let window = Bounds3 { min: min.extend(low), max: max.extend(high) };
        for triangle in body.within(&window) {
            self.each_cell(triangle, &f);
        }
    }

    /// Calls `f` for the cells that a triangle covers.
    fn each_cell(&mut self, corners: &Triangle, f: &impl Fn(&mut Self, usize, f32)) {
        let [a, b, c] = *corners;
        let steps = |side: Vec3| (1.6 * side.length() / CELL).ceil().clamp(1.0, 1500.0) as usize;
        let (along_b, along_c) = (steps(b - a), steps(c - a));
        for i in 0..=along_b {
            let u = i as f32 / along_b as f32;
            // Fewer steps where the triangle is narrow.
            let rows = (along_c as f32 * (1.0 - u)).ceil() as usize;
            let (start, step) = (a + u * (b - a), (1.0 - u) / rows.max(1) as f32 * (c - a));
            for j in 0..=rows {
                let p = start + j as f32 * step;
                if let Some(cell) = self.cell(p.truncate()) {
                    f(self, cell, p.z);
                }
            }
        }
    }

    fn cell(&self, p: Vec2) -> Option<usize> {
        let q = (p - self.min) * (1.0 / CELL);
        let inside = q.min_element() >= 0.0 && q.x < self.columns as f32 && q.y < self.rows as f32 && !self.top.is_empty();
        inside.then(|| q.y as usize * self.columns + q.x as usize)
    }

    /// Height of the upper side at a point.
    pub fn top(&self, p: Vec2) -> Option<f32> {
        self.cell(p).map(|cell| self.top[cell]).filter(|top| top.is_finite())
    }

    /// The place below a rectangle, if all of it is there and free up to `height` above it.
    pub fn level(&self, under: &Footprint, height: f32) -> Option<Level> {
        let corners = under.corners();
        let (low, high) = corners.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        let (first, last) = (((low - self.min) / CELL).floor(), ((high - self.min) / CELL).floor());
        if first.min_element() < 0.0 || last.x as usize >= self.columns || last.y as usize >= self.rows || self.top.is_empty() {
            return None;
        }
        let (mut least, mut most, mut clear) = (f32::INFINITY, f32::NEG_INFINITY, f32::INFINITY);
        for y in first.y as usize..=last.y as usize {
            for x in first.x as usize..=last.x as usize {
                let p = self.min + CELL * (Vec2::new(x as f32, y as f32) + 0.5);
                if under.distance(p) > 0.5 * CELL {
                    continue;
                }
                let cell = y * self.columns + x;
                (least, most) = (least.min(self.top[cell]), most.max(self.top[cell]));
                clear = clear.min(self.clear[cell]);
            }
        }
        let free = least.is_finite() && most.is_finite() && clear > most + height;
        free.then_some(Level { top: most, spread: most - least })
    }

    /// The rectangle that the grid covers.
    pub fn window(&self) -> [Vec2; 2] {
        [self.min, self.min + CELL * Vec2::new(self.columns as f32, self.rows as f32)]
    }

    /// The middle of all places at most `below` lower than the highest, and how far they reach along x and y.
    pub fn crest(&self, below: f32) -> Option<(Vec3, Vec2)> {
        let highest = self.top.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let place = |cell: usize| self.min + CELL * (Vec2::new((cell % self.columns) as f32, (cell / self.columns) as f32) + 0.5);
        let high: Vec<Vec2> = (0..self.top.len()).filter(|&cell| self.top[cell] > highest - below).map(place).collect();
        let (low, far) = high.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, far), p| (low.min(*p), far.max(*p)));
        let middle = high.iter().sum::<Vec2>() / high.len().max(1) as f32;
        highest.is_finite().then(|| (middle.extend(highest), far - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_furniture::shape::{Reshape, bevelled_box};

    fn block(size: [f32; 3], at: [f32; 3]) -> Body {
        let mesh = bevelled_box(Vec3::from_array(size), 0.001).moved(Vec3::from_array(at));
        let mut body = Body::new("block_1");
        body.push((0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect());
        body
    }

    #[test]
    fn a_table_is_level_but_at_its_edge_below_a_lamp_and_where_a_cup_stands() {
        let table = block([1.0, 0.6, 0.04], [0.0, 0.0, 0.73]);
        let (cup, shelf) = (block([0.08, 0.08, 0.1], [0.3, 0.0, 0.801]), block([0.3, 0.6, 0.02], [-0.35, 0.0, 0.95]));
        let ground = Ground::new([Vec2::new(-0.5, -0.3), Vec2::new(0.5, 0.3)], &[&table], [&cup, &shelf].into_iter(), 1.3);
        let at = |x: f32, y: f32| Footprint { center: Vec2::new(x, y), half: Vec2::splat(0.05), yaw: 0.3 };
        let level = ground.level(&at(0.0, 0.0), 0.3).unwrap();
        assert!((level.top - 0.75).abs() < 1e-4 && level.spread < 1e-4, "{level:?}");
        assert_eq!([at(0.48, 0.0), at(0.25, 0.03), at(-0.35, 0.0)].map(|place| ground.level(&place, 0.3)), [None; 3]);
        assert!(ground.level(&at(-0.35, 0.0), 0.15).is_some());
    }
}

//! Shelving of shops and libraries. A gondola: shelves of sheet metal on a rear panel, one or two-sided, 1.4 to 2 m high, filled with goods
//! (class shelves); and an aisle of books: two bookshelves back to back, 1.35 to 2.1 m high (class bookshelf).

use super::goods::{shelved_books, stock};
use crate::builder::{Builder, Class, Object};
use crate::materials::Finish;
use crate::pieces::form::all;
use crate::pieces::{Furniture, board, grained};
use enfilade_math::{DAffine3, Rng, Vec3};
use std::f64::consts::PI;

/// Shelves of sheet metal with goods.
#[derive(Clone, Copy, Debug)]
pub struct Gondola {
    /// Sections beside each other.
    pub sections: usize,
    /// Goods on both sides of the panel.
    pub double: bool,
    /// Height.
    pub height: f32,
    /// Finish of the shelves.
    pub finish: Finish,
}

/// Width of a section, depth of its shelves, and of the base, metres.
const SECTION: f32 = 0.98;
const SHELF: f32 = 0.37;
const BASE: [f32; 2] = [0.45, 0.14];
/// Thickness of the panel, metres.
const PANEL: f32 = 0.03;
/// How far the rails with the prices protrude, metres.
const RAIL: f32 = 0.004;
/// From one shelf to the next, at least, metres.
const STEP: f32 = 0.33;

impl Gondola {
    /// Shelves at a wall.
    pub fn single(rng: &mut Rng) -> Self {
        Self { double: false, height: [1.8, 2.0, 2.1][rng.below(3)], ..Self::random(rng) }
    }

    fn sides(&self) -> &'static [f32] {
        if self.double { &[1.0, -1.0] } else { &[1.0] }
    }

    /// The plane of the panel's middle: at the rear, or in the middle.
    fn middle(&self) -> f32 {
        if self.double { 0.0 } else { 0.5 * PANEL - 0.5 * self.size().y }
    }

    fn frame(&self, b: &mut Builder, object: &Object) {
        let (x, y) = (0.5 * self.size().x, self.middle());
        let panel = board([0.005 - x, y - 0.4 * PANEL, 0.02], [x - 0.005, y + 0.4 * PANEL, self.height - 0.01], 0.001);
        b.part(object, "panel", panel, self.finish);
        let post = |k: usize| {
            let at = SECTION * (k as f32 - 0.5 * self.sections as f32);
            board([at - 0.015, y - 0.5 * PANEL, 0.0], [at + 0.015, y + 0.5 * PANEL, self.height], 0.002)
        };
        b.part(object, "posts", all((0..=self.sections).map(post)), self.finish);
        for (name, s) in ["front", "rear"].into_iter().zip(self.sides()) {
            let ends = [y + s * 0.5 * PANEL, y + s * (0.5 * PANEL + BASE[0])];
            let base = board([0.006 - x, ends[0].min(ends[1]), 0.0], [x - 0.006, ends[0].max(ends[1]), BASE[1]], 0.002);
            b.part(object, &format!("base_{name}"), base, self.finish);
        }
    }

    fn levels(&self) -> Vec<f32> {
        let count = ((self.height - BASE[1]) / STEP) as usize;
        let step = (self.height - BASE[1]) / count as f32;
        (0..count).map(|k| BASE[1] + step * k as f32).collect()
    }
}

impl Furniture for Gondola {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::CoatedWhite, Finish::CoatedWhite, Finish::BlackMetal, Finish::ColoredMetal(1)][rng.below(4)];
        Self { sections: 1 + rng.below(3), double: true, height: [1.4, 1.5, 1.7][rng.below(3)], finish }
    }

    fn size(&self) -> Vec3 {
        let depth = PANEL + (BASE[0] + RAIL) * self.sides().len() as f32;
        Vec3::new(SECTION * self.sections as f32 + 0.03, depth, self.height)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("gondola", Class::Shelves, pose);
        self.frame(b, &object);
        let (levels, y) = (self.levels(), self.middle());
        let step = levels.get(1).map_or(0.5, |z| z - levels[0]);
        let mut filled = Vec::new();
        for (side, s) in self.sides().iter().enumerate() {
            let (mut shelves, mut rails) = (Vec::new(), Vec::new());
            for (level, &z) in levels.iter().enumerate() {
                let deep = if level == 0 { BASE[0] } else { SHELF };
                for section in 0..self.sections {
                    let x0 = SECTION * (section as f32 - 0.5 * self.sections as f32) + 0.016;
                    let x1 = x0 + SECTION - 0.032;
                    let ends = |a: f32, b: f32| [y + s * (0.5 * PANEL + a), y + s * (0.5 * PANEL + b)];
                    let [a, c] = ends(-0.001, deep);
                    if level > 0 {
                        shelves.push(board([x0, a.min(c), z - 0.028], [x1, a.max(c), z], 0.002));
                    }
                    let [a, c] = ends(deep - 0.001, deep + RAIL);
                    rails.push(board([x0 + 0.004, a.min(c), z - 0.034], [x1 - 0.004, a.max(c), z + 0.004], 0.001));
                    filled.push((side, x0, z, deep));
                }
            }
            b.part(&object, &format!("shelves_{}", side + 1), all(shelves), self.finish);
            b.part(
                &object,
                &format!("rails_{}", side + 1),
                all(rails),
                [Finish::Paper, Finish::Plastic(1), Finish::Aluminium][rng.below(3)],
            );
        }
        for (side, x0, z, deep) in filled {
            // The rear side is stocked in the space of someone behind.
            let turn = if side == 0 { 0.0 } else { PI };
            let front = if side == 0 { y + 0.5 * PANEL + deep } else { 0.5 * PANEL + deep - y };
            let x0 = if side == 0 { x0 } else { -x0 - SECTION + 0.032 };
            let place = pose * DAffine3::from_rotation_z(turn);
            stock(b, place, Vec3::new(x0, front - 0.008, z), [SECTION - 0.034, deep, step - 0.05], rng);
        }
    }
}

/// Bookshelves back to back, or one at a wall, filled densely.
#[derive(Clone, Copy, Debug)]
pub struct BookAisle {
    /// Sections beside each other.
    pub sections: usize,
    /// Books on both sides.
    pub double: bool,
    /// Boards above each other.
    pub rows: usize,
    /// Finish of boards and ends.
    pub finish: Finish,
}

/// Width of a section, depth of a side, from board to board, plinth and thickness of boards, metres.
const BOOKS: f32 = 0.9;
const SIDE: f32 = 0.25;
const ROW: f32 = 0.335;
const PLINTH: f32 = 0.09;
const BOARD: f32 = 0.022;

impl BookAisle {
    /// Shelves at a wall.
    pub fn single(rng: &mut Rng) -> Self {
        Self { double: false, rows: 5 + rng.below(2), ..Self::random(rng) }
    }

    fn case(&self, b: &mut Builder, object: &Object, rng: &mut Rng) {
        let (size, t) = (self.size(), BOARD);
        let (x, y) = (0.5 * size.x, 0.5 * size.y);
        for k in 0..=self.sections {
            let at = BOOKS * (k as f32 - 0.5 * self.sections as f32);
            let outer = k == 0 || k == self.sections;
            let (low, high) = if outer { (0.0, size.z) } else { (PLINTH, size.z - 0.03) };
            let set_back = if outer { 0.0 } else { 0.004 };
            let upright = board([at - 0.5 * t, set_back - y, low], [at + 0.5 * t, y - set_back, high], 0.0015);
            b.part(object, &format!("upright_{}", k + 1), grained(upright, rng), self.finish);
        }
        let (mut boards, inner) = (Vec::new(), x - t);
        let middle = if self.double { 0.0 } else { 0.006 - y };
        for k in 0..=self.rows {
            let z = PLINTH + ROW * k as f32;
            boards.push(board([-inner - 0.0005, 0.003 - y, z], [inner + 0.0005, y - 0.003, z + t], 0.0012));
        }
        b.part(object, "boards", grained(all(boards), rng), self.finish);
        b.part(object, "rear", board([-inner, middle - 0.005, PLINTH], [inner, middle + 0.005, size.z - 0.03], 0.001), self.finish);
        b.part(object, "plinth", board([-inner, 0.03 - y, 0.0], [inner, y - 0.03, PLINTH + 0.001], 0.001), Finish::BlackPlastic);
    }
}

impl Furniture for BookAisle {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::Wood, Finish::CoatedWhite, Finish::DarkWood, Finish::ColoredMetal(1)][rng.below(5)];
        Self { sections: 2 + rng.below(3), double: true, rows: 4 + rng.below(2), finish }
    }

    fn size(&self) -> Vec3 {
        let depth = if self.double { 2.0 * SIDE } else { SIDE + 0.012 };
        Vec3::new(BOOKS * self.sections as f32 + BOARD, depth, PLINTH + ROW * self.rows as f32 + BOARD + 0.03)
    }

    fn reach(&self) -> f32 {
        0.7
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let object = b.object("book_aisle", Class::Bookshelf, pose);
        self.case(b, &object, rng);
        let front = 0.5 * self.size().y;
        let turns: &[f64] = if self.double { &[0.0, PI] } else { &[0.0] };
        for (turn, section, row) in
            turns.iter().flat_map(|&turn| (0..self.sections).flat_map(move |section| (0..self.rows).map(move |row| (turn, section, row))))
        {
            if rng.below(16) == 0 {
                continue;
            }
            let x = BOOKS * (section as f32 - 0.5 * self.sections as f32) + 0.5 * BOARD + 0.003;
            let at = Vec3::new(x, front - 0.012, PLINTH + ROW * row as f32 + BOARD);
            let share = if rng.below(4) == 0 { rng.range(0.4, 0.8) } else { rng.range(0.9, 1.0) };
            let width = share * (BOOKS - BOARD - 0.008);
            shelved_books(b, pose * DAffine3::from_rotation_z(turn), at, width, ROW - BOARD - 0.01, rng);
        }
    }
}

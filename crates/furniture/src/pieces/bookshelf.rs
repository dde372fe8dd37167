//! A bookcase of one to three columns and five or six rows of compartments, of wood (class bookshelf). 68 to 85 % of the compartments hold
//! a row of books, the others a pile and an ornament.

use super::book::{pile_of_books, row_of_books};
use super::{Bowl, Candles, Furniture, Plant, Vase, board, grained, on};
use crate::builder::{Builder, Class};
use crate::materials::Finish;
use enfilade_math::{DAffine3, Rng, Vec3};

/// A bookcase: columns of compartments with books and a few other things.
#[derive(Clone, Copy, Debug)]
pub struct Bookshelf {
    /// Columns of compartments.
    pub columns: usize,
    /// Compartments above each other.
    pub rows: usize,
    /// Share of the compartments that hold books, on `[0,1]`.
    pub books: f32,
}

/// Depth of the case, metres: books are 13 to 19 cm deep.
const DEPTH: f32 = 0.30;
/// Thickness of uprights and boards, metres.
const BOARD: f32 = 0.022;
/// From one upright to the next, left face to left face, metres: a board of this length still carries books.
const COLUMN: f32 = 0.62;
/// From one board to the next, metres: 31 cm are free, and books are up to 27.5 cm high.
const ROW: f32 = 0.335;
/// Height of the plinth below the lowest board, metres.
const PLINTH: f32 = 0.06;
/// How far boards reach into the uprights at each end, metres: no light comes through the joint.
const LAP: f32 = 0.0002;

impl Bookshelf {
    fn case(&self, b: &mut Builder, shelf: &crate::builder::Object, rng: &mut Rng) {
        let wood = Finish::Wood;
        let size = self.size();
        let (half, back, front) = (0.5 * size.x, -0.5 * DEPTH, 0.5 * DEPTH);
        for i in 0..=self.columns {
            let x = i as f32 * COLUMN - half;
            let mesh = board([x, back, 0.0], [x + BOARD, front, size.z], 0.0015);
            b.part(shelf, &format!("upright_{}", i + 1), grained(mesh, rng), wood);
        }
        for column in 0..self.columns {
            let x = column as f32 * COLUMN - half + BOARD;
            for row in 0..=self.rows {
                let z = PLINTH + row as f32 * ROW - if row == 0 { 0.0 } else { BOARD };
                let mesh = board([x - LAP, back + 0.011, z], [x + COLUMN - BOARD + LAP, front - 0.003, z + BOARD], 0.0015);
                b.part(shelf, &format!("board_{}_{}", column + 1, row + 1), grained(mesh, rng), wood);
            }
            let plinth = board([x - LAP, front - 0.03, 0.0], [x + COLUMN - BOARD + LAP, front - 0.012, PLINTH - 0.0002], 0.001);
            b.part(shelf, &format!("plinth_{}", column + 1), grained(plinth, rng), wood);
            let rear = board([x - LAP, back + 0.002, 0.01], [x + COLUMN - BOARD + LAP, back + 0.010, size.z - 0.002], 0.0005);
            b.part(shelf, &format!("rear_{}", column + 1), grained(rear, rng), wood);
        }
    }

    /// Fills one compartment whose floor's left front corner is at `at` (y at the front edge).
    fn fill(&self, b: &mut Builder, pose: DAffine3, at: Vec3, rng: &mut Rng) {
        let width = COLUMN - BOARD;
        let kind = rng.next_f32();
        if kind < self.books {
            // Books fill most of the width; something small stands in the rest now and then.
            let share = if rng.below(3) == 0 { rng.range(0.55, 0.75) } else { rng.range(0.86, 0.99) };
            row_of_books(b, pose, at, share * (width - 0.01), share < 0.95, rng);
            if share < 0.76 {
                let place = Vec3::new(at.x + 0.5 * (1.0 + share) * width, at.y - 0.13, at.z);
                ornament(b, on(pose, place, rng.range(-0.6, 0.6)), 0.5 * (1.0 - share) * width, rng);
            }
        } else {
            let from = if rng.below(2) == 0 { 0.28 } else { 0.72 };
            pile_of_books(b, on(pose, Vec3::new(at.x + from * width, at.y - 0.14, at.z), rng.range(-0.08, 0.08)), 3 + rng.below(3), rng);
            let place = Vec3::new(at.x + (1.0 - from) * width, at.y - 0.14, at.z);
            ornament(b, on(pose, place, rng.range(-0.6, 0.6)), 0.11, rng);
        }
    }
}

/// Something to look at that fits a circle of `radius`.
fn ornament(b: &mut Builder, pose: DAffine3, radius: f32, rng: &mut Rng) {
    match rng.below(4) {
        0 => Vase { height: rng.range(0.16, 0.25), belly: radius.min(0.075), branches: 0 }.build(b, pose, rng),
        1 => Bowl { radius: radius.min(0.1) }.build(b, pose, rng),
        2 => Plant::small(rng.range(0.09, 0.11), (0.5 * radius).min(0.045)).build(b, pose, rng),
        _ => Candles { count: 1 + rng.below(2) }.build(b, pose, rng),
    }
}

impl Furniture for Bookshelf {
    fn random(rng: &mut Rng) -> Self {
        Self { columns: 1 + rng.below(3), rows: 5 + rng.below(2), books: rng.range(0.68, 0.85) }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.columns as f32 * COLUMN + BOARD, DEPTH, PLINTH + self.rows as f32 * ROW)
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let shelf = b.object("bookshelf", Class::Bookshelf, pose);
        self.case(b, &shelf, rng);
        let half = 0.5 * self.size().x;
        for column in 0..self.columns {
            for row in 0..self.rows {
                let z = PLINTH + row as f32 * ROW + if row == 0 { BOARD } else { 0.0 };
                let at = Vec3::new(column as f32 * COLUMN - half + BOARD, 0.5 * DEPTH - 0.01, z);
                self.fill(b, pose, at, rng);
            }
        }
    }
}

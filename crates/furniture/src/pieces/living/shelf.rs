//! Shelves, class shelves: one to three boards on the wall, 70 to 120 cm long, and cube shelves in seven formats of up to 4 × 4
//! compartments. Both come with books and decorations, each an object of its own; baskets in cube shelves are of class box. The origin of
//! the wall shelf is the middle of its back.

use crate::builder::{Builder, Class};
use crate::materials::Finish;
use crate::pieces::book::row_of_books;
use crate::pieces::clutter::decoration;
use crate::pieces::form::all;
use crate::pieces::{CONTACT, Furniture, Surface, board, grained, on};
use crate::shape::Reshape;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Boards on the wall one above the other, with things on them; the origin is the middle of the back.
#[derive(Clone, Copy, Debug)]
pub struct WallShelf {
    /// Length along the wall.
    pub width: f32,
    /// Number of boards.
    pub boards: usize,
    /// On brackets of metal instead of hidden bolts.
    pub brackets: bool,
    /// Finish of the boards.
    pub finish: Finish,
}

/// Depth of the boards of a wall shelf, metres: books are up to 19 cm deep.
const DEPTH: f32 = 0.24;
/// Thickness of the boards of a wall shelf, metres.
const BOARD: f32 = 0.03;
/// From one board of a wall shelf to the next, metres: 33 cm are free, and books are up to 27.5 cm high.
const STEP: f32 = 0.36;
/// Air between boards that meet, metres: it keeps faces out of one plane.
const GAP: f32 = 0.0002;

impl WallShelf {
    /// Upper face of board `k` above the origin.
    fn level(&self, k: usize) -> f32 {
        STEP * (k as f32 - 0.5 * self.boards as f32) + BOARD
    }
}

impl Furniture for WallShelf {
    fn random(rng: &mut Rng) -> Self {
        let finish = [Finish::Wood, Finish::WhiteLacquer, Finish::DarkWood][rng.below(3)];
        Self { width: rng.range(0.7, 1.2), boards: 1 + rng.below(3), brackets: rng.below(2) == 0, finish }
    }

    fn size(&self) -> Vec3 {
        Vec3::new(self.width, DEPTH, STEP * self.boards as f32 + 0.008)
    }

    fn surfaces(&self) -> Vec<Surface> {
        // `build` fills the boards itself.
        Vec::new()
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let half = 0.5 * self.width;
        for k in 0..self.boards {
            let z = self.level(k);
            let shelf = b.object("wall_shelf", Class::Shelves, pose);
            b.part(&shelf, "board", grained(board([-half, 0.0005, z - BOARD], [half, DEPTH, z], 0.002), rng), self.finish);
            if self.brackets {
                let bracket = |x: f32| {
                    let [x0, x1] = [x - 0.011, x + 0.011];
                    board([x0, 0.0003, z], [x1, 0.004, z + 0.09], 0.001).with(board(
                        [x0, 0.0003, z - BOARD - 0.004],
                        [x1, DEPTH - 0.01, z - BOARD - 0.0003],
                        0.001,
                    ))
                };
                b.part(&shelf, "brackets", bracket(0.1 - half).with(bracket(half - 0.1)), Finish::BlackMetal);
            }
            fill(b, pose, [-half + 0.03, half - 0.03], [DEPTH, z], STEP - BOARD - 0.03, rng);
        }
    }
}

/// Puts books and things on the board over `x`, whose front edge and height are `edge`, below `headroom`.
fn fill(b: &mut Builder, pose: DAffine3, x: [f32; 2], [front, z]: [f32; 2], headroom: f32, rng: &mut Rng) {
    let mut at = x[0];
    while x[1] - at > 0.12 {
        if rng.below(2) == 0 && headroom > 0.285 {
            let width = rng.range(0.14, 0.32).min(x[1] - at);
            row_of_books(b, pose, Vec3::new(at, front - 0.01, z), width, true, rng);
            at += width + 0.05;
        } else {
            let thing = decoration(headroom, rng);
            let w = thing.size().x;
            if at + w > x[1] || thing.size().y > front - 0.01 {
                at += 0.06;
                continue;
            }
            thing.build(b, on(pose, Vec3::new(at + 0.5 * w, front - 0.5 * DEPTH, z), 0.0), rng);
            at += w + rng.range(0.02, 0.08);
        }
    }
}

/// Square compartments beside and above each other, open or with baskets in them.
#[derive(Clone, Copy, Debug)]
pub struct CubeShelf {
    /// Compartments beside each other.
    pub columns: usize,
    /// Compartments above each other.
    pub rows: usize,
    /// Share of the compartments with a basket, on `[0,1]`.
    pub baskets: f32,
    /// Finish of the boards.
    pub finish: Finish,
}

/// Inner edge of a compartment, metres.
const CUBE: f32 = 0.335;
/// Thickness of the outer boards of a cube shelf, metres.
const OUTER: f32 = 0.038;
/// Thickness of the boards between its compartments, metres.
const INNER: f32 = 0.016;
/// Depth of a cube shelf, metres.
const CUBE_DEPTH: f32 = 0.39;

impl Furniture for CubeShelf {
    fn random(rng: &mut Rng) -> Self {
        let [columns, rows] = [[2, 2], [4, 2], [2, 4], [4, 1], [3, 2], [4, 4], [1, 4]][rng.below(7)];
        Self { columns, rows, baskets: rng.range(0.1, 0.5), finish: [Finish::WhiteLacquer, Finish::Wood, Finish::DarkWood][rng.below(3)] }
    }

    fn size(&self) -> Vec3 {
        let span = |n: usize| n as f32 * CUBE + (n - 1) as f32 * INNER + 2.0 * OUTER;
        Vec3::new(span(self.columns), CUBE_DEPTH, span(self.rows))
    }

    fn reach(&self) -> f32 {
        0.5
    }

    fn surfaces(&self) -> Vec<Surface> {
        let size = self.size();
        let half = 0.5 * size.truncate() - 0.03;
        if size.z < 1.6 { vec![Surface { min: -half, max: half, z: size.z, headroom: f32::INFINITY }] } else { Vec::new() }
    }

    fn build(&self, b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
        let shelf = b.object("cube_shelf", Class::Shelves, pose);
        let size = self.size();
        let (half, back, front) = (0.5 * size.x, -0.5 * CUBE_DEPTH, 0.5 * CUBE_DEPTH);
        let outside = all([
            board([-half, back, 0.0], [half, front, OUTER], 0.0015),
            board([-half, back, size.z - OUTER], [half, front, size.z], 0.0015),
            board([-half, back, OUTER + GAP], [OUTER - half, front, size.z - OUTER - GAP], 0.0015),
            board([half - OUTER, back, OUTER + GAP], [half, front, size.z - OUTER - GAP], 0.0015),
        ]);
        b.part(&shelf, "case", grained(outside, rng), self.finish);
        let left = |column: usize| OUTER - half + (CUBE + INNER) * column as f32;
        let floor = |row: usize| OUTER + (CUBE + INNER) * row as f32;
        let levels = (1..self.rows).map(|r| board([OUTER - half, back, floor(r) - INNER], [half - OUTER, front - 0.001, floor(r)], 0.001));
        let walls = (1..self.columns).flat_map(|c| {
            (0..self.rows)
                .map(move |r| board([left(c) - INNER, back, floor(r) + GAP], [left(c), front - 0.001, floor(r) + CUBE - GAP], 0.001))
        });
        let inside: Vec<_> = levels.chain(walls).collect();
        if !inside.is_empty() {
            b.part(&shelf, "dividers", grained(all(inside), rng), self.finish);
        }
        for row in 0..self.rows {
            for column in 0..self.columns {
                let (x, z) = (left(column), floor(row));
                if rng.next_f32() < self.baskets {
                    basket(b, on(pose, Vec3::new(x + 0.5 * CUBE, 0.0, z + CONTACT), 0.0), rng);
                } else if rng.below(8) > 0 {
                    fill(b, pose, [x + 0.01, x + CUBE - 0.01], [front - 0.02, z], CUBE - 0.02, rng);
                }
            }
        }
    }
}

/// A box that fills a compartment, of wicker, cloth or board, with a grip.
fn basket(b: &mut Builder, pose: DAffine3, rng: &mut Rng) {
    let basket = b.object("basket", Class::Box, pose);
    let (half, h) = (Vec2::new(0.5 * CUBE - 0.012, 0.5 * CUBE_DEPTH - 0.012), CUBE - 0.03);
    let t = 0.008;
    let mesh = all([
        board([-half.x, half.y - t, 0.0], [half.x, half.y, h], 0.003),
        board([-half.x, -half.y, 0.0], [half.x, t - half.y, h], 0.003),
        board([-half.x, t - half.y, 0.0], [t - half.x, half.y - t, h], 0.003),
        board([half.x - t, t - half.y, 0.0], [half.x, half.y - t, h], 0.003),
        board([t - half.x, t - half.y, 0.0], [half.x - t, half.y - t, 0.006], 0.001),
    ]);
    let finish = [Finish::Wicker, Finish::Felt, Finish::Cardboard, Finish::Accent(rng.below(3) as u8)][rng.below(4)];
    b.part(&basket, "walls", mesh.uv_moved(Vec2::splat(rng.next_f32())), finish);
    let grip = crate::pieces::form::wire(
        &[
            [-0.06, half.y - 0.001, h - 0.07],
            [-0.05, half.y + 0.008, h - 0.085],
            [0.05, half.y + 0.008, h - 0.085],
            [0.06, half.y - 0.001, h - 0.07],
        ],
        0.004,
        8,
    );
    b.part(&basket, "grip", grip, Finish::Leather);
}

//! Slicing floor plans: a rectangle cut in two again and again until each room has its cell.
//!
//! A plan is a Polish expression of rooms and cuts, changed by the moves of Wong & Liu, "A New Algorithm for Floorplan Design"
//! (DAC 1986): swap neighbouring rooms, turn a cut, swap a room with a cut.

use enfilade_math::{Rng, Vec2};

/// One word of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    /// A room, by its number.
    Room(usize),
    /// The two preceding pieces are beside each other.
    Beside,
    /// The second of the two preceding pieces is behind the first: further along y.
    Behind,
}

/// An axis-aligned rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The corner with the smallest x and y.
    pub min: Vec2,
    /// The corner with the largest x and y.
    pub max: Vec2,
}

impl Cell {
    /// Width and depth.
    pub fn size(&self) -> Vec2 {
        self.max - self.min
    }

    /// The middle of the cell.
    pub fn center(&self) -> Vec2 {
        0.5 * (self.min + self.max)
    }
}

/// Cuts are at multiples of this, metres.
const STEP: f32 = 0.01;

/// A slicing plan; always valid.
#[derive(Clone, Debug, PartialEq)]
pub struct Slicing {
    words: Vec<Word>,
}

impl Slicing {
    /// Rows of rooms, from the front to the back.
    pub fn rows(rows: &[Vec<usize>]) -> Self {
        let mut words = Vec::new();
        for (i, row) in rows.iter().filter(|row| !row.is_empty()).enumerate() {
            for (k, &room) in row.iter().enumerate() {
                words.push(Word::Room(room));
                words.extend((k > 0).then_some(Word::Beside));
            }
            words.extend((i > 0).then_some(Word::Behind));
        }
        Self { words }
    }

    /// One random change; some leave the plan as it is.
    pub fn changed(&self, rng: &mut Rng) -> Self {
        let mut words = self.words.clone();
        let rooms: Vec<usize> = (0..words.len()).filter(|&i| matches!(words[i], Word::Room(_))).collect();
        match rng.below(4) {
            0 if rooms.len() > 1 => {
                let k = rng.below(rooms.len() - 1);
                words.swap(rooms[k], rooms[k + 1]);
            }
            1 if rooms.len() > 1 => words.swap(rooms[rng.below(rooms.len())], rooms[rng.below(rooms.len())]),
            2 => {
                let at = rng.below(words.len());
                words[at] = match words[at] {
                    Word::Beside => Word::Behind,
                    Word::Behind => Word::Beside,
                    room @ Word::Room(_) => room,
                };
            }
            _ if words.len() > 2 => {
                let at = rng.below(words.len() - 1);
                words.swap(at, at + 1);
            }
            _ => {}
        }
        if is_valid(&words) { Self { words } } else { self.clone() }
    }

    /// The cells of all rooms, by number, when the plan is laid over `whole` and each room gets its share of `areas`.
    pub fn cells(&self, whole: Cell, areas: &[f32]) -> Vec<Cell> {
        // From the last word to the first: each piece is handed down with its rectangle.
        let mut sums = Vec::with_capacity(self.words.len());
        let mut stack: Vec<f32> = Vec::new();
        for word in &self.words {
            let sum = match *word {
                Word::Room(room) => areas[room],
                _ => stack.pop().unwrap_or(0.0) + stack.pop().unwrap_or(0.0),
            };
            stack.push(sum);
            sums.push(sum);
        }
        let mut cells = vec![whole; areas.len()];
        let mut pieces = vec![whole];
        for (i, word) in self.words.iter().enumerate().rev() {
            let Some(piece) = pieces.pop() else { break };
            let axis = match *word {
                Word::Room(room) => {
                    cells[room] = piece;
                    continue;
                }
                Word::Beside => 0,
                Word::Behind => 1,
            };
            // The second piece's expression ends just before this word.
            let share = sums[i - 1] / sums[i];
            let cut = ((piece.max[axis] - share * piece.size()[axis]) / STEP).round() * STEP;
            let (mut first, mut second) = (piece, piece);
            (first.max[axis], second.min[axis]) = (cut, cut);
            pieces.extend([first, second]);
        }
        cells
    }
}

/// Every cut has two pieces before it, and everything is one piece in the end.
fn is_valid(words: &[Word]) -> bool {
    let mut pieces = 0;
    for word in words {
        pieces = match word {
            Word::Room(_) => pieces + 1,
            _ if pieces < 2 => return false,
            _ => pieces - 1,
        };
    }
    pieces == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_tile_the_whole_in_proportion_whatever_was_changed() {
        let whole = Cell { min: Vec2::new(-5.0, -4.0), max: Vec2::new(5.0, 4.0) };
        let areas = [20.0, 12.0, 16.0, 10.0, 14.0, 8.0];
        let mut rng = Rng::new(1);
        let mut plan = Slicing::rows(&[vec![0, 1], vec![2, 3], vec![4, 5]]);
        for _ in 0..500 {
            plan = plan.changed(&mut rng);
            let cells = plan.cells(whole, &areas);
            for (i, a) in cells.iter().enumerate() {
                let size = a.size();
                assert!((size.x * size.y - areas[i]).abs() < 0.35, "{plan:?}: room {i} has {size}");
                for b in &cells[..i] {
                    let overlap = (a.max.min(b.max) - a.min.max(b.min)).max(Vec2::ZERO);
                    assert!(overlap.x * overlap.y < 1e-4, "{plan:?}");
                }
            }
        }
    }
}

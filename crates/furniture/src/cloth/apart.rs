//! A sheet keeps its thickness from itself.

use super::Sheet;
use enfilade_math::Vec3;

/// Slots of the table of cells.
const TABLE: usize = 1 << 12;
/// Nothing more in a slot.
const END: u32 = u32::MAX;

/// Which points are near each other: a table of cells as wide as the distance that is kept, by the hash of their place.
#[derive(Default)]
pub(super) struct Near {
    /// The last point of each slot.
    first: Vec<u32>,
    /// The point before each in its slot.
    next: Vec<u32>,
}

impl Near {
    fn slot([x, y, z]: [i32; 3]) -> usize {
        (x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791)) as u32 as usize % TABLE
    }

    /// Sorts the points of a sheet into cells.
    fn fill(&mut self, sheet: &Sheet, cell: impl Fn(Vec3) -> [i32; 3]) {
        self.first.clear();
        self.first.resize(TABLE, END);
        self.next.resize(sheet.points.len(), END);
        for k in (0..sheet.points.len()).filter(|&k| sheet.here[k]) {
            let slot = Self::slot(cell(sheet.points[k]));
            self.next[k] = std::mem::replace(&mut self.first[slot], k as u32);
        }
    }
}

impl Sheet {
    /// Moves points apart that are nearer to each other than the sheet is thick.
    pub(super) fn keep_apart(&mut self, near: &mut Near) {
        let apart = (2.0 * self.textile.half).min(0.95 * self.pitch().min_element());
        let cell = |p: Vec3| (p / apart).floor().to_array().map(|n| n as i32);
        near.fill(self, cell);
        let columns = self.count[0];
        let neighbours = |a: usize, b: usize| {
            let ([i, j], [k, l]) = ([a % columns, a / columns], [b % columns, b / columns]);
            i.abs_diff(k) <= 1 && j.abs_diff(l) <= 1
        };
        for k in (0..self.points.len()).filter(|&k| self.here[k]) {
            let [x, y, z] = cell(self.points[k]);
            for n in 0..27 {
                let mut other = near.first[Near::slot([x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1])];
                while other != END {
                    let o = other as usize;
                    other = near.next[o];
                    if o <= k {
                        continue;
                    }
                    let along = self.points[o] - self.points[k];
                    let squared = along.length_squared();
                    if squared < apart * apart && squared > 1e-12 && !neighbours(k, o) {
                        let length = squared.sqrt();
                        let shift = along * (0.4 * (apart - length) / length);
                        self.points[k] -= shift;
                        self.points[o] += shift;
                    }
                }
            }
        }
    }
}

//! Leaves: up to eight triangles each, packed one after the other without padding.
//!
//! Leaves take up most of a hierarchy's memory, and few of them are full. Rays mostly wait for memory that is in no cache, so a leaf has
//! only as many words as it needs, although its rows are then not aligned to vectors.

use super::node::LEAF;
use enfilade_math::Vec3;

/// Triangles of a leaf.
pub(super) const LANES: usize = 8;

/// Words of a triangle: its number, and three coordinates of three corners.
pub(super) const WORDS: usize = 10;

/// Words after the last leaf: vectors that begin in it may read them.
pub(super) const BEYOND: usize = LANES;

/// Room for a leaf.
pub(super) type Words = [u32; WORDS * LANES + BEYOND];
pub(super) const NO_WORDS: Words = [0; WORDS * LANES + BEYOND];

/// Largest number of triangles in all leaves together: a child has [`COUNT_AT`] bits for the place of its leaf's first triangle.
pub(super) const MAX_TRIANGLES: usize = 1 << COUNT_AT;

/// The bit of a child from which on the number of its triangles, less one, is stored; the bits below are the place of the first.
const COUNT_AT: u32 = 27;

/// Marks a triangle that asks the filter.
pub(super) const FILTERED: u32 = 1 << 31;

/// Up to eight triangles in memory: a row of their numbers, with [`FILTERED`], then for each axis a row of each corner.
#[derive(Clone, Copy)]
pub(super) struct Leaf<'a> {
    /// From the first row on, with at least [`BEYOND`] words behind the last.
    words: &'a [u32],
    count: usize,
}

/// The word in which a triangle's number is stored, or the number that such a word encodes.
///
/// Vectors of coordinates read some of the next leaf's numbers, and small integers would be denormal floats there, which processors are
/// slow with; so they are kept as floats a little above one.
#[inline(always)]
pub(super) fn word_of(id: u32) -> u32 {
    id ^ 1f32.to_bits()
}

/// Index at which the row of an axis of a corner begins in a leaf of `count` triangles. The rows follow each other, after the triangles'
/// numbers. Rays reorder axes, not corners: with the corners of an axis side by side, one multiplication finds all three.
#[inline(always)]
pub(super) fn row_at(count: usize, corner: usize, axis: usize) -> usize {
    (1 + 3 * axis + corner) * count
}

/// Writes a leaf to the beginning of `words`: numbers and corners of its triangles.
pub(super) fn write(triangles: &[(u32, [Vec3; 3])], words: &mut [u32]) {
    for (lane, (id, corners)) in triangles.iter().enumerate() {
        words[lane] = word_of(*id);
        for (k, corner) in corners.iter().enumerate() {
            for axis in 0..3 {
                words[row_at(triangles.len(), k, axis) + lane] = corner[axis].to_bits();
            }
        }
    }
}

/// The child that is a leaf of `count` triangles, of which the first is at place `first`.
pub(super) fn child_of(first: u32, count: usize) -> u32 {
    debug_assert!((1..=LANES).contains(&count) && (first as usize) < MAX_TRIANGLES);
    LEAF | (count as u32 - 1) << COUNT_AT | first
}

/// Index of the first word of a child that is a leaf.
#[inline(always)]
pub(super) fn start_of(child: u32) -> usize {
    WORDS * (child as usize & (MAX_TRIANGLES - 1))
}

impl<'a> Leaf<'a> {
    /// Without triangles.
    pub const NONE: Leaf<'static> = Leaf { words: &[0; BEYOND], count: 0 };

    /// The leaf that a child refers to.
    ///
    /// # Safety
    /// The child must be a leaf in `words`.
    #[inline(always)]
    pub unsafe fn at(words: &'a [u32], child: u32) -> Self {
        // SAFETY: the caller's.
        let words = unsafe { words.get_unchecked(start_of(child)..) };
        Self { words, count: ((child >> COUNT_AT) as usize & (LANES - 1)) + 1 }
    }

    /// The leaf of `count` triangles that `words` begin with.
    #[inline(always)]
    pub fn of(words: &'a Words, count: usize) -> Self {
        debug_assert!(count <= LANES);
        Self { words, count }
    }

    #[inline(always)]
    pub fn count(self) -> usize {
        self.count
    }

    /// One bit for each of its triangles.
    #[inline(always)]
    pub fn lanes(self) -> u32 {
        (1 << self.count) - 1
    }

    /// The number of a triangle.
    #[inline(always)]
    pub fn id(self, lane: usize) -> u32 {
        debug_assert!(lane < self.count);
        // SAFETY: a leaf has a word for each of its triangles, and no lane is asked for that has none.
        word_of(unsafe { *self.words.get_unchecked(lane) })
    }

    /// An axis of the three corners, with whatever there is in the lanes beyond.
    ///
    /// # Safety
    /// There are three axes.
    #[inline(always)]
    pub unsafe fn rows(self, axis: usize) -> [&'a [f32; LANES]; 3] {
        // SAFETY: there are as many rows, and at least eight words behind the last; words and floats are alike to memory.
        unsafe {
            let first = self.words.as_ptr().add(row_at(self.count, 0, axis));
            [&*first.cast(), &*first.add(self.count).cast(), &*first.add(2 * self.count).cast()]
        }
    }
}

//! Large pictures in tiles, so that memory stays bounded.
//!
//! A pixel depends on pixels at most 101 away. Tiles overlap by more than that, and of each only the pixels that do not depend on anything
//! outside it are kept. They begin at multiples of 64, which are also borders of the coarsest layer's pixels and of its tiles of 4×4.

use std::ops::Range;

/// Pixels that a tile reads beyond what is kept of it.
const OVERLAP: usize = 128;
/// Tiles begin at multiples of this, pixels.
const GRID: usize = 64;

/// A part of one side of a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Span {
    /// The pixels that are filtered.
    pub read: Range<usize>,
    /// The filtered pixels that are kept.
    pub kept: Range<usize>,
}

/// The parts of a side of `length` pixels, of which at most `most` are filtered at a time.
pub(super) fn spans(length: usize, most: usize) -> Vec<Span> {
    if length <= most {
        return vec![Span { read: 0..length, kept: 0..length }];
    }
    let inner = most - 2 * OVERLAP;
    let share = length.div_ceil(length.div_ceil(inner)).next_multiple_of(GRID);
    let span = |start: usize| {
        let kept = start..(start + share).min(length);
        Span { read: kept.start.saturating_sub(OVERLAP)..(kept.end + OVERLAP).min(length), kept }
    };
    (0..length).step_by(share).map(span).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_cover_a_side_once_and_read_what_they_depend_on() {
        for length in [1, 100, 512, 513, 1000, 1023, 4096, 5001] {
            let spans = spans(length, 512);
            let mut end = 0;
            for Span { read, kept } in &spans {
                assert!(kept.start == end && read.start % GRID == 0 && read.len() <= 512, "{length}: {read:?} {kept:?}");
                assert!(read.start == 0 || kept.start - read.start >= 101);
                assert!(read.end == length || read.end - kept.end >= 101);
                end = kept.end;
            }
            assert_eq!(end, length);
        }
        assert_eq!(spans(512, 512), [Span { read: 0..512, kept: 0..512 }]);
    }
}

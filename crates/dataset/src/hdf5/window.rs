//! Rectangles of pixels, and the part of an image inside them.

use super::array::{Array, Elements};

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First row.
    pub top: usize,
    /// First column.
    pub left: usize,
    /// Rows.
    pub height: usize,
    /// Columns.
    pub width: usize,
}

impl Window {
    /// True when no pixel of it is outside an image.
    pub fn fits(&self, height: usize, width: usize) -> bool {
        let inside = |first: usize, count: usize, all: usize| first.checked_add(count).is_some_and(|end| end <= all);
        inside(self.top, self.height, height) && inside(self.left, self.width, width)
    }
}

impl Array {
    /// The elements of a rectangle, which must be inside the image.
    pub(super) fn cut(&self, window: Window) -> Self {
        let size = self.values.element().size();
        let pixel = self.shape.get(2).map_or(size, |channels| channels * size);
        let mut values = Elements::zeroed(self.values.element(), window.height * window.width * pixel / size);
        let run = window.width * pixel;
        let rows = values.as_bytes_mut().chunks_exact_mut(run.max(1));
        for (y, row) in rows.enumerate() {
            let from = ((window.top + y) * self.shape[1] + window.left) * pixel;
            row.copy_from_slice(&self.values.as_bytes()[from..from + run]);
        }
        Self { shape: cut_shape(&self.shape, window), values }
    }
}

/// The shape of an image's part.
pub(super) fn cut_shape(shape: &[usize], window: Window) -> Vec<usize> {
    [&[window.height, window.width], &shape[2..]].concat()
}

//! The classes in a set of frames, with their share of the pixels.

use super::canvas::{Canvas, Color};
use super::lettering::{self, Style};
use super::style::{CAPTION, DETAIL, SUBTITLE};
use crate::palette::semantic_color;
use enfilade_frame::{Frame, Layer};
use enfilade_label::class_name;
use std::collections::BTreeMap;

const COLUMN: u32 = 252;
const LINE: u32 = 26;
const HEADING: u32 = 40;
const SWATCH: u32 = 14;
const FRAME_OF_BLACK: Color = [70, 72, 78];

/// Pixels per class over some frames.
pub struct ClassShares {
    /// Class and fraction of all pixels, largest first; −1 is unlabelled.
    shares: Vec<(i16, f64)>,
}

impl ClassShares {
    /// Counts the `semantic` layers of `frames`; frames without one do not count.
    pub fn of<'a>(frames: impl Iterator<Item = &'a Frame>) -> Self {
        let mut counts: BTreeMap<i16, u64> = BTreeMap::new();
        for values in frames.filter_map(|frame| frame.get(Layer::Semantic)) {
            (0..values.len()).for_each(|i| *counts.entry(values.get(i) as i16).or_default() += 1);
        }
        let total = counts.values().sum::<u64>() as f64;
        let mut shares: Vec<(i16, f64)> = counts.into_iter().map(|(class, n)| (class, n as f64 / total)).collect();
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        Self { shares }
    }

    /// Height of the legend in a field of this width; 0 without classes.
    pub fn height(&self, width: u32) -> u32 {
        if self.shares.is_empty() { 0 } else { HEADING + (self.shares.len() as u32).div_ceil(columns(width)) * LINE }
    }

    /// Draws the legend with its left upper corner at (x, y), symmetric margins assumed.
    pub fn draw(&self, canvas: &mut Canvas, x: u32, y: u32) {
        if self.shares.is_empty() {
            return;
        }
        let heading = Style { height: 12.0, ..SUBTITLE };
        lettering::draw(canvas, x as f32, y as f32 + 18.0, "Classes and their share of the pixels shown", heading);
        let columns = columns(canvas.width() - 2 * x);
        let lines = (self.shares.len() as u32).div_ceil(columns);
        for (i, &(class, share)) in self.shares.iter().enumerate() {
            let (column, line) = (i as u32 / lines, i as u32 % lines);
            let (left, top) = (x + column * COLUMN, y + HEADING + line * LINE);
            draw_entry(canvas, left, top, class, share);
        }
    }
}

fn columns(width: u32) -> u32 {
    (width / COLUMN).max(1)
}

fn draw_entry(canvas: &mut Canvas, x: u32, y: u32, class: i16, share: f64) {
    if semantic_color(class) == [0, 0, 0] {
        canvas.fill(x, y, SWATCH, SWATCH, FRAME_OF_BLACK);
        canvas.fill(x + 1, y + 1, SWATCH - 2, SWATCH - 2, [0, 0, 0]);
    } else {
        canvas.fill(x, y, SWATCH, SWATCH, semantic_color(class));
    }
    let baseline = (y + SWATCH) as f32 - 1.5;
    lettering::draw(canvas, (x + SWATCH + 8) as f32, baseline, class_name(class), CAPTION);
    let percent = if share < 0.0005 { "< 0.1 %".to_string() } else { format!("{:.1} %", 100.0 * share) };
    let right = (x + COLUMN - 30) as f32;
    lettering::draw(canvas, right - lettering::width(&percent, DETAIL), baseline, &percent, DETAIL);
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::Values;

    #[test]
    fn shares_are_fractions_of_all_pixels_largest_first() {
        let mut frame = Frame::new(4, 1);
        frame.insert(Layer::Semantic, Values::I16(vec![5, -1, 5, 2]));
        let shares = ClassShares::of([&frame, &Frame::new(9, 9)].into_iter());
        assert_eq!(shares.shares, [(5, 0.5), (-1, 0.25), (2, 0.25)]);
        assert_eq!(ClassShares::of(std::iter::empty()).height(500), 0);
    }
}

//! All views of a trajectory at a glance.

use super::figure::{PAPER, Subject, time_color};
use super::legend::{INK, MUTED, header, significant};
use super::look::Sight;
use crate::drawing::{Anchor, Drawing, Ink, Text};

const WIDTH: u32 = 1600;
const MARGIN: u32 = 40;
const HEADER: u32 = 92;
/// Pictures in a row: for up to [`FEW`] of them, and for more.
const COLUMNS: [usize; 2] = [6, 8];
const FEW: usize = 48;
const GAP: u32 = 12;
/// Below a picture: frame number and score.
const CAPTION: u32 = 36;

/// One picture per pose, in rows, with the frame's number on the left below it and its score on the right. A bar in the colour
/// of its time joins them with the plan.
pub(super) fn contact_sheet(subject: &Subject<'_>, sights: &[Sight]) -> Drawing {
    let columns = COLUMNS[usize::from(sights.len() > FEW)];
    let width = (WIDTH - 2 * MARGIN - (columns as u32 - 1) * GAP) / columns as u32;
    let height = sights.first().map_or(width * 3 / 4, |sight| (width * sight.height).div_ceil(sight.width));
    let rows = sights.len().div_ceil(columns) as u32;
    let mut page = Drawing::new(WIDTH, 2 * MARGIN + HEADER + rows * (height + CAPTION), PAPER);
    header(&mut page, [MARGIN as f32; 2], subject, "every view, coloured by part");
    let last = (sights.len().max(2) - 1) as f64;
    for (i, (sight, measures)) in sights.iter().zip(subject.measures).enumerate() {
        let x = (MARGIN + (i % columns) as u32 * (width + GAP)) as f32;
        let y = (MARGIN + HEADER + (i / columns) as u32 * (height + CAPTION)) as f32;
        let (w, h) = (width as f32, height as f32);
        let filter = image::imageops::FilterType::Triangle;
        page.picture([x, y], image::imageops::resize(&sight.lit(), width, height, filter));
        page.bar([x, y + h, w, 3.0], Ink::solid(time_color(i as f64 / last)));
        let caption = |words: String, at: f32, bold: bool, anchor: Anchor, ink: Ink| Text {
            at: [at, y + h + 19.0],
            words,
            height: 10.0,
            bold,
            anchor,
            ink,
            halo: None,
        };
        page.write(caption(measures.frame.to_string(), x, true, Anchor::Start, INK));
        page.write(caption(format!("score {}", significant(measures.score)), x + w, false, Anchor::End, MUTED));
    }
    page
}

//! Views of a trajectory at a glance.

use super::legend::header;
use super::look::Sight;
use super::marks::{INK, MUTED, significant};
use super::marks::{PAPER, time_color};
use super::subject::Subject;
use crate::drawing::{Anchor, Drawing, Ink, Text};
use crate::picture::Picture;

const WIDTH: u32 = 1600;
const MARGIN: u32 = 40;
const HEADER: u32 = 92;
/// Pictures in a row: for up to [`FEW`] of them, and for more.
const COLUMNS: [usize; 2] = [6, 8];
const FEW: usize = 48;
/// Largest number of pictures on a sheet: if they are four times as high as wide it has 36,268 rows of pixels, and JPEG can have 65,535.
const MOST: usize = 384;
const GAP: u32 = 12;
/// Below a picture: frame number and score.
const CAPTION: u32 = 36;

/// Indices of the poses on the sheet of a trajectory: all, or [`MOST`] evenly spread from the first to the last.
pub(super) fn shown(poses: usize) -> Vec<usize> {
    let pictures = poses.min(MOST);
    (0..pictures).map(|k| k * (poses - 1) / (pictures - 1).max(1)).collect()
}

/// Words for the views of a trajectory that its sheet with this number of `pictures` shows; `all` is the text for every view.
pub(super) fn which(pictures: usize, poses: usize, all: &str) -> String {
    if pictures == poses { all.into() } else { format!("{pictures} of {poses} views, evenly spread") }
}

/// A view on the sheet.
pub(super) struct Thumbnail {
    /// Index of its pose.
    pose: usize,
    picture: Picture,
}

impl Thumbnail {
    /// The view of the pose of index `pose`, for a sheet of this number of `pictures`.
    pub fn new(pose: usize, sight: &Sight, pictures: usize) -> Self {
        let width = width(columns(pictures));
        let height = (width * sight.height).div_ceil(sight.width);
        Self { pose, picture: image::imageops::resize(&sight.lit(), width, height, image::imageops::FilterType::Triangle) }
    }
}

fn columns(pictures: usize) -> usize {
    COLUMNS[usize::from(pictures > FEW)]
}

/// Width of a picture where there are this many columns.
fn width(columns: usize) -> u32 {
    (WIDTH - 2 * MARGIN - (columns as u32 - 1) * GAP) / columns as u32
}

/// The pictures in rows, with the frame's number on the left below it and its score on the right. A bar in the colour of its time
/// joins them with the plan.
pub(super) fn contact_sheet(subject: &Subject<'_>, thumbnails: &[Thumbnail]) -> Drawing {
    let columns = columns(thumbnails.len());
    let width = width(columns);
    let height = thumbnails.first().map_or(width * 3 / 4, |thumbnail| thumbnail.picture.height());
    let rows = thumbnails.len().div_ceil(columns) as u32;
    let poses = subject.measures.len();
    let mut page = Drawing::new(WIDTH, 2 * MARGIN + HEADER + rows * (height + CAPTION), PAPER);
    let title = format!("{}, coloured by part", which(thumbnails.len(), poses, "every view"));
    header(&mut page, [MARGIN as f32; 2], subject, &title);
    let last = (poses.max(2) - 1) as f64;
    for (i, Thumbnail { pose, picture }) in thumbnails.iter().enumerate() {
        let x = (MARGIN + (i % columns) as u32 * (width + GAP)) as f32;
        let y = (MARGIN + HEADER + (i / columns) as u32 * (height + CAPTION)) as f32;
        let (w, h) = (width as f32, height as f32);
        page.picture([x, y], picture.clone());
        page.bar([x, y + h, w, 3.0], Ink::solid(time_color(*pose as f64 / last)));
        let caption = |words: String, at: f32, bold: bool, anchor: Anchor, ink: Ink| Text {
            at: [at, y + h + 19.0],
            words,
            height: 10.0,
            bold,
            anchor,
            ink,
            halo: None,
        };
        let measures = &subject.measures[*pose];
        page.write(caption(measures.frame.to_string(), x, true, Anchor::Start, INK));
        page.write(caption(format!("score {}", significant(measures.score)), x + w, false, Anchor::End, MUTED));
    }
    page
}

#[cfg(test)]
mod tests {
    use super::super::measure::FrameMeasures;
    use super::super::tests::with_planned;
    use super::*;
    use crate::drawing::Shape;

    #[test]
    fn a_sheet_of_thousands_of_frames_shows_some_and_fits_into_a_jpeg() {
        assert!(shown(0).is_empty());
        assert_eq!(shown(1), [0]);
        assert_eq!(shown(MOST), (0..MOST).collect::<Vec<usize>>());
        let poses = shown(4000);
        assert!(poses.len() == MOST && poses[0] == 0 && poses[MOST - 1] == 3999);
        assert!(poses.windows(2).all(|pair| (10..=11).contains(&(pair[1] - pair[0]))));
        // As high as pictures are at most.
        let thumbnail = |pose| Thumbnail { pose, picture: Picture::new(1, 4 * width(columns(MOST))) };
        let thumbnails: Vec<Thumbnail> = poses.into_iter().map(thumbnail).collect();
        let measures: Vec<FrameMeasures> = (0..4000).map(|frame| FrameMeasures { frame, ..FrameMeasures::default() }).collect();
        with_planned(|planned| {
            let (camera, trajectory) = &planned.filmed[0];
            let page = contact_sheet(&Subject { planned, camera, trajectory, measures: &measures, points: &[], report: None }, &thumbnails);
            assert!(page.height <= 65_535, "{} pixels", page.height);
            assert_eq!(page.shapes.iter().filter(|shape| matches!(shape, Shape::Picture { .. })).count(), MOST);
        });
        assert_eq!(which(3, 3, "every view"), "every view");
        assert_eq!(which(MOST, 4000, "every view"), "384 of 4000 views, evenly spread");
    }
}

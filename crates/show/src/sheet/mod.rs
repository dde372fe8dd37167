//! Contact sheets: a trajectory, or a whole dataset, in one picture that can be judged at a glance.

pub(crate) mod canvas;
mod legend;
pub(crate) mod lettering;
mod style;

use crate::display::Display;
use crate::picture::Picture;
use crate::preview::{Subject, preview};
use canvas::Color;
pub use canvas::{Canvas, Resize};
use enfilade_dataset::counted;
use enfilade_frame::{Frame, Layer};
use image::imageops::{self, FilterType};
use legend::ClassShares;
use lettering::Style;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use style::{CAPTION, DETAIL, SUBTITLE};

const BACKGROUND: Color = [24, 25, 28];
const EMPTY: Color = [38, 40, 44];
const TITLE: Style = Style { height: 26.0, weight: 0.13, color: [244, 244, 240] };

const MARGIN: u32 = 44;
const GAP: u32 = 10;
/// From the lower edge of a picture to the lower edge of its caption.
const CAPTION_SPACE: u32 = 22;
const ROW_GAP: u32 = 20;
const HEADER: u32 = 72;
/// Width of a picture in the overview at most: a single one need not fill the sheet.
const LARGEST_TILE: u32 = 900;
/// Largest number of trajectories in the overview: JPEG can have 65535 rows of pixels.
pub const MOST_TILES: usize = 200;
/// Least width over height of the field of a picture, for the same reason; a narrower picture is centred in it.
const NARROWEST: f64 = 0.4;

/// How large contact sheets are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SheetConfig {
    /// Width in pixels; at least 600.
    pub width: u32,
    /// Frames shown at most, spread evenly over the trajectory.
    pub frames: usize,
}

impl Default for SheetConfig {
    fn default() -> Self {
        Self { width: 1920, frames: 6 }
    }
}

/// Title of a trajectory's sheet.
#[derive(Clone, Copy, Debug)]
pub struct SheetTitle<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Name of the camera.
    pub camera: &'a str,
    /// Number of frames of the trajectory, shown or not.
    pub frames: usize,
}

/// Title of a dataset's sheet.
#[derive(Clone, Copy, Debug)]
pub struct OverviewTitle<'a> {
    /// Name of the dataset.
    pub dataset: &'a str,
    /// Number of scenes, shown or not.
    pub scenes: usize,
    /// Number of trajectories, shown or not.
    pub cameras: usize,
}

impl OverviewTitle<'_> {
    /// The total, and how much of it is shown.
    fn subtitle(&self, shown: usize) -> String {
        let mut parts = vec![counted(self.scenes, "scene"), counted(self.cameras, "camera")];
        if shown < self.cameras {
            parts.push(format!("{shown} shown"));
        }
        parts.join("  ·  ")
    }
}

/// One trajectory of the overview.
#[derive(Clone, Debug)]
pub struct OverviewTile {
    /// Name of the scene.
    pub scene: String,
    /// Details: camera, frames, size.
    pub detail: String,
    /// Tone-mapped colour of one frame.
    pub picture: Picture,
}

impl OverviewTile {
    /// A tile with no more pixels than an overview of `tiles` trajectories shows.
    #[must_use]
    pub fn shrunk(self, tiles: usize, config: &SheetConfig) -> Self {
        let width = f64::from(columns(tiles, config).1);
        let (w, h) = (f64::from(self.picture.width()), f64::from(self.picture.height()));
        let scale = (width / w).min(width / NARROWEST / h);
        if scale >= 1.0 {
            return self;
        }
        let [w, h] = [w, h].map(|side| ((side * scale).round() as u32).max(1));
        Self { picture: imageops::resize(&self.picture, w, h, FilterType::Triangle), ..self }
    }
}

/// Up to `count` indices out of `total`, spread evenly, the first and the last included.
pub fn spread(total: usize, count: usize) -> Vec<usize> {
    match (total, count) {
        (_, 0) => vec![],
        (_, 1) => (0..total.min(1)).collect(),
        _ if total <= count => (0..total).collect(),
        _ => (0..count).map(|i| (2 * i * (total - 1) + count - 1) / (2 * (count - 1))).collect(),
    }
}

/// The sheet of a trajectory: one row per given frame (number and layers), the tone-mapped colour large, eight layers beside it,
/// and the classes with their share of the pixels below.
///
/// `display` is the exposure of all of them. Layers that a frame lacks leave an empty field. Pictures keep the aspect of the first frame.
pub fn trajectory_sheet(title: SheetTitle<'_>, frames: &[(u32, Frame)], display: Display, config: &SheetConfig) -> Picture {
    let size = frames.first().map_or((4, 3), |(_, f)| (f.width, f.height));
    let grid = Grid::new(config.width.max(600), (f64::from(size.0) / f64::from(size.1)).max(NARROWEST));
    let shares = ClassShares::of(frames.iter().map(|(_, frame)| frame));
    let legend_height = shares.height(grid.width - 2 * MARGIN);
    let rows_height = frames.len() as u32 * grid.row();
    let mut canvas = Canvas::new(grid.width, MARGIN + HEADER + rows_height + legend_height + MARGIN - ROW_GAP, BACKGROUND);
    let subtitle = [
        title.camera.to_string(),
        counted(title.frames, "frame"),
        if frames.len() < title.frames { format!("{} shown", frames.len()) } else { String::new() },
        format!("{} x {} px", size.0, size.1),
    ];
    draw_header(&mut canvas, title.scene, &subtitle.join("  ·  ").replace("·    ·", "·"));
    for (row, (number, frame)) in frames.iter().enumerate() {
        draw_frame(&mut canvas, &grid, MARGIN + HEADER + row as u32 * grid.row(), *number, frame, display);
    }
    shares.draw(&mut canvas, MARGIN, MARGIN + HEADER + rows_height);
    canvas.into_picture()
}

/// The sheet of a dataset: one picture per trajectory, of at most [`MOST_TILES`].
pub fn overview_sheet(title: OverviewTitle<'_>, tiles: &[OverviewTile], config: &SheetConfig) -> Picture {
    let aspect = tiles.first().map_or(4.0 / 3.0, |t| f64::from(t.picture.width()) / f64::from(t.picture.height()));
    let grid = OverviewGrid::new(tiles.len(), aspect, config);
    let (width, height) = grid.size();
    let mut canvas = Canvas::new(width, height, BACKGROUND);
    draw_header(&mut canvas, title.dataset, &title.subtitle(tiles.len()));
    for (i, tile) in tiles.iter().enumerate() {
        let ((x, y), (w, h)) = (grid.place_of(i as u32), grid.tile);
        place_inside(&mut canvas, [x, y, w, h], &tile.picture, Resize::Smooth);
        let name = lettering::fit(&tile.scene, CAPTION, w as f32);
        lettering::draw(&mut canvas, x as f32, (y + h + CAPTION_SPACE) as f32, &name, CAPTION);
        let detail = lettering::fit(&tile.detail, DETAIL, w as f32);
        lettering::draw(&mut canvas, x as f32, (y + h + 2 * CAPTION_SPACE - 2) as f32, &detail, DETAIL);
    }
    canvas.into_picture()
}

/// Columns of an overview of that many trajectories, and the width of the pictures in them.
fn columns(tiles: usize, config: &SheetConfig) -> (u32, u32) {
    let columns = (tiles as u32).clamp(1, if tiles > 6 { 4 } else { 3 });
    let width = (config.width.max(600) - 2 * MARGIN - (columns - 1) * 2 * GAP) / columns;
    (columns, width.min(LARGEST_TILE))
}

/// Sizes of an overview: rows of equal fields, two captions below each.
struct OverviewGrid {
    columns: u32,
    rows: u32,
    tile: (u32, u32),
}

impl OverviewGrid {
    fn new(tiles: usize, aspect: f64, config: &SheetConfig) -> Self {
        let (columns, width) = columns(tiles, config);
        let height = (f64::from(width) / aspect.max(NARROWEST)).round() as u32;
        Self { columns, rows: (tiles as u32).div_ceil(columns), tile: (width, height) }
    }

    /// Width and height of the sheet.
    fn size(&self) -> (u32, u32) {
        let width = 2 * MARGIN + self.columns * self.tile.0 + (self.columns - 1) * 2 * GAP;
        (width, MARGIN + HEADER + self.rows * self.row() + MARGIN - ROW_GAP)
    }

    fn row(&self) -> u32 {
        self.tile.1 + 2 * CAPTION_SPACE + ROW_GAP
    }

    /// Left upper corner of field `i`.
    fn place_of(&self, i: u32) -> (u32, u32) {
        let (column, line) = (i % self.columns, i / self.columns);
        (MARGIN + column * (self.tile.0 + 2 * GAP), MARGIN + HEADER + line * self.row())
    }
}

/// Sizes of a row: a large picture, then four columns of two small ones, captions below each.
struct Grid {
    width: u32,
    small: (u32, u32),
    large: (u32, u32),
}

impl Grid {
    /// The large picture is as high as two small ones with the caption between, and all of them fill the width.
    fn new(width: u32, aspect: f64) -> Self {
        let free = f64::from(width - 2 * MARGIN - 4 * GAP) - aspect * f64::from(CAPTION_SPACE + GAP);
        let small_width = (free / 6.0).max(40.0).floor();
        let small = (small_width as u32, (small_width / aspect).round().max(1.0) as u32);
        let large_height = 2 * small.1 + CAPTION_SPACE + GAP;
        let large_width = width - 2 * MARGIN - 4 * (small.0 + GAP);
        Self { width, small, large: (large_width, large_height) }
    }

    fn row(&self) -> u32 {
        self.large.1 + CAPTION_SPACE + ROW_GAP
    }

    /// Left upper corner of small picture `i` of a row at `y`.
    fn place_of(&self, i: u32, y: u32) -> (u32, u32) {
        let x = MARGIN + self.large.0 + GAP + (i % 4) * (self.small.0 + GAP);
        (x, y + (i / 4) * (self.small.1 + CAPTION_SPACE + GAP))
    }
}

/// The small pictures of a row, in reading order.
const TILES: [(&str, Layer, Resize); 8] = [
    ("reflectance", Layer::DiffuseReflectance, Resize::Smooth),
    ("illumination", Layer::DiffuseIllumination, Resize::Smooth),
    ("residual", Layer::Residual, Resize::Smooth),
    ("distance", Layer::DepthMeters, Resize::Smooth),
    ("normals", Layer::NormalBumpWorld, Resize::Smooth),
    ("classes", Layer::Semantic, Resize::Exact),
    ("instances", Layer::SemanticInstance, Resize::Exact),
    ("parts", Layer::RenderEntityId, Resize::Exact),
];

fn draw_header(canvas: &mut Canvas, title: &str, subtitle: &str) {
    let (x, y) = (MARGIN as f32, MARGIN as f32);
    lettering::draw(canvas, x, y + TITLE.height - 6.0, title, TITLE);
    lettering::draw(canvas, x, y + 48.0, subtitle, SUBTITLE);
}

fn draw_frame(canvas: &mut Canvas, grid: &Grid, y: u32, number: u32, frame: &Frame, display: Display) {
    let large = [MARGIN, y, grid.large.0, grid.large.1];
    match preview(Subject::Displayed, frame, display) {
        Some(color) => place_inside(canvas, large, &color.picture, Resize::Smooth),
        None => canvas.fill(large[0], large[1], large[2], large[3], EMPTY),
    }
    draw_caption(canvas, large, &format!("frame {number:04}"), &format!("exposure x {:.3}", display.scale));
    for (i, (name, layer, resize)) in TILES.into_iter().enumerate() {
        let (x, y) = grid.place_of(i as u32, y);
        let place = [x, y, grid.small.0, grid.small.1];
        let detail = match preview(Subject::Layer(layer), frame, display) {
            None => {
                canvas.fill(x, y, grid.small.0, grid.small.1, EMPTY);
                "not there".to_string()
            }
            Some(shown) => {
                place_inside(canvas, place, &shown.picture, resize);
                if resize == Resize::Exact { distinct_ids(frame, layer).to_string() } else { shown.note }
            }
        };
        draw_caption(canvas, place, name, &detail);
    }
}

/// Places a picture whole and centred in the field (x, y, width, height).
fn place_inside(canvas: &mut Canvas, [x, y, width, height]: [u32; 4], picture: &Picture, resize: Resize) {
    let scale = (f64::from(width) / f64::from(picture.width())).min(f64::from(height) / f64::from(picture.height()));
    let fitted = |side: u32, limit: u32| ((f64::from(side) * scale).round() as u32).clamp(1, limit);
    let (w, h) = (fitted(picture.width(), width), fitted(picture.height(), height));
    // A pixel more or less of rounding is filled rather than left as a seam.
    let (w, h) = (if width - w <= 2 { width } else { w }, if height - h <= 2 { height } else { h });
    canvas.fill(x, y, width, height, EMPTY);
    canvas.place(x + (width - w) / 2, y + (height - h) / 2, w, h, picture, resize);
}

/// Name on the left and detail on the right, below the field.
fn draw_caption(canvas: &mut Canvas, [x, y, width, height]: [u32; 4], name: &str, detail: &str) {
    let baseline = (y + height + CAPTION_SPACE - 4) as f32;
    lettering::draw(canvas, x as f32, baseline, name, CAPTION);
    let free = width as f32 - lettering::width(name, CAPTION) - 12.0;
    let detail = lettering::fit(detail, DETAIL, free);
    lettering::draw(canvas, (x + width) as f32 - lettering::width(&detail, DETAIL), baseline, &detail, DETAIL);
}

fn distinct_ids(frame: &Frame, layer: Layer) -> usize {
    let ids = frame.get(layer).map(|values| (0..values.len()).map(|i| values.get(i) as i32).filter(|&id| id >= 1).collect::<BTreeSet<_>>());
    ids.map_or(0, |ids| ids.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_takes_first_last_and_even_steps() {
        assert_eq!(spread(3, 6), [0, 1, 2]);
        assert_eq!(spread(100, 4), [0, 33, 66, 99]);
        assert_eq!(spread(7, 3), [0, 3, 6]);
        assert_eq!((spread(0, 5), spread(5, 1), spread(5, 0)), (vec![], vec![0], vec![]));
    }

    #[test]
    fn rows_fill_the_width_whatever_the_aspect() {
        for aspect in [0.5, 1.0, 4.0 / 3.0, 2.0] {
            let grid = Grid::new(1920, aspect);
            let (x, _) = grid.place_of(3, 0);
            assert_eq!(x + grid.small.0, 1920 - MARGIN);
            let fits = f64::from(grid.large.0) / f64::from(grid.large.1) / aspect;
            assert!((fits - 1.0).abs() < 0.02, "aspect {aspect}: {fits}");
        }
    }

    #[test]
    fn frames_without_layers_still_give_a_sheet() {
        let title = SheetTitle { scene: "s", camera: "cam_00", frames: 1 };
        let sheet = trajectory_sheet(title, &[(0, Frame::new(8, 6))], Display::default(), &SheetConfig { width: 100, frames: 1 });
        assert_eq!(sheet.width(), 600);
        assert_eq!(trajectory_sheet(title, &[], Display::default(), &SheetConfig::default()).width(), 1920);
        let title = OverviewTitle { dataset: "empty", scenes: 0, cameras: 0 };
        assert_eq!(overview_sheet(title, &[], &SheetConfig::default()).width(), LARGEST_TILE + 2 * MARGIN);
    }

    #[test]
    fn overviews_of_more_cameras_than_a_jpeg_holds_show_some_and_say_so() {
        let title = OverviewTitle { dataset: "homes", scenes: 461, cameras: 769 };
        assert_eq!(title.subtitle(MOST_TILES), "461 scenes  ·  769 cameras  ·  200 shown");
        assert_eq!(OverviewTitle { scenes: 1, cameras: 2, ..title }.subtitle(2), "1 scene  ·  2 cameras");
        // The narrowest pictures at the width of all sheets, and in pixels at the least width.
        assert!(OverviewGrid::new(MOST_TILES, 0.01, &SheetConfig::default()).size().1 <= 65535);
        let tile = OverviewTile { scene: "hall".into(), detail: "cam_00".into(), picture: Picture::new(2, 60) };
        let sheet = overview_sheet(title, &vec![tile; MOST_TILES], &SheetConfig { width: 600, frames: 1 });
        assert!(!crate::picture::jpeg(&sheet).is_empty());
    }

    #[test]
    fn tiles_keep_no_more_pixels_than_are_shown() {
        let config = SheetConfig::default();
        let width = columns(MOST_TILES, &config).1;
        let shrunk = |width, height| {
            let tile = OverviewTile { scene: String::new(), detail: String::new(), picture: Picture::new(width, height) };
            tile.shrunk(MOST_TILES, &config).picture.dimensions()
        };
        assert_eq!(shrunk(4 * width, 3 * width), (width, (0.75 * f64::from(width)).round() as u32));
        assert_eq!(shrunk(64, 48), (64, 48));
        assert_eq!(shrunk(10, 10 * width).1, (f64::from(width) / NARROWEST).round() as u32);
    }
}

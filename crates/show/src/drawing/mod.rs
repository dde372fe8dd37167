//! A page as a list of shapes, which [`paint`] turns into pixels and [`svg`] into a file that scales.
//!
//! Page coordinates are pixels, x to the right and y downward, (0,0) being the upper left corner. Later shapes cover earlier ones.

mod paint;
mod svg;

pub(crate) use paint::paint;
pub(crate) use svg::{Dark, svg, themed_svg};

use crate::picture::Picture;
use crate::sheet::canvas::Color;

/// A place on the page.
pub(crate) type Point = [f32; 2];

/// How a shape is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ink {
    /// sRGB.
    pub color: Color,
    /// 0 (invisible) to 1 (covers).
    pub opacity: f32,
}

impl Ink {
    /// A colour that covers.
    pub const fn solid(color: Color) -> Self {
        Self { color, opacity: 1.0 }
    }

    /// A colour that lets what is below through.
    pub const fn veil(color: Color, opacity: f32) -> Self {
        Self { color, opacity }
    }
}

/// The point of a text that is at its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A line of writing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Text {
    /// Anchor of the text on the baseline.
    pub at: Point,
    /// The text.
    pub words: String,
    /// Height of capitals, pixels.
    pub height: f32,
    /// Heavier strokes.
    pub bold: bool,
    /// Which point of it is at `at`.
    pub anchor: Anchor,
    /// Colour of the text.
    pub ink: Ink,
    /// A rim around the letters, to be read on any ground.
    pub halo: Option<Ink>,
}

/// One thing on the page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    /// A filled polygon.
    Area { outline: Vec<Point>, ink: Ink },
    /// Open lines with round ends, painted at once: where they cross, the ink covers once.
    Lines { runs: Vec<Vec<Point>>, width: f32, ink: Ink },
    /// A filled circle.
    Disc { center: Point, radius: f32, ink: Ink },
    /// Writing.
    Text(Text),
    /// A picture, pixel by pixel; `at` is its upper left corner.
    Picture { at: Point, picture: Picture },
}

/// A page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawing {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Colour of the empty page.
    pub paper: Color,
    /// From the first drawn to the last.
    pub shapes: Vec<Shape>,
}

impl Drawing {
    pub fn new(width: u32, height: u32, paper: Color) -> Self {
        Self { width, height, paper, shapes: Vec::new() }
    }

    pub fn area(&mut self, outline: &[Point], ink: Ink) {
        self.shapes.push(Shape::Area { outline: outline.to_vec(), ink });
    }

    /// A filled rectangle: left, top, width, height.
    pub fn bar(&mut self, [x, y, w, h]: [f32; 4], ink: Ink) {
        self.area(&[[x, y], [x + w, y], [x + w, y + h], [x, y + h]], ink);
    }

    pub fn lines(&mut self, runs: Vec<Vec<Point>>, width: f32, ink: Ink) {
        if !runs.is_empty() {
            self.shapes.push(Shape::Lines { runs, width, ink });
        }
    }

    pub fn line(&mut self, points: &[Point], width: f32, ink: Ink) {
        self.lines(vec![points.to_vec()], width, ink);
    }

    pub fn disc(&mut self, center: Point, radius: f32, ink: Ink) {
        self.shapes.push(Shape::Disc { center, radius, ink });
    }

    /// Regular writing that begins at `at`.
    pub fn text(&mut self, at: Point, words: impl Into<String>, height: f32, ink: Ink) {
        self.write(Text { at, words: words.into(), height, bold: false, anchor: Anchor::Start, ink, halo: None });
    }

    pub fn write(&mut self, text: Text) {
        self.shapes.push(Shape::Text(text));
    }

    pub fn picture(&mut self, at: Point, picture: Picture) {
        self.shapes.push(Shape::Picture { at, picture });
    }
}

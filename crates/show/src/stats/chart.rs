//! One chart: axes with their ticks, and the series between them. Colours are Okabe and Ito's, which people with colour-blindness can
//! distinguish.

use super::canvas::{Canvas, UNITS};
use crate::drawing::{Anchor, Dark, Drawing, Ink, Text};
use crate::sheet::canvas::Color;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::Color as _;
use std::ops::Range;

/// Colour of our values.
pub const BLUE: Color = [0, 114, 178];
/// Colour of the dataset that ours is compared with.
pub const VERMILION: Color = [213, 94, 0];
pub(super) const PAPER: Color = [255; 3];
pub(super) const INK: Color = [34, 35, 42];
pub(super) const SOFT: Color = [98, 102, 110];
pub(super) const GRID: Color = [228, 229, 232];
/// Colours on dark pages: the card of `page` as paper, and Okabe and Ito's lighter blue.
pub(super) const DARK: Dark =
    Dark { paper: [31, 32, 36], inks: &[(INK, [232, 232, 228]), (SOFT, [160, 164, 172]), (GRID, [52, 54, 60]), (BLUE, [86, 180, 233])] };
/// Page of a chart, pixels.
const WIDTH: u32 = 760;
const HEIGHT: u32 = 430;
/// Margins: left (further with long labels), top, right, bottom.
const LEFT: u32 = 64;
const TOP: u32 = 74;
const RIGHT: u32 = 24;
const BOTTOM: u32 = 34;
/// Size of the ticks' font, and height of capitals of titles and notes.
const TICK_FONT: u32 = 15;
pub(super) const TITLE: f32 = 13.5;
pub(super) const NOTE: f32 = 10.0;
/// Space below the ticks for the axis's name.
const NAME: u32 = 26;

/// An axis: its name with the unit, its range, and its ticks with their labels.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// Name of the quantity, such as "distance (m)".
    pub name: String,
    /// First value.
    pub low: f64,
    /// Last value.
    pub high: f64,
    /// Values with labels.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// With about five ticks at round numbers.
    pub fn linear(name: &str, low: f64, high: f64) -> Self {
        let step = round_step((high - low) / 5.0);
        let digits = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
        let first = (low / step).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let ticks = (first..=last).map(|i| i as f64 * step).map(|v| (v, format!("{v:.digits$}"))).collect();
        Self { name: name.into(), low, high, ticks }
    }

    /// An axis of logarithms to base ten; ticks at the powers of ten, with their values as labels.
    pub fn log(name: &str, low: f64, high: f64) -> Self {
        let decades = (low.ceil() as i32)..=(high.floor() as i32);
        Self { name: name.into(), low, high, ticks: decades.map(|d| (f64::from(d), power_of_ten(d))).collect() }
    }
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0..=4 => format!("{:.0}", 10f64.powi(exponent)),
        -4..0 => format!("{:.*}", exponent.unsigned_abs() as usize, 10f64.powi(exponent)),
        _ => format!("1e{exponent}"),
    }
}

/// The least of 1, 2 and 5 times a power of ten that is not below `step`.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.max(f64::MIN_POSITIVE).log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= step * (1.0 - 1e-9)).unwrap_or(step)
}

/// A series drawn between the axes.
#[derive(Clone, Debug)]
pub enum Series {
    /// Filled down to the lower border.
    Area(Vec<(f64, f64)>),
    /// A line.
    Line(Vec<(f64, f64)>),
    /// Rectangles: left, lower, right and upper border.
    Bars(Vec<[f64; 4]>),
    /// Dots.
    Dots(Vec<(f64, f64)>),
}

/// A series with its name for the legend, and its colour.
pub type Named = (String, Color, Series);

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Title.
    pub title: String,
    /// One line below the title, such as the name of the vertical axis.
    pub note: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// From the first drawn to the last.
    pub series: Vec<Named>,
}

/// A range of values with ticks of its own.
#[derive(Clone)]
struct Ticked {
    low: f64,
    high: f64,
    ticks: Vec<(f64, String)>,
}

impl Ranged for Ticked {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        (f64::from(limit.0) + share.clamp(-0.1, 1.1) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks.iter().map(|(value, _)| *value).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Ticked {
    fn format_ext(&self, value: &f64) -> String {
        self.ticks.iter().find(|(at, _)| at == value).map(|(_, label)| label.clone()).unwrap_or_default()
    }
}

impl From<&Axis> for Ticked {
    fn from(axis: &Axis) -> Self {
        Self { low: axis.low, high: axis.high, ticks: axis.ticks.clone() }
    }
}

fn rgb([r, g, b]: Color) -> RGBColor {
    RGBColor(r, g, b)
}

impl Chart {
    /// The page of the chart.
    pub fn draw(&self) -> Drawing {
        let bars = self.y.ticks.len() as u32;
        let height = HEIGHT.max(TOP + BOTTOM + NAME + 19 * if self.is_list() { bars } else { 0 });
        let mut page = Drawing::new(WIDTH, height, PAPER);
        self.draw_between_axes(&mut page).expect("a page takes all that is drawn");
        let write = |page: &mut Drawing, at, words: &str, height, bold, anchor, color| {
            page.write(Text { at, words: words.into(), height, bold, anchor, ink: Ink::solid(color), halo: None });
        };
        write(&mut page, [16.0, 28.0], &self.title, TITLE, true, Anchor::Start, INK);
        write(&mut page, [16.0, 52.0], &self.note, NOTE, false, Anchor::Start, SOFT);
        let right = (WIDTH - RIGHT) as f32;
        write(&mut page, [right, height as f32 - 12.0], &self.x.name, NOTE, false, Anchor::End, SOFT);
        self.draw_legend(&mut page);
        page
    }

    /// True when the vertical axis lists names.
    fn is_list(&self) -> bool {
        self.y.ticks.iter().any(|(_, label)| label.parse::<f64>().is_err())
    }

    fn draw_between_axes(&self, page: &mut Drawing) -> Result<(), DrawingAreaErrorKind<std::convert::Infallible>> {
        let left = if self.is_list() { 150 } else { LEFT };
        let area = Canvas(page).into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin_top(TOP * UNITS)
            .margin_right(RIGHT * UNITS)
            .margin_bottom(NAME * UNITS)
            .x_label_area_size(BOTTOM * UNITS)
            .y_label_area_size(left * UNITS)
            .build_cartesian_2d(Ticked::from(&self.x), Ticked::from(&self.y))?;
        let font = ("sans-serif", TICK_FONT * UNITS).into_font().color(&rgb(SOFT));
        let mut mesh = chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT)
            .bold_line_style(rgb(GRID).stroke_width(UNITS))
            .axis_style(rgb(SOFT).stroke_width(UNITS))
            .label_style(font)
            .set_all_tick_mark_size(5 * UNITS as i32)
            .x_labels(self.x.ticks.len())
            .y_labels(self.y.ticks.len());
        if self.is_list() {
            mesh.disable_y_mesh();
        }
        mesh.draw()?;
        for (_, color, series) in &self.series {
            let (fill, line) = (rgb(*color), rgb(*color).stroke_width(2 * UNITS));
            match series {
                Series::Area(points) => {
                    let ends = [points.last(), points.first()].into_iter().flatten().map(|p| (p.0, self.y.low));
                    let outline: Vec<_> = points.iter().copied().chain(ends).collect();
                    chart.draw_series([Polygon::new(outline, fill.mix(0.55).filled())])?;
                }
                Series::Line(points) => drop(chart.draw_series([PathElement::new(points.clone(), line)])?),
                Series::Bars(bars) => {
                    let bar = |[x0, y0, x1, y1]: &[f64; 4]| Rectangle::new([(*x0, *y1), (*x1, *y0)], fill.filled());
                    chart.draw_series(bars.iter().map(bar))?;
                }
                Series::Dots(points) => drop(chart.draw_series(points.iter().map(|p| Circle::new(*p, 3 * UNITS, fill.filled())))?),
            }
        }
        Ok(())
    }

    /// Colours and names, right of the note, where there are several series.
    fn draw_legend(&self, page: &mut Drawing) {
        let named: Vec<&Named> = self.series.iter().filter(|(name, ..)| !name.is_empty()).collect();
        if named.len() < 2 {
            return;
        }
        let mut right = (WIDTH - RIGHT) as f32;
        for (name, color, series) in named.into_iter().rev() {
            let style = crate::sheet::lettering::Style { height: NOTE, weight: 0.11, color: [0; 3] };
            right -= crate::sheet::lettering::width(name, style);
            page.write(Text {
                at: [right, 52.0],
                words: name.clone(),
                height: NOTE,
                bold: false,
                anchor: Anchor::Start,
                ink: Ink::solid(INK),
                halo: None,
            });
            right -= 26.0;
            match series {
                Series::Line(_) => page.line(&[[right, 47.0], [right + 18.0, 47.0]], 2.5, Ink::solid(*color)),
                _ => page.bar([right, 41.0, 18.0, 12.0], Ink::veil(*color, 0.75)),
            }
            right -= 22.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_axis() {
        let labels = |axis: &Axis| axis.ticks.iter().map(|(_, label)| label.clone()).collect::<Vec<_>>().join(" ");
        assert_eq!(labels(&Axis::linear("", 0.0, 20.0)), "0 5 10 15 20");
        assert_eq!(labels(&Axis::linear("", 0.0, 0.9)), "0.0 0.2 0.4 0.6 0.8");
        assert_eq!(labels(&Axis::log("", -3.0, 1.0)), "0.001 0.01 0.1 1 10");
        assert_eq!(labels(&Axis::log("", -6.0, -4.0)), "1e-6 1e-5 0.0001");
    }

    #[test]
    fn a_bar_stands_where_its_values_are() {
        let axis = || Axis::linear("x", 0.0, 10.0);
        let series = vec![(String::new(), BLUE, Series::Bars(vec![[0.0, 0.0, 5.0, 10.0]]))];
        let picture = crate::drawing::paint(&Chart { title: "t".into(), note: "n".into(), x: axis(), y: axis(), series }.draw());
        let blue = |x: u32| picture.get_pixel(x, 200).0[..3] == BLUE;
        let columns: Vec<u32> = (0..picture.width()).filter(|&x| blue(x)).collect();
        let (left, right) = (columns[0], columns[columns.len() - 1]);
        let width = WIDTH - LEFT - RIGHT;
        assert!(left.abs_diff(LEFT) <= 2 && right.abs_diff(LEFT + width / 2) <= 2, "{left} to {right}");
    }
}

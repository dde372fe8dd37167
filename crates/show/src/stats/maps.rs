//! Charts of two dimensions: hue and saturation, and normals. Counts are shown by their logarithm, in viridis.

use super::chart::{GRID, INK, NOTE, PAPER, SOFT, TITLE};
use super::measure::{Map, SIDE};
use crate::drawing::{Anchor, Drawing, Ink, Point, Text};
use crate::palette::viridis;
use crate::picture::Picture;
use crate::sheet::lettering::{self, Style};

/// Side of a map on the page, pixels.
const MAP: f32 = 330.0;
/// Margins and space between maps.
const MARGIN: f32 = 56.0;
const TOP: f32 = 96.0;
const BOTTOM: f32 = 84.0;
/// Space beside the title.
const EDGE: f32 = 16.0;
/// From the rim of a disc to the names of hues, so that the longest ends within.
const INSET: f32 = 26.0;
/// Counts below this share of the largest are shown as this.
const DIMMEST: f64 = 1e-4;

/// Lettering around a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// A disc: hue by direction (red to the right, green up to the left), saturation from the middle.
    Hue,
    /// A square: components from −1 to 1.
    Normal,
}

/// Maps side by side, each with its name.
pub fn draw_maps(title: &str, note: &str, frame: Frame, maps: &[(String, &Map)]) -> Drawing {
    let across = MARGIN + maps.len() as f32 * (MAP + MARGIN);
    let width = across.max(2.0 * EDGE + width_of(title, TITLE).max(width_of(note, NOTE))).ceil();
    let first = MARGIN + (0.5 * (width - across)).floor();
    let mut page = Drawing::new(width as u32, (TOP + MAP + BOTTOM) as u32, PAPER);
    let ink = Ink::solid;
    write(&mut page, [EDGE, 28.0], title, TITLE, Anchor::Start, ink(INK));
    write(&mut page, [EDGE, 52.0], note, NOTE, Anchor::Start, ink(SOFT));
    for (i, (name, map)) in maps.iter().enumerate() {
        let left = first + i as f32 * (MAP + MARGIN);
        write(&mut page, [left + 0.5 * MAP, TOP - 16.0], name, NOTE, Anchor::Middle, ink(INK));
        page.picture([left, TOP], picture(map, frame));
        match frame {
            Frame::Hue => around_disc(&mut page, [left + 0.5 * MAP, TOP + 0.5 * MAP]),
            Frame::Normal => around_square(&mut page, left),
        }
    }
    scale(&mut page, first);
    page
}

fn write(page: &mut Drawing, at: Point, words: &str, height: f32, anchor: Anchor, ink: Ink) {
    page.write(Text { at, words: words.into(), height, bold: height >= TITLE, anchor, ink, halo: None });
}

/// Room that words take, with the pen of bold ones, which is the wider.
fn width_of(words: &str, height: f32) -> f32 {
    lettering::width(words, Style { height, weight: 0.16, color: INK })
}

/// Colour of a share of the largest count.
fn color(share: f64) -> [u8; 3] {
    viridis(1.0 - share.max(DIMMEST).log10() / DIMMEST.log10())
}

fn picture(map: &Map, frame: Frame) -> Picture {
    let most = map.counts.iter().copied().max().unwrap_or(1).max(1) as f64;
    let scale = SIDE as f32 / MAP;
    Picture::from_fn(MAP as u32, MAP as u32, |x, y| {
        let [x, y] = [x as f32 + 0.5, y as f32 + 0.5];
        let from_center = ((x - 0.5 * MAP).powi(2) + (y - 0.5 * MAP).powi(2)).sqrt();
        if frame == Frame::Hue && from_center > 0.5 * MAP {
            return image::Rgba([0; 4]); // the paper shows
        }
        let (column, row) = ((x * scale) as usize, SIDE - 1 - (y * scale) as usize);
        let [r, g, b] = color(map.counts[row.min(SIDE - 1) * SIDE + column.min(SIDE - 1)] as f64 / most);
        image::Rgba([r, g, b, 255])
    })
}

fn around_disc(page: &mut Drawing, [x, y]: Point) {
    let radius = 0.5 * MAP;
    let circle =
        |r: f32| -> Vec<Point> { (0..=96).map(|i| f32::to_radians(3.75 * i as f32)).map(|a| [x + r * a.cos(), y - r * a.sin()]).collect() };
    page.lines(vec![circle(radius)], 1.5, Ink::solid(SOFT));
    page.lines(vec![circle(0.5 * radius)], 1.0, Ink::veil(GRID, 0.5));
    let hues = ["red", "yellow", "green", "cyan", "blue", "magenta"];
    for (i, name) in hues.iter().enumerate() {
        let angle = f32::to_radians(60.0 * i as f32);
        let place = [x + (radius - INSET) * angle.cos(), y - (radius - INSET) * angle.sin() + 4.0];
        let anchor = if i % 6 == 0 {
            Anchor::End
        } else if i == 3 {
            Anchor::Start
        } else {
            Anchor::Middle
        };
        write(page, place, name, 8.5, anchor, Ink::solid(PAPER));
    }
}

fn around_square(page: &mut Drawing, left: f32) {
    let (right, bottom) = (left + MAP, TOP + MAP);
    page.line(&[[left, TOP], [right, TOP], [right, bottom], [left, bottom], [left, TOP]], 1.5, Ink::solid(SOFT));
    for (share, label) in [(0.0, "-1"), (0.5, "0"), (1.0, "1")] {
        write(page, [left + share * MAP, bottom + 18.0], label, NOTE, Anchor::Middle, Ink::solid(SOFT));
        write(page, [left - 8.0, bottom - share * MAP + 4.0], label, NOTE, Anchor::End, Ink::solid(SOFT));
    }
    write(page, [left + 0.25 * MAP, bottom + 18.0], "left", NOTE, Anchor::Middle, Ink::solid(SOFT));
    write(page, [left + 0.75 * MAP, bottom + 18.0], "right", NOTE, Anchor::Middle, Ink::solid(SOFT));
    write(page, [left - 8.0, bottom - 0.75 * MAP + 4.0], "up", NOTE, Anchor::End, Ink::solid(SOFT));
    write(page, [left - 8.0, bottom - 0.25 * MAP + 4.0], "down", NOTE, Anchor::End, Ink::solid(SOFT));
}

/// The colour scale.
fn scale(page: &mut Drawing, left: f32) {
    let (top, steps, least) = (TOP + MAP + 38.0, 96, "1/10000 or less");
    let bar = left + width_of(least, 8.5) + 10.0;
    for i in 0..steps {
        let share = f64::from(i) / f64::from(steps - 1);
        page.bar([bar + 2.0 * i as f32, top, 2.5, 12.0], Ink::solid(viridis(share)));
    }
    write(page, [left, top + 11.0], least, 8.5, Anchor::Start, Ink::solid(SOFT));
    write(page, [bar + 2.0 * steps as f32 + 10.0, top + 11.0], "most", 8.5, Anchor::Start, Ink::solid(SOFT));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Shape;

    #[test]
    fn words_have_room_on_the_page_in_the_disc_and_before_the_scale() {
        let title = "Diffuse reflectance: hue and saturation";
        let page = draw_maps(title, "hue by direction", Frame::Hue, &[("this dataset".into(), &Map::default())]);
        let middle = page.width as f32 / 2.0;
        let bar = page.shapes.iter().find_map(|shape| if let Shape::Area { outline, .. } = shape { Some(outline[0][0]) } else { None });
        let mut named = 0;
        for text in page.shapes.iter().filter_map(|shape| if let Shape::Text(text) = shape { Some(text) } else { None }) {
            let width = width_of(&text.words, text.height);
            let left = match text.anchor {
                Anchor::Start => text.at[0],
                Anchor::Middle => text.at[0] - 0.5 * width,
                Anchor::End => text.at[0] - width,
            };
            assert!(left >= 0.0 && left + width <= page.width as f32, "{}", text.words);
            if text.words.starts_with("1/10000") {
                assert!(left + width < bar.unwrap(), "{left} + {width}");
            }
            if text.ink.color == PAPER {
                named += 1;
                for (x, y) in [left, left + width].into_iter().flat_map(|x| [text.at[1] - text.height, text.at[1]].map(|y| (x, y))) {
                    let from_center = (x - middle).hypot(y - TOP - 0.5 * MAP);
                    assert!(from_center < 0.5 * MAP, "{}: {from_center}", text.words);
                }
            }
        }
        assert_eq!(named, 6);
    }

    #[test]
    fn rows_of_a_map_go_up_and_its_largest_count_is_brightest() {
        let mut map = Map::default();
        map.counts[90 * SIDE + 20] = 1000;
        let shown = picture(&map, Frame::Normal);
        let at = |x: f32, y: f32| shown.get_pixel((x * MAP) as u32, (y * MAP) as u32).0;
        assert_eq!(at(0.205, 0.095)[..3], viridis(1.0));
        assert_eq!(at(0.5, 0.5)[..3], viridis(0.0));
    }
}

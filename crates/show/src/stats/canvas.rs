//! The canvas of `plotters`: a page of shapes, which then becomes a picture and a scalable file, with our lettering and without system
//! fonts.

use crate::drawing::{Anchor, Drawing, Ink, Point, Text};
use crate::sheet::lettering::{self, Style};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind};
use std::convert::Infallible;

/// Units of `plotters` per pixel: it has whole units only, and smaller ones place lines exactly.
pub const UNITS: u32 = 8;
/// Height of capitals over the size of a font, as most have it.
const CAPITAL: f64 = 0.72;
/// Weight of regular lettering.
const REGULAR: f32 = 0.11;

/// A page that `plotters` can draw on.
pub struct Canvas<'a>(pub &'a mut Drawing);

type Done = Result<(), DrawingErrorKind<Infallible>>;

fn point((x, y): BackendCoord) -> Point {
    [x as f32 / UNITS as f32, y as f32 / UNITS as f32]
}

fn ink(color: BackendColor) -> Ink {
    Ink::veil(color.rgb.into(), color.alpha as f32)
}

fn width<S: BackendStyle>(style: &S) -> f32 {
    style.stroke_width() as f32 / UNITS as f32
}

fn capital_height<T: BackendTextStyle>(style: &T) -> f32 {
    (CAPITAL * style.size()) as f32 / UNITS as f32
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.0.width * UNITS, self.0.height * UNITS)
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        Ok(())
    }

    fn draw_pixel(&mut self, at: BackendCoord, color: BackendColor) -> Done {
        let [x, y] = point(at);
        self.0.bar([x, y, 1.0 / UNITS as f32, 1.0 / UNITS as f32], ink(color));
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Done {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S, fill: bool) -> Done {
        let ([x, y], [right, bottom]) = (point(from), point(to));
        if fill {
            self.0.bar([x, y, right - x, bottom - y], ink(style.color()));
            return Ok(());
        }
        let corners = [from, (to.0, from.1), to, (from.0, to.1), from];
        self.draw_path(corners, style)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Done {
        let points: Vec<Point> = path.into_iter().map(point).collect();
        if style.color().alpha > 0.0 {
            self.0.line(&points, width(style), ink(style.color()));
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, center: BackendCoord, radius: u32, style: &S, _fill: bool) -> Done {
        self.0.disc(point(center), radius as f32 / UNITS as f32, ink(style.color()));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, corners: I, style: &S) -> Done {
        let outline: Vec<Point> = corners.into_iter().map(point).collect();
        self.0.area(&outline, ink(style.color()));
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, at: BackendCoord) -> Done {
        let (height, [x, y]) = (capital_height(style), point(at));
        let anchor = match style.anchor().h_pos {
            HPos::Left => Anchor::Start,
            HPos::Center => Anchor::Middle,
            HPos::Right => Anchor::End,
        };
        let baseline = match style.anchor().v_pos {
            VPos::Top => y + height,
            VPos::Center => y + 0.5 * height,
            VPos::Bottom => y,
        };
        self.0.write(Text { at: [x, baseline], words: text.into(), height, bold: false, anchor, ink: ink(style.color()), halo: None });
        Ok(())
    }

    fn estimate_text_size<T: BackendTextStyle>(&self, text: &str, style: &T) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let height = capital_height(style);
        let width = lettering::width(text, Style { height, weight: REGULAR, color: [0; 3] });
        Ok(((width * UNITS as f32).ceil() as u32, (height * UNITS as f32).ceil() as u32))
    }
}

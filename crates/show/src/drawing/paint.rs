//! A page in pixels, antialiased.

use super::{Anchor, Drawing, Ink, Point, Shape, Text};
use crate::picture::Picture;
use crate::sheet::lettering::{self, Style};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, PremultipliedColorU8, Stroke, Transform,
};

/// Pen width over the height of capitals.
const REGULAR: f32 = 0.115;
const BOLD: f32 = 0.16;
/// How far a halo reaches beyond the letters, over the height of capitals.
const HALO: f32 = 0.34;

/// The page as a picture. The same page gives the same pixels.
///
/// # Panics
/// When a side of the page is 0 or its pixels exceed 2 GiB.
pub(crate) fn paint(drawing: &Drawing) -> Picture {
    let mut pixels = Pixmap::new(drawing.width, drawing.height).expect("a page has sides of at least one pixel");
    let [r, g, b] = drawing.paper;
    pixels.fill(Color::from_rgba8(r, g, b, 255));
    drawing.shapes.iter().for_each(|shape| paint_shape(&mut pixels, shape));
    Picture::from_raw(drawing.width, drawing.height, pixels.take()).expect("four bytes per pixel, opaque")
}

fn paint_shape(pixels: &mut Pixmap, shape: &Shape) {
    match shape {
        Shape::Area { outline, ink } => fill(pixels, polygon(outline), *ink),
        Shape::Lines { runs, width, ink } => stroke(pixels, runs, *width, *ink),
        Shape::Disc { center, radius, ink } => fill(pixels, PathBuilder::from_circle(center[0], center[1], *radius), *ink),
        Shape::Text(text) => paint_text(pixels, text),
        Shape::Picture { at, picture } => paint_picture(pixels, *at, picture),
    }
}

fn style(height: f32, bold: bool) -> Style {
    Style { height, weight: if bold { BOLD } else { REGULAR }, color: [0; 3] }
}

fn paint_text(pixels: &mut Pixmap, text: &Text) {
    let style = style(text.height, text.bold);
    let x = match text.anchor {
        Anchor::Start => text.at[0],
        Anchor::Middle => text.at[0] - 0.5 * lettering::width(&text.words, style),
        Anchor::End => text.at[0] - lettering::width(&text.words, style),
    };
    let runs = lettering::runs(x, text.at[1], &text.words, style);
    let pen = style.weight * style.height;
    if let Some(halo) = text.halo {
        stroke(pixels, &runs, pen + 2.0 * HALO * text.height, halo);
    }
    stroke(pixels, &runs, pen, text.ink);
}

fn ink_of(ink: Ink) -> Paint<'static> {
    let [r, g, b] = ink.color;
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, (255.0 * ink.opacity.clamp(0.0, 1.0)).round() as u8);
    paint
}

fn fill(pixels: &mut Pixmap, path: Option<Path>, ink: Ink) {
    if let Some(path) = path {
        pixels.fill_path(&path, &ink_of(ink), FillRule::Winding, Transform::identity(), None);
    }
}

fn stroke(pixels: &mut Pixmap, runs: &[Vec<Point>], width: f32, ink: Ink) {
    let mut builder = PathBuilder::new();
    for run in runs {
        let Some(first) = run.first() else { continue };
        builder.move_to(first[0], first[1]);
        match &run[1..] {
            // A run of one point is a dot: the shortest line that has round ends.
            [] => builder.line_to(first[0] + 0.01, first[1]),
            rest => rest.iter().for_each(|p| builder.line_to(p[0], p[1])),
        }
    }
    if let Some(path) = builder.finish() {
        let pen = Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
        pixels.stroke_path(&path, &ink_of(ink), &pen, Transform::identity(), None);
    }
}

fn polygon(outline: &[Point]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let (first, rest) = outline.split_first()?;
    builder.move_to(first[0], first[1]);
    rest.iter().for_each(|p| builder.line_to(p[0], p[1]));
    builder.close();
    builder.finish()
}

fn paint_picture(pixels: &mut Pixmap, at: Point, picture: &Picture) {
    let Some(mut source) = Pixmap::new(picture.width(), picture.height()) else { return };
    for (to, from) in source.pixels_mut().iter_mut().zip(picture.pixels()) {
        let [r, g, b, a] = from.0;
        let times = |v: u8| ((u32::from(v) * u32::from(a) + 127) / 255) as u8;
        *to = PremultipliedColorU8::from_rgba(times(r), times(g), times(b), a).unwrap_or(PremultipliedColorU8::TRANSPARENT);
    }
    pixels.draw_pixmap(at[0] as i32, at[1] as i32, source.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_cover_their_places_in_order() {
        let mut page = Drawing::new(40, 30, [255; 3]);
        page.bar([10.0, 10.0, 20.0, 10.0], Ink::solid([200, 0, 0]));
        page.line(&[[10.0, 15.0], [30.0, 15.0]], 4.0, Ink::solid([0, 0, 200]));
        page.disc([20.0, 15.0], 1.5, Ink::veil([255; 3], 0.5));
        page.picture([0.0, 0.0], Picture::from_pixel(2, 2, image::Rgba([0, 9, 0, 255])));
        let picture = paint(&page);
        let at = |x, y| picture.get_pixel(x, y).0;
        assert_eq!([at(12, 11), at(12, 15), at(5, 25), at(1, 1)], [[200, 0, 0, 255], [0, 0, 200, 255], [255; 4], [0, 9, 0, 255]]);
        assert_eq!(at(20, 15), [128, 128, 228, 255]);
    }

    #[test]
    fn text_stands_where_its_anchor_says() {
        let ink_columns = |anchor| {
            let mut page = Drawing::new(200, 40, [255; 3]);
            let text = Text {
                at: [100.0, 30.0],
                words: "frame 10".into(),
                height: 10.0,
                bold: false,
                anchor,
                ink: Ink::solid([0; 3]),
                halo: None,
            };
            page.write(text);
            let picture = paint(&page);
            let dark: Vec<u32> = (0..200).filter(|&x| (0..40).any(|y| picture.get_pixel(x, y).0[0] < 128)).collect();
            (dark[0], dark[dark.len() - 1])
        };
        let width = lettering::width("frame 10", style(10.0, false));
        assert!(ink_columns(Anchor::Start).0.abs_diff(100) <= 1 && ink_columns(Anchor::End).1.abs_diff(99) <= 1);
        let (left, right) = ink_columns(Anchor::Middle);
        assert!(((right - left + 1) as f32 - width).abs() < 2.0 && (left + right).abs_diff(199) <= 2);
    }
}

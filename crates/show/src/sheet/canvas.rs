//! A plain drawing surface for contact sheets and overlays.

use crate::picture::Picture;
use image::imageops::{self, FilterType};

/// sRGB.
pub type Color = [u8; 3];

/// An opaque picture to draw on.
pub struct Canvas {
    picture: Picture,
}

/// How a picture is brought to another size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resize {
    /// Values may be mixed.
    Smooth,
    /// Every pixel keeps a colour of the original: for ids.
    Exact,
}

impl Canvas {
    /// A surface of one colour.
    pub fn new(width: u32, height: u32, [r, g, b]: Color) -> Self {
        Self { picture: Picture::from_pixel(width, height, image::Rgba([r, g, b, 255])) }
    }

    /// A picture to draw on.
    pub fn over(picture: Picture) -> Self {
        Self { picture }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.picture.width(), self.picture.height()]
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.picture.width()
    }

    /// The finished picture.
    pub fn into_picture(self) -> Picture {
        self.picture
    }

    /// Fills a rectangle, cut to the surface.
    pub fn fill(&mut self, x: u32, y: u32, width: u32, height: u32, [r, g, b]: Color) {
        for py in y..(y + height).min(self.picture.height()) {
            for px in x..(x + width).min(self.picture.width()) {
                self.picture.put_pixel(px, py, image::Rgba([r, g, b, 255]));
            }
        }
    }

    /// Places `picture` in the rectangle; its transparent pixels let the surface through.
    pub fn place(&mut self, x: u32, y: u32, width: u32, height: u32, picture: &Picture, resize: Resize) {
        let shrinks = width <= picture.width();
        let filter = match resize {
            Resize::Exact => FilterType::Nearest,
            Resize::Smooth if shrinks => FilterType::Triangle,
            Resize::Smooth => FilterType::CatmullRom,
        };
        let resized = imageops::resize(picture, width.max(1), height.max(1), filter);
        imageops::overlay(&mut self.picture, &resized, i64::from(x), i64::from(y));
    }

    /// Draws a line through `points` with a round pen of the given radius, antialiased. One point gives a dot.
    pub fn stroke(&mut self, points: &[[f32; 2]], radius: f32, color: Color) {
        let margin = radius + 1.0;
        let low = |axis: usize| points.iter().map(|p| p[axis]).fold(f32::INFINITY, f32::min) - margin;
        let high = |axis: usize| points.iter().map(|p| p[axis]).fold(f32::NEG_INFINITY, f32::max) + margin;
        let range = |axis: usize, limit: u32| (low(axis).max(0.0) as u32)..(high(axis).max(0.0).ceil() as u32).min(limit);
        for y in range(1, self.picture.height()) {
            for x in range(0, self.picture.width()) {
                let center = [x as f32 + 0.5, y as f32 + 0.5];
                let distance = points
                    .windows(2)
                    .map(|w| distance_to_segment(center, w[0], w[1]))
                    .fold(f32::INFINITY, f32::min)
                    .min(if points.len() == 1 { distance_to_segment(center, points[0], points[0]) } else { f32::INFINITY });
                self.blend(x, y, color, (radius - distance + 0.5).clamp(0.0, 1.0));
            }
        }
    }

    /// Mixes a colour into a pixel.
    pub fn blend(&mut self, x: u32, y: u32, color: Color, coverage: f32) {
        let pixel = self.picture.get_pixel_mut(x, y);
        for c in 0..3 {
            let under = f32::from(pixel.0[c]);
            pixel.0[c] = (under + (f32::from(color[c]) - under) * coverage).round() as u8;
        }
    }
}

/// Distance of a point from a straight stroke.
pub fn distance_to_segment(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length2 = dx * dx + dy * dy;
    let t = if length2 > 0.0 { (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (p[0] - a[0] - t * dx).hypot(p[1] - a[1] - t * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_cover_the_pen_and_nothing_else() {
        let mut canvas = Canvas::new(20, 20, [0; 3]);
        canvas.stroke(&[[5.0, 10.0], [15.0, 10.0]], 2.0, [255; 3]);
        let picture = canvas.into_picture();
        let at = |x, y| picture.get_pixel(x, y).0[0];
        assert_eq!([at(10, 9), at(10, 10), at(10, 14), at(10, 5), at(1, 10)], [255, 255, 0, 0, 0]);
    }

    #[test]
    fn transparent_pixels_let_the_surface_through_and_edges_are_cut() {
        let mut canvas = Canvas::new(4, 4, [9; 3]);
        canvas.place(2, 2, 4, 4, &Picture::from_pixel(2, 2, image::Rgba([200, 0, 0, 0])), Resize::Exact);
        canvas.fill(3, 0, 10, 1, [1, 2, 3]);
        let picture = canvas.into_picture();
        assert_eq!((picture.get_pixel(3, 3).0, picture.get_pixel(3, 0).0), ([9, 9, 9, 255], [1, 2, 3, 255]));
    }
}

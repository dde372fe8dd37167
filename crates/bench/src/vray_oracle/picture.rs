//! Linear pictures: V-Ray's and ours.

use anyhow::{Context, Result};
use enfilade_frame::{Frame, Layer};
use std::path::Path;

/// Linear RGB, row by row from the top.
pub struct Picture {
    pub width: usize,
    pub height: usize,
    pub rgb: Vec<[f32; 3]>,
}

impl Picture {
    pub fn read(path: &Path) -> Result<Self> {
        let picture = exr::prelude::read_first_rgba_layer_from_file(
            path,
            |size, _| Self { width: size.width(), height: size.height(), rgb: vec![[0.0; 3]; size.area()] },
            |picture: &mut Self, position, (r, g, b, _a): (f32, f32, f32, f32)| {
                let index = position.y() * picture.width + position.x();
                picture.rgb[index] = [r, g, b];
            },
        );
        Ok(picture.with_context(|| format!("cannot read {}", path.display()))?.layer_data.channel_data.pixels)
    }

    pub fn of(frame: &Frame) -> Result<Self> {
        let color = frame.get(Layer::Color).context("the frame has no colour")?;
        let rgb = (0..frame.pixels()).map(|p| std::array::from_fn(|c| color.get(3 * p + c) as f32)).collect();
        Ok(Self { width: frame.width as usize, height: frame.height as usize, rgb })
    }

    /// The picture with natural vignetting, which V-Ray's camera has and ours not: light falls off with the fourth power of the cosine
    /// of the angle from the axis.
    pub fn vignetted(mut self, fov_x_rad: f64) -> Self {
        let (w, h) = (self.width as f64, self.height as f64);
        let focal = 0.5 * w / (0.5 * fov_x_rad).tan();
        for (i, rgb) in self.rgb.iter_mut().enumerate() {
            let (x, y) = ((i % self.width) as f64 + 0.5 - 0.5 * w, (i / self.width) as f64 + 0.5 - 0.5 * h);
            let cos_squared = focal * focal / (focal * focal + x * x + y * y);
            *rgb = rgb.map(|v| v * (cos_squared * cos_squared) as f32);
        }
        self
    }

    pub fn luminance(&self, x: usize, y: usize) -> f64 {
        let [r, g, b] = self.rgb[y.min(self.height - 1) * self.width + x.min(self.width - 1)];
        f64::from(0.2126 * r + 0.7152 * g + 0.0722 * b)
    }

    /// Luminance at a place of the picture (upper left corner at 0, 0), linear between the centres of pixels.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (x, y) = ((x - 0.5).max(0.0), (y - 0.5).max(0.0));
        let (left, top, fx, fy) = (x as usize, y as usize, x.fract(), y.fract());
        let row = |y: usize| self.luminance(left, y) * (1.0 - fx) + self.luminance(left + 1, y) * fx;
        row(top) * (1.0 - fy) + row(top + 1) * fy
    }

    /// The mean of the squares of `side` pixels: a picture that is as much smaller.
    pub fn shrunk(&self, side: usize) -> Self {
        let (width, height) = (self.width / side, self.height / side);
        let mean = |i: usize| {
            let (x0, y0) = (i % width * side, i / width * side);
            let mut sum = [0.0f64; 3];
            for (x, y) in (0..side * side).map(|k| (x0 + k % side, y0 + k / side)) {
                (0..3).for_each(|c| sum[c] += f64::from(self.rgb[y * self.width + x][c]));
            }
            sum.map(|s| (s / (side * side) as f64) as f32)
        };
        Self { width, height, rgb: (0..width * height).map(mean).collect() }
    }
}

/// Relative differences of luminance, ours over V-Ray's minus 1, of two pictures of one size; the darkest hundredth counts as that.
pub fn relative_differences(ours: &Picture, reference: &Picture) -> Vec<f64> {
    let (width, count) = (ours.width, ours.rgb.len());
    let values = |p: &Picture| (0..count).map(|i| p.luminance(i % width, i / width)).collect::<Vec<f64>>();
    let (a, b) = (values(ours), values(reference));
    let floor = 0.01 * b.iter().sum::<f64>() / count as f64;
    a.iter().zip(&b).map(|(a, b)| (a - b) / b.max(floor)).collect()
}

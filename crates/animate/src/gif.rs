//! GIF: 256 colours per picture, chosen again for each and dithered where there are more.

use crate::colors::few_colors;
use crate::format::{AnimationError, AnimationFormat, refused};
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use quantette::deps::palette::Srgb;
use quantette::{ImageRef, Pipeline};
use std::borrow::Cow;

/// A GIF that begins again for ever. Every picture has its own palette: the colours that are there, or 256 chosen by Wu's method in
/// Oklab with the error diffused.
pub(crate) struct Gif {
    size: (u16, u16),
    hundredths: f64,
    /// Number of picture times that have been written.
    written: u32,
    encoder: Encoder<Vec<u8>>,
}

impl Gif {
    pub fn begin((width, height): (u32, u32), fps: f64) -> Result<Self, AnimationError> {
        let size = (width as u16, height as u16);
        let refused = refused(AnimationFormat::Gif);
        let mut encoder = Encoder::new(Vec::new(), size.0, size.1, &[]).map_err(|e| refused(e.to_string()))?;
        encoder.set_repeat(Repeat::Infinite).map_err(|e| refused(e.to_string()))?;
        Ok(Self { size, hundredths: 100.0 / fps, written: 0, encoder })
    }

    pub fn add(&mut self, rgb: &[[u8; 3]], times: u32) -> Result<(), AnimationError> {
        let (palette, indices) = match few_colors(rgb) {
            Some(colors) => {
                let indices = rgb.iter().map(|color| colors.binary_search(color).unwrap_or(0) as u8).collect();
                (colors, indices)
            }
            None => reduce(rgb, self.size).map_err(refused(AnimationFormat::Gif))?,
        };
        // Hundredths of a second are whole numbers: if one picture lasts too long, a later one is shorter.
        let at = |time: u32| (f64::from(time) * self.hundredths).round();
        let delay = at(self.written + times) - at(self.written);
        let frame = Frame {
            width: self.size.0,
            height: self.size.1,
            delay: delay.clamp(1.0, f64::from(u16::MAX)) as u16,
            dispose: DisposalMethod::Keep,
            palette: Some(palette.into_flattened()),
            buffer: Cow::Owned(indices),
            ..Frame::default()
        };
        self.written += times;
        self.encoder.write_frame(&frame).map_err(|e| refused(AnimationFormat::Gif)(e.to_string()))
    }

    pub fn finish(self) -> Result<Vec<u8>, AnimationError> {
        if self.written == 0 {
            return Err(refused(AnimationFormat::Gif)("no picture".into()));
        }
        self.encoder.into_inner().map_err(|e| refused(AnimationFormat::Gif)(e.to_string()))
    }
}

/// 256 colours, and the one of each pixel.
fn reduce(rgb: &[[u8; 3]], (width, height): (u16, u16)) -> Result<(Vec<[u8; 3]>, Vec<u8>), String> {
    let colors: Vec<Srgb<u8>> = rgb.iter().map(|&[r, g, b]| Srgb::new(r, g, b)).collect();
    let image = ImageRef::new(u32::from(width), u32::from(height), &colors[..]).map_err(|e| e.to_string())?;
    let (palette, indices) = Pipeline::new().input_image(image).output_srgb8_indexed_image().into_parts();
    Ok((palette.into_iter().map(|c| [c.red, c.green, c.blue]).collect(), indices))
}

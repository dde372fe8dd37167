//! Moving pictures: a row of pictures as MP4 (H.264) or GIF.
//!
//! Each encoder runs on one thread, so that the bytes do not depend on the number of threads. Transparency is laid over black,
//! since H.264 has none. GIF keeps a picture of at most 256 colours exactly.

use crate::format::{AnimationError, AnimationFormat};
use crate::{gif, mp4};
use enfilade_show::picture::Picture;

/// An animation in the making.
pub struct Animation {
    size: (u32, u32),
    encoder: Encoder,
}

enum Encoder {
    Mp4(Box<mp4::Mp4>),
    Gif(gif::Gif),
}

impl Animation {
    /// Begins an animation of pictures of `size` (width, height), `fps` of them per second.
    ///
    /// # Errors
    /// When the rate is out of range, or the format cannot store pictures of that size.
    pub fn begin(format: AnimationFormat, size: (u32, u32), fps: f64) -> Result<Self, AnimationError> {
        if !(fps > 0.01 && fps <= 100.0) {
            return Err(AnimationError::Rate(fps));
        }
        let [long, short] = format.longest_sides();
        if size.0.max(size.1) > long || size.0.min(size.1) > short {
            return Err(AnimationError::TooLarge { format: format.name(), found: sides(size), most: sides((long, short)) });
        }
        let encoder = match format {
            AnimationFormat::Mp4 => Encoder::Mp4(Box::new(mp4::Mp4::begin(size, fps)?)),
            AnimationFormat::Gif => Encoder::Gif(gif::Gif::begin(size, fps)?),
        };
        Ok(Self { size, encoder })
    }

    /// Adds a picture that is shown for `times` frame durations, at least one.
    ///
    /// # Errors
    /// When it has another size than the animation, or the encoder refuses.
    pub fn add(&mut self, picture: &Picture, times: u32) -> Result<(), AnimationError> {
        if picture.dimensions() != self.size {
            return Err(AnimationError::Size { found: sides(picture.dimensions()), expected: sides(self.size) });
        }
        let rgb: Vec<[u8; 3]> = picture.pixels().map(|pixel| over_black(pixel.0)).collect();
        match &mut self.encoder {
            Encoder::Mp4(mp4) => mp4.add(&rgb, times.max(1)),
            Encoder::Gif(gif) => gif.add(&rgb, times.max(1)),
        }
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// When no picture was added, or the encoder refuses.
    pub fn finish(self) -> Result<Vec<u8>, AnimationError> {
        match self.encoder {
            Encoder::Mp4(mp4) => mp4.finish(),
            Encoder::Gif(gif) => gif.finish(),
        }
    }
}

fn sides((width, height): (u32, u32)) -> String {
    format!("{width}x{height} pixels")
}

fn over_black([r, g, b, alpha]: [u8; 4]) -> [u8; 3] {
    [r, g, b].map(|v| (u16::from(v) * u16::from(alpha) / 255) as u8)
}

//! Moving pictures: a row of pictures as MP4 (H.264), GIF or animated WebP.
//!
//! Each encoder runs on one thread, so that the bytes do not depend on the number of threads. Transparency is laid over black,
//! since H.264 has none. GIF and WebP keep a picture of at most 256 colours exactly.

mod gif;
mod mp4;
mod webp;

use crate::picture::Picture;
use std::collections::BTreeSet;

/// The form of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// H.264 in MP4: small, and every browser and player shows it. At most 3840 × 2160 pixels or 2160 × 3840.
    Mp4,
    /// 256 colours per picture, dithered; shown wherever pictures are.
    Gif,
    /// Animated WebP: all colours, shown by browsers.
    Webp,
}

impl AnimationFormat {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Mp4, Self::Gif, Self::Webp];

    /// Its name, which is the extension of its files too.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mp4 => "mp4",
            Self::Gif => "gif",
            Self::Webp => "webp",
        }
    }

    /// The longest long side and the longest short side of a picture in it.
    const fn longest_sides(self) -> [u32; 2] {
        match self {
            Self::Mp4 => [3840, 2160],
            Self::Gif => [65535, 65535],
            Self::Webp => [16383, 16383],
        }
    }
}

/// Why an animation cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum AnimationError {
    /// The rate is no rate.
    #[error("{0} pictures per second; expected more than 0.01 and at most 100")]
    Rate(f64),
    /// The pictures are too large for the format.
    #[error("pictures of {found}, but {format} holds at most {most}; choose another --format, which may be webp or gif")]
    TooLarge {
        /// Name of the format.
        format: &'static str,
        /// Size of the pictures.
        found: String,
        /// Largest size, the long side first.
        most: String,
    },
    /// A picture has another size than the first.
    #[error("a picture of {found} after one of {expected}; all of an animation have one size")]
    Size {
        /// Its size.
        found: String,
        /// That of the first.
        expected: String,
    },
    /// The encoder refuses.
    #[error("{format} cannot be encoded: {message}")]
    Encoder {
        /// Name of the format.
        format: &'static str,
        /// What the library says.
        message: String,
    },
}

/// An animation in the making.
pub struct Animation {
    size: (u32, u32),
    encoder: Encoder,
}

enum Encoder {
    Mp4(Box<mp4::Mp4>),
    Gif(gif::Gif),
    Webp(Box<webp::Webp>),
}

impl Animation {
    /// Begins an animation of pictures of `size` (width, height), `fps` of them per second.
    ///
    /// # Errors
    /// When the rate is no rate, or the format cannot hold pictures of that size.
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
            AnimationFormat::Webp => Encoder::Webp(Box::new(webp::Webp::begin(size, fps)?)),
        };
        Ok(Self { size, encoder })
    }

    /// Adds a picture that stands for `times` times the duration of one; at least once.
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
            Encoder::Webp(webp) => webp.add(&rgb, times.max(1)),
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
            Encoder::Webp(webp) => webp.finish(),
        }
    }
}

fn sides((width, height): (u32, u32)) -> String {
    format!("{width}x{height} pixels")
}

fn over_black([r, g, b, alpha]: [u8; 4]) -> [u8; 3] {
    [r, g, b].map(|v| (u16::from(v) * u16::from(alpha) / 255) as u8)
}

/// The colours of a picture, ascending; `None` when there are more than 256.
fn few_colors(rgb: &[[u8; 3]]) -> Option<Vec<[u8; 3]>> {
    let mut colors = BTreeSet::new();
    let mut last = None;
    for &color in rgb {
        if last != Some(color) && colors.insert(color) && colors.len() > 256 {
            return None;
        }
        last = Some(color);
    }
    Some(colors.into_iter().collect())
}

/// An encoder's refusal.
fn refused(format: AnimationFormat) -> impl Fn(String) -> AnimationError {
    move |message| AnimationError::Encoder { format: format.name(), message }
}

#[cfg(test)]
mod tests;

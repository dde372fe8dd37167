//! The formats of an animation: what each stores, and why one cannot be made.

/// The form of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// H.264 in MP4: small, and every browser and player shows it. At most 3840 × 2160 pixels or 2160 × 3840.
    Mp4,
    /// 256 colours per picture, dithered; shown wherever pictures are.
    Gif,
}

impl AnimationFormat {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Mp4, Self::Gif];

    /// Name of the format, which is the extension of its files too.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mp4 => "mp4",
            Self::Gif => "gif",
        }
    }

    /// The longest long side and the longest short side of a picture in it.
    pub(crate) const fn longest_sides(self) -> [u32; 2] {
        match self {
            Self::Mp4 => [3840, 2160],
            Self::Gif => [65535, 65535],
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
    #[error("pictures of {found}, but {format} holds at most {most}; --format gif holds the largest")]
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
        /// Size of the picture.
        found: String,
        /// Size of the first picture.
        expected: String,
    },
    /// The encoder refuses.
    #[error("{format} cannot be encoded: {message}")]
    Encoder {
        /// Name of the format.
        format: &'static str,
        /// The library's message.
        message: String,
    },
}

/// An encoder's refusal.
pub(crate) fn refused(format: AnimationFormat) -> impl Fn(String) -> AnimationError {
    move |message| AnimationError::Encoder { format: format.name(), message }
}

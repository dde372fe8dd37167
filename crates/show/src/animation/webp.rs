//! Animated WebP, without loss where a picture has few colours.

use super::colors::few_colors;
use super::format::{AnimationError, AnimationFormat, refused};
use webp_animation::{ColorMode, Encoder, EncoderOptions, EncodingConfig, EncodingType, LossyEncodingConfig};

/// Of 100; photographs are usually stored with 75 to 90.
const QUALITY: f32 = 85.0;

/// An animated WebP that begins again for ever: pictures of few colours exactly, the others with the loss of WebP's own method.
pub(super) struct Webp {
    milliseconds: f64,
    /// Number of picture times that have been added.
    added: u32,
    encoder: Encoder,
}

impl Webp {
    pub fn begin(size: (u32, u32), fps: f64) -> Result<Self, AnimationError> {
        let options = EncoderOptions { color_mode: ColorMode::Rgb, allow_mixed: false, ..EncoderOptions::default() };
        let encoder = Encoder::new_with_options(size, options).map_err(|e| refused(AnimationFormat::Webp)(e.to_string()))?;
        Ok(Self { milliseconds: 1000.0 / fps, added: 0, encoder })
    }

    pub fn add(&mut self, rgb: &[[u8; 3]], times: u32) -> Result<(), AnimationError> {
        let encoding_type = match few_colors(rgb) {
            Some(_) => EncodingType::Lossless,
            None => EncodingType::Lossy(LossyEncodingConfig { use_sharp_yuv: true, ..LossyEncodingConfig::default() }),
        };
        let config = EncodingConfig { encoding_type, quality: QUALITY, method: 4 };
        let time = self.time();
        // The library's `add_frame_with_config` (0.10) passes on a configuration that it has already freed.
        let set = self.encoder.set_default_encoding_config(config);
        let added = set.and_then(|()| self.encoder.add_frame(rgb.as_flattened(), time));
        self.added += times;
        added.map_err(|e| refused(AnimationFormat::Webp)(e.to_string()))
    }

    fn time(&self) -> i32 {
        (f64::from(self.added) * self.milliseconds).round() as i32
    }

    pub fn finish(self) -> Result<Vec<u8>, AnimationError> {
        let end = self.time();
        let bytes = self.encoder.finalize(end).map_err(|e| refused(AnimationFormat::Webp)(e.to_string()))?;
        Ok(bytes.to_vec())
    }
}

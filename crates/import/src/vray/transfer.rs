//! Transfer functions: whether the texels of a `BitmapBuffer` are encoded for the eye or linear.
//!
//! By Chaos's descriptions of its plugins `transfer_function`, which was called `color_space` before, is 0 (linear), 1 (`gamma`, which is
//! ignored otherwise), 2 (sRGB) or 3 (by the file, see [`Reader::by_file`]).

use super::plugins::Handle;
use super::reader::Reader;
use crate::ImportError;
use crate::images::Use;
use ::image::{ColorType, ImageDecoder, ImageFormat, ImageReader};
use std::io::Cursor;
use std::path::Path;

const LINEAR: i64 = 0;
const GAMMA: i64 = 1;
const SRGB: i64 = 2;
const AUTO: i64 = 3;

/// Gammas by which sRGB is usually stated: the picture's, or the one that undoes it, as 3ds Max's exporter writes it.
const USUAL_GAMMAS: [f64; 2] = [2.2, 1.0 / 2.2];

/// Gammas that differ by no more than this share are the same.
const NEAR_GAMMA: f64 = 0.15;

impl<'n> Reader<'n, '_> {
    /// The decoding of a buffer's picture; `path` leads to its file.
    pub(super) fn decoding(&mut self, buffer: Handle<'n>, path: &str) -> Result<Use, ImportError> {
        let function = buffer.int("transfer_function", buffer.int("color_space", GAMMA)?)?;
        Ok(match function {
            LINEAR => Use::Data,
            GAMMA => self.by_gamma(buffer)?,
            SRGB => Use::Color,
            AUTO => self.by_file(buffer, path),
            other => {
                self.warn(buffer, format!("the transfer function {other} is not known; the picture was taken for sRGB"));
                Use::Color
            }
        })
    }

    fn by_gamma(&mut self, buffer: Handle<'n>) -> Result<Use, ImportError> {
        let gamma = buffer.number("gamma", 1.0)?;
        if gamma == 1.0 {
            return Ok(Use::Data);
        }
        if USUAL_GAMMAS.iter().all(|usual| (gamma / usual - 1.0).abs() > NEAR_GAMMA) {
            self.warn(buffer, format!("gamma {gamma} treated as sRGB"));
        }
        Ok(Use::Color)
    }

    /// The decoding by the name of the file, `_lin_srgb` or `raw` for linear and `_srgb` for sRGB, or else sRGB where it has eight bits a
    /// channel and three or four channels (Chaos's documentation of the bitmap texture).
    fn by_file(&mut self, buffer: Handle<'n>, path: &str) -> Use {
        let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
        if name.contains("_lin_srgb") {
            return Use::Data;
        }
        if name.contains("raw") {
            // V-Ray's rule, by which a drawer.jpg is linear too.
            self.warn(buffer, format!("the name {name:?} holds raw, so the picture was taken for a linear one (transfer_function=3)"));
            return Use::Data;
        }
        if name.contains("_srgb") {
            return Use::Color;
        }
        match self.a.read(path) {
            Ok((_, bytes)) if has_colors_of_eight_bits(name, &bytes) => Use::Color,
            // What cannot be read is reported where it is decoded.
            _ => Use::Data,
        }
    }
}

/// True for pictures of three or four channels of eight bits, as their headers have it.
fn has_colors_of_eight_bits(name: &str, bytes: &[u8]) -> bool {
    let format = ::image::guess_format(bytes).ok().or_else(|| ImageFormat::from_path(Path::new(name)).ok());
    let decoder = format.and_then(|format| ImageReader::with_format(Cursor::new(bytes), format).into_decoder().ok());
    decoder.is_some_and(|decoder| matches!(decoder.color_type(), ColorType::Rgb8 | ColorType::Rgba8))
}

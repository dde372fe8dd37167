//! Pictures for people: 8-bit sRGB with alpha, and their files' bytes.

use image::codecs::jpeg::JpegEncoder;

/// A picture, row by row from the top.
pub type Picture = image::RgbaImage;

/// A picture of something measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// The picture.
    pub picture: Picture,
    /// The range of the values shown, if they were stretched; otherwise empty.
    pub note: String,
}

/// JPEG quality of every picture that is not exact.
const JPEG_QUALITY: u8 = 92;

/// A picture of `width` × `height` whose pixel `i` (row by row) is `color(i)`.
pub fn from_pixels(width: u32, height: u32, color: impl Fn(usize) -> [u8; 4]) -> Picture {
    Picture::from_fn(width, height, |x, y| image::Rgba(color(y as usize * width as usize + x as usize)))
}

/// A displayed value on `[0,1]` as a byte; NaN gives 0.
pub(crate) fn byte(v: f64) -> u8 {
    (v * 255.0).round() as u8
}

/// The bytes of a JPEG file; transparency is dropped.
///
/// # Panics
/// If a side is 0 or longer than 65535 pixels, the limit of JPEG.
pub fn jpeg(picture: &Picture) -> Vec<u8> {
    let rgb = image::DynamicImage::ImageRgba8(picture.clone()).into_rgb8();
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY).encode_image(&rgb).expect("sides of 1 to 65535 pixels");
    bytes
}

/// The bytes of a PNG file; `note` becomes its text chunk "Description" (Latin-1).
///
/// # Panics
/// When a side is 0, or the note is not Latin-1.
pub fn png(picture: &Picture, note: Option<&str>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    if let Some(note) = note {
        encoder.add_text_chunk("Description".into(), note.into()).expect("notes are Latin-1");
    }
    let mut writer = encoder.write_header().expect("writing to memory cannot fail");
    writer.write_image_data(picture.as_raw()).expect("as many pixels as the header says");
    writer.finish().expect("writing to memory cannot fail");
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_survive_their_files() {
        let picture = from_pixels(16, 8, |i| [(i * 2) as u8, 128, 40, 255]);
        let back = image::load_from_memory(&png(&picture, Some("range 1 m to 2 m"))).unwrap().into_rgba8();
        assert_eq!(back, picture);
        let back = image::load_from_memory(&jpeg(&picture)).unwrap().into_rgba8();
        assert!(back.as_raw().iter().zip(picture.as_raw()).all(|(a, b)| a.abs_diff(*b) < 12));
    }

    #[test]
    fn bytes_round_and_saturate() {
        assert_eq!([0.5 / 255.0, 1.0, 7.0, -1.0, f64::NAN].map(byte), [1, 255, 255, 0, 0]);
    }
}

//! Storage of a scene's pictures in a package: eight-bit ones as PNG, which is lossless, the others as raw values.
//!
//! Pictures are packed and unpacked in parallel, each by itself, so the bytes do not depend on the number of threads. The package's
//! own hash guards them, which is why PNG's checksums are not computed again when they are read.

use crate::{Image, Pixels};
use png::ColorType;
use rayon::prelude::*;
use serde::de::{Deserialize, Deserializer, Error as _, Visitor};
use serde::ser::{Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::io::Cursor;
use std::sync::Arc;

/// An [`Image`] in a package.
#[derive(serde::Serialize, serde::Deserialize)]
struct Packed<'a> {
    name: Cow<'a, str>,
    width: u32,
    height: u32,
    pixels: PackedPixels<'a>,
}

#[derive(serde::Serialize, serde::Deserialize)]
enum PackedPixels<'a> {
    Png { srgb: bool, file: Bytes },
    RgbF32(Cow<'a, [[f32; 3]]>),
}

/// Bytes in one run, which are not written one by one.
struct Bytes(Vec<u8>);

/// Writes all pictures, for `serde(with)`.
pub fn serialize<S: Serializer>(images: &[Arc<Image>], serializer: S) -> Result<S::Ok, S::Error> {
    enfilade_parallel::map(images, |image| packed(image)).serialize(serializer)
}

/// Reads all pictures, for `serde(with)`.
///
/// # Errors
/// When the data end too soon or a picture is no PNG of its size.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Arc<Image>>, D::Error> {
    Vec::<Packed>::deserialize(deserializer)?
        .into_par_iter()
        .map(|packed| image(packed).map(Arc::new))
        .collect::<Result<_, _>>()
        .map_err(D::Error::custom)
}

fn packed(image: &Image) -> Packed<'_> {
    let pixels = match &image.pixels {
        Pixels::Rgba8 { srgb, texels } => PackedPixels::Png { srgb: *srgb, file: Bytes(png(image, texels)) },
        Pixels::RgbF32(texels) => PackedPixels::RgbF32(Cow::Borrowed(texels)),
    };
    Packed { name: Cow::Borrowed(&image.name), width: image.width, height: image.height, pixels }
}

fn image(packed: Packed) -> Result<Image, String> {
    let Packed { name, width, height, pixels } = packed;
    let pixels = match pixels {
        PackedPixels::Png { srgb, file } => {
            let texels = texels(&file.0, [width, height]).map_err(|problem| format!("picture {name:?}: {problem}"))?;
            Pixels::Rgba8 { srgb, texels }
        }
        PackedPixels::RgbF32(texels) => Pixels::RgbF32(texels.into_owned()),
    };
    Ok(Image { name: name.into_owned(), width, height, pixels })
}

/// A PNG file with no more channels than the picture needs: many are grey, most are opaque.
fn png(size: &Image, texels: &[[u8; 4]]) -> Vec<u8> {
    smallest_png([size.width, size.height], texels, PngEffort::Fast)
}

/// How long to look for a smaller file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PngEffort {
    /// For files that are soon read again.
    Fast,
    /// For files that are kept and sent.
    Balanced,
}

/// A PNG file of eight bits per channel, with no more channels than the picture needs: grey or RGB, with alpha where something is not
/// opaque. `texels` are R, G, B, A row by row from the top, of a picture of `size` [width, height].
///
/// # Panics
/// If the number of texels does not fit the size.
pub fn smallest_png(size: [u32; 2], texels: &[[u8; 4]], effort: PngEffort) -> Vec<u8> {
    let opaque = texels.iter().all(|&[_, _, _, a]| a == 255);
    let grey = texels.iter().all(|&[r, g, b, _]| r == g && g == b);
    let (color, channels): (_, Vec<u8>) = match (grey, opaque) {
        (true, true) => (ColorType::Grayscale, texels.iter().map(|texel| texel[0]).collect()),
        (true, false) => (ColorType::GrayscaleAlpha, texels.iter().flat_map(|&[v, _, _, a]| [v, a]).collect()),
        (false, true) => (ColorType::Rgb, texels.iter().flat_map(|&[r, g, b, _]| [r, g, b]).collect()),
        (false, false) => (ColorType::Rgba, texels.as_flattened().to_vec()),
    };
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(match effort {
        PngEffort::Fast => png::Compression::Fast,
        PngEffort::Balanced => png::Compression::Balanced,
    });
    let mut writer = encoder.write_header().expect("writing to memory cannot fail");
    writer.write_image_data(&channels).expect("as many texels as the header says");
    writer.finish().expect("writing to memory cannot fail");
    file
}

/// Deflate makes at most this many bytes of one, so a file that claims more pixels does not have them.
const MAX_DEFLATE_RATIO: usize = 1032;

fn texels(file: &[u8], expected: [u32; 2]) -> Result<Vec<[u8; 4]>, String> {
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(file), png::Limits { bytes: usize::MAX });
    decoder.ignore_checksums(true);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let found = [reader.info().width, reader.info().height];
    if found != expected {
        return Err(format!("expected {} x {} pixels, found {} x {}", expected[0], expected[1], found[0], found[1]));
    }
    let size = reader.output_buffer_size().filter(|&size| size / MAX_DEFLATE_RATIO <= file.len());
    let size = size.ok_or_else(|| format!("{} bytes cannot hold {} x {} pixels", file.len(), found[0], found[1]))?;
    let mut channels = vec![0; size];
    let found = reader.next_frame(&mut channels).map_err(|error| error.to_string())?;
    Ok(match found.color_type {
        ColorType::Grayscale => channels.iter().map(|&v| [v, v, v, 255]).collect(),
        ColorType::GrayscaleAlpha => channels.as_chunks::<2>().0.iter().map(|&[v, a]| [v, v, v, a]).collect(),
        ColorType::Rgb => channels.as_chunks::<3>().0.iter().map(|&[r, g, b]| [r, g, b, 255]).collect(),
        ColorType::Rgba => channels.as_chunks::<4>().0.to_vec(),
        ColorType::Indexed => return Err("expected grey or RGB, found a palette".into()),
    })
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(&self.0)
    }
}

impl<'de> Deserialize<'de> for Bytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Run;
        impl Visitor<'_> for Run {
            type Value = Bytes;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a run of bytes")
            }

            fn visit_bytes<E>(self, bytes: &[u8]) -> Result<Bytes, E> {
                Ok(Bytes(bytes.to_vec()))
            }
        }
        deserializer.deserialize_bytes(Run)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    fn picture(name: &str, pixels: Pixels) -> Image {
        Image { name: name.into(), width: 37, height: 20, pixels }
    }

    /// Coloured and grey ones, opaque and clear ones, and one of large numbers.
    fn scene() -> Scene {
        let eight = |grey: bool, opaque: bool| {
            let texel = |i: u32| {
                let [r, g, b] = [(i % 37) as u8 * 5, (i / 37) as u8 * 9, (i * 31 % 256) as u8];
                [r, if grey { r } else { g }, if grey { r } else { b }, if opaque { 255 } else { (i % 7) as u8 }]
            };
            Pixels::Rgba8 { srgb: grey, texels: (0..740).map(texel).collect() }
        };
        let float = Pixels::RgbF32((0..740).map(|i| [i as f32 * 0.1, -0.0, f32::MAX]).collect());
        let kinds = [eight(true, true), eight(true, false), eight(false, true), eight(false, false), float];
        Scene { images: kinds.into_iter().map(|pixels| picture("p", pixels).into()).collect(), ..Scene::default() }
    }

    #[test]
    fn pictures_come_back_bit_by_bit_with_no_more_channels_than_they_need() {
        let bytes = postcard::to_stdvec(&scene()).unwrap();
        assert_eq!(postcard::from_bytes::<Scene>(&bytes).unwrap(), scene());
        let eight = |image: &Image| match &image.pixels {
            Pixels::Rgba8 { texels, .. } => Some(png(image, texels)),
            Pixels::RgbF32(_) => None,
        };
        // PNG's colour types: grey, grey with alpha, RGB, RGBA.
        let types: Vec<u8> = scene().images.iter().filter_map(|image| eight(image)).map(|file| file[25]).collect();
        assert_eq!(types, [0, 4, 2, 6]);
    }

    #[test]
    fn a_picture_of_another_size_or_cut_short_is_refused() {
        let all = vec![[1, 2, 3, 4]; 740];
        let file = png(&picture("p", Pixels::Rgba8 { srgb: false, texels: all.clone() }), &all);
        assert_eq!(texels(&file, [37, 20]).unwrap(), all);
        assert_eq!(texels(&file, [20, 37]).unwrap_err(), "expected 20 x 37 pixels, found 37 x 20");
        assert!(texels(&file[..40], [37, 20]).is_err());
    }
}

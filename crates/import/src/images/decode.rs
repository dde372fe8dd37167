//! Bytes of a picture file to an [`Image`], by what they begin with.

use super::float_picture::{FloatPicture, check_size};
use super::layout::Surface;
use super::{dds, exr, ktx2, pfm, tiff};
use crate::disguise::Content;
use ::image::codecs::hdr::HdrDecoder;
use ::image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use enfilade_scene::{Image, PictureFile, Pixels};
use std::io::Cursor;
use std::path::Path;

/// The use of a picture, which decides whether its bytes are sRGB-encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Use {
    /// Colours: eight-bit RGB is sRGB.
    Color,
    /// Numbers such as normals and roughness: eight-bit RGB is linear.
    Data,
}

/// A decoded picture and what was lost on the way, if anything.
pub(crate) struct Decoded {
    /// The picture.
    pub image: Image,
    /// Changes to the picture, for the report.
    pub note: Option<String>,
    /// The file, where it is of a kind that every program reads.
    pub file: Option<PictureFile>,
}

/// The formats that are read, for messages.
const KNOWN: &str = "PNG, JPEG, TIFF, WebP, GIF, BMP, TGA, DDS, KTX2, PNM, HDR, EXR, PFM";

/// The largest finite half float, which infinite texels become.
const LARGEST_HALF: f32 = 65_504.0;

/// Decodes a picture from the bytes of a file. `name` is for messages, and its extension identifies TGA, which has no signature.
///
/// # Errors
/// The fault of the bytes, as the rest of a sentence that begins with the file's name.
pub(crate) fn decode(name: &str, bytes: &[u8], usage: Use) -> Result<Decoded, String> {
    if let Some(decoded) = by_signature(name, bytes, usage) {
        return decoded;
    }
    if let Some(content) = Content::of(bytes).filter(|content| !content.is_picture()) {
        return Err(format!("is {}, not a picture", content.words()));
    }
    let format = format(name, bytes).ok_or_else(|| format!("is not a picture of a known format ({KNOWN})"))?;
    if format == ImageFormat::Tiff
        && let Some(picture) = tiff::decode_floats(bytes)?
    {
        return float_image(name, picture);
    }
    if format == ImageFormat::Tiff
        && let Some((width, height, texels)) = tiff::decode_others(bytes)?
    {
        return of_surface(name, Surface::Bytes { width, height, texels }, usage);
    }
    let size = ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().map_err(undecodable)?;
    check_size(size.0, size.1)?;
    // The library's own limit of 512 MB for what it decodes applies too.
    let picture = ImageReader::with_format(Cursor::new(bytes), format).decode().map_err(undecodable)?;
    let (width, height) = (picture.width(), picture.height());
    match picture {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            float_image(name, FloatPicture { width, height, texels: picture.into_rgb32f().pixels().map(|p| p.0).collect() })
        }
        _ => {
            let sixteen = matches!(
                picture,
                DynamicImage::ImageLuma16(_) | DynamicImage::ImageLumaA16(_) | DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgba16(_)
            );
            let texels = picture.into_rgba8().pixels().map(|p| p.0).collect();
            let pixels = Pixels::Rgba8 { srgb: usage == Use::Color, texels };
            let note = sixteen.then(|| "16 bits a channel were rounded to 8".to_string());
            let decoded = finish(Image { name: name.to_string(), width, height, pixels }, note)?;
            Ok(Decoded { file: to_pass_on(format, bytes), ..decoded })
        }
    }
}

/// A PNG or JPEG file as it is. JPEG files of four channels (inks) are none that others read.
fn to_pass_on(format: ImageFormat, bytes: &[u8]) -> Option<PictureFile> {
    let media_type = match format {
        ImageFormat::Png => "image/png",
        ImageFormat::Jpeg if matches!(jpeg_channels(bytes), Some(1 | 3)) => "image/jpeg",
        _ => return None,
    };
    Some(PictureFile { media_type, bytes: bytes.into() })
}

/// The number of channels that the header of a JPEG file's frame states (ISO/IEC 10918-1, B.2.2).
fn jpeg_channels(bytes: &[u8]) -> Option<u8> {
    let mut at = 2;
    loop {
        let [mark, kind, high, low] = *bytes.get(at..)?.first_chunk::<4>()?;
        if mark != 0xff {
            return None;
        }
        match kind {
            0xff => at += 1,
            0xc0..=0xcf if !matches!(kind, 0xc4 | 0xc8 | 0xcc) => return bytes.get(at + 9).copied(),
            _ => at += 2 + usize::from(u16::from_be_bytes([high, low])),
        }
    }
}

/// A picture in a format that is ours to read; `None` for other formats.
fn by_signature(name: &str, bytes: &[u8], usage: Use) -> Option<Result<Decoded, String>> {
    let floats = |picture: Result<FloatPicture, String>| picture.and_then(|picture| float_image(name, picture));
    let surface = |surface: Result<Surface, String>| surface.and_then(|surface| of_surface(name, surface, usage));
    Some(match bytes {
        [0x76, 0x2f, 0x31, 0x01, ..] => floats(exr::decode(bytes)),
        [b'P', b'F' | b'f', ..] => floats(pfm::decode(bytes)),
        b if b.starts_with(b"#?RGBE") => floats(rgbe(bytes)),
        b if b.starts_with(dds::MAGIC) => surface(dds::decode(bytes)),
        b if b.starts_with(ktx2::MAGIC) => surface(ktx2::decode(bytes)),
        [_, _, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', b'f' | b's', ..] => {
            Err("is an AVIF, which is not read; save it as PNG, JPEG or WebP".into())
        }
        _ => return None,
    })
}

/// The format of a picture by how it begins, or else, as TGA begins in no certain way, by its name or because it looks like TGA.
fn format(name: &str, bytes: &[u8]) -> Option<ImageFormat> {
    // Names of files within an archive end in a bracket, those within a scene file in a parenthesis.
    let by_name = || ImageFormat::from_path(Path::new(name.trim_end_matches([']', ')', '"']))).ok();
    let by_look = || looks_like_tga(bytes).then_some(ImageFormat::Tga);
    ::image::guess_format(bytes).ok().or_else(by_name).or_else(by_look)
}

/// True for bytes that begin with a possible header of TGA, and have enough behind it where they are not compressed.
fn looks_like_tga(bytes: &[u8]) -> bool {
    let Some(head) = bytes.first_chunk::<18>() else { return false };
    let (has_map, kind, depth, descriptor) = (head[1], head[2], head[16], head[17]);
    let number = |at: usize| usize::from(u16::from_le_bytes([head[at], head[at + 1]]));
    let map = if has_map == 1 { number(5) * usize::from(head[7]).div_ceil(8) } else { 0 };
    let (width, height) = (number(12), number(14));
    let fits = match kind {
        1 => has_map == 1 && depth == 8,
        2 => matches!(depth, 15 | 16 | 24 | 32),
        3 => matches!(depth, 8 | 16),
        9 => has_map == 1 && depth == 8,
        10 => matches!(depth, 15 | 16 | 24 | 32),
        11 => matches!(depth, 8 | 16),
        _ => false,
    };
    let pixels = if kind < 9 { width * height * usize::from(depth).div_ceil(8) } else { 1 };
    let needed = 18 + usize::from(head[0]) + map + pixels;
    has_map <= 1 && fits && width > 0 && height > 0 && descriptor & 0xc0 == 0 && bytes.len() >= needed
}

fn undecodable(e: ImageError) -> String {
    format!("cannot be decoded ({e})")
}

/// Radiance HDR with the signature `#?RGBE`, which some programs write; the library passes over it unless it insists on its own.
fn rgbe(bytes: &[u8]) -> Result<FloatPicture, String> {
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(bytes)).map_err(undecodable)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height)?;
    Limits::default().reserve(decoder.total_bytes()).map_err(undecodable)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(undecodable)?;
    Ok(FloatPicture { width, height, texels: picture.into_rgb32f().pixels().map(|p| p.0).collect() })
}

fn float_image(name: &str, mut picture: FloatPicture) -> Result<Decoded, String> {
    let mut replaced = 0usize;
    for value in picture.texels.iter_mut().flatten() {
        if !(0.0..=f32::MAX).contains(value) {
            *value = if *value == f32::INFINITY { LARGEST_HALF } else { 0.0 };
            replaced += 1;
        }
    }
    let note = (replaced > 0).then(|| format!("{replaced} values that were negative, infinite or not numbers were replaced"));
    let pixels = Pixels::RgbF32(picture.texels);
    finish(Image { name: name.to_string(), width: picture.width, height: picture.height, pixels }, note)
}

fn of_surface(name: &str, surface: Surface, usage: Use) -> Result<Decoded, String> {
    match surface {
        Surface::Floats(picture) => float_image(name, picture),
        Surface::Bytes { width, height, texels } => {
            let pixels = Pixels::Rgba8 { srgb: usage == Use::Color, texels };
            finish(Image { name: name.to_string(), width, height, pixels }, None)
        }
    }
}

fn finish(image: Image, note: Option<String>) -> Result<Decoded, String> {
    if image.width == 0 || image.height == 0 {
        return Err("has no pixels".into());
    }
    Ok(Decoded { image, note, file: None })
}

#[cfg(test)]
mod tests {
    use super::super::looks::{is_grey, is_opaque, looks_like_normals};
    use super::*;
    use ::image::{ImageBuffer, Luma, Rgba};

    fn png(picture: impl Into<DynamicImage>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn eight_bit_pictures_keep_their_bytes_and_know_their_use() {
        let bytes = png(ImageBuffer::from_fn(2, 1, |x, _| Rgba([x as u8, 7, 200, 128])));
        let expected = vec![[0, 7, 200, 128], [1, 7, 200, 128]];
        let color = decode("a.png", &bytes, Use::Color).unwrap().image;
        assert_eq!(color.pixels, Pixels::Rgba8 { srgb: true, texels: expected.clone() });
        assert!(!is_opaque(&color) && !is_grey(&color));
        let data = decode("a.png", &bytes, Use::Data).unwrap().image;
        assert_eq!(data.pixels, Pixels::Rgba8 { srgb: false, texels: expected });
    }

    #[test]
    fn sixteen_bit_greys_are_rounded_and_noted() {
        let bytes = png(ImageBuffer::from_fn(1, 1, |_, _| Luma([65_535u16])));
        let decoded = decode("a.png", &bytes, Use::Data).unwrap();
        assert_eq!(decoded.image.pixels, Pixels::Rgba8 { srgb: false, texels: vec![[255; 4]] });
        assert!(decoded.note.unwrap().contains("16 bits"));
    }

    /// The bytes of a picture in a format.
    fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.into().write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn pictures_of_every_lossless_format_keep_their_bytes() {
        let texels = vec![[10, 200, 30, 255], [0, 0, 255, 255]];
        let picture = ImageBuffer::from_fn(2, 1, |x, _| Rgba(texels[x as usize]));
        for format in [ImageFormat::Tiff, ImageFormat::WebP, ImageFormat::Gif, ImageFormat::Bmp, ImageFormat::Tga] {
            // Whatever the extension, and without one.
            for name in ["a.png (12)", "images[0]", "3 (C:\\tex\\wood.tga)"] {
                let decoded = decode(name, &encoded(picture.clone(), format), Use::Color).unwrap_or_else(|e| panic!("{format:?} {e}"));
                assert_eq!(decoded.image.pixels, Pixels::Rgba8 { srgb: true, texels: texels.clone() }, "{format:?} as {name}");
            }
        }
        let grey = DynamicImage::ImageLuma8(ImageBuffer::from_fn(1, 1, |_, _| Luma([77u8])));
        let pnm = decode("a.ppm", &encoded(grey, ImageFormat::Pnm), Use::Data).unwrap().image.pixels;
        assert_eq!(pnm, Pixels::Rgba8 { srgb: false, texels: vec![[77, 77, 77, 255]] });
    }

    #[test]
    fn tiff_has_sixteen_bits_or_floats_of_one_channel_or_three() {
        let sixteen = encoded(ImageBuffer::from_fn(1, 1, |_, _| Luma([32_896u16])), ImageFormat::Tiff);
        let decoded = decode("a.tif", &sixteen, Use::Data).unwrap();
        assert_eq!(decoded.image.pixels, Pixels::Rgba8 { srgb: false, texels: vec![[128, 128, 128, 255]] });
        assert!(decoded.note.unwrap().contains("16 bits"));
        let color = ImageBuffer::from_fn(1, 1, |_, _| ::image::Rgb([4.0f32, 0.5, 0.25]));
        let pixels = decode("a.tif", &encoded(color, ImageFormat::Tiff), Use::Color).unwrap().image.pixels;
        assert_eq!(pixels, Pixels::RgbF32(vec![[4.0, 0.5, 0.25]]));
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = ::tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
        encoder.write_image::<::tiff::encoder::colortype::Gray32Float>(2, 1, &[0.75, 3.0]).unwrap();
        let pixels = decode("height.tif", &bytes.into_inner(), Use::Data).unwrap().image.pixels;
        assert_eq!(pixels, Pixels::RgbF32(vec![[0.75; 3], [3.0; 3]]));
    }

    #[test]
    fn tiff_has_palettes_and_grey_with_alpha() {
        // Written by hand after TIFF 6.0: 3 x 2 pixels of 2 bits, colours of 16 bits each.
        let entry = |tag: u16, kind: u16, count: u32, value: u32, big: bool| {
            let value = if (kind, count, big) == (3, 1, true) { value << 16 } else { value };
            let le = [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &count.to_le_bytes(), &value.to_le_bytes()].concat();
            let be = [&tag.to_be_bytes()[..], &kind.to_be_bytes(), &count.to_be_bytes(), &value.to_be_bytes()].concat();
            if big { be } else { le }
        };
        let map: [u16; 12] = [0, 0xffff, 0x8080, 0x1010, 0, 0, 0x4040, 0x2020, 0, 0, 0xc0c0, 0x3030];
        for big in [false, true] {
            let short = |v: u16| if big { v.to_be_bytes() } else { v.to_le_bytes() };
            let long = |v: u32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
            let entries = [
                (256, 3, 1, 3),
                (257, 3, 1, 2),
                (258, 3, 1, 2),
                (259, 3, 1, 1),
                (262, 3, 1, 3),
                (273, 4, 1, 8),
                (277, 3, 1, 1),
                (278, 3, 1, 2),
                (279, 4, 1, 2),
                (320, 3, 12, 10),
            ];
            let mut bytes = [if big { &b"MM"[..] } else { b"II" }, &short(42), &long(34), &[0b0001_1000, 0b1110_0100]].concat();
            bytes.extend(map.iter().flat_map(|v| short(*v)));
            bytes.extend(short(entries.len() as u16));
            bytes.extend(entries.iter().flat_map(|(tag, kind, count, value)| entry(*tag, *kind, *count, *value, big)));
            bytes.extend(long(0));
            let pixels = decode("a.tif", &bytes, Use::Color).unwrap_or_else(|e| panic!("{e}")).image.pixels;
            let [black, red, blue, grey] = [[0, 0, 0, 255], [255, 0, 0, 255], [128, 64, 192, 255], [16, 32, 48, 255]];
            assert_eq!(pixels, Pixels::Rgba8 { srgb: true, texels: vec![black, red, blue, grey, blue, red] });
        }
    }

    #[test]
    fn what_looks_like_tga_has_its_size() {
        let tga = encoded(ImageBuffer::from_fn(4, 4, |x, y| Rgba([x as u8, y as u8, 0, 255])), ImageFormat::Tga);
        assert!(looks_like_tga(&tga));
        for other in [&b"hello, this is text that is long enough"[..], &[0; 64], &tga[..17], b""] {
            assert!(!looks_like_tga(other));
        }
        assert!(!looks_like_tga(&[&[0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 4, 24, 0][..], &[0; 100]].concat()));
    }

    #[test]
    fn broken_pictures_say_what_is_wrong() {
        let bytes = png(ImageBuffer::from_fn(8, 8, |x, y| Luma([(x * y) as u8])));
        assert!(decode("a.png", &bytes[..bytes.len() / 2], Use::Data).err().unwrap().contains("cannot be decoded"));
        assert!(decode("a.xyz", b"hello", Use::Data).err().unwrap().contains("not a picture of a known format"));
        // A PNG's width and height are four bytes each from byte 16; what follows them is not looked at.
        let mut huge = bytes.clone();
        huge[16..24].fill(0x7f);
        assert!(decode("a.png", &huge, Use::Data).is_err());
        assert!(
            decode("a.tga", &[&[0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 32, 8][..], &[0; 9]].concat(), Use::Data)
                .err()
                .unwrap()
                .contains("65535x65535 pixels, expected at most")
        );
        assert!(decode("a.avif", b"\0\0\0\x1cftypavif\0\0\0\0", Use::Color).err().unwrap().contains("is an AVIF, which is not read"));
        assert!(decode("a.exr", &[0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0], Use::Data).is_err());
    }

    #[test]
    fn normals_are_told_from_colours_and_greys() {
        let looks = |r: u8, g: u8, b: u8| {
            // A little relief.
            let tilted = |x: u32, y: u32| Rgba([r ^ (x as u8 * 16), g ^ (y as u8 * 16), b, 255]);
            looks_like_normals(&decode("a.png", &png(ImageBuffer::from_fn(2, 2, tilted)), Use::Data).unwrap().image)
        };
        assert!(looks(128, 128, 255));
        // Wood, plaster, the sky, and greys of which one is as long as a unit vector.
        for [r, g, b] in [[150, 100, 60], [220, 215, 200], [135, 206, 235], [128; 3], [201; 3], [255; 3]] {
            assert!(!looks(r, g, b), "{r} {g} {b}");
        }
    }

    #[test]
    fn radiance_pictures_are_read_by_either_signature() {
        let header = |signature: &str| format!("{signature}\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n");
        let picture = |signature: &str| [header(signature).as_bytes(), &[128, 64, 32, 129]].concat();
        let pixels = |signature| decode("a.hdr", &picture(signature), Use::Color).unwrap_or_else(|e| panic!("{e}")).image.pixels;
        assert_eq!(pixels("#?RGBE"), Pixels::RgbF32(vec![[1.0, 0.5, 0.25]]));
        assert_eq!(pixels("#?RADIANCE"), pixels("#?RGBE"));
        let claims = b"#?RGBE\n\n-Y 100000 +X 100000\n";
        assert!(decode("a.hdr", claims, Use::Color).err().unwrap().contains("pixels, expected at most"));
    }

    #[test]
    fn impossible_radiances_are_replaced_and_counted() {
        let mut bytes = b"PF\n1 1\n-1.0\n".to_vec();
        for v in [f32::NAN, f32::INFINITY, -1.0] {
            bytes.extend(v.to_le_bytes());
        }
        let decoded = decode("a.pfm", &bytes, Use::Color).unwrap();
        assert_eq!(decoded.image.pixels, Pixels::RgbF32(vec![[0.0, LARGEST_HALF, 0.0]]));
        assert!(decoded.note.unwrap().starts_with("3 values"));
    }
}

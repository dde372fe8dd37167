//! Pictures of a few pixels in every format that is read, and an image of V-Ray's.

use super::seed;
use crate::Seed;
use exr::prelude::{Image, SpecificChannels, WritableImage, f16};
use image::{DynamicImage, ImageFormat, RgbaImage};
use std::io::Cursor;

/// A picture of six pixels in every format; PNG first.
pub fn pictures() -> Vec<Seed> {
    let picture: DynamicImage = RgbaImage::from_fn(3, 2, |x, y| image::Rgba([80 * x as u8, 120 * y as u8, 7, 255 - x as u8])).into();
    let rgb = DynamicImage::from(picture.to_rgb8());
    let encoded = |picture: &DynamicImage, format| {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).expect("writing to memory cannot fail");
        bytes.into_inner()
    };
    let mut pfm = b"PF\n2 1\n-1.0\n".to_vec();
    pfm.extend([0.5f32, 1.0, 2.0, -1.0, 0.0, 3.0].iter().flat_map(|v| v.to_le_bytes()));
    vec![
        seed("rgba.png", encoded(&picture, ImageFormat::Png)),
        seed("grey.png", encoded(&picture.to_luma16().into(), ImageFormat::Png)),
        seed("rgb.jpg", encoded(&rgb, ImageFormat::Jpeg)),
        seed("rgb.bmp", encoded(&rgb, ImageFormat::Bmp)),
        seed("rgba.tga", encoded(&picture, ImageFormat::Tga)),
        seed("rgba.tif", encoded(&picture, ImageFormat::Tiff)),
        seed("floats.tif", encoded(&picture.to_rgb32f().into(), ImageFormat::Tiff)),
        seed("rgba.webp", encoded(&picture, ImageFormat::WebP)),
        seed("rgba.gif", encoded(&picture, ImageFormat::Gif)),
        seed("rgb.ppm", encoded(&rgb, ImageFormat::Pnm)),
        seed("dxt1.dds", dds(u32::from_le_bytes(*b"DXT1"), None)),
        seed("bc5.dds", dds(u32::from_le_bytes(*b"ATI2"), None)),
        seed("bc6.dds", dds(DX10, Some(95))),
        seed("bc7.dds", dds(DX10, Some(98))),
        seed("etc1s.ktx2", include_bytes!("../../../import/tests/ktx2/etc1s_alpha.ktx2")),
        seed("uastc.ktx2", include_bytes!("../../../import/tests/ktx2/uastc.ktx2")),
        seed("zstd.ktx2", include_bytes!("../../../import/tests/ktx2/uastc_alpha_zstd.ktx2")),
        seed("rgb.hdr", encoded(&picture.to_rgb32f().into(), ImageFormat::Hdr)),
        seed("rgb.exr", exr()),
        seed("rgb.pfm", pfm),
    ]
}

/// The code of a DDS whose format is given in the extension of its header.
const DX10: u32 = u32::from_le_bytes(*b"DX10");

/// A DDS of one block in a format by its code, and by its number in the extension.
fn dds(code: u32, dxgi: Option<u32>) -> Vec<u8> {
    let mut words = [0u32; 32];
    words[..5].copy_from_slice(&[u32::from_le_bytes(*b"DDS "), 124, 0x1007, 3, 2]);
    words[19..22].copy_from_slice(&[32, 4, code]);
    let extension = dxgi.into_iter().flat_map(|format| [format, 3, 0, 1, 0]);
    words.into_iter().chain(extension).flat_map(u32::to_le_bytes).chain((0..16u8).map(|i| i.wrapping_mul(37))).collect()
}

fn exr() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let pixel = |at: exr::prelude::Vec2<usize>| (f16::from_f32(at.x() as f32), f16::from_f32(at.y() as f32), f16::from_f32(0.5));
    Image::from_channels((3, 2), SpecificChannels::rgb(pixel)).write().to_buffered(&mut bytes).expect("writing to memory cannot fail");
    bytes.into_inner()
}

/// An image with two render elements: scan lines packed and plain.
#[cfg(feature = "program")]
pub fn vray_images() -> Vec<Seed> {
    use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes};
    let colors = ["R", "G", "B", "VRayNormals.X", "VRayNormals.Y", "VRayNormals.Z"];
    let mut channels: Vec<_> = colors.iter().map(|name| AnyChannel::new(*name, FlatSamples::F32(vec![0.5; 6]))).collect();
    channels.push(AnyChannel::new("VRayNodeID", FlatSamples::U32(vec![1, 2, 3, u32::MAX, 5, 6])));
    let image = |name: &str, encoding| {
        let layer = Layer::new((3, 2), LayerAttributes::default(), encoding, AnyChannels::sort(channels.clone().into()));
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layer(layer).write().to_buffered(&mut bytes).expect("writing to memory cannot fail");
        seed(name, bytes.into_inner())
    };
    vec![image("packed.exr", Encoding::SMALL_LOSSLESS), image("plain.exr", Encoding::UNCOMPRESSED)]
}

//! Procedural pictures: what surfaces look like up close.
//!
//! Every picture is a function of a seed. [`Paint`] says how many metres a picture covers, so that shapes, whose texture
//! coordinates are metres, show it at its true size.

mod backdrop;
mod books;
mod fabric;
mod noise;
mod painting;
mod plaster;
mod rug;
mod wood;

pub use backdrop::paint_surroundings;
pub use books::{BOOK_COLUMNS, BOOK_ROWS, book_spines};
pub use fabric::{knit, weave};
pub use painting::{PaintingStyle, painting};
pub use plaster::{plaster, stone};
pub use rug::{RugStyle, rug};
pub use wood::{FLOOR_STRIPS, WoodTone, floor_planks, wood};

use enfilade_math::{Rgb, Vec2, srgb_from_linear};
use enfilade_scene::{ColorParam, Image, Pixels, TextureRef};
use rayon::prelude::*;
use std::sync::LazyLock;

/// A picture of `width` × `height` pixels from a function of texture coordinates on `[0,1]²` (v upward) to linear reflectance.
pub fn paint(name: &str, width: u32, height: u32, color: impl Fn(Vec2) -> Rgb + Sync) -> Image {
    let texels = pixel_centers(width, height).map(|uv| {
        let c = color(uv);
        [encode(c.r), encode(c.g), encode(c.b), 255]
    });
    Image { name: name.into(), width, height, pixels: Pixels::Rgba8 { srgb: true, texels: texels.collect() } }
}

/// As [`paint`], but numbers on `[0,1]` kept linear: heights and roughness.
pub fn measure(name: &str, width: u32, height: u32, value: impl Fn(Vec2) -> f32 + Sync) -> Image {
    let texels = pixel_centers(width, height).map(|uv| {
        let v = (value(uv).clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        [v, v, v, 255]
    });
    Image { name: name.into(), width, height, pixels: Pixels::Rgba8 { srgb: false, texels: texels.collect() } }
}

fn pixel_centers(width: u32, height: u32) -> impl ParallelIterator<Item = Vec2> {
    let size = Vec2::new(width as f32, height as f32);
    (0..width * height).into_par_iter().map(move |i| {
        let center = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / size;
        Vec2::new(center.x, 1.0 - center.y)
    })
}

/// sRGB byte of a linear value; a table, because a picture has a million of them.
fn encode(linear: f32) -> u8 {
    static TABLE: LazyLock<Vec<u8>> =
        LazyLock::new(|| (0..=8192).map(|i| (srgb_from_linear(i as f32 / 8192.0) * 255.0 + 0.5) as u8).collect());
    TABLE[(linear.clamp(0.0, 1.0) * 8192.0 + 0.5) as usize]
}

/// An image and how many metres it covers.
#[derive(Clone, Copy, Debug)]
pub struct Paint {
    /// Index into the scene's images.
    pub image: u32,
    /// Metres across and up.
    pub covers: Vec2,
}

impl Paint {
    /// The texture for coordinates in metres.
    pub fn texture(self) -> TextureRef {
        let [u, v] = [1.0 / self.covers.x, 1.0 / self.covers.y];
        TextureRef { uv_transform: [[u, 0.0, 0.0], [0.0, v, 0.0]], ..TextureRef::new(self.image) }
    }

    /// The picture multiplied by `factor`.
    pub fn tinted(self, factor: Rgb) -> ColorParam {
        ColorParam { factor, texture: Some(self.texture()) }
    }
}

//! Procedural textures: what the surfaces of a home look like up close.
//!
//! Every picture is a function of a seed. [`Paint`] states how many metres a picture covers, so that shapes, whose texture
//! coordinates are metres, show it at its true size.

mod books;
mod fabric;
mod hide;
mod mark;
pub mod noise;
mod painting;
mod paper;
mod plaster;
mod rug;
mod stone;
mod tile;
mod wood;

pub use books::{BOOK_COLUMNS, BOOK_ROWS, book_spines};
pub use fabric::{Pattern, Weave, cotton, felt, knit, loops, pile, weave};
pub use hide::{cork, leather, wicker};
pub use mark::{Mark, mark, worn, worn_gloss};
pub use painting::{PaintingStyle, painting};
pub use paper::{Display, cardboard, display, leaf};
pub use plaster::{PaperPattern, rolled, trowelled, wallpaper};
pub use rug::{RugStyle, rug};
pub use stone::{SlabLook, brick, concrete, slab, terrazzo};
pub use tile::{TileFigure, TileLook, tiles};
pub use wood::{FLOOR_STRIPS, HERRINGBONE_M, WoodTone, floor_planks, herringbone, veneer};

use enfilade_math::{Rgb, Vec2, srgb_from_linear};
use enfilade_scene::{ColorParam, Image, Pixels, ScalarParam, TextureRef};
use std::sync::LazyLock;

/// A picture of `width` × `height` pixels from a function of texture coordinates on `[0,1]²` (v upward) to linear reflectance.
pub fn paint(name: &str, width: u32, height: u32, color: impl Fn(Vec2) -> Rgb + Sync) -> Image {
    let texels = of_pixels([width, height], |uv| {
        let c = color(uv);
        [encode(c.r), encode(c.g), encode(c.b), 255]
    });
    Image { name: name.into(), width, height, pixels: Pixels::Rgba8 { srgb: true, texels } }
}

/// Properties of a surface at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grain {
    /// Linear reflectance, or a factor of one.
    pub color: Rgb,
    /// GGX roughness on `[0,1]`.
    pub alpha: f32,
    /// Height as a share of the relief's depth, on `[0,1]`.
    pub height: f32,
}

/// The pictures of a surface.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Colour, with the roughness as opacity.
    pub color: Image,
    /// Heights.
    pub height: Image,
}

/// A surface of `width` × `height` pixels from a function of texture coordinates on `[0,1]²` (v upward).
pub fn skin(name: &str, [width, height]: [u32; 2], grain: impl Fn(Vec2) -> Grain + Sync) -> Skin {
    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let both = of_pixels([width, height], |uv| {
        let Grain { color: c, alpha, height } = grain(uv);
        ([encode(c.r), encode(c.g), encode(c.b), byte(alpha)], [byte(height), byte(height), byte(height), 255])
    });
    let (colors, heights) = both.into_iter().unzip();
    let image = |name: String, srgb, texels| Image { name, width, height, pixels: Pixels::Rgba8 { srgb, texels } };
    Skin { color: image(name.into(), true, colors), height: image(format!("{name} relief"), false, heights) }
}

/// A value at the middle of every pixel.
fn of_pixels<T: Send>([width, height]: [u32; 2], value: impl Fn(Vec2) -> T + Sync) -> Vec<T> {
    let size = Vec2::new(width as f32, height as f32);
    enfilade_parallel::map_up_to((width * height) as usize, |i| {
        let i = i as u32;
        let center = Vec2::new((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / size;
        value(Vec2::new(center.x, 1.0 - center.y))
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

    /// The opacity, which has the roughness of a [`Skin`], multiplied by `factor`.
    pub fn alpha(self, factor: f32) -> ScalarParam {
        ScalarParam { factor, texture: Some((self.texture(), 3)) }
    }

    /// The picture multiplied by `factor`.
    pub fn tinted(self, factor: Rgb) -> ColorParam {
        ColorParam { factor, texture: Some(self.texture()) }
    }
}

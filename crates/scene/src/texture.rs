//! Pictures and how they are read: wrapping, filtering, and the transform from a mesh's texture coordinates (v upward) to texels.

use enfilade_math::{Rgb, Vec2};
use serde::{Deserialize, Serialize};

/// A decoded picture. Row 0 is the top.
///
/// ```
/// use enfilade_math::{Rgb, Vec2};
/// use enfilade_scene::{Filter, Image, Pixels, TextureRef};
///
/// // Black and white side by side. Halfway between their centres bilinear filtering mixes them.
/// let pixels = Pixels::RgbF32(vec![[0.0; 3], [1.0; 3]]);
/// let image = Image { name: "stripes".into(), width: 2, height: 1, pixels };
/// let smooth = TextureRef::new(0);
/// assert_eq!(image.sample(&smooth, Vec2::new(0.5, 0.5)), (Rgb::splat(0.5), 1.0));
/// let sharp = TextureRef { filter: Filter::Nearest, ..smooth };
/// assert_eq!(image.sample(&sharp, Vec2::new(0.49, 0.5)).0, Rgb::BLACK);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// Source, for messages.
    pub name: String,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The texels, row by row.
    pub pixels: Pixels,
}

/// Texel storage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Pixels {
    /// Eight bits a channel, RGBA. `srgb` means that RGB are sRGB-encoded; alpha is always linear.
    Rgba8 {
        /// True for colours, false for data such as normals and roughness.
        srgb: bool,
        /// width × height texels.
        texels: Vec<[u8; 4]>,
    },
    /// Linear floating-point RGB, for environment maps and high-dynamic-range textures.
    RgbF32(Vec<[f32; 3]>),
}

/// How a texture continues outside the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The border texel continues.
    Clamp,
    /// The image repeats mirrored.
    Mirror,
}

/// How a texture is read between texel centres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Filter {
    /// Bilinear.
    #[default]
    Linear,
    /// The nearest texel.
    Nearest,
}

/// A use of an image: which, and how texture coordinates find their way into it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TextureRef {
    /// Index into `Scene::images`.
    pub image: u32,
    /// Rows of the affine map uv' = M (u, v, 1), applied in the mesh's convention (v upward).
    pub uv_transform: [[f32; 3]; 2],
    /// Wrapping along u and v.
    pub wrap: [Wrap; 2],
    /// Interpolation.
    pub filter: Filter,
}

impl TextureRef {
    /// The unmodified image: repeated, bilinear, coordinates unchanged.
    pub fn new(image: u32) -> Self {
        Self { image, uv_transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], wrap: [Wrap::Repeat; 2], filter: Filter::Linear }
    }

    /// Texture coordinates after the transform.
    #[inline]
    pub fn transform(&self, uv: Vec2) -> Vec2 {
        let row = |r: [f32; 3]| r[0] * uv.x + r[1] * uv.y + r[2];
        Vec2::new(row(self.uv_transform[0]), row(self.uv_transform[1]))
    }
}

impl Wrap {
    /// The texel of `n` along an axis that contains a texture coordinate.
    #[inline]
    pub fn nearest(self, coordinate: f32, n: u32) -> usize {
        self.index(floor(self.reduced(coordinate) * n as f32), n as i32)
    }

    /// The four texels of `n` along an axis around a texture coordinate, and its place between the middle two (0 at the second).
    #[inline]
    pub fn four(self, coordinate: f32, n: u32) -> ([usize; 4], f32) {
        let (first, share) = self.placed(coordinate, n);
        ([-1, 0, 1, 2].map(|i| self.index(first + i, n as i32)), share)
    }

    /// A texture coordinate as a place on the axis of `n` texels, and its neighbours: the texel whose centre is at or before it, the
    /// next one, and the share of the latter.
    #[inline]
    pub fn neighbours(self, coordinate: f32, n: u32) -> (usize, usize, f32) {
        let (first, share) = self.placed(coordinate, n);
        (self.index(first, n as i32), self.index(first + 1, n as i32), share)
    }

    /// The texel whose centre is at or before a texture coordinate, before it is wrapped, and the share of the next one.
    #[inline]
    fn placed(self, coordinate: f32, n: u32) -> (i32, f32) {
        let position = self.reduced(coordinate) * n as f32 - 0.5;
        let first = floor(position);
        (first, position - first as f32)
    }

    /// The coordinate within one period (repeat: [0,1], mirror: [0,2]) or, clamped, within [−1,2], so that it fits integers.
    #[inline]
    fn reduced(self, coordinate: f32) -> f32 {
        match self {
            Self::Repeat => coordinate - whole_part(coordinate),
            Self::Mirror => coordinate - 2.0 * whole_part(0.5 * coordinate),
            Self::Clamp => coordinate.clamp(-1.0, 2.0),
        }
    }

    /// The texel on 0..n for an integer up to two steps outside the range of [`Wrap::reduced`].
    #[inline]
    fn index(self, i: i32, n: i32) -> usize {
        (match self {
            // Of a single texel two steps lead back to it.
            Self::Repeat if i < 0 => (i + n).max(0),
            Self::Repeat if i >= n => (i - n).min(n - 1),
            Self::Repeat => i,
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let j = if i < 0 { i + 2 * n } else { i };
                let j = if j >= 2 * n { j - 2 * n } else { j };
                if j < n { j } else { 2 * n - 1 - j }
            }
        }) as usize
    }
}

/// ⌊v⌋ for |v| below 2³¹, without a call to the mathematics library.
#[inline]
fn floor(v: f32) -> i32 {
    let truncated = v as i32;
    truncated - i32::from(truncated as f32 > v)
}

/// ⌊v⌋ as a number; for huge values, which have no fraction, the value itself.
#[inline]
fn whole_part(v: f32) -> f32 {
    if v.abs() < 1e9 { floor(v) as f32 } else { v }
}

impl Image {
    /// Linear RGB and alpha of the texel in column `x`, row `y`.
    #[inline]
    pub fn texel(&self, x: usize, y: usize) -> (Rgb, f32) {
        self.at(y * self.width as usize + x)
    }

    #[inline]
    fn at(&self, index: usize) -> (Rgb, f32) {
        match &self.pixels {
            Pixels::Rgba8 { srgb, texels } => {
                let [r, g, b, a] = texels[index];
                let alpha = f32::from(a) * (1.0 / 255.0);
                if *srgb {
                    let table = srgb_table();
                    (Rgb::new(table[usize::from(r)], table[usize::from(g)], table[usize::from(b)]), alpha)
                } else {
                    (Rgb::new(f32::from(r), f32::from(g), f32::from(b)) * (1.0 / 255.0), alpha)
                }
            }
            Pixels::RgbF32(texels) => (Rgb::from(texels[index]), 1.0),
        }
    }

    /// Linear RGB and alpha at texture coordinates `uv` (v upward) of `texture`.
    #[inline]
    pub fn sample(&self, texture: &TextureRef, uv: Vec2) -> (Rgb, f32) {
        let uv = texture.transform(uv);
        let row_length = self.width as usize;
        // Rows count downward, v upward.
        let v = 1.0 - uv.y;
        if texture.filter == Filter::Nearest {
            return self.at(texture.wrap[1].nearest(v, self.height) * row_length + texture.wrap[0].nearest(uv.x, self.width));
        }
        let (left, right, fx) = texture.wrap[0].neighbours(uv.x, self.width);
        let (top, bottom, fy) = texture.wrap[1].neighbours(v, self.height);
        let (c00, a00) = self.at(top * row_length + left);
        let (c10, a10) = self.at(top * row_length + right);
        let (c01, a01) = self.at(bottom * row_length + left);
        let (c11, a11) = self.at(bottom * row_length + right);
        let (w00, w10, w01, w11) = ((1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy);
        (c00 * w00 + c10 * w10 + c01 * w01 + c11 * w11, a00 * w00 + a10 * w10 + a01 * w01 + a11 * w11)
    }
}

/// Linear values of the 256 sRGB codes.
fn srgb_table() -> &'static [f32; 256] {
    static TABLE: std::sync::LazyLock<[f32; 256]> =
        std::sync::LazyLock::new(|| std::array::from_fn(|i| enfilade_math::linear_from_srgb(i as f32 / 255.0)));
    &TABLE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_by_two() -> Image {
        let texels = vec![[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 0]];
        Image { name: "t".into(), width: 2, height: 2, pixels: Pixels::Rgba8 { srgb: false, texels } }
    }

    #[test]
    fn row_zero_is_the_top_and_v_points_up() {
        let t = TextureRef { filter: Filter::Nearest, ..TextureRef::new(0) };
        assert_eq!(two_by_two().sample(&t, Vec2::new(0.25, 0.75)).0, Rgb::new(1.0, 0.0, 0.0));
        assert_eq!(two_by_two().sample(&t, Vec2::new(0.75, 0.25)), (Rgb::WHITE, 0.0));
        assert_eq!(two_by_two().sample(&t, Vec2::new(1.25, -0.25)).0, Rgb::new(1.0, 0.0, 0.0));
    }

    #[test]
    fn bilinear_passes_through_texel_centres_and_averages_between() {
        let t = TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::new(0) };
        assert_eq!(two_by_two().sample(&t, Vec2::new(0.25, 0.75)).0, Rgb::new(1.0, 0.0, 0.0));
        let middle = two_by_two().sample(&t, Vec2::new(0.5, 0.5));
        assert_eq!(middle, (Rgb::splat(0.5), 0.75));
    }

    #[test]
    fn mirror_reflects_about_the_border() {
        assert_eq!([-1, 0, 1, 2, 3, 4].map(|i| Wrap::Mirror.index(i, 2)), [0, 0, 1, 1, 0, 0]);
        let at = |wrap: Wrap, u: f32| wrap.index(floor(wrap.reduced(u) * 4.0), 4);
        assert_eq!([-0.1, 0.1, 0.9, 1.1, 1.9, 2.1, -1.9].map(|u| at(Wrap::Mirror, u)), [0, 0, 3, 3, 0, 0, 0]);
    }

    #[test]
    fn coordinates_far_away_and_not_finite_stay_inside_the_image() {
        let image = two_by_two();
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for filter in [Filter::Linear, Filter::Nearest] {
                let t = TextureRef { wrap: [wrap; 2], filter, ..TextureRef::new(0) };
                for u in [0.0, 1.0, -1.0, 0.999_999_94, -1e-9, 2.0, 1e7, -3e9, 1e30, f32::MAX, f32::INFINITY, f32::NAN] {
                    let _ = image.sample(&t, Vec2::new(u, -u));
                }
            }
        }
    }
}

use enfilade_math::{Rgb, Vec2};
use serde::{Deserialize, Serialize};

/// A decoded picture. Row 0 is the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// Where it came from, for messages.
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
    /// Eight bits a channel, RGBA. `srgb` says that RGB are sRGB-encoded; alpha is always linear.
    Rgba8 {
        /// True for colours, false for data such as normals and roughness.
        srgb: bool,
        /// width × height texels.
        texels: Vec<[u8; 4]>,
    },
    /// Linear floating-point RGB, for environment maps and high-dynamic-range textures.
    RgbF32(Vec<[f32; 3]>),
}

/// What lies outside the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The border texel goes on.
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
    /// The image as it is: repeated, bilinear, coordinates unchanged.
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
    /// The texel index on 0..n for any integer.
    #[inline]
    fn index(self, i: i32, n: i32) -> usize {
        (match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let j = i.rem_euclid(2 * n);
                if j < n { j } else { 2 * n - 1 - j }
            }
        }) as usize
    }
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
        let (w, h) = (self.width as i32, self.height as i32);
        // Texture coordinates of millions of repeats lose their fraction; reduce first, so that the integers below fit.
        let reduce = |v: f32| if v.abs() < 1e6 { v } else { v.fract() };
        let (x, y) = (reduce(uv.x) * w as f32, (1.0 - reduce(uv.y)) * h as f32);
        let column = |x: i32| texture.wrap[0].index(x, w);
        let row = |y: i32| texture.wrap[1].index(y, h) * w as usize;
        if texture.filter == Filter::Nearest {
            return self.at(row(y.floor() as i32) + column(x.floor() as i32));
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let (left, right) = (column(x0 as i32), column(x0 as i32 + 1));
        let (top, bottom) = (row(y0 as i32), row(y0 as i32 + 1));
        let (c00, a00) = self.at(top + left);
        let (c10, a10) = self.at(top + right);
        let (c01, a01) = self.at(bottom + left);
        let (c11, a11) = self.at(bottom + right);
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
    }
}

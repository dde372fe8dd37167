//! A mip pyramid: a picture and its copies of half, a quarter and so on of its size, read with interpolation (Williams 1983).

use super::Footprint;
use enfilade_math::{Rgb, Vec2, Vec4, linear_from_srgb};
use enfilade_parallel::flat_map_up_to;
use enfilade_scene::{Filter, Image, Pixels, TextureRef};
use std::sync::LazyLock;

/// A picture with its levels.
#[derive(Debug)]
pub(super) struct Pyramid<'s> {
    full: Full<'s>,
    width: u32,
    height: u32,
    /// True when red, green and blue are the same everywhere.
    grey: bool,
    /// From half the size down to one texel.
    levels: Vec<Level>,
}

/// The picture itself.
#[derive(Clone, Copy, Debug)]
enum Full<'s> {
    /// Eight bits a channel and the values of their codes.
    Bytes(&'s [[u8; 4]], &'static [f32; 256]),
    Floats(&'s [[f32; 3]]),
}

/// A smaller copy.
#[derive(Debug)]
struct Level {
    width: u32,
    height: u32,
    texels: Texels,
}

#[derive(Debug)]
enum Texels {
    /// Linear, 65535 is one.
    Shorts(Vec<[u16; 4]>),
    Floats(Vec<[f32; 4]>),
}

/// Storage of the texels of a level in memory.
#[derive(Clone, Copy)]
enum Stored<'a> {
    Bytes(&'a [[u8; 4]], &'static [f32; 256]),
    Triples(&'a [[f32; 3]]),
    Shorts(&'a [[u16; 4]]),
    Floats(&'a [[f32; 4]]),
}

const SHORT: f32 = 65535.0;

impl<'s> Pyramid<'s> {
    /// A picture without smaller copies.
    pub fn single(image: &'s Image) -> Self {
        let (full, grey) = match &image.pixels {
            Pixels::Rgba8 { srgb, texels } => {
                (Full::Bytes(texels, if *srgb { &SRGB } else { &LINEAR }), texels.iter().all(|t| t[0] == t[1] && t[1] == t[2]))
            }
            Pixels::RgbF32(texels) => (Full::Floats(texels), false),
        };
        Self { full, width: image.width, height: image.height, grey, levels: Vec::new() }
    }

    /// A picture with all levels. `cut_out`: colours count by their alpha, so that what is cut away does not stain the rest.
    pub fn new(image: &'s Image, cut_out: bool) -> Self {
        let mut pyramid = Self::single(image);
        let (mut width, mut height) = (image.width, image.height);
        while width > 1 || height > 1 {
            let level = pyramid.halved(pyramid.levels.len(), width, height, cut_out);
            (width, height) = (level.width, level.height);
            pyramid.levels.push(level);
        }
        pyramid
    }

    /// The level after `level`, which has `width` × `height` texels.
    fn halved(&self, level: usize, width: u32, height: u32, cut_out: bool) -> Level {
        let (w, h) = ((width / 2).max(1), (height / 2).max(1));
        let row = |y: usize| {
            (0..w).map(move |x| {
                let (mut color, mut plain, mut alpha, mut total) = (Vec4::ZERO, Vec4::ZERO, 0.0, 0.0);
                for (j, wy) in covered(y as u32, height, h) {
                    for (i, wx) in covered(x, width, w) {
                        let (texel, weight) = (self.texel(level, (j * width + i) as usize), wx * wy);
                        plain += texel * weight;
                        color += texel * (weight * texel.w);
                        alpha += weight * texel.w;
                        total += weight;
                    }
                }
                let mean = if cut_out && alpha > 0.0 { color / alpha } else { plain / total };
                mean.truncate().extend(alpha / total).to_array()
            })
        };
        let texels = match self.full {
            Full::Bytes(..) => Texels::Shorts(flat_map_up_to(h as usize, |y| row(y).map(|t| t.map(|v| (v * SHORT + 0.5) as u16)))),
            Full::Floats(_) => Texels::Floats(flat_map_up_to(h as usize, row)),
        };
        Level { width: w, height: h, texels }
    }

    /// Linear RGBA of a texel of a level by its number.
    #[inline]
    fn texel(&self, level: usize, index: usize) -> Vec4 {
        let [texel] = self.texels(level, [index]);
        texel
    }

    /// Texels of a level along both axes.
    #[inline]
    fn size(&self, level: usize) -> (u32, u32) {
        if level == 0 { (self.width, self.height) } else { (self.levels[level - 1].width, self.levels[level - 1].height) }
    }

    /// The finer of the two levels whose texels are about the footprint's size, and how much of the other to take.
    #[inline]
    fn level(&self, texture: &TextureRef, footprint: &Footprint) -> (usize, f32) {
        let m = texture.uv_transform;
        let determinant = (m[0][0] * m[1][1] - m[0][1] * m[1][0]).abs();
        // In texels of level 0.
        let area = footprint.area * determinant * self.width as f32 * self.height as f32;
        if area.is_nan() || area <= 1.0 {
            return (0, 0.0);
        }
        // Half of the binary exponent.
        let exponent = (area.to_bits() >> 23) as usize - 127;
        let level = exponent / 2;
        if level >= self.levels.len() {
            return (self.levels.len(), 0.0);
        }
        if !footprint.sharp {
            return (level, 0.0);
        }
        (level, area.sqrt() / (1u64 << level) as f32 - 1.0)
    }

    /// Linear RGB and alpha at texture coordinates `uv` (v upward) of `texture`.
    #[inline]
    pub fn sample(&self, texture: &TextureRef, uv: Vec2, footprint: &Footprint) -> Vec4 {
        let (level, blend) = self.level(texture, footprint);
        let uv = texture.transform(uv);
        let at = Vec2::new(uv.x, 1.0 - uv.y);
        let fine = self.read(level, texture, at);
        if blend > 0.0 { fine.lerp(self.read(level + 1, texture, at), blend) } else { fine }
    }

    /// A level at the place `at`, whose second coordinate counts downward.
    #[inline]
    fn read(&self, level: usize, texture: &TextureRef, at: Vec2) -> Vec4 {
        let (width, height) = self.size(level);
        if level == 0 && texture.filter == Filter::Nearest {
            let (x, y) = (texture.wrap[0].nearest(at.x, width), texture.wrap[1].nearest(at.y, height));
            return self.texel(0, y * width as usize + x);
        }
        let (left, right, fx) = texture.wrap[0].neighbours(at.x, width);
        let (top, bottom, fy) = texture.wrap[1].neighbours(at.y, height);
        let (top, bottom) = (top * width as usize, bottom * width as usize);
        let [a, b, c, d] = self.texels(level, [top + left, top + right, bottom + left, bottom + right]);
        let upper = a * (1.0 - fx) + b * fx;
        let lower = c * (1.0 - fx) + d * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// Derivatives of the luminance by the texture's own coordinates (v upward) at `uv`, which the texture's transform has not met.
    #[inline]
    pub fn slope(&self, texture: &TextureRef, uv: Vec2, footprint: &Footprint) -> Vec2 {
        let (level, blend) = self.level(texture, footprint);
        let uv = texture.transform(uv);
        let at = Vec2::new(uv.x, 1.0 - uv.y);
        let fine = self.slope_of(level, texture, at);
        if blend > 0.0 { fine.lerp(self.slope_of(level + 1, texture, at), blend) } else { fine }
    }

    /// Central differences over one texel each way, interpolated between texel centres.
    fn slope_of(&self, level: usize, texture: &TextureRef, at: Vec2) -> Vec2 {
        let (width, height) = self.size(level);
        let (columns, fx) = texture.wrap[0].four(at.x, width);
        let (rows, fy) = texture.wrap[1].four(at.y, height);
        let ([x0, x1, x2, x3], [y0, y1, y2, y3]) = (columns, rows);
        let [y0, y1, y2, y3] = [y0 * width as usize, y1 * width as usize, y2 * width as usize, y3 * width as usize];
        // Of four by four texels without the corners.
        #[rustfmt::skip]
        let at = [
                     y0 + x1, y0 + x2,
            y1 + x0, y1 + x1, y1 + x2, y1 + x3,
            y2 + x0, y2 + x1, y2 + x2, y2 + x3,
                     y3 + x1, y3 + x2,
        ];
        let [a1, a2, b0, b1, b2, b3, c0, c1, c2, c3, d1, d2] = self.luminances(level, at);
        let between = |a: f32, b: f32, share: f32| a * (1.0 - share) + b * share;
        let by_column = between(between(b2 - b0, b3 - b1, fx), between(c2 - c0, c3 - c1, fx), fy);
        let by_row = between(between(c1 - a1, c2 - a2, fx), between(d1 - b1, d2 - b2, fx), fy);
        Vec2::new(0.5 * by_column * width as f32, -0.5 * by_row * height as f32)
    }

    /// How a level is stored: asked once for all texels that are read together.
    #[inline]
    fn stored(&self, level: usize) -> Stored<'_> {
        match (self.full, level.checked_sub(1).map(|level| &self.levels[level].texels)) {
            (Full::Bytes(texels, values), None) => Stored::Bytes(texels, values),
            (Full::Floats(texels), None) => Stored::Triples(texels),
            (_, Some(Texels::Shorts(texels))) => Stored::Shorts(texels),
            (_, Some(Texels::Floats(texels))) => Stored::Floats(texels),
        }
    }

    /// See [`Pyramid::texel`].
    #[inline]
    fn texels<const N: usize>(&self, level: usize, at: [usize; N]) -> [Vec4; N] {
        match self.stored(level) {
            Stored::Bytes(texels, values) => at.map(|i| of_bytes(texels[i], values)),
            Stored::Triples(texels) => at.map(|i| of_floats(texels[i])),
            Stored::Shorts(texels) => at.map(|i| of_shorts(texels[i])),
            Stored::Floats(texels) => at.map(|i| Vec4::from_array(texels[i])),
        }
    }

    /// Luminances of texels of a level by their numbers.
    #[inline]
    fn luminances<const N: usize>(&self, level: usize, at: [usize; N]) -> [f32; N] {
        match self.stored(level) {
            Stored::Bytes(texels, values) if self.grey => at.map(|i| values[usize::from(texels[i][0])]),
            Stored::Shorts(texels) if self.grey => at.map(|i| f32::from(texels[i][0]) * (1.0 / SHORT)),
            _ => self.texels(level, at).map(|t| Rgb::new(t.x, t.y, t.z).luminance()),
        }
    }
}

#[inline]
fn of_bytes(texel: [u8; 4], values: &[f32; 256]) -> Vec4 {
    let [r, g, b, a] = texel;
    let value = |code: u8| values[usize::from(code)];
    Vec4::new(value(r), value(g), value(b), f32::from(a) * (1.0 / 255.0))
}

#[inline]
fn of_floats([r, g, b]: [f32; 3]) -> Vec4 {
    Vec4::new(r, g, b, 1.0)
}

#[inline]
fn of_shorts([r, g, b, a]: [u16; 4]) -> Vec4 {
    Vec4::new(f32::from(r), f32::from(g), f32::from(b), f32::from(a)) * (1.0 / SHORT)
}

/// The texels of `n` that texel `i` of `m` ≤ `n` covers, and how much of each.
fn covered(i: u32, n: u32, m: u32) -> impl Iterator<Item = (u32, f32)> + Clone {
    // In units of 1/(n·m) of the picture.
    let [i, n, m] = [i, n, m].map(u64::from);
    let (from, to) = (i * n, (i + 1) * n);
    (from / m..to.div_ceil(m)).map(move |j| (j as u32, (to.min((j + 1) * m) - from.max(j * m)) as f32))
}

/// Values of the 256 codes, sRGB-encoded and linear.
static SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| linear_from_srgb(i as f32 / 255.0)));
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| i as f32 / 255.0));

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;
    use enfilade_scene::Wrap;

    fn picture(width: u32, height: u32, srgb: bool) -> Image {
        let mut rng = Rng::new(u64::from(width));
        let texels = (0..width * height).map(|_| rng.next_u64().to_le_bytes()[..4].try_into().unwrap()).collect();
        Image { name: "t".into(), width, height, pixels: Pixels::Rgba8 { srgb, texels } }
    }

    fn mean(pyramid: &Pyramid<'_>, level: usize) -> Vec4 {
        let (w, h) = pyramid.size(level);
        (0..w * h).map(|i| pyramid.texel(level, i as usize)).sum::<Vec4>() / (w * h) as f32
    }

    #[test]
    fn every_level_has_the_mean_of_the_linear_picture() {
        for (width, height) in [(64, 64), (37, 5), (1, 9), (100, 33)] {
            let image = picture(width, height, true);
            let pyramid = Pyramid::new(&image, false);
            let expected = mean(&pyramid, 0);
            for level in 1..=pyramid.levels.len() {
                let error = (mean(&pyramid, level) - expected).abs().max_element();
                assert!(error < 1e-4, "{width}x{height}, level {level}: off by {error}");
            }
            assert_eq!(pyramid.size(pyramid.levels.len()), (1, 1));
        }
    }

    #[test]
    fn points_are_read_as_from_the_picture() {
        let image = picture(16, 8, true);
        let pyramid = Pyramid::new(&image, false);
        let mut rng = Rng::new(2);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for filter in [Filter::Linear, Filter::Nearest] {
                let texture = TextureRef { wrap: [wrap; 2], filter, ..TextureRef::new(0) };
                for _ in 0..100 {
                    let uv = Vec2::new(rng.next_f32(), rng.next_f32()) * 3.0 - 1.0;
                    let ((rgb, a), ours) = (image.sample(&texture, uv), pyramid.sample(&texture, uv, &Footprint::POINT));
                    assert!((Rgb::new(ours.x, ours.y, ours.z) - rgb).max_component() < 1e-5 && (ours.w - a).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn a_wide_footprint_reads_the_mean_and_the_blend_has_no_steps() {
        let image = picture(32, 32, true);
        let pyramid = Pyramid::new(&image, false);
        let texture = TextureRef::new(0);
        let read = |area: f32| pyramid.sample(&texture, Vec2::splat(0.3), &Footprint { area, sharp: true });
        assert!((read(1.0) - mean(&pyramid, 0)).abs().max_element() < 1e-4);
        for level in 0..6 {
            let area = 4f32.powi(level) / 1024.0;
            assert!((read(area * 0.9999) - read(area * 1.0001)).abs().max_element() < 1e-3, "level {level}");
        }
        for area in [f32::INFINITY, f32::NAN, f32::MAX] {
            let _ = read(area);
        }
    }

    #[test]
    fn what_is_cut_away_does_not_stain_the_rest() {
        let texels = vec![[255, 0, 0, 255], [0, 255, 0, 0], [0, 255, 0, 0], [0, 255, 0, 0]];
        let image = Image { name: "t".into(), width: 2, height: 2, pixels: Pixels::Rgba8 { srgb: false, texels } };
        let pyramid = Pyramid::new(&image, true);
        assert!((pyramid.texel(1, 0) - Vec4::new(1.0, 0.0, 0.0, 0.25)).abs().max_element() < 1e-4);
    }

    #[test]
    fn slopes_are_the_differences_of_readings() {
        let mut image = picture(16, 8, false);
        if let Pixels::Rgba8 { texels, .. } = &mut image.pixels {
            texels.iter_mut().for_each(|t| *t = [t[0], t[0], t[0], 255]);
        }
        let pyramid = Pyramid::new(&image, false);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            let texture = TextureRef { wrap: [wrap; 2], ..TextureRef::new(0) };
            for at in [Vec2::new(0.43, 0.21), Vec2::new(0.99, 0.02), Vec2::new(0.0, 1.0)] {
                let h = |d: Vec2| image.sample(&texture, at + d).0.g;
                let (dx, dy) = (Vec2::new(1.0 / 16.0, 0.0), Vec2::new(0.0, 1.0 / 8.0));
                let expected = Vec2::new((h(dx) - h(-dx)) * 8.0, (h(dy) - h(-dy)) * 4.0);
                let found = pyramid.slope(&texture, at, &Footprint::POINT);
                assert!((found - expected).length() < 1e-3, "{wrap:?} at {at}: {found}, expected {expected}");
            }
        }
    }
}

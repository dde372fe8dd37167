//! The environment (the sky): a constant or a latitude–longitude map, sampled in proportion to luminance × solid angle.

use enfilade_math::{Distribution2, Mat3, Rgb, Vec2, Vec3, warp};
use enfilade_scene::{Environment, Image, MapRows, Pixels, TextureRef, Wrap, direction_from_uv, uv_from_direction};
use half::f16;
use std::f32::consts::PI;
use std::sync::Arc;

/// The environment with its sampling distribution.
#[derive(Debug)]
pub(super) struct Sky<'s> {
    light: SkyLight<'s>,
    irradiance: f32,
}

#[derive(Debug)]
enum SkyLight<'s> {
    Constant { radiance: Rgb },
    Map(Box<SkyMap<'s>>),
}

#[derive(Debug)]
struct SkyMap<'s> {
    image: &'s Image,
    /// The image's texels as sixteen-bit numbers, if all fit exactly, as in most files: lookups are spread over the sky and wait for
    /// memory, and this halves its size.
    halves: Option<Vec<[u16; 3]>>,
    texture: TextureRef,
    rows: MapRows,
    scale: Rgb,
    map_from_world: Mat3,
    distribution: Distribution2,
}

impl<'s> Sky<'s> {
    /// `None` when it is black everywhere.
    pub fn new(environment: &Environment, images: &'s [Arc<Image>]) -> Option<Self> {
        let light = match environment {
            Environment::Constant { radiance } => (!radiance.is_black()).then_some(SkyLight::Constant { radiance: *radiance })?,
            Environment::Map { image, rows, scale, map_from_world } => {
                let image = &images[*image as usize];
                let (weights, columns) = cell_weights(image, *scale);
                let distribution = Distribution2::new(&weights, columns)?;
                let texture = TextureRef { wrap: [Wrap::Repeat, Wrap::Clamp], ..TextureRef::new(0) };
                let (rows, scale, map_from_world) = (*rows, *scale, *map_from_world);
                SkyLight::Map(Box::new(SkyMap { image, halves: halves(image), texture, rows, scale, map_from_world, distribution }))
            }
        };
        let mut sky = Self { light, irradiance: 0.0 };
        sky.irradiance = sky.mean_luminance() * PI;
        Some(sky)
    }

    /// About the irradiance of a surface in the open, as a luminance.
    pub fn irradiance(&self) -> f32 {
        self.irradiance
    }

    /// Radiance in the unit direction `d`.
    #[inline]
    pub fn radiance(&self, d: Vec3) -> Rgb {
        match &self.light {
            SkyLight::Constant { radiance } => *radiance,
            SkyLight::Map(map) => {
                let uv = uv_from_direction(map.map_from_world * d);
                let down = map.rows.place(uv.y, map.image.height);
                map.scale * map.read(Vec2::new(uv.x, down))
            }
        }
    }

    /// Mean over 64 directions.
    fn mean_luminance(&self) -> f32 {
        let directions = 64;
        (0..directions).map(|k| self.radiance(warp::fibonacci_sphere(k, directions).as_vec3()).luminance()).sum::<f32>() / directions as f32
    }

    /// A direction in proportion to brightness, and its density per solid angle.
    pub fn sample(&self, u: [f32; 2]) -> Option<(Vec3, f32)> {
        match &self.light {
            SkyLight::Constant { .. } => Some((warp::sphere(u), 0.25 / PI)),
            SkyLight::Map(map) => {
                let (uv, density) = map.distribution.sample(u);
                let sin_theta = (uv[1] * PI).sin();
                let direction = map.map_from_world.transpose() * direction_from_uv(Vec2::from(uv));
                (density > 0.0 && sin_theta > 0.0).then(|| (direction, density / (2.0 * PI * PI * sin_theta)))
            }
        }
    }

    /// Density of [`Sky::sample`].
    #[inline]
    pub fn pdf(&self, d: Vec3) -> f32 {
        match &self.light {
            SkyLight::Constant { .. } => 0.25 / PI,
            SkyLight::Map(map) => {
                let d = map.map_from_world * d;
                let uv = uv_from_direction(d);
                // Near the poles the cosine rounds to one before the sine is zero.
                let sin_theta = (d.x * d.x + d.z * d.z).sqrt();
                if sin_theta <= 0.0 { 0.0 } else { map.distribution.pdf(uv.to_array()) / (2.0 * PI * PI * sin_theta) }
            }
        }
    }
}

impl SkyMap<'_> {
    /// Interpolates between the texels around `at`, whose second coordinate counts downward.
    #[inline]
    fn read(&self, at: Vec2) -> Rgb {
        let Some(halves) = &self.halves else { return self.image.sample(&self.texture, Vec2::new(at.x, 1.0 - at.y)).0 };
        let (left, right, fx) = self.texture.wrap[0].neighbours(at.x, self.image.width);
        let (top, bottom, fy) = self.texture.wrap[1].neighbours(at.y, self.image.height);
        let width = self.image.width as usize;
        let row = |row: usize| {
            let [left, right] = [left, right].map(|column| Rgb::from(halves[row * width + column].map(positive)));
            left * (1.0 - fx) + right * fx
        };
        row(top) * (1.0 - fy) + row(bottom) * fy
    }
}

/// The texels as numbers of sixteen bits; `None` unless that changes none of them.
fn halves(image: &Image) -> Option<Vec<[u16; 3]>> {
    let Pixels::RgbF32(texels) = &image.pixels else { return None };
    let half = |value: f32| Some(f16::from_f32(value).to_bits()).filter(|&bits| positive(bits) == value);
    texels.iter().map(|&[r, g, b]| Some([half(r)?, half(g)?, half(b)?])).collect()
}

/// The value of a half-precision number that is neither negative nor infinite.
#[inline]
fn positive(bits: u16) -> f32 {
    // The bits at their places in single precision, whose exponents begin 112 lower.
    const UP: f32 = f32::from_bits((127 + 112) << 23);
    f32::from_bits(u32::from(bits) << 13) * UP
}

/// Columns of the sampling grid (rows: half as many). The coarse one stays in a core's cache, which is worth more than its
/// loss of detail, unless a sun or a lamp fills so little of the sky that most samples of a coarse cell would miss it.
const COARSE: usize = 512;
const FINE: usize = 1024;

/// The fraction of all light in a single coarse cell beyond which the fine grid is used.
const CONCENTRATED: f32 = 0.02;

/// Luminance × solid angle of each cell of the sampling grid, and its number of columns.
fn cell_weights(image: &Image, scale: Rgb) -> (Vec<f32>, usize) {
    let texels = texel_weights(image, scale);
    let coarse = pooled(&texels, image, COARSE);
    let brightest = coarse.0.iter().fold(0.0f32, |m, &w| m.max(w));
    if brightest > CONCENTRATED * coarse.0.iter().sum::<f32>() { pooled(&texels, image, FINE) } else { coarse }
}

/// Sums of texel weights over the cells of a grid of at most `limit` columns.
fn pooled(texels: &[f32], image: &Image, limit: usize) -> (Vec<f32>, usize) {
    let (w, h) = (image.width as usize, image.height as usize);
    let (columns, rows) = (w.min(limit), h.min(limit / 2));
    let mut cells = vec![0.0; columns * rows];
    for (i, weight) in texels.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        for (row, of_row) in overlaps(i / w, h, rows) {
            for (column, of_column) in overlaps(i % w, w, columns) {
                cells[row * columns + column] += weight * of_row * of_column;
            }
        }
    }
    (cells, columns)
}

/// The cells that texel `i` of `texels` overlaps, at most two if there are no more `cells` than texels, with its fraction in each.
fn overlaps(i: usize, texels: usize, cells: usize) -> impl Iterator<Item = (usize, f32)> {
    let first = i * cells / texels;
    let inside = ((first + 1) * texels - i * cells).min(cells) as f32 / cells as f32;
    std::iter::once((first, inside)).chain((inside < 1.0).then_some((first + 1, 1.0 - inside)))
}

/// Luminance × solid angle of each texel, smeared over the neighbours, because lookups interpolate between texels: wherever
/// radiance is positive, so must be the density. Rows from pole to pole are less than one row off the cells: the neighbours cover that.
fn texel_weights(image: &Image, scale: Rgb) -> Vec<f32> {
    let (w, h) = (image.width as usize, image.height as usize);
    let luminance: Vec<f32> = (0..w * h).map(|i| (scale * image.texel(i % w, i / w).0).luminance().max(0.0)).collect();
    (0..w * h)
        .map(|i| {
            let (x, y) = (i % w, i / w);
            let mut sum = 0.0;
            for (dy, row_weight) in [(0usize, 1.0), (1, 2.0), (2, 1.0)] {
                let row = (y + dy).saturating_sub(1).min(h - 1) * w;
                sum += row_weight * (luminance[row + (x + w - 1) % w] + 2.0 * luminance[row + x] + luminance[row + (x + 1) % w]);
            }
            sum * ((y as f32 + 0.5) / h as f32 * PI).sin()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;
    use enfilade_testkit::ChiSquare;

    #[test]
    fn a_map_of_halves_is_the_same_sky_in_half_of_the_memory() {
        let mut rng = Rng::new(5);
        let half = |v: f32| f16::from_f32(v).to_f32();
        let mut texels: Vec<[f32; 3]> = (0..512).map(|_| [0.0f32; 3].map(|_| half(rng.next_f32().powi(20) * 6e4))).collect();
        texels[0] = [0.0, f16::MIN_POSITIVE_SUBNORMAL.to_f32(), f16::MAX.to_f32()];
        let image = |texels| [Arc::new(Image { name: "sky".into(), width: 32, height: 16, pixels: Pixels::RgbF32(texels) })];
        let packed = image(texels.clone());
        assert_eq!(halves(&packed[0]).expect("all are halves").concat().into_iter().map(positive).collect::<Vec<_>>(), texels.concat());
        let map = Environment::Map { image: 0, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world: Mat3::IDENTITY };
        let sky = Sky::new(&map, &packed).unwrap();
        // One texel that is no half, of others that are not changed by it.
        texels[511][0] += 1e-3;
        for wrong in [texels.clone(), [vec![[f32::INFINITY; 3]], texels[1..].to_vec()].concat(), vec![[-0.5; 3]; 512]] {
            assert!(halves(&image(wrong)[0]).is_none());
        }
        let floats = image(texels);
        let plain = Sky::new(&map, &floats).unwrap();
        for _ in 0..1000 {
            let d = warp::sphere([rng.next_f32(), rng.next_f32()]);
            let (a, b) = (sky.radiance(d), plain.radiance(d));
            // The place between two texels is rounded in another way.
            let off = (a - b).map(f32::abs).max_component();
            assert!(off <= 1e-5 * f16::MAX.to_f32(), "{d}: {a:?}, {b:?}");
        }
    }

    #[test]
    fn directions_near_the_zenith_have_density() {
        let images = [Image { name: "sky".into(), width: 8, height: 4, pixels: Pixels::RgbF32(vec![[1.0; 3]; 32]) }.into()];
        let map = Environment::Map { image: 0, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world: Mat3::IDENTITY };
        let sky = Sky::new(&map, &images).unwrap();
        for angle in [1e-3f32, 1e-4, 1e-6] {
            assert!(sky.pdf(Vec3::new(angle, 1.0, 0.0)) > 0.0, "{angle} rad from the zenith");
        }
    }

    #[test]
    fn a_bright_texel_is_seen_in_its_row_and_sampled_wherever_it_shines() {
        let (width, height, x, y) = (64u32, 32u32, 40u32, 3u32);
        let mut texels = vec![[0.0; 3]; (width * height) as usize];
        texels[(y * width + x) as usize] = [1.0; 3];
        let images = [Image { name: "sky".into(), width, height, pixels: Pixels::RgbF32(texels) }.into()];
        for (rows, v) in [(MapRows::Bands, (y as f32 + 0.5) / height as f32), (MapRows::PoleToPole, y as f32 / (height as f32 - 1.0))] {
            let map = Environment::Map { image: 0, rows, scale: Rgb::WHITE, map_from_world: Mat3::IDENTITY };
            let sky = Sky::new(&map, &images).unwrap();
            let u = (x as f32 + 0.5) / width as f32;
            let at = |du: f32, dv: f32| direction_from_uv(Vec2::new(u + du / width as f32, v + dv / height as f32));
            assert!((sky.radiance(at(0.0, 0.0)).g - 1.0).abs() < 1e-4, "{rows:?}");
            for k in 0..400 {
                let d = at((k % 20) as f32 / 9.5 - 1.0, (k / 20) as f32 / 9.5 - 1.0);
                assert!(sky.pdf(d) > 0.0 || sky.radiance(d).is_black(), "{rows:?} {d}");
            }
        }
    }

    #[test]
    fn a_texel_across_two_cells_has_density_in_both() {
        for width in [1500u32, 3000] {
            let height = width / 2;
            for x in 5..15 {
                let (x, y) = (width / 2 + x, height / 3 + x);
                let mut texels = vec![[0.0; 3]; (width * height) as usize];
                texels[(y * width + x) as usize] = [1e4; 3];
                let images = [Image { name: "sun".into(), width, height, pixels: Pixels::RgbF32(texels) }.into()];
                let map = Environment::Map { image: 0, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world: Mat3::IDENTITY };
                let sky = Sky::new(&map, &images).unwrap();
                for k in 0..400 {
                    let place = |i: u32, k: i32| {
                        (i as f32 + 0.5 + (k as f32 / 9.5 - 1.0) * 0.98) / if i == x { width as f32 } else { height as f32 }
                    };
                    let d = direction_from_uv(Vec2::new(place(x, k % 20), place(y, k / 20)));
                    assert!(sky.pdf(d) > 0.0 || sky.radiance(d).is_black(), "{width}: {x}, {k}");
                }
            }
        }
    }

    #[test]
    fn directions_of_a_map_follow_its_brightness() {
        let (width, height) = (64u32, 32u32);
        let mut rng = Rng::new(9);
        let texels = (0..width * height).map(|_| [rng.next_f32().powi(8) * 10.0; 3]).collect();
        let images = [Image { name: "sky".into(), width, height, pixels: Pixels::RgbF32(texels) }.into()];
        let map_from_world = Mat3::from_rotation_x(-1.0) * Mat3::from_rotation_z(0.4);
        let sky = Sky::new(&Environment::Map { image: 0, rows: MapRows::Bands, scale: Rgb::WHITE, map_from_world }, &images).unwrap();
        let place = |d: Vec3| uv_from_direction(map_from_world * d).to_array();
        let test = ChiSquare::square(
            400_000,
            |u| sky.sample([u[0], u[1]]).map(|(d, _)| place(d)),
            |uv| sky.pdf(map_from_world.transpose() * direction_from_uv(Vec2::from(uv))) * 2.0 * PI * PI * (uv[1] * PI).sin(),
        );
        test.assert("environment map", 1);
        // And wherever there is light, however faint, there is density.
        for _ in 0..10_000 {
            let d = warp::sphere([rng.next_f32(), rng.next_f32()]);
            assert!(sky.pdf(d) > 0.0 || sky.radiance(d).is_black());
        }
    }
}

//! Infinite lights to environments.
//!
//! Both versions have z up in the light's own space. Version 3's pictures are equirectangular: across by the azimuth from +x towards +y,
//! down by the polar angle. Version 4's are squares onto which the sphere is mapped with equal areas (Clarberg 2008, "Fast Equal-Area
//! Mapping of the (Hemi)Sphere using SIMD"): the upper hemisphere within the diamond that joins the middles of the edges, the lower one
//! folded out into the corners. These are resampled into equirectangular ones.

use super::params::Params;
use super::reader::Reader;
use super::version::Version;
use crate::ImportError;
use crate::assembly::Source;
use enfilade_math::{DMat3, DVec3, Rgb, Vec2};
use enfilade_scene::{Environment, Image, MapRows, Pixels, direction_from_uv};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// From the space of our maps (y up, azimuth from −z towards +x) to the space of pbrt's lights (z up, azimuth from +x towards +y).
pub(crate) const PBRT_FROM_MAP: DMat3 = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::NEG_X);

/// Rows of a resampled map at most.
const MAX_ROWS: u32 = 2048;

/// Samples along each side of a texel of a resampled map.
const SUBSAMPLES: u32 = 3;

impl Reader<'_> {
    /// Sets the environment of an infinite light.
    pub(super) fn infinite(&mut self, params: &Params) -> Result<(), ImportError> {
        if params.has("portal") {
            self.warn(&params.place, "the portal was dropped; the surroundings shine from everywhere");
        }
        let strength = self.emitted(params, "L")?;
        let illuminance = params.float_or("illuminance", -1.0)?;
        let path = params.string("mapname")?.or(params.string("filename")?).filter(|p| !p.is_empty());
        let place = params.place.text();
        let Some(path) = path else {
            let factor = if illuminance > 0.0 { illuminance / PI } else { 1.0 };
            self.a.set_environment(Environment::Constant { radiance: strength * factor as f32 }, &place);
            return Ok(());
        };
        let Some(mut image) = self.a.light_image(&Source::File(path), &place)? else { return Ok(()) };
        let mut scale = strength;
        if self.version == Version::V4 {
            let source = self.a.image_at(image);
            if source.width != source.height {
                let problem = format!(
                    "{path} has {}x{} pixels, expected a square in pbrt-v4's equal-area layout; convert it by imgtool makeequiarea",
                    source.width, source.height
                );
                return Err(params.place.error(problem));
            }
            if illuminance > 0.0 {
                let own = upper_illuminance(source);
                scale *= if own > 0.0 { illuminance / own } else { 1.0 } as f32;
            }
            let resampled = equirectangular(source);
            image = self.a.push_image(resampled);
        }
        let file_from_map = (self.file_from_world * self.state.ctm).matrix3 * PBRT_FROM_MAP;
        self.a.set_environment_map(image, MapRows::Bands, scale, file_from_map, &place);
        Ok(())
    }
}

/// The place in the equal-area square, from its upper left corner, of a unit direction with z up.
fn square_from_direction(d: DVec3) -> [f64; 2] {
    let r = (1.0 - d.z.abs()).max(0.0).sqrt();
    let share = d.y.abs().atan2(d.x.abs()) / FRAC_PI_2;
    let (mut u, mut v) = (r - share * r, share * r);
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    [0.5 * (1.0 + u.copysign(d.x)), 0.5 * (1.0 + v.copysign(d.y))]
}

fn texel_at(image: &Image, [u, v]: [f64; 2]) -> Rgb {
    let index = |c: f64, n: u32| ((c * f64::from(n)) as usize).min(n as usize - 1);
    image.texel(index(u, image.width), index(v, image.height)).0
}

/// The equal-area square as an equirectangular picture in the space of our maps.
fn equirectangular(source: &Image) -> Image {
    let height = source.height.clamp(2, MAX_ROWS);
    let width = 2 * height;
    // Large sources are sampled more densely, so that no texel of theirs is missed.
    let n = SUBSAMPLES * source.height.div_ceil(height);
    let mut texels = Vec::with_capacity(width as usize * height as usize);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let mut sum = Rgb::BLACK;
        let mut total = 0.0;
        for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
            let at = |a: u32, b: u32, size: u32| (a as f32 + (b as f32 + 0.5) / n as f32) / size as f32;
            let uv = Vec2::new(at(x, i, width), at(y, j, height));
            let weight = (uv.y * std::f32::consts::PI).sin();
            sum += texel_at(source, square_from_direction(PBRT_FROM_MAP * direction_from_uv(uv).as_dvec3())) * weight;
            total += weight;
        }
        texels.push((sum * (1.0 / total)).to_array());
    }
    Image { name: format!("{} (equirectangular)", source.name), width, height, pixels: Pixels::RgbF32(texels) }
}

/// The illuminance of the upper hemisphere of an equal-area square on a floor.
fn upper_illuminance(image: &Image) -> f64 {
    let rows = 256u32;
    let mut sum = 0.0;
    for (j, i) in (0..rows).flat_map(|j| (0..4 * rows).map(move |i| (j, i))) {
        // Even in the square of the sine, which is even in cos·dω.
        let sin2 = (f64::from(j) + 0.5) / f64::from(rows);
        let phi = (f64::from(i) + 0.5) / f64::from(4 * rows) * TAU;
        let d = DVec3::new(phi.cos() * sin2.sqrt(), phi.sin() * sin2.sqrt(), (1.0 - sin2).sqrt());
        sum += f64::from(texel_at(image, square_from_direction(d)).luminance());
    }
    sum * PI / f64::from(4 * rows * rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::uv_from_direction;

    #[test]
    fn axes_lie_where_the_equal_area_map_has_them() {
        let cases = [
            (DVec3::Z, [0.5, 0.5]),
            (DVec3::X, [1.0, 0.5]),
            (DVec3::NEG_X, [0.0, 0.5]),
            (DVec3::Y, [0.5, 1.0]),
            (DVec3::NEG_Y, [0.5, 0.0]),
        ];
        for (d, expected) in cases {
            let found = square_from_direction(d);
            assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-12), "{d}: {found:?}");
        }
        let down = square_from_direction(DVec3::NEG_Z);
        assert!(down.iter().all(|c| *c == 0.0 || *c == 1.0), "{down:?}");
    }

    /// The upper hemisphere is 3, the lower one 1.
    #[test]
    fn resampled_maps_keep_their_light_where_it_was() {
        let n = 64u32;
        let mut texels = Vec::new();
        for (y, x) in (0..n).flat_map(|y| (0..n).map(move |x| (y, x))) {
            let [u, v] = [x, y].map(|c| (2.0 * (f64::from(c) + 0.5) / f64::from(n) - 1.0).abs());
            texels.push([if u + v < 1.0 { 3.0f32 } else { 1.0 }; 3]);
        }
        // Every texel of the square has the same solid angle.
        let own_mean = texels.iter().map(|t| f64::from(t[0])).sum::<f64>() / f64::from(n * n);
        let source = Image { name: "sky".into(), width: n, height: n, pixels: Pixels::RgbF32(texels) };
        let map = equirectangular(&source);
        let at = |d: DVec3| {
            let uv = uv_from_direction((PBRT_FROM_MAP.transpose() * d).as_vec3());
            map.texel((uv.x * map.width as f32) as usize, ((uv.y * map.height as f32) as usize).min(map.height as usize - 1)).0.r
        };
        assert_eq!((at(DVec3::new(0.1, 0.0, 0.99)), at(DVec3::new(0.3, -0.2, -0.9))), (3.0, 1.0));
        let mut mean = 0.0;
        let mut total = 0.0;
        for y in 0..map.height {
            let weight = ((f64::from(y) + 0.5) / f64::from(map.height) * PI).sin();
            for x in 0..map.width {
                mean += weight * f64::from(map.texel(x as usize, y as usize).0.r);
                total += weight;
            }
        }
        assert!((mean / total / own_mean - 1.0).abs() < 2e-3, "{} instead of {own_mean}", mean / total);
        assert!((upper_illuminance(&source) - 3.0 * PI).abs() < 0.05, "{}", upper_illuminance(&source));
    }
}

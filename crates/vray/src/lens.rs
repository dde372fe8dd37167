//! Non-parametric lens distortion, as Hypersim's toolkit gives it to V-Ray: a picture that bends the rays of a pinhole.
//!
//! The picture has (2H + 1) × (2W + 1) texels, so that the centre of every pixel is the centre of a texel, and so is every corner. Red
//! and green of a texel are the place (u, v) in the pinhole's image, on [0, 1] from the lower left corner, that shows what the texel's
//! ray sees. The pinhole's field of view is wider than the rays by 0.1°, and rounded to 7 decimals, because scenes are written with
//! as many: its exact value is then known, and the picture is made for it.

use crate::error::VrayError;
use enfilade_scene::Projection;

/// Margin of the field of view.
const MARGIN_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;
/// Decimals of a number in a scene.
const DECIMALS: f64 = 1e7;
/// Texels at most: more come of a mistaken image size.
const MAX_TEXELS: u64 = 1 << 28;

/// The picture of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct LensPicture {
    /// Horizontal field of view of the pinhole, radians.
    pub fov_x_rad: f64,
    /// Columns and rows.
    pub size: [u32; 2],
    /// (u, v) of the texels, row by row from the top.
    pub uv: Vec<[f32; 2]>,
}

impl LensPicture {
    /// The picture of a projection.
    ///
    /// # Errors
    /// Says why there is none: cameras that see to the side or behind are bent pinholes of no width, and neither is one that shows
    /// nothing at a corner.
    pub(crate) fn new(projection: &Projection) -> Result<Self, VrayError> {
        let wrong = |found: String| VrayError::usage(found, "choose a pinhole, radial_tangential or a grid of rays as camera model");
        if !projection.has_image_plane() {
            return Err(wrong("V-Ray's scene has no form for this camera, which sees to the side or behind".into()));
        }
        let image = projection.size();
        let size = image.map(|n| 2 * u64::from(n) + 1);
        if size[0] * size[1] > MAX_TEXELS {
            return Err(wrong(format!(
                "the lens of an image of {}x{} pixels would have {}x{} texels",
                image[0], image[1], size[0], size[1]
            )));
        }
        let [columns, rows] = size;
        let slope = |i: u64| {
            let (x, y) = (0.5 * (i % columns) as f64, 0.5 * (i / columns) as f64);
            let ray = projection.ray(x, y).filter(|ray| ray.z < 0.0 && ray.is_finite());
            let ray = ray.ok_or_else(|| wrong(format!("the camera sees nothing at the image point ({x}, {y})")))?;
            Ok([ray.x / -ray.z, ray.y / -ray.z])
        };
        let slopes: Vec<[f64; 2]> = (0..columns * rows).map(slope).collect::<Result<_, VrayError>>()?;
        let aspect = f64::from(image[1]) / f64::from(image[0]);
        let widest = slopes.iter().fold(0.0, |most: f64, [x, y]| most.max(x.abs()).max(y.abs() / aspect));
        let fov_x_rad = ((2.0 * widest.atan() + MARGIN_RAD) * DECIMALS).round() / DECIMALS;
        let (tan_x, tan_y) = ((0.5 * fov_x_rad).tan(), aspect * (0.5 * fov_x_rad).tan());
        let place = |&[x, y]: &[f64; 2]| [(0.5 + 0.5 * x / tan_x) as f32, (0.5 + 0.5 * y / tan_y) as f32];
        Ok(Self { fov_x_rad, size: size.map(|n| n as u32), uv: slopes.iter().map(place).collect() })
    }

    /// The picture as an OpenEXR file of red, green and blue in float32, without compression; blue is 0.
    ///
    /// It is written here, because the same picture must give the same bytes, which the library's order of attributes does not.
    pub fn to_exr(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let mut out = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
        let mut attribute = |name: &str, kind: &str, value: &[u8]| {
            [name.as_bytes(), &[0], kind.as_bytes(), &[0], &(value.len() as u32).to_le_bytes(), value].iter().for_each(|b| out.extend(*b));
        };
        // Name, float32, not for perception, and one sample per pixel both ways.
        let channel = |name: u8| [[name, 0].as_slice(), &2u32.to_le_bytes(), &[0; 4], &1u32.to_le_bytes(), &1u32.to_le_bytes()].concat();
        attribute("channels", "chlist", &[channel(b'B'), channel(b'G'), channel(b'R'), vec![0]].concat());
        attribute("compression", "compression", &[0]);
        let window: Vec<u8> = [0, 0, width - 1, height - 1].iter().flat_map(|v| v.to_le_bytes()).collect();
        attribute("dataWindow", "box2i", &window);
        attribute("displayWindow", "box2i", &window);
        attribute("lineOrder", "lineOrder", &[0]);
        attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
        attribute("screenWindowCenter", "v2f", &[0; 8]);
        attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
        out.push(0);
        let row_bytes = 12 * width as usize;
        let first = out.len() + 8 * height as usize;
        let starts = (0..height as usize).map(|row| (first + row * (8 + row_bytes)) as u64);
        out.extend(starts.flat_map(u64::to_le_bytes));
        for (y, row) in self.uv.chunks(width as usize).enumerate() {
            out.extend((y as u32).to_le_bytes());
            out.extend((row_bytes as u32).to_le_bytes());
            out.extend(std::iter::repeat_n(0, 4 * width as usize));
            out.extend(row.iter().flat_map(|uv| uv[1].to_le_bytes()));
            out.extend(row.iter().flat_map(|uv| uv[0].to_le_bytes()));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;
    use enfilade_scene::{Intrinsics, RadialTangential, RayGrid};

    /// The ray that V-Ray's pinhole shoots for the image point of a texel.
    fn ray(picture: &LensPicture, aspect: f64, texel: usize) -> DVec3 {
        let tan = (0.5 * picture.fov_x_rad).tan();
        let [u, v] = picture.uv[texel].map(|t| 2.0 * f64::from(t) - 1.0);
        DVec3::new(u * tan, v * tan * aspect, -1.0)
    }

    #[test]
    fn the_identity_is_a_pinhole_within_a_wider_one() {
        let fov = 45.0f64.to_radians();
        let picture = LensPicture::new(&Projection::Pinhole(Intrinsics::from_fov_x(1024, 768, fov))).unwrap();
        assert_eq!(picture.size, [2049, 1537]);
        let expected = (45.1f64.to_radians() * 1e7).round() / 1e7;
        assert_eq!(picture.fov_x_rad, expected);
        let corner = 0.5 * (1.0 - (0.5 * fov).tan() / (0.5 * expected).tan());
        let [u, v] = picture.uv[0];
        assert!((f64::from(u) - corner).abs() < 1e-7 && (f64::from(v) - (1.0 - corner)).abs() < 1e-7, "upper left: {u} {v}");
        assert_eq!(picture.uv[2049 * 768 + 1024], [0.5, 0.5]);
    }

    #[test]
    fn every_texel_gives_its_ray_whatever_the_camera() {
        let k = Intrinsics { cx: 30.0, ..Intrinsics::from_fov_x(64, 48, 1.2) };
        let bent = RadialTangential::new(&[-0.1, 0.02, 1e-3, 0.0]).unwrap();
        let rays: Vec<DVec3> = (0..97 * 129).map(|i| k.ray(0.5 * f64::from(i % 129), 0.5 * f64::from(i / 129)) * 3.0).collect();
        let grid = RayGrid::new(64, 48, 97, 129, &rays).unwrap();
        for projection in [Projection::Pinhole(k), Projection::RadialTangential(k, bent), Projection::RayGrid(grid)] {
            let picture = LensPicture::new(&projection).unwrap();
            assert!(picture.uv.iter().flatten().all(|v| (0.0..=1.0).contains(v)));
            for texel in [0, 128, 40 * 129 + 71, 96 * 129, 96 * 129 + 128] {
                let (x, y) = (0.5 * (texel % 129) as f64, 0.5 * (texel / 129) as f64);
                let off = ray(&picture, 0.75, texel) - projection.ray(x, y).unwrap();
                assert!(off.length() < 1e-6, "({x}, {y}) is off by {off}");
            }
        }
        let panorama = Projection::Equirectangular { width: 64, height: 32 };
        assert!(LensPicture::new(&panorama).unwrap_err().to_string().contains("sees to the side"));
        let giant = Projection::Pinhole(Intrinsics::from_fov_x(60_000, 60_000, 1.0));
        assert!(LensPicture::new(&giant).unwrap_err().to_string().contains("120001x120001 texels"));
    }

    #[test]
    fn the_file_is_an_exr_of_the_numbers() {
        let picture = LensPicture::new(&Projection::Pinhole(Intrinsics::from_fov_x(6, 4, 1.0))).unwrap();
        let image = exr::prelude::read_first_rgba_layer_from_file;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lens.exr");
        std::fs::write(&path, picture.to_exr()).unwrap();
        let put = |pixels: &mut Vec<[f32; 3]>, at: exr::math::Vec2<usize>, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.1 * 13 + at.0] = [r, g, b];
        };
        let read = image(&path, |size: exr::math::Vec2<usize>, _: &_| vec![[9.0f32; 3]; size.area()], put).unwrap();
        let expected: Vec<[f32; 3]> = picture.uv.iter().map(|&[u, v]| [u, v, 0.0]).collect();
        assert_eq!(read.layer_data.channel_data.pixels, expected);
    }
}

//! The camera of a page: as the page sends it, and as a checked pinhole camera that rays start from.

use super::planned::rows;
use enfilade_geometry::PinholeRays;
use enfilade_math::{Bounds3, DMat3, DVec3, Ray, Vec3};
use serde::Deserialize;

/// Pixels per side that a request may ask about.
const MAX_SIDE: u32 = 8192;
/// Coordinates beyond this are a mistake, metres.
const MAX_COORDINATE_M: f64 = 1e6;

/// A camera as the page sends it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraRequest {
    position: [f64; 3],
    orientation: [f64; 9],
    fov_y_deg: f64,
    width: u32,
    height: u32,
    /// Near plane: what is nearer along the optical axis is not seen, metres.
    #[serde(default)]
    near_m: f64,
    /// Box outside of which nothing is seen.
    #[serde(default)]
    clip: Option<Clip>,
}

/// A box along the axes of the world, metres.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Clip {
    min: [f32; 3],
    max: [f32; 3],
}

/// A pinhole camera in world space, with the size of its image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageCamera {
    position: DVec3,
    world_from_camera: DMat3,
    /// Half the height of the image at distance 1.
    half_height: f64,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Near plane: what is nearer along the optical axis is not seen, metres.
    pub near_m: f64,
    /// Box outside of which nothing is seen.
    pub clip: Option<Bounds3>,
}

impl CameraRequest {
    /// The camera, if it is one.
    ///
    /// # Errors
    /// Which number is wrong, and what was expected.
    pub fn check(&self) -> Result<PageCamera, String> {
        let wrong = |field: &str, found: String, expected: &str| Err(format!("camera.{field} is {found}; expected {expected}"));
        let position = DVec3::from_array(self.position);
        if !position.is_finite() || position.abs().max_element() > MAX_COORDINATE_M {
            return wrong("position", position.to_string(), "three finite numbers, metres");
        }
        let m = rows(&self.orientation);
        let error = (m * m.transpose() - DMat3::IDENTITY).to_cols_array().iter().fold(0.0f64, |max, v| max.max(v.abs()));
        if !m.is_finite() || !error.is_finite() || error > 1e-3 || m.determinant() < 0.0 {
            return wrong("orientation", format!("{:?}", self.orientation), "a rotation, world from camera, row by row");
        }
        if !(1.0..=170.0).contains(&self.fov_y_deg) {
            return wrong("fov_y_deg", self.fov_y_deg.to_string(), "1 to 170");
        }
        for (field, pixels) in [("width", self.width), ("height", self.height)] {
            if !(1..=MAX_SIDE).contains(&pixels) {
                return wrong(field, pixels.to_string(), "1 to 8192 pixels");
            }
        }
        if !(0.0..=MAX_COORDINATE_M).contains(&self.near_m) {
            return wrong("near_m", self.near_m.to_string(), "zero or more metres");
        }
        let clip = self.clip.map(|clip| Bounds3 { min: Vec3::from(clip.min), max: Vec3::from(clip.max) });
        if let Some(Bounds3 { min, max }) = clip.filter(|clip| !clip.min.cmple(clip.max).all()) {
            return wrong("clip", format!("{min} to {max}"), "min at most max, metres");
        }
        let camera = PageCamera::new(position, m, self.fov_y_deg, [self.width, self.height]);
        Ok(PageCamera { near_m: self.near_m, clip, ..camera })
    }
}

impl PageCamera {
    /// A pinhole at `position` with a vertical field of view.
    pub fn new(position: DVec3, world_from_camera: DMat3, fov_y_deg: f64, [width, height]: [u32; 2]) -> Self {
        Self { position, world_from_camera, half_height: (0.5 * fov_y_deg.to_radians()).tan(), width, height, near_m: 0.0, clip: None }
    }

    /// Half of the smaller field of view, radians.
    pub fn half_angle(&self) -> f32 {
        let aspect = f64::from(self.width) / f64::from(self.height);
        (self.half_height * aspect.min(1.0)).atan() as f32
    }

    /// The rays of the pixels from column `x` and row `y` on.
    pub fn rays(&self, x: u32, y: u32) -> PinholeRays {
        let pixel = 2.0 * self.half_height / f64::from(self.height);
        let m = &self.world_from_camera;
        let (right, down) = (m.x_axis * pixel, -m.y_axis * pixel);
        let (from_left, from_top) = (f64::from(x) + 0.5 - 0.5 * f64::from(self.width), f64::from(y) + 0.5 - 0.5 * f64::from(self.height));
        let corner = -m.z_axis + right * from_left + down * from_top;
        PinholeRays { origin: self.position.as_vec3(), corner: corner.as_vec3(), right: right.as_vec3(), down: down.as_vec3() }
    }

    /// The point that is seen at the image point (x, y) at a depth along the optical axis.
    pub fn point(&self, x: f64, y: f64, depth_m: f64) -> DVec3 {
        self.position + self.through(x, y) * depth_m
    }

    /// The direction through an image point, of length 1 along the optical axis.
    fn through(&self, x: f64, y: f64) -> DVec3 {
        let pixel = 2.0 * self.half_height / f64::from(self.height);
        let m = &self.world_from_camera;
        let right = m.x_axis * (pixel * (x - 0.5 * f64::from(self.width)));
        let down = m.y_axis * (pixel * (0.5 * f64::from(self.height) - y));
        right + down - m.z_axis
    }

    /// The ray through the image point (x, y), counted from the image's corner; its direction is a unit vector.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let through = self.through(x, y);
        let ray = Ray::new(self.position.as_vec3(), through.normalize().as_vec3());
        Ray { t_min: ray.t_min.max((self.near_m * through.length()) as f32), ..ray }
    }
}

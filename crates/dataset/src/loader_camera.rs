//! The camera that loaders written for Hypersim assume, and their errors for other cameras.
//!
//! Marigold's preprocessing, GeoWizard's and ZoeDepth's loaders compute planar depth from `depth_meters` with a pinhole of 1024 × 768 pixels
//! and a focal length of 886.81 pixels, whatever camera the dataset's tables describe.

use enfilade_math::quantile;
use enfilade_scene::Camera;

/// Size of the images, pixels.
pub const LOADER_SIZE: [u32; 2] = [1024, 768];

/// Focal length, pixels: 60 degrees across the width.
pub const LOADER_FOCAL_PX: f64 = 886.81;

/// Relative errors of planar depth up to this are due to a rounded focal length.
const EXACT: f64 = 1e-3;

/// Distance of tested pixels along both axes, pixels.
const STRIDE: usize = 8;

/// Planar depth by a loader of Hypersim, from the distance of a pixel whose centre is at (x, y); both in the same unit.
///
/// ```
/// use enfilade_dataset::loader_depth;
///
/// assert!((loader_depth([512.0, 384.0], 2.0) - 2.0).abs() < 1e-12);
/// assert!(loader_depth([0.5, 0.5], 2.0) < 1.7);
/// ```
pub fn loader_depth([x, y]: [f64; 2], distance: f64) -> f64 {
    let [width, height] = LOADER_SIZE.map(f64::from);
    let (x, y) = (x - 0.5 * width, y - 0.5 * height);
    distance * LOADER_FOCAL_PX / (x * x + y * y + LOADER_FOCAL_PX * LOADER_FOCAL_PX).sqrt()
}

/// The error that loaders of Hypersim make with a camera, in words; `None` for the camera that they assume.
pub fn loader_problem(camera: &Camera) -> Option<String> {
    let [width, height] = camera.size();
    let make = "preset = \"hypersim\" takes pictures with the camera that they expect";
    if [width, height] != LOADER_SIZE {
        let [w, h] = LOADER_SIZE;
        return Some(format!("images are {width} x {height}: loaders that take Hypersim's {w} x {h} for granted cannot read them; {make}"));
    }
    let error = |x: usize, y: usize| {
        let [x, y] = [x, y].map(|i| i as f64 + 0.5);
        let ray = camera.projection.ray(x, y)?;
        Some((loader_depth([x, y], ray.length()) / -ray.z - 1.0).abs())
    };
    let rows = (0..height as usize).step_by(STRIDE);
    let mut errors: Vec<f64> = rows.flat_map(|y| (0..width as usize).step_by(STRIDE).filter_map(move |x| error(x, y))).collect();
    let [median, worst] = [0.5, 1.0].map(|share| 100.0 * quantile(&mut errors, share).unwrap_or(f64::INFINITY));
    (worst.is_nan() || worst > 100.0 * EXACT).then(|| {
        format!(
            "planar depth by loaders that take Hypersim's focal length of {LOADER_FOCAL_PX} px for granted is wrong by {median:.1} % in the \
             median, {worst:.1} % at worst: take depth_z_meters, or the calibration; {make}"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Intrinsics;

    fn problem(width: u32, height: u32, fov_x_deg: f64) -> Option<String> {
        loader_problem(&Intrinsics::from_fov_x(width, height, fov_x_deg.to_radians()).into())
    }

    #[test]
    fn hypersims_camera_is_what_its_loaders_expect() {
        assert_eq!(problem(1024, 768, 60.0), None);
    }

    #[test]
    fn what_goes_wrong_with_another_is_told() {
        let wide = problem(1024, 768, 74.0).unwrap();
        assert!(wide.contains("wrong by 4.7 % in the median") && wide.contains("depth_z_meters"), "{wide}");
        assert!(problem(320, 240, 60.0).unwrap().contains("320 x 240"));
    }
}

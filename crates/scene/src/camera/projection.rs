//! The camera models under one name: which direction belongs to an image point, and which image point to a camera-space point.

use super::{CameraError, Fisheye, Intrinsics, RadialTangential, RayGrid, TiltedPinhole};
use enfilade_math::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Image size, and which direction belongs to which image point.
///
/// ```
/// use enfilade_math::DVec3;
/// use enfilade_scene::{Fisheye, Intrinsics, Projection};
///
/// // A panorama sees everything, a pinhole only what is in front of it.
/// let behind = DVec3::new(0.5, 0.0, 1.0);
/// let panorama = Projection::Equirectangular { width: 360, height: 180 };
/// assert!(panorama.project(behind).is_some());
/// let k = Intrinsics::from_fov_x(64, 48, 1.0);
/// assert!(Projection::Pinhole(k).project(behind).is_none());
/// let (x, y) = panorama.project(DVec3::X).unwrap();
/// assert!((x - 270.0).abs() < 1e-9 && (y - 90.0).abs() < 1e-9, "90 degrees to the right of the middle");
///
/// // `project` inverts `ray` for every model.
/// let fisheye = Projection::Fisheye(k, Fisheye::new([-0.01, 0.002, 0.0, 0.0]).unwrap());
/// let (x, y) = fisheye.project(2.0 * fisheye.ray(10.5, 20.5).unwrap()).unwrap();
/// assert!((x - 10.5).abs() < 1e-9 && (y - 20.5).abs() < 1e-9);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Projection {
    /// K alone; with an off-centre principal point also a shifted lens.
    Pinhole(Intrinsics),
    /// A pinhole with a tilted image plane.
    TiltedPinhole(TiltedPinhole),
    /// K after OpenCV's radial and tangential distortion.
    RadialTangential(Intrinsics, RadialTangential),
    /// K after OpenCV's fisheye model.
    Fisheye(Intrinsics, Fisheye),
    /// All around: longitude along x, latitude along y. The image's middle looks forward, its upper border up.
    Equirectangular {
        /// Pixels per row, of 360 degrees.
        width: u32,
        /// Rows, of 180 degrees.
        height: u32,
    },
    /// A table of rays.
    RayGrid(RayGrid),
}

impl Projection {
    /// Image width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Pinhole(k) | Self::RadialTangential(k, _) | Self::Fisheye(k, _) => [k.width, k.height],
            Self::TiltedPinhole(tilted) => tilted.size(),
            Self::Equirectangular { width, height } => [*width, *height],
            Self::RayGrid(grid) => grid.size(),
        }
    }

    /// True for cameras that see only what is in front of them: their [`Projection::ray`] has z = −1, and a plane can be in focus.
    pub fn has_image_plane(&self) -> bool {
        !matches!(self, Self::Fisheye(..) | Self::Equirectangular { .. })
    }

    /// True when straight lines stay straight: `M_cam_from_uv` and `M_proj` describe the camera completely.
    pub fn is_linear(&self) -> bool {
        matches!(self, Self::Pinhole(_) | Self::TiltedPinhole(_))
    }

    /// Direction through the image point (x, y) in camera space: with z = −1 for cameras with an image plane, else of unit length.
    /// `None` where the picture shows nothing, as outside of a fisheye's image circle. Points beyond the image's border are allowed.
    #[inline]
    pub fn ray(&self, x: f64, y: f64) -> Option<DVec3> {
        match self {
            Self::Pinhole(k) => Some(k.ray(x, y)),
            Self::TiltedPinhole(tilted) => Some(tilted.ray(x, y)),
            Self::RadialTangential(k, distortion) => {
                // OpenCV's y points down.
                let q = k.ray(x, y);
                let p = distortion.undistort(DVec2::new(q.x, -q.y))?;
                Some(DVec3::new(p.x, -p.y, -1.0))
            }
            Self::Fisheye(k, fisheye) => fisheye.direction(k.ray(x, y).truncate()),
            Self::Equirectangular { width, height } => {
                let (sin_lon, cos_lon) = (TAU * (x / f64::from(*width) - 0.5)).sin_cos();
                let (sin_lat, cos_lat) = (PI * (0.5 - y / f64::from(*height))).sin_cos();
                Some(DVec3::new(cos_lat * sin_lon, sin_lat, -cos_lat * cos_lon))
            }
            Self::RayGrid(grid) => Some(grid.ray(x, y)),
        }
    }

    /// The viewing axis of K in camera space, unit length: planar depth that goes with K is measured along it. It is −z except for a tilted
    /// image plane, whose K belongs to a turned camera ([`TiltedPinhole::straightened`]).
    pub fn image_axis(&self) -> DVec3 {
        match self {
            Self::TiltedPinhole(tilted) => tilted.straightened().1.transpose() * DVec3::NEG_Z,
            _ => DVec3::NEG_Z,
        }
    }

    /// Image point of a camera-space point. `None` for points that no image point shows; the result may be beyond the image's border.
    pub fn project(&self, p_camera: DVec3) -> Option<(f64, f64)> {
        let in_front = p_camera.z < 0.0;
        if self.has_image_plane() && !in_front {
            return None;
        }
        match self {
            Self::Pinhole(k) => Some(k.project(p_camera)),
            Self::TiltedPinhole(tilted) => tilted.project(p_camera),
            Self::RadialTangential(k, distortion) => {
                let q = distortion.distort(DVec2::new(p_camera.x, -p_camera.y) / -p_camera.z)?;
                Some(k.project(DVec3::new(q.x, -q.y, -1.0)))
            }
            Self::Fisheye(k, fisheye) => Some(k.project(fisheye.project(p_camera)?.extend(-1.0))),
            Self::Equirectangular { width, height } => {
                let (lon, lat) = (p_camera.x.atan2(-p_camera.z), p_camera.y.atan2(p_camera.x.hypot(p_camera.z)));
                Some((f64::from(*width) * (lon / TAU + 0.5), f64::from(*height) * (0.5 - lat / PI)))
            }
            Self::RayGrid(grid) => grid.project(p_camera),
        }
    }

    /// Distance in pixels between the image points `a` and `b`, which are near each other: the way around the seam of a panorama
    /// counts where it is shorter, and its rows shrink toward the poles.
    pub fn image_distance(&self, a: (f64, f64), b: (f64, f64)) -> f64 {
        let (dx, dy) = (a.0 - b.0, a.1 - b.1);
        match self {
            Self::Equirectangular { width, height } => {
                let width = f64::from(*width);
                let around = dx - width * (dx / width).round();
                (around * (PI * (0.5 - b.1 / f64::from(*height))).cos()).hypot(dy)
            }
            _ => dx.hypot(dy),
        }
    }

    /// The horizontal field of view, in radians, at most `limit`.
    pub fn fov_x_rad(&self, limit: f64) -> f64 {
        let [width, height] = self.size().map(f64::from);
        let fov = match self {
            Self::Pinhole(k) if k.cx == 0.5 * width => k.fov_x_rad(),
            Self::Equirectangular { .. } => TAU,
            _ => {
                // Where the picture ends before the image border, the first ray inward is used.
                let side = |from: f64| (0..=64).find_map(|i| self.ray(from + (0.5 * width - from) * f64::from(i) / 64.0, 0.5 * height));
                let angle = |ray: Option<DVec3>| ray.map_or(0.0, |r| r.x.atan2(-r.z));
                angle(side(width)) - angle(side(0.0))
            }
        };
        fov.min(limit)
    }

    pub(super) fn validate(&self) -> Result<(), CameraError> {
        let [width, height] = self.size();
        if width == 0 || height == 0 {
            return Err(CameraError::new("image", format!("{width}x{height}"), "at least one pixel"));
        }
        if let Self::Pinhole(k) | Self::RadialTangential(k, _) | Self::Fisheye(k, _) = self {
            let finite = [k.fx, k.fy, k.cx, k.cy, k.skew].iter().all(|v| v.is_finite());
            if !(finite && k.fx > 0.0 && k.fy > 0.0) {
                let found = format!("fx {}, fy {}, cx {}, cy {}, skew {}", k.fx, k.fy, k.cx, k.cy, k.skew);
                return Err(CameraError::new("calibration", found, "finite numbers and focal lengths above 0"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use enfilade_math::DMat3;

    /// One of each model, over 64 × 48 pixels.
    pub(crate) fn models() -> Vec<Projection> {
        let k = Intrinsics { width: 64, height: 48, fx: 50.0, fy: 52.0, cx: 30.5, cy: 25.0, skew: 0.7 };
        let grid: Vec<DVec3> =
            (0..7 * 9).map(|i| k.ray(f64::from(i % 9) * 8.0, f64::from(i / 9) * 8.0)).map(|r| r + r * r * 0.03).collect();
        vec![
            Projection::Pinhole(k),
            Projection::TiltedPinhole(TiltedPinhole::new(64, 48, DMat3::from_rotation_x(0.2) * k.cam_from_uv()).unwrap()),
            Projection::RadialTangential(k, RadialTangential::new(&[-0.2, 0.05, 0.002, -0.001, 0.01]).unwrap()),
            Projection::Fisheye(Intrinsics { fx: 18.0, fy: 18.0, ..k }, Fisheye::new([-0.01, 0.002, -0.0003, 0.0]).unwrap()),
            Projection::Equirectangular { width: 64, height: 48 },
            Projection::RayGrid(RayGrid::new(64, 48, 7, 9, &grid).unwrap()),
        ]
    }

    #[test]
    fn every_image_point_comes_back() {
        for model in models() {
            model.validate().unwrap();
            let mut seen = 0;
            for i in 0..64 * 48 {
                let at = (f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5);
                let Some(ray) = model.ray(at.0, at.1) else { continue };
                seen += 1;
                assert!(if model.has_image_plane() { ray.z == -1.0 } else { (ray.length() - 1.0).abs() < 1e-12 });
                let back = model.project(ray * 2.7).unwrap();
                assert!((back.0 - at.0).abs() < 1e-9 && (back.1 - at.1).abs() < 1e-9, "{model:?}: {at:?} became {back:?}");
            }
            assert!(seen > 2000, "{model:?} sees {seen}");
        }
    }

    #[test]
    fn a_panorama_looks_forward_in_its_middle_and_has_no_seam() {
        let panorama = Projection::Equirectangular { width: 100, height: 50 };
        let ray = |x, y| panorama.ray(x, y).unwrap();
        assert!((ray(50.0, 25.0) - DVec3::NEG_Z).length() < 1e-15);
        assert!((ray(75.0, 25.0) - DVec3::X).length() < 1e-15, "a quarter to the right");
        assert!((ray(50.0, 0.0) - DVec3::Y).length() < 1e-15, "up");
        assert!((ray(0.0, 20.0) - ray(100.0, 20.0)).length() < 1e-14 && (ray(-0.25, 20.0) - ray(99.75, 20.0)).length() < 1e-14);
        assert!(panorama.image_distance((99.9, 25.0), (0.1, 25.0)) < 0.21);
    }

    #[test]
    fn what_no_image_point_shows_has_none() {
        let k = Intrinsics::from_fov_x(64, 48, 1.0);
        let behind = DVec3::new(0.1, 0.2, 1.0);
        assert_eq!(Projection::Pinhole(k).project(behind), None);
        assert_eq!(Projection::RadialTangential(k, RadialTangential::new(&[0.0; 4]).unwrap()).project(behind), None);
        assert!(Projection::Equirectangular { width: 64, height: 32 }.project(behind).is_some());
        let circle = Projection::Fisheye(Intrinsics { fx: 9.0, fy: 9.0, ..k }, Fisheye::new([0.0; 4]).unwrap());
        assert!(circle.ray(0.5, 0.5).is_none() && circle.ray(32.0, 0.5).is_some());
    }

    #[test]
    fn fields_of_view_are_the_models() {
        let k = Intrinsics::from_fov_x(64, 48, 1.0);
        let wide = Intrinsics { fx: 32.0 / 1.5, fy: 32.0 / 1.5, ..k };
        let fov = |p: &Projection| p.fov_x_rad(10.0);
        assert!((fov(&Projection::Pinhole(k)) - 1.0).abs() < 1e-12);
        assert!((fov(&Projection::Fisheye(wide, Fisheye::new([0.0; 4]).unwrap())) - 3.0).abs() < 1e-12);
        assert_eq!(Projection::Equirectangular { width: 2, height: 1 }.fov_x_rad(2.0), 2.0);
        // With the axis at the image's border, or beyond it.
        let none = RadialTangential::new(&[0.0; 4]).unwrap();
        for (cx, expected) in [(0.0, (64.0 / k.fx).atan()), (-10.0, (74.0 / k.fx).atan() - (10.0 / k.fx).atan())] {
            let aside = Intrinsics { cx, ..k };
            assert!((fov(&Projection::Pinhole(aside)) - expected).abs() < 1e-12);
            assert!((fov(&Projection::RadialTangential(aside, none)) - expected).abs() < 1e-9);
        }
        let broken = Projection::Pinhole(Intrinsics { fx: 0.0, ..k }).validate().unwrap_err().to_string();
        assert!(broken.starts_with("the camera's calibration is fx 0"), "{broken}");
    }
}

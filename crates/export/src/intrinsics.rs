//! K of many cameras in one table (`intrinsics.csv`), in OpenCV's conventions.

use crate::calibration::OPENCV;
use enfilade_dataset::CameraTable;
use enfilade_math::{DMat3, DQuat};
use enfilade_scene::{Intrinsics, Projection};
use std::f64::consts::FRAC_PI_3;

/// A pinhole in OpenCV's terms.
pub(crate) struct Intrinsic {
    k: Intrinsics,
    /// Takes Hypersim's camera axes (x right, y up, z backward) to OpenCV's of the camera that K is of.
    opencv_from_camera: DMat3,
    /// Angle of that turn, beyond the change of names of the axes, degrees.
    turn_deg: f64,
    /// Error of the image of a centred camera of 60 degrees in the worst corner, pixels.
    naive_error_px: f64,
}

impl Intrinsic {
    /// Intrinsics of a pinhole, straight or tilted; `None` for other cameras, which are more than K.
    pub fn of(projection: &Projection) -> Option<Self> {
        let (k, turn) = match projection {
            Projection::Pinhole(k) => (*k, DMat3::IDENTITY),
            Projection::TiltedPinhole(tilted) => tilted.straightened(),
            _ => return None,
        };
        let naive = Intrinsics::from_fov_x(k.width, k.height, FRAC_PI_3);
        let (w, h) = (f64::from(k.width), f64::from(k.height));
        let error = |(x, y): (f64, f64)| projection.ray(x, y).map(|ray| naive.project(ray)).map_or(0.0, |p| (p.0 - x).hypot(p.1 - y));
        let naive_error_px = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)].map(error).into_iter().fold(0.0, f64::max);
        let turn_deg = DQuat::from_mat3(&turn).to_axis_angle().1.to_degrees();
        Some(Self { k, opencv_from_camera: OPENCV * turn, turn_deg, naive_error_px })
    }

    fn cells(&self) -> Vec<String> {
        let k = &self.k;
        let [[fx, skew, cx], [_, fy, cy], _] = k.opencv_k();
        let mut cells = vec![k.width.to_string(), k.height.to_string()];
        let rotation = self.opencv_from_camera.transpose().to_cols_array();
        // Adding zero turns -0 into 0.
        let numbers = [fx, fy, cx, cy, skew].into_iter().chain(rotation).chain([self.turn_deg, self.naive_error_px]);
        cells.extend(numbers.map(|v| (v + 0.0).to_string()));
        cells
    }
}

/// The table as CSV; cells of cameras that are no pinholes are empty.
pub(crate) fn csv_of(rows: impl Iterator<Item = (String, Option<String>, Option<Intrinsic>)>) -> String {
    let mut header: Vec<String> = ["width", "height", "fx", "fy", "cx", "cy", "skew"].map(String::from).into();
    header.extend((0..9).map(|i| format!("r{}{}", i / 3, i % 3)));
    header.extend(["turn_deg", "naive_error_px"].map(String::from));
    let mut text = format!("scene_name,camera_name,{}\n", header.join(","));
    for (scene, camera, found) in rows {
        let cells = found.map_or_else(|| vec![String::new(); header.len()], |found| found.cells());
        text.push_str(&format!("{scene},{},{}\n", camera.unwrap_or_default(), cells.join(",")));
    }
    text
}

/// K and the turn of every scene of a table of cameras, as CSV. OpenCV's conventions: pixel centres are whole numbers; `r00` to `r22` takes
/// Hypersim's camera axes to those of K. Cells of scenes whose camera is no pinhole are empty.
pub fn intrinsics_csv(table: &CameraTable) -> String {
    let row = |scene: &str| {
        let found = table.projection(scene).ok().as_ref().and_then(Intrinsic::of);
        (scene.to_string(), None, found)
    };
    csv_of(table.scenes().map(row))
}

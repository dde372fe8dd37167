//! Planned viewpoints of a scene: the cameras of its file, or the planned trajectories of its dataset.

use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{Camera, Pose, Projection, Scene, StartCamera};
use serde::{Serialize, Serializer};
use std::path::PathBuf;

/// A camera's planned frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannedCamera {
    /// Name of the camera.
    pub name: String,
    /// In order.
    pub frames: Vec<PlannedFrame>,
}

/// A view of the scene to take a picture from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlannedFrame {
    /// Frame number.
    pub frame: u32,
    /// Metres.
    pub position: [f64; 3],
    /// World from camera, row by row.
    pub orientation: [f64; 9],
    /// Vertical field of view; for cameras that are not pinholes, the one of a pinhole that shows about as much.
    pub fov_y_deg: f64,
    /// Width over height.
    pub aspect: f64,
    /// Path of its picture once it is rendered. The page receives only whether the file exists.
    #[serde(serialize_with = "is_file")]
    pub photograph: Option<PathBuf>,
}

fn is_file<S: Serializer>(photograph: &Option<PathBuf>, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_bool(photograph.as_ref().is_some_and(|path| path.is_file()))
}

impl PlannedFrame {
    /// The view of a pose.
    pub fn new(pose: &Pose, fov_y_deg: f64, aspect: f64) -> Self {
        let orientation = pose.world_from_camera.transpose().to_cols_array();
        Self { frame: pose.frame, position: pose.position.to_array(), orientation, fov_y_deg, aspect, photograph: None }
    }
}

/// The cameras of a scene file: one frame each.
pub fn cameras_of_file(scene: &Scene) -> Vec<PlannedCamera> {
    let camera = |camera: &StartCamera| {
        let fov_y = 2.0 * ((0.5 * camera.fov_x_rad).tan() / camera.aspect).atan();
        let frames = vec![PlannedFrame::new(&camera.pose(0), fov_y.to_degrees(), camera.aspect)];
        PlannedCamera { name: camera.name.clone(), frames }
    };
    scene.cameras.iter().map(camera).collect()
}

/// Vertical field of view in degrees, and width over height, of a pinhole that shows about what the camera does.
pub fn field_of_view(camera: &Camera) -> (f64, f64) {
    /// Beyond this, straight perspective distorts a picture too much to recognise things.
    const WIDEST_DEG: f64 = 100.0;
    let [width, height] = camera.size().map(f64::from);
    let edge = |y: f64| camera.projection.ray(0.5 * width, y);
    let fov = match (edge(0.0), edge(height)) {
        (Some(top), Some(bottom)) => top.angle_between(bottom).to_degrees(),
        _ => WIDEST_DEG,
    };
    (fov.clamp(1.0, WIDEST_DEG), width / height)
}

/// True where a picture of the camera, laid over a view of the same direction and angle, fits it.
pub fn is_plain(camera: &Camera) -> bool {
    let Projection::Pinhole(k) = &camera.projection else { return false };
    let middle = [k.cx - 0.5 * f64::from(k.width), k.cy - 0.5 * f64::from(k.height)];
    k.skew == 0.0 && (k.fx / k.fy - 1.0).abs() < 1e-3 && middle.iter().all(|off| off.abs() < 1.0)
}

/// The pose of a view from `position` to `look_at` with z up, or with y up where the view is vertical.
pub fn upright(frame: u32, position: DVec3, look_at: DVec3) -> Option<Pose> {
    Pose::look_at(frame, position, look_at, DVec3::Z).or_else(|| Pose::look_at(frame, position, look_at, DVec3::Y))
}

/// The rotation `world_from_camera` from nine numbers, row by row.
pub fn rows(orientation: &[f64; 9]) -> DMat3 {
    DMat3::from_cols_array(orientation).transpose()
}

//! The commit records: small JSON files that say that a frame, or its labels, are complete, and what they are made of.

use crate::CameraRecord;
use crate::layout::FIXTURE_PARTS;
use enfilade_math::DVec3;
use enfilade_options::words;
use enfilade_scene::{Camera, Intrinsics, Pose};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the records' form.
pub(crate) const RECORD_FORMAT: u32 = 1;
/// Poses that differ by no more, metres and parts of a rotation, are the same: what `verify` allows too.
const SAME_POSE: f64 = 1e-9;
/// Greatest difference of two calibrations of the same camera, pixels: the table of cameras has them as matrices.
const SAME_CAMERA_PX: f64 = 1e-6;

/// Size and checksum of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Length.
    pub bytes: u64,
    /// BLAKE3 of the content, 64 hexadecimal digits.
    pub blake3: String,
}

/// A pose as it is written in a record: metres, camera axes x right, y up, z backward.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseRecord {
    /// Camera centre in the world.
    pub position: [f64; 3],
    /// A point on the viewing axis.
    pub look_at: [f64; 3],
    /// Rows of the rotation that takes camera to world directions.
    pub world_from_camera: [[f64; 3]; 3],
}

impl From<&Pose> for PoseRecord {
    fn from(pose: &Pose) -> Self {
        let rows = pose.world_from_camera.transpose().to_cols_array_2d();
        Self { position: pose.position.to_array(), look_at: pose.look_at.to_array(), world_from_camera: rows }
    }
}

impl PoseRecord {
    /// The pose of frame number `frame`.
    pub fn to_pose(&self, frame: u32) -> Pose {
        let world_from_camera = enfilade_math::DMat3::from_cols_array_2d(&self.world_from_camera).transpose();
        Pose { frame, position: DVec3::from(self.position), look_at: DVec3::from(self.look_at), world_from_camera }
    }
}

/// How the samples of a frame were spent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sampling {
    /// Mean samples per pixel.
    pub samples_taken: f64,
    /// Noise that is left: the root mean square over the image of each pixel's standard error over (its luminance + 0.2 × the
    /// image's mean); `None` where it is not known, as after one sample per pixel.
    pub noise: Option<f64>,
    /// The noise at which it was to end, where that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_target: Option<f32>,
    /// What ended it.
    pub stopped_by: StoppedBy,
}

/// What ends the rendering of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StoppedBy {
    /// All samples were taken.
    Samples,
    /// Fewer were enough for the noise that was asked for.
    Noise,
    /// The time limit was over.
    #[serde(rename = "time limit")]
    TimeLimit,
}

/// What rendered a frame: with the dataset's poses and camera, all that is needed to render it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// The program, with its version.
    pub program: String,
    /// Version of what the program's rendering comes to: it is raised whenever the same inputs give other values.
    pub render_version: u32,
    /// BLAKE3 of the scene package, which lies in the work folder.
    pub scene_blake3: String,
    /// The resolved settings of the renderer, seed included.
    pub settings: serde_json::Value,
    /// Wall-clock seconds after which the frame was to end; absent: no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit_s: Option<f64>,
}

/// What a rendered frame was made from and what it consists of: enough to render it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameRecord {
    /// Version of this form.
    pub format: u32,
    /// Scene name.
    pub scene: String,
    /// Camera name.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Samples per pixel, as asked for.
    pub samples: u32,
    /// Hash of everything that the frame's values depend on.
    pub config_hash: String,
    /// How they were spent.
    #[serde(flatten)]
    pub sampling: Option<Sampling>,
    /// Where the camera stood.
    pub pose: PoseRecord,
    /// Image size and calibration of a pinhole that is in focus and at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub intrinsics: Option<Intrinsics>,
    /// Every other camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera_model: Option<CameraRecord>,
    /// What rendered it; absent in records of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recipe: Option<Recipe>,
    /// What `color` and the two layers that it is made of hold; records of earlier versions do not say so, and mean rendered ones.
    #[serde(default)]
    pub color: ColorKind,
    /// How they were denoised; absent where they are as they were rendered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub denoised: Option<Denoised>,
    /// The layer files, by path relative to the scene's folder.
    pub files: BTreeMap<String, FileRecord>,
}

words! {
    /// What `color`, `diffuse_illumination` and `residual` hold.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum ColorKind {
        /// The rendered layers: unbiased and noisy.
        #[default]
        Rendered = "rendered",
        /// A clean but biased estimate; the rendered layers are kept beside it, as color_rendered, ...
        Denoised = "denoised",
    }
}

/// How the colour layers of a frame were denoised.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Denoised {
    /// The program that denoised, with its version.
    pub denoiser: String,
    /// Hash of the settings that it ran with.
    pub denoise_hash: String,
    /// The files that were rendered, where they were not kept, by the paths that they would have, relative to the scene's folder.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub dropped: BTreeMap<String, FileRecord>,
}

impl FrameRecord {
    /// The number of fixtures whose light the frame has apart.
    pub fn fixtures(&self) -> u32 {
        let end = format!("_{}.hdf5", FIXTURE_PARTS[0].spec().name);
        self.files.keys().filter(|name| name.contains(".fixture_") && name.ends_with(&end)).count() as u32
    }

    /// `intrinsics` and `camera_model` of a camera.
    pub(crate) fn of_camera(camera: &Camera) -> (Option<Intrinsics>, Option<CameraRecord>) {
        match camera.plain_pinhole() {
            Some(intrinsics) => (Some(*intrinsics), None),
            None => (None, Some(camera.into())),
        }
    }

    /// How far the recorded camera is from `camera`: the largest difference of two pinholes' numbers, in pixels; otherwise 0 when
    /// they are the same and infinite when not.
    pub fn camera_differs_by(&self, camera: &Camera) -> f64 {
        let values = |k: &Intrinsics| [k.fx, k.fy, k.cx, k.cy, k.skew, f64::from(k.width), f64::from(k.height)];
        match (camera.plain_pinhole(), &self.intrinsics, &self.camera_model) {
            (Some(a), Some(b), None) => values(a).iter().zip(values(b)).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())),
            (None, None, Some(record)) if *record == camera.into() => 0.0,
            _ => f64::INFINITY,
        }
    }

    /// True when the frame was taken with `camera` in the pose `pose`.
    pub fn is_taken(&self, camera: &Camera, pose: &Pose) -> bool {
        let then = self.pose.to_pose(pose.frame);
        let moved = (then.position - pose.position).abs().max_element();
        let turned = (then.world_from_camera - pose.world_from_camera).to_cols_array();
        let differs = turned.iter().fold(moved, |m: f64, v| m.max(v.abs()));
        differs <= SAME_POSE && self.camera_differs_by(camera) <= SAME_CAMERA_PX
    }
}

/// A commit record as [`FrameRecord`], but for the label layers, which come and go without the frame being rendered again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LabelRecord {
    /// Version of this form.
    pub format: u32,
    /// Scene name.
    pub scene: String,
    /// Camera name.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// Hash of the label tables that the layers were joined from.
    pub labels_hash: String,
    /// The layer files, by path relative to the scene's folder.
    pub files: BTreeMap<String, FileRecord>,
}

//! A camera's folder under `_detail`: the keyframe arrays of its trajectory, and its poses and calibration in OpenCV's conventions.

use crate::hdf5::{Array, Elements, Storage, read_array, write_array};
use crate::tables::{Table, write_parameters};
use crate::{Dataset, DatasetError, StereoRecord, check_name, replace_file, write_bytes};
use enfilade_math::{DMat3, DVec3, nearest_rotation};
use enfilade_scene::{Camera, Intrinsics, Motion, Pose, Projection, Trajectory};
use serde::Serialize;
use std::path::Path;

/// Hypersim's time between two frames, for cameras that are at rest for each.
const FRAME_TIME_S: f64 = 1.0;
/// Orientations with a larger [`Pose::orthonormality_error`] are no rotations.
const ORTHONORMAL: f64 = 1e-9;

impl Dataset {
    /// The motion of a camera through its frames; `None` if these are no video: a second or more apart, or none.
    ///
    /// # Errors
    /// When the trajectory or the time between frames cannot be read.
    pub fn read_motion(&self, scene: &str, camera: &str) -> Result<Option<Motion>, DatasetError> {
        let frame_time_s = self.read_frame_time(scene, camera)?;
        if !(frame_time_s.is_finite() && frame_time_s > 0.0) {
            let path = self.layout().metadata_camera(scene, camera);
            let problem = format!("frame_time_seconds is {frame_time_s}, expected a positive number; plan the scene again");
            return Err(DatasetError::text(&path, problem));
        }
        if frame_time_s >= FRAME_TIME_S {
            return Ok(None);
        }
        Ok(Motion::through(&self.read_trajectory(scene, camera)?.poses, frame_time_s))
    }

    /// Writes a trajectory: the four keyframe arrays, `metadata_camera.csv`, `cameras_opencv.json`, the camera's row in
    /// `metadata_cameras.csv` and, if K alone does not describe the camera, `camera.json` with its arrays.
    ///
    /// # Errors
    /// When a file cannot be written, or the camera's name cannot be part of a path.
    pub fn write_trajectory(
        &self,
        scene: &str,
        trajectory: &Trajectory,
        camera: &Camera,
        stereo: Option<&StereoRecord>,
    ) -> Result<(), DatasetError> {
        let name = trajectory.name.as_str();
        check_name("scene name", scene)?;
        check_name("camera name", name)?;
        let poses = &trajectory.poses;
        let vectors = |of: fn(&Pose) -> DVec3| Array::f64(&[poses.len(), 3], poses.iter().flat_map(|p| of(p).to_array()).collect());
        let rotations = poses.iter().flat_map(|p| p.world_from_camera.transpose().to_cols_array()).collect();
        let arrays = [
            ("frame_indices", Array::i64(&[poses.len()], poses.iter().map(|p| i64::from(p.frame)).collect())),
            ("positions", vectors(|p| p.position)),
            ("look_at_positions", vectors(|p| p.look_at)),
            ("orientations", Array::f64(&[poses.len(), 3, 3], rotations)),
        ];
        for (what, array) in &arrays {
            replace_file(&self.layout().keyframes(scene, name, what), |aside| write_array(aside, array, Storage::Contiguous, &[]))?;
        }
        let frame_time_s = camera.shutter.map_or(FRAME_TIME_S, |shutter| shutter.frame_time_s);
        write_parameters(&self.layout().metadata_camera(scene, name), &[("frame_time_seconds", frame_time_s)])?;
        write_bytes(&self.layout().cameras_opencv(scene, name), opencv_cameras(scene, trajectory, camera))?;
        self.write_camera_model(scene, trajectory, camera, stereo)?;
        self.make_records_dir(scene, name)?;
        self.add_camera(scene, name)
    }

    /// Writes the time between two frames of a trajectory that was planned for one, in place of the camera's own.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_frame_time(&self, scene: &str, camera: &str, frame_time_s: f64) -> Result<(), DatasetError> {
        write_parameters(&self.layout().metadata_camera(scene, camera), &[("frame_time_seconds", frame_time_s)])
    }

    /// The time between two frames of a camera in seconds: 1 unless the trajectory was planned or filmed as a video.
    ///
    /// # Errors
    /// When the file is there but cannot be read.
    pub fn read_frame_time(&self, scene: &str, camera: &str) -> Result<f64, DatasetError> {
        let table = optional(Table::read(&self.layout().metadata_camera(scene, camera)))?;
        table.map_or(Ok(FRAME_TIME_S), |table| table.parameter("frame_time_seconds"))
    }

    /// A camera's trajectory in metres; if the unit is not recorded, our own files are taken to be in metres. Without look-at positions the
    /// point one metre ahead is used, and without frame numbers frames count from 0.
    ///
    /// Orientations that are off a rotation become the nearest one: Hypersim's frame 0 has the artist's matrix, which may be stretched.
    /// Those that mirror stay as they are.
    ///
    /// # Errors
    /// When an array is missing, damaged, or of another shape or length than the others, and when the unit of a release is not recorded.
    pub fn read_trajectory(&self, scene: &str, camera: &str) -> Result<Trajectory, DatasetError> {
        let mut trajectory = self.read_stored_trajectory(scene, camera)?;
        for pose in trajectory.poses.iter_mut().filter(|pose| pose.orthonormality_error() > ORTHONORMAL) {
            pose.world_from_camera = nearest_rotation(pose.world_from_camera).unwrap_or(pose.world_from_camera);
        }
        Ok(trajectory)
    }

    /// [`Dataset::read_trajectory`] with the orientations as they are stored.
    ///
    /// # Errors
    /// As [`Dataset::read_trajectory`].
    pub fn read_stored_trajectory(&self, scene: &str, camera: &str) -> Result<Trajectory, DatasetError> {
        let keyframes = |what: &str| self.layout().keyframes(scene, camera, what);
        let positions = read_f64(&keyframes("positions"), None, &[3])?;
        let n = positions.len() / 3;
        let orientations = read_f64(&keyframes("orientations"), Some(n), &[3, 3])?;
        let look_at = optional(read_f64(&keyframes("look_at_positions"), Some(n), &[3]))?;
        let frames = match optional(self.frame_indices(scene, camera))? {
            Some(frames) if frames.len() != n => {
                let problem = format!("{} frame numbers for {n} positions; plan the trajectory again", frames.len());
                return Err(DatasetError::hdf5(&keyframes("frame_indices"), problem));
            }
            frames => frames.unwrap_or_else(|| (0..n as u32).collect()),
        };
        let metres = self.meters_per_stored_unit(scene)?;
        let pose = |i: usize| {
            let rows: [f64; 9] = std::array::from_fn(|k| orientations[9 * i + k]);
            let world_from_camera = DMat3::from_cols_array(&rows).transpose();
            let position = DVec3::from_slice(&positions[3 * i..]);
            let ahead = || position - world_from_camera.z_axis / metres;
            let look_at = look_at.as_ref().map_or_else(ahead, |at| DVec3::from_slice(&at[3 * i..]));
            Pose { frame: frames[i], position: position * metres, look_at: look_at * metres, world_from_camera }
        };
        Ok(Trajectory { name: camera.to_string(), poses: (0..n).map(pose).collect() })
    }

    /// The frame numbers of a trajectory.
    pub(crate) fn frame_indices(&self, scene: &str, camera: &str) -> Result<Vec<u32>, DatasetError> {
        let path = self.layout().keyframes(scene, camera, "frame_indices");
        let wrong = |what: String| DatasetError::hdf5(&path, format!("expected frame numbers (int64, ≥ 0), found {what}"));
        match read_array(&path)?.values {
            Elements::I64(v) => v.into_iter().map(|frame| u32::try_from(frame).map_err(|_| wrong(format!("the number {frame}")))).collect(),
            other => Err(wrong(other.element().name().to_string())),
        }
    }

    /// Adds a camera to `metadata_cameras.csv`, if it is not there, in order of name.
    fn add_camera(&self, scene: &str, camera: &str) -> Result<(), DatasetError> {
        let path = self.layout().metadata_cameras(scene);
        let mut table = optional(Table::read(&path))?.unwrap_or_else(|| Table::new(&path, &["camera_name"]));
        let names = table.column("camera_name")?;
        if table.rows.iter().any(|row| row[names] == camera) {
            return Ok(());
        }
        let mut row = vec![String::new(); table.header.len()];
        row[names] = camera.to_string();
        table.rows.push(row);
        table.rows.sort_by(|a, b| a[names].cmp(&b[names]));
        table.write()
    }
}

/// `None` instead of the error that a file does not exist.
pub(crate) fn optional<T>(result: Result<T, DatasetError>) -> Result<Option<T>, DatasetError> {
    match result {
        Err(error) if error.is_not_found() => Ok(None),
        other => other.map(Some),
    }
}

/// Reads doubles of shape (n, `inner`…), where `n` is checked if given.
fn read_f64(path: &Path, n: Option<usize>, inner: &[usize]) -> Result<Vec<f64>, DatasetError> {
    let array = read_array(path)?;
    let fits = array.shape.len() == inner.len() + 1 && array.shape[1..] == *inner && n.is_none_or(|n| array.shape[0] == n);
    match array.values {
        Elements::F64(values) if fits => Ok(values),
        other => {
            let first = n.map_or("n".to_string(), |n| n.to_string());
            let found = format!("{} of shape {:?}", other.element().name(), array.shape);
            let problem =
                format!("expected float64 of shape ({first}, {inner:?}), found {found}; run the stage that makes this file again");
            Err(DatasetError::hdf5(path, problem))
        }
    }
}

/// Reads three doubles.
pub(crate) fn read_f64_vec3(path: &Path) -> Result<DVec3, DatasetError> {
    Ok(DVec3::from_slice(&read_f64(path, Some(3), &[])?))
}

#[derive(Serialize)]
struct OpencvCameras<'a> {
    convention: &'static str,
    unit: &'static str,
    scene: &'a str,
    camera: &'a str,
    width: u32,
    height: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(rename = "K", skip_serializing_if = "Option::is_none")]
    k: Option<[[f64; 3]; 3]>,
    distortion: Vec<f64>,
    frames: Vec<OpencvFrame>,
}

#[derive(Serialize)]
struct OpencvFrame {
    frame: u32,
    world_from_camera: [[f64; 4]; 4],
}

const OPENCV_CONVENTION: &str = "OpenCV: camera axes x right, y down, z forward; the centre of the upper left pixel is (0, 0). \
    world_from_camera takes camera coordinates (column vectors) to the world, which is right-handed with z up. A world point p falls \
    on pixel K [I|0] inverse(world_from_camera) p. No lens distortion.";

const OPENCV_DISTORTED: &str = "OpenCV: camera axes x right, y down, z forward; the centre of the upper left pixel is (0, 0). \
    world_from_camera takes camera coordinates (column vectors) to the world, which is right-handed with z up. model opencv: K and \
    distortion are those of cv2.projectPoints (k1 k2 p1 p2 k3 k4 k5 k6); opencv_fisheye: of cv2.fisheye.projectPoints (k1 k2 k3 k4). \
    Neither reads the skew K[0][1]: where it is not 0, add K[0][1] (y - K[1][2]) / K[1][1] to the x of the former, and give the latter \
    alpha = K[0][1] / K[0][0]. Other models have no K: camera_rays.hdf5 has the ray of every pixel, with y and z the other way around. \
    With a rolling shutter these poses are those of the middle row; camera_row_positions.hdf5 and camera_row_orientations.hdf5 have those \
    of all rows, in Hypersim's axes and, of a camera with a tilted image plane, as M_cam_from_uv wants them: not turned as these are.";

/// The text of `cameras_opencv.json` for the poses of a trajectory.
pub fn opencv_cameras(scene: &str, trajectory: &Trajectory, camera: &Camera) -> String {
    let [width, height] = camera.size();
    let calibration = OpencvCalibration::of(&camera.projection);
    let frame = |pose: &Pose| OpencvFrame { frame: pose.frame, world_from_camera: calibration.world_from_camera(pose) };
    let model = calibration.model;
    let rolls = camera.shutter.is_some_and(|shutter| shutter.readout_s > 0.0);
    let cameras = OpencvCameras {
        convention: if model.is_some() || rolls { OPENCV_DISTORTED } else { OPENCV_CONVENTION },
        unit: "m",
        scene,
        camera: &trajectory.name,
        width,
        height,
        model,
        k: calibration.intrinsics.map(|k| k.opencv_k()),
        distortion: calibration.distortion.clone(),
        frames: trajectory.poses.iter().map(frame).collect(),
    };
    let mut text = serde_json::to_string_pretty(&cameras).expect("plain data encodes");
    text.push('\n');
    text
}

/// A camera in OpenCV's conventions: axes x right, y down, z forward, and the centre of the upper left pixel at (0, 0).
///
/// ```
/// use enfilade_dataset::OpencvCalibration;
/// use enfilade_scene::{Intrinsics, Projection};
/// // Counted from the corner of the image, the middle of 1024 x 768 pixels is (512, 384).
/// let pinhole = Intrinsics { width: 1024, height: 768, fx: 887.0, fy: 887.0, cx: 512.0, cy: 384.0, skew: 0.0 };
/// let calibration = OpencvCalibration::of(&Projection::Pinhole(pinhole));
/// let k = calibration.intrinsics.unwrap().opencv_k();
/// assert_eq!(k, [[887.0, 0.0, 511.5], [0.0, 887.0, 383.5], [0.0, 0.0, 1.0]]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct OpencvCalibration {
    /// The pinhole, before distortion; `None` for cameras that have none. [`Intrinsics::opencv_k`] gives K.
    pub intrinsics: Option<Intrinsics>,
    /// Turns the pinhole into the camera: a tilted image plane is a turned camera with a straight one. The identity for all others.
    turned: DMat3,
    /// The model, if it is more than a pinhole: `opencv`, `opencv_fisheye`, `equirectangular` or `ray_grid`.
    pub model: Option<&'static str>,
    /// Coefficients in OpenCV's order.
    pub distortion: Vec<f64>,
}

impl OpencvCalibration {
    /// The calibration of a projection.
    pub fn of(projection: &Projection) -> Self {
        let plain = |intrinsics, model, distortion| Self { intrinsics, turned: DMat3::IDENTITY, model, distortion };
        match projection {
            Projection::Pinhole(k) => plain(Some(*k), None, Vec::new()),
            Projection::TiltedPinhole(tilted) => {
                let (k, rotation) = tilted.straightened();
                Self { turned: rotation.transpose(), ..plain(Some(k), None, Vec::new()) }
            }
            Projection::RadialTangential(k, distortion) => plain(Some(*k), Some("opencv"), distortion.coefficients().to_vec()),
            Projection::Fisheye(k, fisheye) => plain(Some(*k), Some("opencv_fisheye"), fisheye.coefficients().to_vec()),
            Projection::Equirectangular { .. } => plain(None, Some("equirectangular"), Vec::new()),
            Projection::RayGrid(_) => plain(None, Some("ray_grid"), Vec::new()),
        }
    }

    /// Camera to world, row by row: camera axes x right, y down, z forward; metres.
    pub fn world_from_camera(&self, pose: &Pose) -> [[f64; 4]; 4] {
        let straight = self.turned == DMat3::IDENTITY;
        let r = if straight { pose.world_from_camera } else { pose.world_from_camera * self.turned };
        // Adding zero turns −0 into 0.
        let row = |i: usize| [r.x_axis[i] + 0.0, 0.0 - r.y_axis[i], 0.0 - r.z_axis[i], pose.position[i] + 0.0];
        [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::TiltedPinhole;

    fn trajectory() -> Trajectory {
        let pose = |frame, x| Pose::look_at(frame, DVec3::new(x, 0.5, 1.5), DVec3::new(2.0, 3.0, 1.0), DVec3::Z).unwrap();
        Trajectory { name: "cam_00".into(), poses: vec![pose(0, 0.0), pose(1, 0.25), pose(5, -1.0)] }
    }

    #[test]
    fn a_trajectory_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let camera = Intrinsics::from_fov_x(64, 48, 1.0).into();
        dataset.write_trajectory("room", &Trajectory { name: "cam_01".into(), ..trajectory() }, &camera, None).unwrap();
        dataset.write_trajectory("room", &trajectory(), &camera, None).unwrap();
        dataset.write_trajectory("room", &trajectory(), &camera, None).unwrap();
        assert_eq!(dataset.read_trajectory("room", "cam_00").unwrap(), trajectory());
        assert_eq!(dataset.cameras("room").unwrap(), ["cam_00", "cam_01"]);
        let missing = dataset.read_trajectory("room", "cam_02").unwrap_err();
        assert!(missing.is_not_found() && missing.to_string().contains("camera_keyframe_positions.hdf5"), "{missing}");
    }

    #[test]
    fn opencv_matrices_project_as_the_camera_does() {
        let k = Intrinsics { width: 640, height: 480, fx: 500.0, fy: 510.0, cx: 300.0, cy: 260.0, skew: 0.0 };
        let tilt = DMat3::from_rotation_x(0.15) * k.cam_from_uv();
        for projection in [Projection::Pinhole(k), Projection::TiltedPinhole(TiltedPinhole::new(640, 480, tilt).unwrap())] {
            let json: serde_json::Value = serde_json::from_str(&opencv_cameras("room", &trajectory(), &projection.clone().into())).unwrap();
            let number = |value: &serde_json::Value, i: usize, j: usize| value[i][j].as_f64().unwrap();
            let (k, pose) = (&json["K"], &json["frames"][2]["world_from_camera"]);
            let p_camera = DVec3::new(0.3, 0.2, 2.0); // OpenCV's axes
            let p_world =
                DVec3::from_array([0, 1, 2].map(|i| (0..3).map(|j| number(pose, i, j) * p_camera[j]).sum::<f64>() + number(pose, i, 3)));
            let expected = trajectory().poses[2];
            let p = expected.world_from_camera.transpose() * (p_world - expected.position);
            let (x, y) = projection.project(p).unwrap();
            let pixel = [0, 1].map(|i| (0..3).map(|j| number(k, i, j) * p_camera[j]).sum::<f64>() / p_camera.z);
            assert!((pixel[0] + 0.5 - x).abs() < 1e-9 && (pixel[1] + 0.5 - y).abs() < 1e-9, "{pixel:?} {x} {y}");
        }
    }

    #[test]
    fn arrays_of_another_length_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_trajectory("room", &trajectory(), &Intrinsics::from_fov_x(64, 48, 1.0).into(), None).unwrap();
        let path = dataset.layout().keyframes("room", "cam_00", "orientations");
        write_array(&path, &Array::f64(&[2, 3, 3], vec![0.0; 18]), Storage::Contiguous, &[]).unwrap();
        let message = dataset.read_trajectory("room", "cam_00").unwrap_err().to_string();
        assert!(message.contains("expected float64 of shape (3, [3, 3]), found float64 of shape [2, 3, 3]"), "{message}");
    }

    #[test]
    fn hypersims_own_trajectory_is_read() {
        let Some(scenes) = std::env::var_os("ENFILADE_SCENES") else {
            return eprintln!("skipped: ENFILADE_SCENES is not set");
        };
        let dataset = Dataset::open(Path::new(&scenes).join("hypersim-real")).unwrap();
        let trajectory = dataset.read_trajectory("ai_037_002", "cam_00").unwrap();
        assert_eq!((trajectory.poses.len(), trajectory.poses[99].frame), (100, 99));
        let error = |p: &Pose| (p.world_from_camera * p.world_from_camera.transpose() - DMat3::IDENTITY).to_cols_array();
        assert!(trajectory.poses[1..].iter().flat_map(error).all(|v| v.abs() < 1e-6));
    }
}

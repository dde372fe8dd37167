//! Files of a camera that is more than a pinhole in focus and at rest: the model, its rays, its motion.
//!
//! `camera.json` has the model in full. `camera_rays.hdf5` has the ray of every pixel's centre in camera space, so that position = camera
//! centre + depth_meters × (world_from_camera × ray) for every model. `camera_lens_distortion.hdf5` is a grid of rays as Hypersim's toolkit
//! takes it. `camera_row_{positions,orientations}.hdf5` have the camera's pose for each row of a rolling shutter.

use crate::atomic::remove_if_there;
use crate::camera_record::{CameraRecord, ProjectionRecord, grid_checksum};
use crate::frames::read_json;
use crate::hdf5::{Array, Elements, Storage, read_array, write_array};
use crate::{Dataset, DatasetError, replace_file, write_json};
use enfilade_math::{DMat3, DVec3};
use enfilade_scene::{Camera, CameraView, Projection, RayGrid, Trajectory};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The side of a camera in a stereo rig, and its partner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StereoRecord {
    /// `left` or `right`.
    pub side: StereoSide,
    /// Name of the other camera; its frames of the same numbers are taken at the same moments.
    pub partner: String,
    /// Distance between the two, metres.
    pub baseline_m: f64,
    /// Position of the other camera in this one's space (x right, y up, z backward), metres. Both look the same way.
    pub partner_position_m: [f64; 3],
}

/// The side of a stereo rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs, reason = "plain words")]
pub enum StereoSide {
    Left,
    Right,
}

impl StereoRecord {
    /// One side of a rig.
    pub fn new(side: StereoSide, partner: String, baseline_m: f64) -> Self {
        let x = if side == StereoSide::Left { baseline_m } else { -baseline_m };
        Self { side, partner, baseline_m, partner_position_m: [x, 0.0, 0.0] }
    }
}

/// `camera.json`.
#[derive(Serialize, Deserialize)]
struct CameraFile {
    convention: String,
    scene: String,
    name: String,
    camera: CameraRecord,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stereo: Option<StereoRecord>,
}

const CONVENTION: &str = "Camera axes x right, y up, z backward. Image coordinates x right, y down in pixels from the upper left corner \
    of the image, so that pixel centres lie at halves; cx, cy and skew are in these. Distortion is OpenCV's, radial_tangential in the \
    order k1 k2 p1 p2 k3 k4 k5 k6, fisheye k1 k2 k3 k4. camera_rays.hdf5 has the unit ray of every pixel's centre in camera space, NaN \
    where the picture shows nothing. Geometry layers are about these rays through the lens's centre, at the middle of the exposure of \
    the pixel's row: row i of H at the frame's time + readout_s * ((i + 0.5) / H - 0.5). The frame's pose is that of the image's middle.";

impl Dataset {
    /// Writes the files of a camera that need more than K, and removes those of an earlier one.
    pub(crate) fn write_camera_model(
        &self,
        scene: &str,
        trajectory: &Trajectory,
        camera: &Camera,
        stereo: Option<&StereoRecord>,
    ) -> Result<(), DatasetError> {
        let (name, layout) = (trajectory.name.as_str(), self.layout());
        let model = layout.camera_model(scene, name);
        match camera.plain_pinhole().is_none() || stereo.is_some() {
            true => {
                let (scene, name) = (scene.to_string(), name.to_string());
                write_json(
                    &model,
                    &CameraFile { convention: CONVENTION.into(), scene, name, camera: camera.into(), stereo: stereo.cloned() },
                )?;
            }
            false => remove_if_there(&model)?,
        }
        let rays = (!camera.projection.is_linear()).then(|| pixel_rays(&camera.projection));
        put(&layout.camera_rays(scene, name), rays, Storage::Compressed)?;
        let grid = match &camera.projection {
            Projection::RayGrid(grid) => {
                let [rows, columns] = grid.shape();
                Some(Array::f64(&[rows, columns, 3], grid.rays().flat_map(|ray| ray.to_array()).collect()))
            }
            _ => None,
        };
        put(&layout.camera_ray_grid(scene, name), grid, Storage::Compressed)?;
        let rolls = camera.shutter.is_some_and(|shutter| shutter.readout_s > 0.0);
        let [positions, orientations] = if rolls { row_placements(camera, trajectory).map(Some) } else { [None, None] };
        put(&layout.camera_rows(scene, name, "positions"), positions, Storage::Contiguous)?;
        put(&layout.camera_rows(scene, name, "orientations"), orientations, Storage::Contiguous)
    }

    /// A scene's camera of that name: from `camera.json` where it is there, else the pinhole of `metadata_camera_parameters.csv`.
    ///
    /// # Errors
    /// When the files are missing or damaged, or do not describe a camera.
    pub fn read_camera(&self, scene: &str, name: &str) -> Result<Camera, DatasetError> {
        let path = self.layout().camera_model(scene, name);
        let Some(file) = self.camera_file(scene, name)? else { return Ok(self.table_projection(scene)?.into()) };
        let grid = |size: [u32; 2]| {
            let path = self.layout().camera_ray_grid(scene, name);
            let grid = read_ray_grid(&path, size)?;
            match &file.camera.projection {
                ProjectionRecord::RayGrid { blake3, .. } if *blake3 != grid_checksum(&grid) => {
                    Err(DatasetError::hdf5(&path, "its rays are not those of camera.json; run the plan stage again"))
                }
                _ => Ok(grid),
            }
        };
        file.camera.to_camera(grid, |error| DatasetError::text(&path, error.to_string()))
    }

    /// The side of a camera in a stereo rig; `None` if it is in none.
    ///
    /// # Errors
    /// When `camera.json` cannot be read or understood.
    pub fn read_stereo(&self, scene: &str, name: &str) -> Result<Option<StereoRecord>, DatasetError> {
        Ok(self.camera_file(scene, name)?.and_then(|file| file.stereo))
    }

    /// The stored rays of all pixel centres, row by row, in camera space; NaN where the picture shows nothing. `None` if the camera's
    /// matrix alone describes them.
    ///
    /// # Errors
    /// When the file is damaged or has another shape than the image.
    pub fn read_camera_rays(&self, scene: &str, name: &str, [width, height]: [u32; 2]) -> Result<Option<Vec<DVec3>>, DatasetError> {
        let path = self.layout().camera_rays(scene, name);
        if !path.is_file() {
            return Ok(None);
        }
        let shape = [height as usize, width as usize, 3];
        match read_array(&path)? {
            Array { shape: found, values: Elements::F64(values) } if found == shape => {
                Ok(Some(values.chunks_exact(3).map(DVec3::from_slice).collect()))
            }
            other => Err(DatasetError::hdf5(&path, format!("expected float64 of shape {shape:?}, found {}", in_words(&other)))),
        }
    }

    /// The files that a camera has beyond its trajectory, of those that are there.
    pub fn camera_model_files(&self, scene: &str, name: &str) -> Vec<std::path::PathBuf> {
        let layout = self.layout();
        let files = [
            layout.camera_model(scene, name),
            layout.camera_rays(scene, name),
            layout.camera_ray_grid(scene, name),
            layout.camera_rows(scene, name, "positions"),
            layout.camera_rows(scene, name, "orientations"),
        ];
        files.into_iter().filter(|file| file.is_file()).collect()
    }

    fn camera_file(&self, scene: &str, name: &str) -> Result<Option<CameraFile>, DatasetError> {
        read_json(&self.layout().camera_model(scene, name), "run the plan stage again")
    }
}

/// Reads a grid of rays in Hypersim's form: rows × columns × 3 numbers, the first ray at the upper left corner of the image, camera
/// axes x right, y up, z backward.
///
/// # Errors
/// When the file cannot be read, has another shape, or is no camera.
pub fn read_ray_grid(path: &Path, [width, height]: [u32; 2]) -> Result<RayGrid, DatasetError> {
    let array = read_array(path)?;
    let values: Option<Vec<f64>> = match &array.values {
        Elements::F64(values) => Some(values.clone()),
        Elements::F32(values) => Some(values.iter().map(|&v| f64::from(v)).collect()),
        _ => None,
    };
    let (&[rows, columns, 3], Some(values)) = (array.shape.as_slice(), values) else {
        let problem = format!("expected float64 or float32 of shape (rows, columns, 3), found {}", in_words(&array));
        return Err(DatasetError::hdf5(path, problem));
    };
    let rays: Vec<DVec3> = values.chunks_exact(3).map(DVec3::from_slice).collect();
    RayGrid::new(width, height, rows, columns, &rays).map_err(|error| DatasetError::hdf5(path, error.to_string()))
}

fn in_words(array: &Array) -> String {
    format!("{} of shape {:?}", array.values.element().name(), array.shape)
}

/// Writes an array, or removes the file that an earlier camera left.
fn put(path: &Path, array: Option<Array>, storage: Storage) -> Result<(), DatasetError> {
    match array {
        Some(array) => replace_file(path, |aside| write_array(aside, &array, storage, &[])),
        None => remove_if_there(path),
    }
}

/// The unit rays of all pixel centres.
fn pixel_rays(projection: &Projection) -> Array {
    let [width, height] = projection.size();
    let ray = |x: u32, y: u32| projection.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).map_or(DVec3::NAN, DVec3::normalize);
    let rays = (0..height).flat_map(|y| (0..width).flat_map(move |x| ray(x, y).to_array())).collect();
    Array::f64(&[height as usize, width as usize, 3], rays)
}

/// Camera centres and orientations by frame and row.
fn row_placements(camera: &Camera, trajectory: &Trajectory) -> [Array; 2] {
    let (frames, height) = (trajectory.poses.len(), camera.size()[1]);
    let (mut positions, mut orientations) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        let view = CameraView::of_frame(camera, &trajectory.poses, frame);
        for row in 0..height {
            let (position, world_from_camera): (DVec3, DMat3) = view.row_placement(f64::from(row) + 0.5);
            positions.extend(position.to_array());
            orientations.extend(world_from_camera.transpose().to_cols_array());
        }
    }
    let rows = height as usize;
    [Array::f64(&[frames, rows, 3], positions), Array::f64(&[frames, rows, 3, 3], orientations)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::{Fisheye, Intrinsics, Pose, RadialTangential, Shutter, ThinLens, TiltedPinhole};

    fn trajectory() -> Trajectory {
        let pose = |frame, x| Pose::look_at(frame, DVec3::new(x, 0.5, 1.5), DVec3::new(2.0, 3.0, 1.0), DVec3::Z).unwrap();
        Trajectory { name: "cam_00".into(), poses: vec![pose(0, 0.0), pose(1, 0.25)] }
    }

    fn cameras() -> Vec<Camera> {
        let k = Intrinsics { width: 32, height: 24, fx: 30.0, fy: 31.0, cx: 15.5, cy: 12.25, skew: 0.5 };
        let lens = ThinLens { aperture_radius_m: 0.01, focus_distance_m: 2.0, blades: 7, focus_tilt_rad: [0.0; 2] };
        let shutter = Shutter { exposure_s: 0.02, readout_s: 0.03, frame_time_s: 0.1 };
        let grid: Vec<DVec3> = (0..4 * 5).map(|i| k.ray(8.0 * f64::from(i % 5), 8.0 * f64::from(i / 5))).collect();
        let tilt = DMat3::from_rotation_x(0.1) * k.cam_from_uv();
        vec![
            k.into(),
            Camera { lens: Some(lens), shutter: Some(shutter), ..k.into() },
            Projection::TiltedPinhole(TiltedPinhole::new(32, 24, tilt).unwrap()).into(),
            Projection::RadialTangential(k, RadialTangential::new(&[-0.1, 0.01, 1e-3, -1e-3]).unwrap()).into(),
            Projection::Fisheye(Intrinsics { fx: 8.0, fy: 8.0, ..k }, Fisheye::new([0.01, 0.0, 0.0, 0.0]).unwrap()).into(),
            Projection::Equirectangular { width: 32, height: 24 }.into(),
            Projection::RayGrid(RayGrid::new(32, 24, 4, 5, &grid).unwrap()).into(),
        ]
    }

    #[test]
    fn every_camera_comes_back_and_leaves_nothing_to_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let same = |a: &Camera, b: &Camera| {
            let rays = |c: &Camera| (0..32 * 24).map(|i| c.projection.ray(f64::from(i % 32), f64::from(i / 32))).collect::<Vec<_>>();
            let apart = rays(a).into_iter().zip(rays(b)).map(|(a, b)| a.unwrap_or_default().distance(b.unwrap_or_default()));
            apart.fold(0.0, f64::max) < 1e-12 && a.lens == b.lens && a.shutter == b.shutter
        };
        let files = |n: usize| assert_eq!(dataset.camera_model_files("room", "cam_00").len(), n);
        for (camera, n) in cameras().iter().zip([0, 3, 1, 2, 2, 2, 3]) {
            dataset.write_camera_parameters("room", camera).unwrap();
            dataset.write_trajectory("room", &trajectory(), camera, None).unwrap();
            let back = dataset.read_camera("room", "cam_00").unwrap();
            assert!(same(camera, &back), "{camera:?} became {back:?}");
            assert_eq!(CameraRecord::from(camera), CameraRecord::from(&back));
            files(n);
            let rays = dataset.read_camera_rays("room", "cam_00", [32, 24]).unwrap();
            assert_eq!(rays.is_none(), camera.projection.is_linear());
            if let Some(rays) = rays {
                let expected = camera.projection.ray(20.5, 7.5).unwrap().normalize();
                assert!((rays[7 * 32 + 20] - expected).length() < 1e-15);
            }
        }
        dataset.write_trajectory("room", &trajectory(), &cameras()[0], None).unwrap();
        files(0);
    }

    #[test]
    fn the_rows_of_a_rolling_shutter_have_their_own_poses() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        dataset.write_trajectory("room", &trajectory(), &cameras()[1], None).unwrap();
        let positions = read_array(&dataset.layout().camera_rows("room", "cam_00", "positions")).unwrap();
        assert_eq!(positions.shape, [2, 24, 3]);
        let Elements::F64(x) = positions.values else { panic!() };
        // 0.25 m in 0.1 s; the first row is exposed 0.03 · (0.5/24 − 0.5) s off the frame's time.
        assert!((x[0] - 2.5 * 0.03 * (0.5 / 24.0 - 0.5)).abs() < 1e-12, "{}", x[0]);
    }

    #[test]
    fn a_rig_and_a_damaged_grid_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let cameras = cameras();
        let left = StereoRecord::new(StereoSide::Left, "cam_01".into(), 0.12);
        dataset.write_camera_parameters("room", &cameras[0]).unwrap();
        dataset.write_trajectory("room", &trajectory(), &cameras[0], Some(&left)).unwrap();
        assert_eq!(dataset.read_stereo("room", "cam_00").unwrap(), Some(left));
        assert_eq!(dataset.read_camera("room", "cam_00").unwrap(), cameras[0]);
        dataset.write_trajectory("room", &trajectory(), &cameras[6], None).unwrap();
        let path = dataset.layout().camera_ray_grid("room", "cam_00");
        let other = Array::f64(&[2, 2, 3], [-1., 1., -1., 1., 1., -1., -1., -1., -1., 1., -1., -1.].to_vec());
        write_array(&path, &other, Storage::Compressed, &[]).unwrap();
        let message = dataset.read_camera("room", "cam_00").unwrap_err().to_string();
        assert!(message.contains("its rays are not those of camera.json"), "{message}");
        write_array(&path, &Array::i64(&[2], vec![1, 2]), Storage::Contiguous, &[]).unwrap();
        let message = dataset.read_camera("room", "cam_00").unwrap_err().to_string();
        assert!(message.contains("expected float64 or float32 of shape (rows, columns, 3), found int64 of shape [2]"), "{message}");
    }
}

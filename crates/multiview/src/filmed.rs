//! The finished frames of a scene, of all its cameras side by side.

use crate::MultiviewError;
use enfilade_dataset::{Dataset, DatasetError};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, CameraView, Cx, Pose};
use std::ops::Range;

/// The cameras of a scene, and its finished frames.
pub struct Filmed<'d> {
    pub(crate) dataset: &'d Dataset,
    pub(crate) scene: String,
    tracks: Vec<Track>,
    /// Track and pose of each frame, by camera and number.
    pub(crate) frames: Vec<(usize, usize)>,
}

/// A camera and its whole trajectory.
struct Track {
    name: String,
    camera: Camera,
    poses: Vec<Pose>,
}

impl<'d> Filmed<'d> {
    /// The whole frames of a scene, of the cameras of these names or of all, by camera and number. `cx` is warned of frames that have
    /// lost a file.
    ///
    /// # Errors
    /// When a camera cannot be read.
    pub fn read(dataset: &'d Dataset, scene: &str, cameras: Option<&[String]>, cx: &dyn Cx) -> Result<Self, MultiviewError> {
        let (mut tracks, mut frames) = (Vec::new(), Vec::new());
        for name in dataset.cameras(scene)?.into_iter().filter(|name| cameras.is_none_or(|cameras| cameras.contains(name))) {
            let finished = dataset.whole_frames([scene, &name], None, cx)?;
            if finished.is_empty() {
                continue;
            }
            let poses = dataset.read_trajectory(scene, &name)?.poses;
            let there = (0..poses.len()).filter(|&i| finished.binary_search(&poses[i].frame).is_ok());
            frames.extend(there.map(|i| (tracks.len(), i)));
            tracks.push(Track { camera: dataset.read_camera(scene, &name)?, name, poses });
        }
        Ok(Self { dataset, scene: scene.into(), tracks, frames })
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// True when none is finished.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Camera and number of a frame.
    pub fn name(&self, frame: usize) -> (&str, u32) {
        let (track, index) = self.frames[frame];
        (&self.tracks[track].name, self.tracks[track].poses[index].frame)
    }

    /// The frames whose numbers are in a range; all frames without one.
    pub fn numbered(&self, range: Option<&Range<u32>>) -> Vec<usize> {
        (0..self.len()).filter(|&frame| range.is_none_or(|range| range.contains(&self.name(frame).1))).collect()
    }

    /// Pose of the camera of a frame.
    pub fn pose(&self, frame: usize) -> &Pose {
        let (track, index) = self.frames[frame];
        &self.tracks[track].poses[index]
    }

    /// The camera at the moment of a frame.
    pub fn view(&self, frame: usize) -> CameraView<'_> {
        let (track, index) = self.frames[frame];
        CameraView::of_frame(&self.tracks[track].camera, &self.tracks[track].poses, index)
    }

    /// Distance between the camera centres of two frames, metres.
    pub fn baseline_m(&self, [a, b]: [usize; 2]) -> f64 {
        self.pose(a).position.distance(self.pose(b).position)
    }

    /// Angle between the viewing axes of two frames, degrees.
    pub fn angle_deg(&self, [a, b]: [usize; 2]) -> f64 {
        let [a, b] = [a, b].map(|frame| self.pose(frame).world_from_camera.z_axis);
        a.cross(b).length().atan2(a.dot(b)).to_degrees()
    }

    /// The stored distances of a frame, metres, row by row; NaN where nothing was hit.
    pub(crate) fn distances_m(&self, frame: usize) -> Result<Vec<f32>, MultiviewError> {
        let (camera, number) = self.name(frame);
        let read: Frame = self.dataset.read_frame(&self.scene, camera, number, &[Layer::DepthMeters])?;
        let ([width, height], found) = (self.view(frame).camera().size(), [read.width, read.height]);
        if found != [width, height] {
            let path = self.dataset.layout().layer(&self.scene, camera, number, Layer::DepthMeters);
            let problem = format!("{}x{} pixels, but its camera has {width}x{height}; plan and render it again", found[0], found[1]);
            return Err(DatasetError::Hdf5 { path, problem }.into());
        }
        match read.get(Layer::DepthMeters) {
            Some(Values::F32(distances)) => Ok(distances.clone()),
            _ => unreachable!("distances are read as float32"),
        }
    }

    /// The surface points that a frame shows in some of its pixels (column, row), world, metres; pixels that show nothing are left out.
    pub(crate) fn points(&self, frame: usize, distances_m: &[f32], pixels: impl Iterator<Item = [u32; 2]>) -> Vec<DVec3> {
        let view = self.view(frame);
        let width = view.camera().size()[0];
        let point = |[column, row]: [u32; 2]| {
            let distance = f64::from(distances_m[(row * width + column) as usize]);
            let ray = view.centre_ray(f64::from(column) + 0.5, f64::from(row) + 0.5).filter(|_| distance.is_finite())?;
            Some(ray.origin + ray.direction * distance)
        };
        pixels.filter_map(point).collect()
    }
}

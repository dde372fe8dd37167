//! The finished frames of a scene, of all its cameras side by side.

use crate::MultiviewError;
use enfilade_dataset::{BodyPlaces, Dataset, DatasetError, FilmedBodies};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::DVec3;
use enfilade_render::{Lookout, TrianglePoint, Ways};
use enfilade_scene::{Camera, CameraView, Cx, DEFORM, Pose, Scene};
use std::ops::Range;

/// The cameras of a scene, and its finished frames.
pub struct Filmed<'d> {
    pub(crate) dataset: &'d Dataset,
    pub(crate) scene: String,
    tracks: Vec<Track>,
    /// Track and pose of each frame, by camera and number.
    pub(crate) frames: Vec<(usize, usize)>,
}

/// A point on a surface.
#[derive(Clone, Copy)]
pub(crate) struct SurfacePoint {
    /// World, metres, in the frame that shows it.
    pub p_world: DVec3,
    /// The part that it is on, as `render_entity_id` numbers it; −1 where nothing in the scene moves.
    pub part: i16,
    /// Where it is on a part that deforms.
    pub on: Option<TrianglePoint>,
    /// Image coordinate of the row that shows it.
    pub y: f64,
}

/// A camera and its whole trajectory.
struct Track {
    name: String,
    camera: Camera,
    poses: Vec<Pose>,
    /// Seconds between frames.
    frame_time_s: f64,
    /// What moves in the scene.
    bodies: Option<FilmedBodies>,
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
            let (camera, frame_time_s) = (dataset.read_camera(scene, &name)?, dataset.read_frame_time(scene, &name)?);
            let bodies = dataset.read_filmed_bodies(scene, &name)?;
            tracks.push(Track { name, camera, poses, frame_time_s, bodies });
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

    /// The moment of the scene that a frame shows, seconds.
    fn moment_s(&self, frame: usize) -> f64 {
        let (track, index) = self.frames[frame];
        self.tracks[track].poses[index].moment_s(self.tracks[track].frame_time_s)
    }

    /// The scene as the rows of a frame show it: bands of rows with their first rows, mostly one.
    pub(crate) fn moments(&self, scene: &Scene, frame: usize) -> Vec<(u32, Scene)> {
        self.times(frame).into_iter().map(|(row, time_s)| (row, scene.at(time_s))).collect()
    }

    /// The first row of each band of rows of a frame, and the moment of the scene that it shows, seconds.
    fn times(&self, frame: usize) -> Vec<(u32, f64)> {
        let (track, _) = self.frames[frame];
        let bands = self.tracks[track].bodies.as_ref().map_or(&[][..], |bodies| bodies.bands(self.name(frame).1));
        let times: Vec<(u32, f64)> = bands.iter().map(|band| (band.first_row, band.time_s)).collect();
        if times.is_empty() { vec![(0, self.moment_s(frame))] } else { times }
    }

    /// Where the bodies of a scene are in two frames.
    pub(crate) fn ways(&self, scene: &Scene, frames: [usize; 2]) -> Ways {
        let maps = |frame: usize| self.times(frame).into_iter().map(|(_, time_s)| scene.world_from_rest(time_s)).collect();
        Ways { body_of_parts: scene.body_of_parts(), here: maps(frames[0]), there: maps(frames[1]) }
    }

    /// Where the parts of the scene are in a frame.
    fn places(&self, frame: usize) -> BodyPlaces<'_> {
        let (track, _) = self.frames[frame];
        self.tracks[track].bodies.as_ref().map_or_else(BodyPlaces::default, |bodies| bodies.at(self.name(frame).1))
    }

    /// True when nothing in the scene moves.
    pub fn is_still(&self) -> bool {
        self.tracks.iter().all(|track| track.bodies.is_none())
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

    /// The part that each pixel of a frame shows, as `render_entity_id` numbers it; empty where nothing in the scene moves, because then
    /// it does not matter.
    pub(crate) fn parts(&self, frame: usize) -> Result<Vec<i16>, MultiviewError> {
        if self.is_still() {
            return Ok(Vec::new());
        }
        let (camera, number) = self.name(frame);
        let read: Frame = self.dataset.read_frame(&self.scene, camera, number, &[Layer::RenderEntityId])?;
        match read.get(Layer::RenderEntityId) {
            Some(Values::I16(parts)) => Ok(parts.clone()),
            _ => unreachable!("parts are read as int16"),
        }
    }

    /// The surface points that a frame shows in some of its pixels (column, row); pixels that show nothing are left out, and without a look at
    /// the frame's moment those that show parts that deform.
    pub(crate) fn points(
        &self,
        frame: usize,
        (distances_m, parts): (&[f32], &[i16]),
        lookout: Option<&Lookout<'_>>,
        pixels: impl Iterator<Item = [u32; 2]>,
    ) -> Vec<SurfacePoint> {
        let (view, places) = (self.view(frame), self.places(frame));
        let width = view.camera().size()[0];
        let point = |[column, row]: [u32; 2]| {
            let pixel = (row * width + column) as usize;
            let (distance, part) = (f64::from(distances_m[pixel]), parts.get(pixel).copied().unwrap_or(-1));
            let y = f64::from(row) + 0.5;
            let ray = view.centre_ray(f64::from(column) + 0.5, y).filter(|_| distance.is_finite())?;
            let on = if places.deforms(i64::from(part)) { Some(lookout?.touch(&view, [column, row])?) } else { None };
            Some(SurfacePoint { p_world: ray.origin + ray.direction * distance, part, on, y })
        };
        pixels.filter_map(point).collect()
    }

    /// The place of a point that the frame `from` shows when the frame `to`, at whose moment `lookout` looks, does.
    pub(crate) fn carry(&self, [from, to]: [usize; 2], point: &SurfacePoint, lookout: Option<&Lookout<'_>>) -> DVec3 {
        let view = self.view(to);
        let deformed = lookout.zip(point.on.as_ref()).map(|(lookout, on)| lookout.place(&view, on));
        let carried = || self.places(from).carry_to(point.y, (&self.places(to), &view), i64::from(point.part), point.p_world);
        deformed.or_else(carried).unwrap_or(point.p_world)
    }

    /// True if a part of the scene deforms.
    pub(crate) fn deforms(&self) -> bool {
        self.tracks.iter().flat_map(|track| &track.bodies).any(|bodies| bodies.bodies.iter().any(|body| body.joint == DEFORM))
    }
}

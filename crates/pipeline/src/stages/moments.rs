//! Scenes that move: the moment that a frame shows, and the scene as that frame finds it. Frame n of a camera shows the scene n times the
//! camera's time between frames after its beginning.

use super::exposure::{self, Stretches};
use super::views::views;
use super::{Input, Job};
use crate::error::Error;
use enfilade_dataset::{BodyRow, Dataset, FrameBodies};
use enfilade_frame::{Frame, Layer, Values, traits};
use enfilade_math::DAffine3;
use enfilade_render::{Lookout, Moved, Ways};
use enfilade_scene::{Body, BodyStates, CameraView, PACKAGE_HEAD_BYTES, Pose, Scene, Trajectory, is_jointed_package, is_moving_package};
use std::io::Read;
use std::path::Path;

/// True if the package is of a scene that moves; what cannot be read does not.
pub(crate) fn moves(package: &Path) -> bool {
    is_moving_package(&head(package))
}

/// True if the package is of a scene with joints, whether they move or not.
pub(crate) fn has_joints(package: &Path) -> bool {
    is_jointed_package(&head(package))
}

/// The first bytes of a file; none of one that cannot be read.
fn head(package: &Path) -> Vec<u8> {
    let mut head = Vec::new();
    let read = std::fs::File::open(package).and_then(|file| file.take(PACKAGE_HEAD_BYTES).read_to_end(&mut head));
    if read.is_ok() { head } else { Vec::new() }
}

/// The files that tell how long the time between frames is, of a scene that moves.
///
/// # Errors
/// When a file is missing.
pub(super) fn inputs(job: &Job) -> Result<Vec<Input>, Error> {
    if !moves(&job.package()?) {
        return Ok(Vec::new());
    }
    let file = |trajectory: &Trajectory| Input::of(&job.dataset.layout().metadata_camera(&job.scene.name, &trajectory.name));
    job.filmed()?.iter().map(|(_, trajectory)| file(trajectory)).collect()
}

/// Seconds between the frames of a camera, if the scene of the package moves.
///
/// # Errors
/// When the camera's file cannot be read.
pub(crate) fn frame_time(dataset: &Dataset, package: &Path, scene: &str, camera: &str) -> Result<Option<f64>, Error> {
    moves(package).then(|| dataset.read_frame_time(scene, camera).map_err(Error::stage)).transpose()
}

/// A scene that moves, at the moment of a frame, and where everything goes.
pub(crate) struct Moment {
    /// The scene as the frame finds it.
    pub scene: Scene,
    /// The scene as the rows of the next frame find it: bands of rows with their first rows, mostly one; and the way to there.
    next: Option<(Vec<(u32, Scene)>, Ways)>,
    /// By part: whether it moves on the way to the next frame, or from the one before.
    moving: Vec<bool>,
    /// The scene in the middle of equal stretches of the exposure, in the order of time; none if nothing moves in it.
    pub exposed: Vec<Scene>,
    /// Bands of rows with their first rows, whose geometry shows the scene of a stretch; none if all rows show the frame's own moment.
    pub bands: Vec<(u32, usize)>,
    /// How far something moves from band to band at most, pixels.
    pub step_px: f64,
}

impl Moment {
    /// The moment of the pose `index` of a trajectory whose frames are `frame_time_s` apart; `views` are those of its poses.
    pub fn new(scene: &Scene, views: &[CameraView<'_>], poses: &[Pose], index: usize, frame_time_s: f64) -> Self {
        let at = |index: usize| poses.get(index).map(|pose| pose.moment_s(frame_time_s));
        let now = poses[index].moment_s(frame_time_s);
        let maps = |moments: &[(u32, f64)]| moments.iter().map(|(_, time_s)| scene.world_from_rest(*time_s)).collect();
        let next = at(index + 1).map(|then| {
            let (here, there) = (exposure::moments(scene, &views[index], now), exposure::moments(scene, &views[index + 1], then));
            let ways = Ways { body_of_parts: scene.body_of_parts(), here: maps(&here), there: maps(&there) };
            (there.into_iter().map(|(row, time_s)| (row, scene.at(time_s))).collect(), ways)
        });
        let carried = [at(index + 1), index.checked_sub(1).and_then(at)].map(|then| then.map(|then| scene.carried(now, then)));
        let mut moving = vec![false; scene.parts.len()];
        for carried in carried.iter().flatten() {
            for (moves, carried) in moving.iter_mut().zip(carried) {
                *moves |= carried.is_some_and(|carried| carried != DAffine3::IDENTITY);
            }
        }
        for then in [at(index + 1), index.checked_sub(1).and_then(at)].into_iter().flatten() {
            scene.deformed(now, then).into_iter().for_each(|part| moving[part as usize] = true);
        }
        let stretches = Stretches::of(scene, &views[index], now);
        let exposed = stretches.as_ref().map_or_else(Vec::new, |stretches| stretches.scenes(scene));
        let (bands, step_px) = stretches.map_or((Vec::new(), 0.0), |stretches| (stretches.bands, stretches.step_px));
        Self { scene: scene.at(now), next, moving, exposed, bands, step_px }
    }

    /// The next frame's moment, ready for flow; `None` of the last frame.
    ///
    /// # Errors
    /// When the scene has more parts than ids.
    pub fn moved(&self) -> Result<Option<Moved<'_>>, Error> {
        let Some((scenes, ways)) = &self.next else { return Ok(None) };
        Ok(Some(Lookout::of_rows(scenes).map_err(Error::stage)?.moved(ways.clone())))
    }

    /// Marks what moves in `surface_traits`, where the frame has it.
    pub fn mark(&self, frame: &mut Frame) {
        let Some(Values::I16(entities)) = frame.get(Layer::RenderEntityId) else { return };
        let moves = |&entity: &i16| usize::try_from(entity - 1).ok().and_then(|part| self.moving.get(part)).copied().unwrap_or(false);
        let moving: Vec<bool> = entities.iter().map(moves).collect();
        let Some(Values::U8(bits)) = frame.get(Layer::SurfaceTraits) else { return };
        let marked = bits.iter().zip(moving).map(|(bits, moves)| bits | if moves { traits::MOVES } else { 0 }).collect();
        frame.insert(Layer::SurfaceTraits, Values::U8(marked));
    }
}

/// Writes the tables of what moves or can move; removes those of a scene in which nothing does any longer.
pub(super) fn write_tables(job: &Job, scene: Option<&Scene>) -> Result<(), Error> {
    let name = &job.scene.name;
    let bodies = scene.map_or(&[][..], |scene| &scene.bodies);
    // Of a still scene only cameras move, which have poses of their own.
    let moving = scene.map_or_else(Vec::new, |scene| if scene.is_still() { vec![false; bodies.len()] } else { scene.moving_bodies() });
    let rows: Vec<BodyRow> = bodies.iter().zip(&moving).zip(1..).map(|((body, &moves), id)| row(body, id, moves)).collect();
    job.dataset.write_bodies(name, &rows).map_err(Error::stage)?;
    for (camera, trajectory) in job.filmed()?.iter() {
        let frame_time_s = job.dataset.read_frame_time(name, &trajectory.name).map_err(Error::stage)?;
        let views = views(camera, trajectory);
        let frame = |scene: &Scene, view: &CameraView<'_>| {
            let band = |(first_row, time_s): (u32, f64)| {
                let states = scene.bodies.iter().map(|body| body.motion.state_at(time_s)).collect();
                FrameBodies { frame: view.pose().frame, first_row, time_s, world_from_rest: scene.world_from_rest(time_s), states }
            };
            exposure::moments(scene, view, view.pose().moment_s(frame_time_s)).into_iter().map(band).collect::<Vec<_>>()
        };
        let mut frames: Vec<FrameBodies> = Vec::new();
        if let Some(scene) = scene.filter(|scene| !scene.is_still()) {
            frames.extend(views.iter().flat_map(|view| frame(scene, view)));
        }
        job.dataset.write_body_poses(name, &trajectory.name, &frames).map_err(Error::stage)?;
    }
    Ok(())
}

/// The row of a body.
fn row(body: &Body, id: u32, moves: bool) -> BodyRow {
    let (axis, point) = match &body.motion.states {
        BodyStates::Free { .. } | BodyStates::Deform { .. } => (None, None),
        BodyStates::Hinge { axis, point, .. } => (Some(axis.to_array()), Some(point.to_array())),
        BodyStates::Slide { axis, .. } => (Some(axis.to_array()), None),
    };
    BodyRow {
        id,
        name: body.name.clone(),
        parent: body.parent.map(|parent| parent + 1),
        joint: body.motion.states.joint().into(),
        axis,
        point,
        limits: body.limits,
        moves,
        node_ids: body.parts.iter().map(|part| part + 1).collect(),
    }
}

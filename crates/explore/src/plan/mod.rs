//! Trajectories: where the pictures of a scene are taken from. One file per mode, all of them under the same rules.

mod composition;
mod config;
mod coverage;
mod first;
mod gates;
mod glance;
mod headings;
mod hypersim;
mod keyframes;
mod measure;
mod objects;
mod paper;
mod patches;
mod photos;
mod places;
mod planner;
mod report;
mod rules;
mod spline;
mod stills;
mod targets;
mod timing;
mod tour;
mod video;
mod walk;

use crate::{ExploreError, FreeSpace, Preset};
use enfilade_geometry::Bvh;
use enfilade_math::Rng;
use enfilade_scene::{Cx, Pose, StartCamera, WorldMesh};
use gates::Gates;
use glance::Glancer;
use planner::{Draft, Planner};
use rules::Rules;
use targets::Targets;

pub use config::{
    CamerasConfig, CoverageConfig, KeyframesConfig, Mode, ObjectsConfig, PhotosConfig, PlanConfig, PlanKeys, StillsConfig, VideoConfig,
    WalkConfig,
};
pub use keyframes::{Keyframe, parse_keyframes};
pub use report::{
    CoverageReport, Fault, FrameValues, ObjectVisibility, PartCoverage, PlanReport, PlanStatistics, Planned, PlannedStart, RejectedCounts,
    RelaxedFrame, Spread, WalkBox, WalkBoxes,
};
pub use targets::TargetObject;

/// Finds trajectory `trajectory_index` (`cam_00`, `cam_01`, …), which begins at `start`, by the configured [`Mode`].
///
/// Every pose keeps these rules, whatever the mode: the camera is in free space, `clearance_m` from every surface and at the height above
/// the floor that is asked for; its target is in free space, at least `min_look_distance_m` away, and seen; roll and pitch are within their
/// limits; a second camera of a stereo rig has room too. Views with a [`Fault`] are taken only when nothing better is found; there is a
/// warning, and the report lists them.
///
/// The first pose is exactly the start camera's if that is in free space: clearance, roll and gates apply to poses that are chosen. It is
/// moved or turned, with a warning, only if it is not in free space, or does not have the height, the pitch or the level view that is asked
/// for. A video moves from its first frame on, so it begins at the nearest place with room for that.
///
/// # Errors
/// A configuration out of its domain, a start camera with no clear position near it or nothing to look at, or a mode that finds no
/// way to continue. Poses made by hand are not planned: [`follow`] is for them.
pub fn plan(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    trajectory_index: u32,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    plan_accepted(world, bvh, space, start, &format!("cam_{trajectory_index:02}"), trajectory_index, config, &|_| true, cx)
}

/// Plans a trajectory as [`plan`] does, but of any `name`, whose random numbers `trajectory_index` chooses, and with a final decision by
/// the caller: a view for which `accepts` is false has [`Fault::Refused`]. It is asked about views that have no other fault, from any
/// thread, and never about the first pose; the other presets do not ask.
///
/// # Errors
/// As [`plan`].
pub fn plan_accepted(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    name: &str,
    trajectory_index: u32,
    config: &PlanConfig,
    accepts: &(dyn Fn(&Pose) -> bool + Sync),
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    plan_objects(world, bvh, space, start, name, trajectory_index, config, &[], accepts, cx)
}

/// Plans a trajectory as [`plan_accepted`] does, with the objects that the mode `objects` looks at. The mode `photos` takes their parts for
/// what is a thing in a picture, and without any objects all parts shorter than 2.4 m; other modes have no use for them.
///
/// The first pose of the mode `objects` is not the start camera's. Its cameras may be nearer to what they look at than
/// `min_look_distance_m`: as near as half of the least `radius_m`.
///
/// # Errors
/// As [`plan`]; also when the mode has no objects, or no camera around them is in free space.
pub fn plan_objects(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    start: &StartCamera,
    name: &str,
    trajectory_index: u32,
    config: &PlanConfig,
    objects: &[TargetObject],
    accepts: &(dyn Fn(&Pose) -> bool + Sync),
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    config.validate()?;
    let config = &near_objects(config);
    // The common inputs of all modes: the rules of a pose, the gates of a view, and the arguments.
    let rules = Rules::new(bvh, space, config);
    let glancer = Glancer::new(&rules, world);
    let gates = Gates::new(&glancer, config, world, start, cx);
    let planner = Planner { accepts, start: Some(start), ..Planner::new(&rules, &gates, world, name, cx) };

    // Hypersim's program, step by step.
    if config.preset == Preset::Hypersim {
        let (poses, views) =
            hypersim::walk(world, bvh, space, start, name, config, &|frame| planner.progress(frame as usize, config.frames as usize))?
                .into_iter()
                .unzip();
        return Ok(measure::finish(&planner, Draft { poses, views, ..Draft::default() }));
    }

    let rng = Rng::new(config.seed).fork(u64::from(trajectory_index));
    if let Mode::Objects(mode) = &config.mode {
        let draft = objects::objects(&planner, mode, &Targets::new(world, objects)?, &rng)?;
        return Ok(measure::finish(&planner, draft));
    }

    // The first pose, then the others by the configured mode.
    let first = first::pose(&rules, start, &planner.image, cx)?;
    let draft = match &config.mode {
        Mode::Walk(_) if config.preset == Preset::Paper => paper::walk(&planner, first, &rng),
        Mode::Walk(_) => walk::walk(&planner, first, &rng),
        Mode::Video(video) => video::video(&planner, first, video, &rng),
        Mode::Stills(stills) => stills::stills(&planner, first, stills, &rng),
        Mode::Photos(photos) => photos::photos(&planner, first, photos, objects, &rng),
        Mode::Coverage(coverage) => coverage::cover(&planner, first, coverage, &rng),
        Mode::Objects(_) | Mode::Keyframes(_) | Mode::Cameras(_) => Err(ExploreError::Config {
            field: "mode",
            found: config.mode.name().into(),
            expected: "a mode that finds poses; poses that are given go to `follow` and `film`",
        }),
    }?;

    // Measure what came out.
    Ok(measure::finish(&planner, draft))
}

/// The configuration with a target distance that cameras near objects can keep.
fn near_objects(config: &PlanConfig) -> PlanConfig {
    let Mode::Objects(mode) = &config.mode else { return config.clone() };
    PlanConfig { min_look_distance_m: config.min_look_distance_m.min(0.5 * mode.radius_m[0]), ..config.clone() }
}

/// The trajectory `name` through poses made by hand, with every frame between two of them interpolated: positions and targets on
/// splines of continuous curvature, roll evenly. Nothing is fixed: frames that break a rule are named in a warning and in the report.
///
/// The first position is taken to be on the right side of things, as the start camera is in [`plan`].
///
/// # Errors
/// A configuration out of its domain, or a frame that has no view: looking straight up or down, or at its own position.
pub fn follow(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    keyframes: &[Keyframe],
    name: &str,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    config.validate()?;
    given(world, bvh, space, keyframes::interpolate(keyframes, name)?, name, config, cx)
}

/// The trajectory `name` of poses that are given, one for each frame, of which there is at least one: those of a camera of the scene. As with
/// [`follow`], nothing is changed, and frames that break a rule are named in a warning and in the report.
///
/// # Errors
/// A configuration out of its domain, or no pose.
pub fn film(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    poses: Vec<Pose>,
    name: &str,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    config.validate()?;
    if poses.is_empty() {
        return Err(ExploreError::Config { field: "poses", found: "none".into(), expected: "at least one pose" });
    }
    given(world, bvh, space, poses, name, config, cx)
}

/// A trajectory of given poses, measured.
fn given(
    world: &WorldMesh,
    bvh: &Bvh,
    space: &FreeSpace,
    poses: Vec<Pose>,
    name: &str,
    config: &PlanConfig,
    cx: &dyn Cx,
) -> Result<Planned, ExploreError> {
    let first = &poses[0];
    let start = StartCamera {
        name: name.to_string(),
        position: first.position,
        world_from_camera: first.world_from_camera,
        fov_x_rad: config.fov_x_rad,
        aspect: f64::from(config.test_width) / f64::from(config.test_height),
    };
    let rules = Rules::new(bvh, space, config);
    let glancer = Glancer::new(&rules, world);
    let gates = Gates::new(&glancer, config, world, &start, cx);
    let planner = Planner::new(&rules, &gates, world, name, cx);
    keyframes::warn_of_crossings(&planner, &poses);
    Ok(measure::finish(&planner, Draft { poses, ..Draft::default() }))
}

#[cfg(test)]
mod tests;

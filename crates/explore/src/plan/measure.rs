//! Measures a finished trajectory: fills the report, and warns of frames that break a rule.

use super::patches::patches;
use super::planner::{Draft, Planner};
use super::report::{Fault, FrameRow, FrameValues, PlanReport, PlanStatistics, Planned, PlannedStart, RelaxedFrame, WalkBox, WalkBoxes};
use super::rules::{pitch_rad, turned_rad};
use super::{Mode, PlanConfig};
use crate::{Preset, ViewStats};
use enfilade_geometry::Surfaces;
use enfilade_parallel::{map, map_up_to};
use enfilade_scene::{Pose, StartCamera, Trajectory};
use std::collections::BTreeMap;

/// Points by which the share of the area that was seen is measured.
const SAMPLES: usize = 20_000;

/// A view of which one plane fills more than this is bare.
const BARE_SHARE: f64 = 0.9;

/// Tolerance of the limits of angles, degrees.
const ROUNDING_DEG: f64 = 1e-6;

/// Tolerance of the direction of a look-at point on the axis.
const ON_AXIS: f64 = 1e-9;

/// Most frames named in a warning; it only mentions that there are more.
const FRAMES_NAMED: usize = 12;

/// The trajectory of a draft, with its report.
pub(super) fn finish(planner: &Planner, draft: Draft) -> Planned {
    // Values and faults of every frame.
    let poses = draft.poses;
    let views = if draft.views.len() == poses.len() { draft.views } else { planner.views(&poses) };
    let surfaces = Surfaces::new(&planner.world.corners);
    let start = planner.start.map(|start| planned_start(start, &poses[0]));
    let is_kept = start.as_ref().is_some_and(|start| start.is_kept);
    let measured = |i: usize| {
        let (row, mut faults) = measure(planner, &surfaces, &poses[i], &views[i], i.checked_sub(1).map(|i| &poses[i]));
        // The start camera's own pose keeps the gates' faults alone: the rules are for poses that are chosen.
        if i > 0 || !is_kept {
            faults.extend(broken_rules(planner, &poses[i], &row));
        }
        (row, faults)
    };
    let rows: Vec<(FrameRow, Vec<Fault>)> = map_up_to(poses.len(), measured);

    let mut per_frame = FrameValues::default();
    let (mut relaxed, mut bare_frames) = (Vec::new(), Vec::new());
    for (row, faults) in rows {
        relaxed.extend(faults.into_iter().map(|fault| RelaxedFrame { frame: row.frame, fault }));
        bare_frames.extend(Some(row.frame).filter(|_| row.plane_share > BARE_SHARE));
        per_frame.push(row);
    }

    // Warn of frames with a fault, except where Hypersim's program is followed, which has no such rules.
    if planner.config.preset == Preset::Default {
        warn_of_faults(planner, &relaxed, poses.len());
    }
    let (seen_area_share, seen_part_share) = seen(planner, &poses);
    let report = PlanReport {
        trajectory: planner.name.to_string(),
        mode: planner.config.mode.name().to_string(),
        preset: planner.config.preset,
        roll_limit_deg: roll_limit_deg(planner),
        walk: boxes(planner.config),
        start,
        seen_area_share,
        seen_part_share,
        statistics: PlanStatistics::of(&per_frame),
        rejected: draft.rejected,
        relaxed,
        bare_frames,
        coverage: draft.coverage,
        objects: draft.objects,
        per_frame,
    };
    Planned { trajectory: Trajectory { name: planner.name.to_string(), poses }, report }
}

/// The roll limit of poses, if they have one, degrees.
fn roll_limit_deg(planner: &Planner) -> Option<f64> {
    let is_held = planner.config.preset != Preset::Hypersim && !planner.config.mode.is_given();
    is_held.then(|| planner.rules.roll_limit_rad().to_degrees())
}

/// The boxes that a walk keeps to.
fn boxes(config: &PlanConfig) -> Option<WalkBoxes> {
    let free = WalkBox { step_m: config.step_m, height_range_m: Some(config.height_range_m) };
    match (&config.mode, config.camera_height_m.filter(|_| config.preset == Preset::Default)) {
        (Mode::Walk(_), None) => Some(WalkBoxes { position: free.clone(), target: free }),
        // The camera's height is above the floor, and its target goes with it.
        (Mode::Walk(_), Some([min, max])) => {
            let [x, y, z] = config.step_m;
            let position = WalkBox { step_m: [x, y, z.max(max - min)], height_range_m: None };
            let target = if config.level { position.clone() } else { WalkBox { step_m: config.step_m, height_range_m: None } };
            Some(WalkBoxes { position, target })
        }
        _ => None,
    }
}

/// The start camera, and whether the pose of frame 0 keeps it.
fn planned_start(start: &StartCamera, first: &Pose) -> PlannedStart {
    let ahead = (first.look_at - first.position).try_normalize();
    PlannedStart {
        name: start.name.clone(),
        position: start.position,
        world_from_camera: start.world_from_camera,
        is_kept: first.position == start.position && first.world_from_camera == start.world_from_camera,
        looks_along_axis: ahead.is_some_and(|ahead| (ahead + first.world_from_camera.z_axis).abs().max_element() < ON_AXIS),
    }
}

/// The values of one frame, and what the gates find wrong with it.
fn measure(planner: &Planner, surfaces: &Surfaces, pose: &Pose, view: &ViewStats, before: Option<&Pose>) -> (FrameRow, Vec<Fault>) {
    let (gates, glancer) = (planner.gates, planner.gates.glancer);
    let glance = glancer.look(pose);
    let row = FrameRow {
        frame: pose.frame,
        score: planner.score(view),
        void_share: view.void_share(),
        back_face_share: gates.back_face_share(&glance),
        near_share: gates.near_share(&glance),
        plane_share: glance.plane_share(),
        open_share: gates.open_shares(pose.position).into_iter().fold(0.0, f64::max),
        clearance_m: surfaces.distance_m(pose.position),
        height_m: planner.rules.height_m(pose.position),
        roll_deg: pose.roll_rad().to_degrees(),
        pitch_deg: pitch_rad(-pose.world_from_camera.z_axis).to_degrees(),
        step_m: before.map(|before| before.position.distance(pose.position)),
        turn_deg: before.map(|before| turned_rad(before, pose).to_degrees()),
        overlap: before.and_then(|before| glancer.overlap(&glance, before)),
    };
    let faults = gates.faults(pose, &glance, view, before);
    (row, faults)
}

/// The rules of [`super::plan`] that a pose breaks.
fn broken_rules(planner: &Planner, pose: &Pose, row: &FrameRow) -> impl Iterator<Item = Fault> {
    let (rules, config) = (planner.rules, planner.config);
    let within = |value: f64, [low, high]: [f64; 2]| value >= low - ROUNDING_DEG && value <= high + ROUNDING_DEG;
    let roll_limit = rules.roll_limit_rad().to_degrees();
    let tilted = !within(row.roll_deg, [-roll_limit, roll_limit]) || !within(row.pitch_deg, rules.pitch_limits_rad().map(f64::to_degrees));
    let near = pose.position.distance(pose.look_at) < config.min_look_distance_m * (1.0 - ROUNDING_DEG);
    let sight = near || !rules.is_free(pose.look_at) || !rules.sees(pose.position, pose.look_at);
    let place = !rules.is_position(pose.position) || !rules.has_room_beside(pose);
    [(Fault::Place, place), (Fault::Sight, sight), (Fault::Tilt, tilted)].into_iter().filter(|(_, broken)| *broken).map(|(fault, _)| fault)
}

/// Shares of the area and of the parts that some pose sees.
fn seen(planner: &Planner, poses: &[Pose]) -> (f64, f64) {
    let patches = patches(planner.world, SAMPLES);
    let glancer = planner.gates.glancer;
    let seen = map(&patches, |patch| poses.iter().any(|pose| glancer.sees(pose, patch.p_world)));
    let (mut area, mut seen_area, mut parts) = (0.0, 0.0, BTreeMap::new());
    for (patch, seen) in patches.iter().zip(seen) {
        area += patch.area_m2;
        seen_area += if seen { patch.area_m2 } else { 0.0 };
        *parts.entry(patch.part).or_insert(false) |= seen;
    }
    let share = |some: f64, all: f64| if all > 0.0 { some / all } else { 0.0 };
    (share(seen_area, area), share(parts.values().filter(|seen| **seen).count() as f64, parts.len() as f64))
}

/// One warning for each kind of fault.
fn warn_of_faults(planner: &Planner, relaxed: &[RelaxedFrame], frames: usize) {
    let mut by_fault: BTreeMap<Fault, Vec<u32>> = BTreeMap::new();
    for RelaxedFrame { frame, fault } in relaxed {
        by_fault.entry(*fault).or_default().push(*frame);
    }
    for (fault, found) in by_fault {
        let named: Vec<String> = found.iter().take(FRAMES_NAMED).map(u32::to_string).collect();
        let more = if found.len() > FRAMES_NAMED { ", …" } else { "" };
        let (n, what) = (found.len(), describe(planner, fault));
        planner.warn(format!("{n} of {frames} views {what} (frames {}{more})", named.join(", ")));
    }
}

/// Description of a fault of frames, and of the setting that may help.
fn describe(planner: &Planner, fault: Fault) -> String {
    let config = planner.config;
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    match fault {
        Fault::Refused => "are refused by a later gate".into(),
        Fault::Overlap => {
            let [min, max] = config.overlap.unwrap_or_default().map(percent);
            format!("share less than {min} or more than {max} with the view before, and no better ones were found: widen overlap or step_m")
        }
        Fault::Void => format!(
            "show no surface in more than {} of their pixels, and no better ones were found: the scene is open or lacks walls there",
            percent(config.max_void_share)
        ),
        Fault::Near => {
            format!("show something nearer than {} m in more than {} of their pixels", config.min_depth_m, percent(config.max_near_share))
        }
        Fault::BackFaces => format!(
            "show the back of things in more than {} of their pixels, as from outside of a room or from within a thing",
            percent(config.max_back_face_share)
        ),
        Fault::Open => {
            format!(
                "are in the open, with no surface in more than {} of the level or of the upward directions",
                percent(config.max_open_share)
            )
        }
        Fault::Place => {
            let height = config.camera_height_m.map_or(String::new(), |[min, max]| format!(", {min} to {max} m above the floor"));
            format!("are not from free space with {} m to every surface{height}", config.clearance_m)
        }
        Fault::Sight => format!("have no free and visible target {} m away", config.min_look_distance_m),
        Fault::Tilt => {
            let [low, high] = planner.rules.pitch_limits_rad().map(f64::to_degrees);
            format!("roll by more than {} degrees or look below {low} or above {high} degrees", planner.rules.roll_limit_rad().to_degrees())
        }
    }
}

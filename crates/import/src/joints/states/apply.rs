//! Gives the bodies of a robot the motion of a stored run.

use super::{States, Track};
use crate::ImportError;
use crate::assembly::Assembly;
use crate::joints::joint::{Joint, Link, quaternion, relative};
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};
use enfilade_scene::{BodyMotion, BodyStates, RigidPose};
use std::collections::BTreeMap;

/// A body that no joint moves may stand by so much elsewhere than in the model, metres: states are often of single precision.
const SAME_M: f64 = 2e-3;
/// Names of joints that errors list.
const LISTED: usize = 8;

/// A robot with its bodies and joints, in the order of its file.
pub(crate) struct Tree<'t> {
    pub joints: &'t [Joint],
    pub links: &'t [Link],
    /// Whether the order of the joints is that of `qpos`.
    pub ordered: bool,
}

/// Gives every body its motion.
///
/// # Errors
/// When the states are of another model, or one is no number.
pub(crate) fn apply(states: &States, tree: &Tree, a: &mut Assembly) -> Result<(), ImportError> {
    if tree.ordered && states.track("qpos")?.is_some() {
        return qpos(states, tree, a);
    }
    if states.track("xpos")?.is_some() {
        return poses(states, tree, a);
    }
    by_name(states, tree, a)
}

fn qpos(states: &States, tree: &Tree, a: &mut Assembly) -> Result<(), ImportError> {
    let width: usize = tree.joints.iter().map(|joint| joint.kind.width()).sum();
    let what = format!("qpos of the model's {} joints", tree.joints.len());
    let Some(track) = states.shaped("qpos", &[width], &what)? else { return Ok(()) };
    let mut first = 0;
    for joint in tree.joints {
        let steps: Vec<&[f64]> = (0..states.times_s.len()).map(|step| track.step(step, first, joint.kind.width())).collect();
        give(states, &track, joint, &steps, a)?;
        first += joint.kind.width();
    }
    mocap(states, tree, a)
}

/// Bodies that a program moves.
fn mocap(states: &States, tree: &Tree, a: &mut Assembly) -> Result<(), ImportError> {
    let moved: Vec<&Link> = tree.links.iter().filter(|link| link.mocap).collect();
    if moved.is_empty() {
        return Ok(());
    }
    let what = "the model's mocap bodies";
    let tracks = (states.shaped("mocap_pos", &[moved.len(), 3], what)?, states.shaped("mocap_quat", &[moved.len(), 4], what)?);
    let (Some(positions), Some(rotations)) = tracks else {
        a.warn("states", format!("{} mocap bodies stay at rest: the states have no mocap_pos and mocap_quat", moved.len()));
        return Ok(());
    };
    for (at, link) in moved.iter().enumerate() {
        let poses = (0..states.times_s.len()).map(|step| {
            let (position, rotation) = (positions.step(step, 3 * at, 3), rotations.step(step, 4 * at, 4));
            let placed = placed(position, rotation).ok_or_else(|| bad(states, "mocap_pos", &link.name, step, position))?;
            Ok(own_pose(link.file_from_link, placed))
        });
        let poses: Result<Vec<RigidPose>, ImportError> = poses.collect();
        a.move_body(link.body, link.file_from_link, free(&states.times_s, poses?));
    }
    Ok(())
}

/// States of joints by their names; those that are not named stay at rest.
fn by_name(states: &States, tree: &Tree, a: &mut Assembly) -> Result<(), ImportError> {
    let known: Vec<&str> = tree.joints.iter().map(|joint| joint.name.as_str()).collect();
    if let Some(name) = states.names().find(|name| !known.contains(name)) {
        let listed = known.iter().take(LISTED).map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
        let more = if known.len() > LISTED { ", …" } else { "" };
        let problem = format!("there is no joint of this name among {listed}{more}; are these states of another model?");
        return Err(states.wrong(&format!("array {name:?}"), problem));
    }
    for joint in tree.joints {
        let width = joint.kind.width();
        let axes = if width == 1 { vec![] } else { vec![width] };
        let followed = joint.mimic.as_ref().filter(|_| !states.arrays.contains_key(&joint.name));
        let source = followed.map_or(&joint.name, |mimic| &mimic.of);
        let Some(track) = states.shaped(source, &axes, "values of the joint")? else { continue };
        let factors = followed.map_or([1.0, 0.0], |mimic| [mimic.multiplier, mimic.offset]);
        let values: Vec<f64> =
            track.values.iter().map(|value| if followed.is_some() { factors[0] * value + factors[1] } else { *value }).collect();
        let steps: Vec<&[f64]> = values.chunks_exact(width).collect();
        give(states, &track, joint, &steps, a)?;
    }
    let has_states = |name: &str| states.arrays.contains_key(name);
    let without =
        tree.joints.iter().filter(|joint| !has_states(&joint.name) && !joint.mimic.as_ref().is_some_and(|m| has_states(&m.of))).count();
    if without > 0 {
        a.warn("states", format!("{without} of {} joints have no states and stay at rest", known.len()));
    }
    Ok(())
}

/// Gives the body of a joint its states.
fn give(states: &States, track: &Track, joint: &Joint, steps: &[&[f64]], a: &mut Assembly) -> Result<(), ImportError> {
    let what = format!("joint {:?}", joint.name);
    if let Some(step) = steps.iter().position(|values| !values.iter().all(|value| value.is_finite())) {
        return Err(bad(states, track.name, &what, step, steps[step]));
    }
    // A joint that stays needs one state.
    let stays = steps.windows(2).all(|pair| pair[0] == pair[1]);
    let (times, steps) = if stays { (&states.times_s[..1], &steps[..1]) } else { (&states.times_s[..], steps) };
    let motion = joint.states(steps).map_err(|step| bad(states, track.name, &what, step, steps[step]))?;
    a.move_body(joint.body, joint.file_from_frame, BodyMotion { times_s: times.to_vec(), states: motion });
    Ok(())
}

/// Poses of all bodies in the world: each is stated in relation to the body that bears it.
fn poses(states: &States, tree: &Tree, a: &mut Assembly) -> Result<(), ImportError> {
    let columns = columns(states, tree, a)?;
    let count = columns.len();
    let what = "the model's bodies, the world among them";
    let positions = states.shaped("xpos", &[count, 3], what)?;
    let rotations = states.shaped("xquat", &[count, 4], what)?;
    let (Some(positions), Some(rotations)) = (positions, rotations) else {
        return Err(states.wrong("array \"xquat\"", "it is missing; expected it beside xpos".into()));
    };
    // Maps of the world from rest, by link and step.
    let mut maps: BTreeMap<usize, Vec<DAffine3>> = BTreeMap::new();
    let by_link: BTreeMap<usize, usize> = columns.iter().enumerate().filter_map(|(column, link)| Some(((*link)?, column))).collect();
    for (index, link) in tree.links.iter().enumerate().filter(|(_, link)| link.moves()) {
        let Some(&column) = by_link.get(&index) else { continue };
        let own: Result<Vec<DAffine3>, ImportError> = (0..states.times_s.len())
            .map(|step| {
                let (position, rotation) = (positions.step(step, 3 * column, 3), rotations.step(step, 4 * column, 4));
                let placed =
                    placed(position, rotation).ok_or_else(|| bad(states, "xpos", &format!("body {:?}", link.name), step, position))?;
                Ok(placed * link.file_from_link.inverse())
            })
            .collect();
        let own = own?;
        let bearer = bearer(tree, index).and_then(|bearer| maps.get(&bearer));
        let carried = |(step, map): (usize, &DAffine3)| bearer.map_or(*map, |maps| maps[step].inverse() * *map);
        let poses: Vec<RigidPose> =
            own.iter().enumerate().map(|at| own_pose(link.file_from_link, carried(at) * link.file_from_link)).collect();
        a.move_body(link.body, link.file_from_link, free(&states.times_s, poses));
        maps.insert(index, own);
    }
    stand(states, tree, &by_link, &positions, &maps)
}

/// The nearest body around another that moves.
fn bearer(tree: &Tree, link: usize) -> Option<usize> {
    let mut at = tree.links[link].parent;
    while at != 0 && !tree.links[at].moves() {
        at = tree.links[at].parent;
    }
    (at != 0).then_some(at)
}

/// Bodies that no joint moves stand where the model has them, or else the states are of another one.
fn stand(
    states: &States,
    tree: &Tree,
    by_link: &BTreeMap<usize, usize>,
    positions: &Track,
    maps: &BTreeMap<usize, Vec<DAffine3>>,
) -> Result<(), ImportError> {
    for (index, link) in tree.links.iter().enumerate().filter(|(_, link)| !link.moves()) {
        let Some(&column) = by_link.get(&index) else { continue };
        let map = bearer(tree, index).and_then(|bearer| maps.get(&bearer)).map_or(DAffine3::IDENTITY, |maps| maps[0]);
        let (expected, found) =
            (map.transform_point3(link.file_from_link.translation), DVec3::from_slice(positions.step(0, 3 * column, 3)));
        if !found.is_finite() || expected.distance(found) > SAME_M {
            let problem = format!(
                "body {:?} is at {found} in step 0, but the model has it at {expected}; are these states of another model?",
                link.name
            );
            return Err(states.wrong("array \"xpos\"", problem));
        }
    }
    Ok(())
}

/// The link of each column of poses; by the names of bodies if the states have them, else all in the model's order.
fn columns(states: &States, tree: &Tree, a: &mut Assembly) -> Result<Vec<Option<usize>>, ImportError> {
    let Some(names) = states.texts("body_names") else { return Ok((0..tree.links.len()).map(Some).collect()) };
    let link = |name: &String| tree.links.iter().position(|link| link.name == *name);
    let columns: Vec<Option<usize>> = names.iter().map(|name| if name == "world" { Some(0) } else { link(name) }).collect();
    if let Some(at) = columns.iter().position(Option::is_none) {
        let problem = format!("the model has no body {:?}; are these states of another model?", names[at]);
        return Err(states.wrong("array \"body_names\"", problem));
    }
    let without = tree.links.iter().enumerate().filter(|(at, link)| link.moves() && !columns.contains(&Some(*at))).count();
    if without > 0 {
        a.warn(
            "states",
            format!("{without} bodies that joints move are not in body_names; they stay as they are in the bodies around them"),
        );
    }
    Ok(columns)
}

/// The placement of a position and a quaternion (w, x, y, z); `None` if one is no number, or the quaternion zero.
fn placed(position: &[f64], rotation: &[f64]) -> Option<DAffine3> {
    let position = DVec3::from_slice(position);
    let rotation = quaternion(rotation).filter(|rotation| rotation.is_finite() && position.is_finite())?;
    Some(DAffine3 { matrix3: DMat3::from_quat(rotation), translation: position })
}

/// The pose in a rigid frame of what was at the frame and is at `placed`.
fn own_pose(file_from_frame: DAffine3, placed: DAffine3) -> RigidPose {
    relative(file_from_frame.inverse(), placed.translation, DQuat::from_mat3(&placed.matrix3).normalize())
}

fn free(times_s: &[f64], poses: Vec<RigidPose>) -> BodyMotion {
    let count = if poses.windows(2).all(|pair| pair[0] == pair[1]) { 1 } else { poses.len() };
    let states = BodyStates::Free { position: DVec3::ZERO, rotation: DQuat::IDENTITY, poses: poses[..count].to_vec() };
    BodyMotion { times_s: times_s[..count].to_vec(), states }
}

fn bad(states: &States, array: &str, what: &str, step: usize, found: &[f64]) -> ImportError {
    let problem = format!("{what} is {found:?} in step {step} ({} s), expected finite numbers and a rotation", states.times_s[step]);
    states.wrong(&format!("array {array:?}"), problem)
}

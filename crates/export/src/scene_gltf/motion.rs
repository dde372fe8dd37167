//! What moves, as nodes with animations.
//!
//! A body is a node in the frame of its joint, with its parts and lights below it, at rest in the file's own state and animated by linear
//! channels. glTF interpolates rotations the shortest way, so turns have a key at least every quarter turn; then linear channels show what
//! the scene has at every moment.

use super::document::Document;
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};
use enfilade_scene::{Body, BodyStates, RigidPose, Scene};
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;

/// Moments of a node that moves, and its translation and rotation there.
type Keys = Vec<(f32, DVec3, DQuat)>;

/// Where the nodes of moving things belong.
pub(super) struct Bodies {
    /// By body: its node, and the map from the world to the node's axes, at rest; none if nothing moves.
    nodes: Vec<(usize, DAffine3)>,
    of_part: Vec<Option<u32>>,
    of_light: Vec<Option<u32>>,
    of_camera: Vec<Option<u32>>,
}

impl Bodies {
    /// Adds the nodes of the bodies of a scene that moves, and their animation.
    pub fn add(document: &mut Document, scene: &Scene) -> Self {
        let (mut of_light, mut of_camera) = (vec![None; scene.lights.len()], vec![None; scene.cameras.len()]);
        for (body, id) in scene.bodies.iter().zip(0..) {
            body.lights.iter().for_each(|&light| of_light[light as usize] = Some(id));
            body.cameras.iter().for_each(|&camera| of_camera[camera as usize] = Some(id));
        }
        let mut bodies = Self { nodes: Vec::new(), of_part: scene.body_of_parts(), of_light, of_camera };
        if !scene.moving_bodies().contains(&true) {
            if !scene.bodies.is_empty() {
                document.notes.push("joints that stay as they are have no place in glTF, so they were left out".into());
            }
            return bodies;
        }
        let mut channels = Vec::new();
        for body in &scene.bodies {
            let frame = frame(body);
            let parent_from_world = body.parent.map_or(DAffine3::IDENTITY, |parent| bodies.nodes[parent as usize].1);
            let parent_from_frame = parent_from_world * frame;
            let node = document.nodes.len();
            let (translation, rotation) = (parent_from_frame.translation, rotation(&parent_from_frame));
            document.nodes.push(json!({
                "name": body.name,
                "translation": translation.as_vec3().to_array(),
                "rotation": rotation.as_quat().to_array(),
            }));
            bodies.nodes.push((node, frame.inverse()));
            if let Some(parent) = body.parent {
                adopt(document, bodies.nodes[parent as usize].0, node);
            }
            if matches!(body.motion.states, BodyStates::Deform { .. }) {
                document.notes.push(format!("body {:?}: it deforms, which is not written; it has the shape of rest", body.name));
            } else if !body.motion.is_rest() {
                channels.push((node, keys(body, &parent_from_frame)));
            }
            if body.limits.is_some() {
                document.notes.push(format!("body {:?}: the limits of its joint have no place in glTF", body.name));
            }
        }
        animate(document, channels);
        bodies
    }

    /// The node of the body that a part belongs to, and the map from the world to its axes.
    pub fn of_part(&self, part: usize) -> Option<(usize, &DAffine3)> {
        self.of(self.of_part[part])
    }

    /// The node of the body that a light belongs to, and the map from the world to its axes.
    pub fn of_light(&self, light: usize) -> Option<(usize, &DAffine3)> {
        self.of(self.of_light[light])
    }

    /// The node of the body that a camera rides on, and the map from the world to its axes.
    pub fn of_camera(&self, camera: usize) -> Option<(usize, &DAffine3)> {
        self.of(self.of_camera[camera])
    }

    fn of(&self, body: Option<u32>) -> Option<(usize, &DAffine3)> {
        self.nodes.get(body? as usize).map(|(node, from_world)| (*node, from_world))
    }

    /// The nodes of bodies that no other one bears.
    pub fn roots<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = usize> + 'a {
        scene.bodies.iter().zip(&self.nodes).filter(|(body, _)| body.parent.is_none()).map(|(_, (node, _))| *node)
    }
}

/// Makes a node the last child of another.
pub(super) fn adopt(document: &mut Document, parent: usize, child: usize) {
    match document.nodes[parent]["children"].as_array_mut() {
        Some(children) => children.push(json!(child)),
        None => document.nodes[parent]["children"] = json!([child]),
    }
}

/// The world from the frame that a body's poses are stated in.
fn frame(body: &Body) -> DAffine3 {
    match &body.motion.states {
        BodyStates::Free { position, rotation, .. } => DAffine3::from_rotation_translation(*rotation, *position),
        BodyStates::Hinge { point, .. } => DAffine3::from_translation(*point),
        BodyStates::Slide { .. } | BodyStates::Deform { .. } => DAffine3::IDENTITY,
    }
}

fn rotation(map: &DAffine3) -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis)).normalize()
}

/// The keys of a body's node.
fn keys(body: &Body, parent_from_frame: &DAffine3) -> Keys {
    let times = moments(body);
    let turn = rotation(parent_from_frame);
    let mut keys = Keys::with_capacity(times.len());
    for (time_s, pose) in times {
        let key = (time_s as f32, parent_from_frame.transform_point3(pose.translation), turn * pose.rotation);
        match keys.last() {
            // Two states of one moment: the later one begins right after the earlier one.
            Some(&(last, ..)) if key.0 <= last => keys.push((last.next_up(), key.1, key.2)),
            _ => keys.push(key),
        }
    }
    keys
}

/// The states of a body, as poses in its frame; moments before 0, which glTF has not, are left out.
fn moments(body: &Body) -> Vec<(f64, RigidPose)> {
    let turned = |axis: DVec3, angle| RigidPose { rotation: DQuat::from_axis_angle(axis, angle), translation: DVec3::ZERO };
    let slid = |axis: DVec3, way| RigidPose { rotation: DQuat::IDENTITY, translation: axis * way };
    let times = &body.motion.times_s;
    let mut found: Vec<(f64, RigidPose)> = match &body.motion.states {
        BodyStates::Deform { .. } => Vec::new(),
        BodyStates::Free { poses, .. } => times.iter().copied().zip(poses.iter().copied()).collect(),
        BodyStates::Slide { axis, distances_m } => times.iter().zip(distances_m).map(|(&t, &way)| (t, slid(*axis, way))).collect(),
        BodyStates::Hinge { axis, angles_rad, .. } => {
            let mut found = Vec::new();
            for (at, (&time_s, &angle)) in times.iter().zip(angles_rad).enumerate() {
                if let Some(before) = at.checked_sub(1) {
                    let pieces = ((angle - angles_rad[before]).abs() / FRAC_PI_2).ceil().max(1.0) as usize;
                    let share = |piece: usize| piece as f64 / pieces as f64;
                    let between = |from: f64, to: f64, piece| from + (to - from) * share(piece);
                    found
                        .extend((1..pieces).map(|piece| {
                            (between(times[before], time_s, piece), turned(*axis, between(angles_rad[before], angle, piece)))
                        }));
                }
                found.push((time_s, turned(*axis, angle)));
            }
            found
        }
    };
    if let Some(first) = found.iter().position(|(time_s, _)| *time_s >= 0.0)
        && first > 0
    {
        let (from, to) = (found[first - 1], found[first]);
        let share = -from.0 / (to.0 - from.0);
        let rotation = from.1.rotation.slerp(to.1.rotation, share);
        found[first - 1] = (0.0, RigidPose { rotation, translation: from.1.translation.lerp(to.1.translation, share) });
        found.drain(..first - 1);
    } else if found.iter().all(|(time_s, _)| *time_s < 0.0) {
        found = found.last().map(|(_, pose)| (0.0, *pose)).into_iter().collect();
    }
    found
}

/// Adds one animation of these nodes.
fn animate(document: &mut Document, nodes: Vec<(usize, Keys)>) {
    let (mut samplers, mut channels): (Vec<Value>, Vec<Value>) = (Vec::new(), Vec::new());
    for (node, keys) in nodes {
        let times: Vec<[f32; 1]> = keys.iter().map(|(time_s, ..)| [*time_s]).collect();
        let translations: Vec<[f32; 3]> = keys.iter().map(|(_, translation, _)| translation.as_vec3().to_array()).collect();
        let rotations: Vec<[f32; 4]> = keys.iter().map(|(.., rotation)| rotation.as_quat().to_array()).collect();
        let input = document.buffer.numbers(&times, true);
        for (path, output) in
            [("translation", document.buffer.numbers(&translations, false)), ("rotation", document.buffer.numbers(&rotations, false))]
        {
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
            samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
        }
    }
    document.animations.push(json!({ "name": "motion", "samplers": samplers, "channels": channels }));
}

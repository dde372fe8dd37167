//! Animations of nodes, as rigid motion over time.
//!
//! ufbx samples the local placement of every animated node, with all pivots and layers, sixty times a second where it does not change
//! evenly, and keeps the states that matter. Nodes whose scale changes, or that take only a part of their parent's, are no bodies: see `deform`.

use super::matrix::affine;
use crate::assembly::TimedPoses;
use crate::motion;
use enfilade_math::{DAffine3, DQuat, DVec3};
use enfilade_scene::RigidPose;
use std::collections::BTreeMap;
use ufbx::{Anim, BakeOpts, BakedNode, InheritMode, Node, Quat, Scene, Vec3};

/// The motion of the nodes of a file, by number.
#[derive(Default)]
pub(super) struct Animations {
    /// States of rigid motion; `None` where it is not rigid.
    nodes: BTreeMap<u32, Option<TimedPoses>>,
}

/// The motion of a node.
pub(super) enum Motion {
    Still,
    /// The frame in the file of the node's axes at rest, and states relative to its first moment in these axes.
    Rigid(DAffine3, TimedPoses),
    /// The scale changes, only a part of the parent's scale is taken, or there are too many states.
    Other,
}

impl Animations {
    /// Samples an animation of a scene; its first moment is 0.
    ///
    /// # Errors
    /// When the library cannot.
    pub(super) fn sample(scene: &Scene, anim: &Anim, options: BakeOpts) -> Result<Self, Box<ufbx::Error>> {
        let options = BakeOpts {
            trim_start_time: true,
            resample_rate: motion::RATE_HZ,
            key_reduction_enabled: true,
            key_reduction_rotation: true,
            ..options
        };
        let baked = ufbx::bake_anim(scene, anim, options)?;
        let moves = |node: &&BakedNode| !(node.constant_translation && node.constant_rotation && node.constant_scale);
        Ok(Self { nodes: baked.nodes.iter().filter(moves).map(|node| (node.typed_id, states(node))).collect() })
    }

    /// How a node moves.
    pub(super) fn of(&self, node: &Node) -> Motion {
        match self.nodes.get(&node.element.typed_id) {
            None => Motion::Still,
            Some(Some(states)) if node.inherit_mode == InheritMode::Normal => {
                let local = &node.local_transform;
                let parent_from_frame = DAffine3::from_rotation_translation(rotation(&local.rotation), vector(&local.translation));
                let file_from_parent = node.parent.as_ref().map_or(DAffine3::IDENTITY, |parent| affine(&parent.node_to_world));
                Motion::Rigid(file_from_parent * parent_from_frame, states.clone())
            }
            Some(_) => Motion::Other,
        }
    }
}

/// The states of a sampled node, if its motion is rigid.
fn states(node: &BakedNode) -> Option<TimedPoses> {
    if !node.constant_scale {
        return None;
    }
    let (translations, rotations) = (node.translation_keys.as_ref(), node.rotation_keys.as_ref());
    let moments = translations.iter().map(|key| key.time).chain(rotations.iter().map(|key| key.time)).collect();
    let at = |time_s: f64| {
        let translation = vector(&ufbx::evaluate_baked_vec3(translations, time_s));
        (translation, rotation(&ufbx::evaluate_baked_quat(rotations, time_s)))
    };
    let (start, turn) = at(0.0);
    let back = turn.inverse();
    let states = motion::states(moments, |time_s, _| {
        let (translation, rotation) = at(time_s);
        RigidPose { rotation: (back * rotation).normalize(), translation: back * (translation - start) }
    });
    states.ok().flatten()
}

fn vector(v: &Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

fn rotation(q: &Quat) -> DQuat {
    DQuat::from_xyzw(q.x, q.y, q.z, q.w).normalize()
}

//! Bodies: parts that move together, and how they move over time.
//!
//! A scene's placements are its rest: where everything is while nothing has moved. The motion of a body is a map of the world to itself,
//! relative to that rest, and is carried on to the bodies that it bears: a drawer moves with its cupboard.

use crate::deform::{Shape, mixed};
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index into [`Scene::bodies`](crate::Scene::bodies).
pub type BodyId = u32;

/// The word for bodies whose part deforms, in place of that for their joint.
pub const DEFORM: &str = "deform";

/// By how much an axis or a rotation may differ from unit length, and axes of a similarity from one length.
const UNIT: f64 = 1e-6;

/// Parts, lights and cameras that move as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Unique among the bodies of the scene.
    pub name: String,
    /// The body that bears it, which comes before it.
    pub parent: Option<BodyId>,
    /// Indices of the body's parts, in ascending order; no part has two bodies.
    pub parts: Vec<u32>,
    /// Indices of the body's lights, in ascending order.
    pub lights: Vec<u32>,
    /// Indices of the cameras of the scene that ride on the body, in ascending order. Packages have them apart from the rest.
    #[serde(skip)]
    pub cameras: Vec<u32>,
    /// The least and the greatest state of the joint: radians of a hinge, metres of a slide, from rest. `None` of a joint without end, and of
    /// free bodies. Joints of things that close are closed at the least and open at the greatest. States beyond them are no error: what a
    /// simulator or an animation says is taken.
    pub limits: Option<[f64; 2]>,
    /// Motion relative to its parent.
    pub motion: BodyMotion,
}

/// Motion of a body relative to the one that bears it: states at moments. Between two moments the state is interpolated; before the first
/// and after the last it stays. Where two states have one moment, the later one begins there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyMotion {
    /// Seconds; they do not descend.
    pub times_s: Vec<f64>,
    /// The states, one for each moment.
    pub states: BodyStates,
}

/// States of a body, by the joint that it has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum BodyStates {
    /// Any pose. Rotations are interpolated along the shortest way (slerp), translations linearly.
    Free {
        /// Position and axes of the frame that poses are stated in, world, at rest.
        position: DVec3,
        /// Rotation of that frame.
        rotation: DQuat,
        /// Poses in the frame: the identity is rest.
        poses: Vec<RigidPose>,
    },
    /// Turns about an axis.
    Hinge {
        /// A point on the axis, world, at rest.
        point: DVec3,
        /// Direction of the axis, world, at rest; unit length.
        axis: DVec3,
        /// Angles, counter-clockwise seen against the axis; 0 is rest.
        angles_rad: Vec<f64>,
    },
    /// Slides along an axis.
    Slide {
        /// Direction, world, at rest; unit length.
        axis: DVec3,
        /// Distances; 0 is rest.
        distances_m: Vec<f64>,
    },
    /// Stays where it is, and its only part changes its shape: every vertex goes straight from one shape to the next. What it bears does not
    /// follow.
    Deform {
        /// Shapes of the part's mesh, which has that of rest itself.
        shapes: Vec<Arc<Shape>>,
    },
}

/// A rotation, then a translation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidPose {
    /// Unit length.
    pub rotation: DQuat,
    /// Metres.
    pub translation: DVec3,
}

impl RigidPose {
    /// No motion.
    pub const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    fn map(&self) -> DAffine3 {
        DAffine3 { matrix3: DMat3::from_quat(self.rotation), translation: self.translation }
    }
}

impl BodyStates {
    /// This joint in other states, radians of a hinge or metres of a slide; `None` of free bodies and such that deform.
    pub fn with_values(&self, values: Vec<f64>) -> Option<Self> {
        match self {
            Self::Free { .. } | Self::Deform { .. } => None,
            Self::Hinge { point, axis, .. } => Some(Self::Hinge { point: *point, axis: *axis, angles_rad: values }),
            Self::Slide { axis, .. } => Some(Self::Slide { axis: *axis, distances_m: values }),
        }
    }

    /// The map of the world that takes what has this joint from rest to a state, radians of a hinge or metres of a slide; of what has no
    /// such joint, to the first of its own states.
    pub fn map_to(&self, state: f64) -> DAffine3 {
        let states = self.with_values(vec![state]).unwrap_or_else(|| self.clone());
        BodyMotion { times_s: vec![0.0], states }.world_from_rest(0.0)
    }

    /// The word for the joint.
    pub fn joint(&self) -> &'static str {
        match self {
            Self::Free { .. } => "free",
            Self::Hinge { .. } => "hinge",
            Self::Slide { .. } => "slide",
            Self::Deform { .. } => DEFORM,
        }
    }
}

impl BodyMotion {
    /// A motion of no joint that stays at rest.
    pub fn rest() -> Self {
        let states = BodyStates::Free { position: DVec3::ZERO, rotation: DQuat::IDENTITY, poses: vec![RigidPose::IDENTITY] };
        Self { times_s: vec![0.0], states }
    }

    /// The same joint, which stays at rest.
    #[must_use]
    pub fn rested(&self) -> Self {
        let states = match &self.states {
            BodyStates::Free { position, rotation, .. } => {
                Some(BodyStates::Free { position: *position, rotation: *rotation, poses: vec![RigidPose::IDENTITY] })
            }
            joint => joint.with_values(vec![0.0]),
        };
        states.map_or_else(Self::rest, |states| Self { times_s: vec![0.0], states })
    }

    /// True when it never leaves rest.
    pub fn is_rest(&self) -> bool {
        match &self.states {
            BodyStates::Free { poses, .. } => poses.iter().all(|pose| *pose == RigidPose::IDENTITY),
            BodyStates::Deform { .. } => false,
            BodyStates::Hinge { angles_rad: values, .. } | BodyStates::Slide { distances_m: values, .. } => {
                values.iter().all(|&value| value == 0.0)
            }
        }
    }

    /// The shape of its part at a moment; `None` of bodies that do not deform.
    pub fn shape_at(&self, time_s: f64) -> Option<Arc<Shape>> {
        match &self.states {
            BodyStates::Deform { shapes } => Some(mixed(shapes, self.between(time_s))),
            _ => None,
        }
    }

    /// The state at a moment: radians of a hinge, metres of a slide; `None` of free bodies and such that deform.
    pub fn state_at(&self, time_s: f64) -> Option<f64> {
        match &self.states {
            BodyStates::Free { .. } | BodyStates::Deform { .. } => None,
            BodyStates::Hinge { angles_rad: values, .. } | BodyStates::Slide { distances_m: values, .. } => {
                Some(self.mixed(values, time_s))
            }
        }
    }

    fn mixed(&self, values: &[f64], time_s: f64) -> f64 {
        let (before, after, share) = self.between(time_s);
        values[before] + (values[after] - values[before]) * share
    }

    /// The map of the world to itself that takes the body from rest to its place at a moment, while its parent rests.
    pub fn world_from_rest(&self, time_s: f64) -> DAffine3 {
        match &self.states {
            BodyStates::Deform { .. } => DAffine3::IDENTITY,
            BodyStates::Slide { axis, distances_m } => DAffine3::from_translation(*axis * self.mixed(distances_m, time_s)),
            BodyStates::Hinge { point, axis, angles_rad } => {
                let matrix3 = DMat3::from_axis_angle(*axis, self.mixed(angles_rad, time_s));
                DAffine3 { matrix3, translation: *point - matrix3 * *point }
            }
            BodyStates::Free { position, rotation, poses } => {
                let (before, after, share) = self.between(time_s);
                let [a, b] = [&poses[before], &poses[after]];
                let pose =
                    RigidPose { rotation: a.rotation.slerp(b.rotation, share), translation: a.translation.lerp(b.translation, share) };
                let frame = RigidPose { rotation: *rotation, translation: *position }.map();
                if pose == RigidPose::IDENTITY { DAffine3::IDENTITY } else { frame * pose.map() * frame.inverse() }
            }
        }
    }

    /// The states around a moment, and the share of the second.
    fn between(&self, time_s: f64) -> (usize, usize, f64) {
        let after = self.times_s.partition_point(|&t| t <= time_s);
        let last = self.times_s.len() - 1;
        if after == 0 || after > last {
            return (after.min(last), after.min(last), 0.0);
        }
        let [from, to] = [self.times_s[after - 1], self.times_s[after]];
        (after - 1, after, (time_s - from) / (to - from))
    }

    /// Number of states.
    pub(crate) fn count(&self) -> usize {
        match &self.states {
            BodyStates::Free { poses, .. } => poses.len(),
            BodyStates::Hinge { angles_rad, .. } => angles_rad.len(),
            BodyStates::Slide { distances_m, .. } => distances_m.len(),
            BodyStates::Deform { shapes } => shapes.len(),
        }
    }

    /// The motion after the world was carried away by a similarity.
    fn carried(&self, by: &Similarity) -> Self {
        let states = match &self.states {
            // In the mesh's own space.
            deform @ BodyStates::Deform { .. } => deform.clone(),
            BodyStates::Slide { axis, distances_m } => BodyStates::Slide {
                axis: by.rotation * *axis,
                distances_m: distances_m.iter().map(|distance| by.scale * distance).collect(),
            },
            BodyStates::Hinge { point, axis, angles_rad } => {
                BodyStates::Hinge { point: by.map.transform_point3(*point), axis: by.rotation * *axis, angles_rad: angles_rad.clone() }
            }
            BodyStates::Free { position, rotation, poses } => BodyStates::Free {
                position: by.map.transform_point3(*position),
                rotation: (by.rotation * *rotation).normalize(),
                poses: poses.iter().map(|pose| RigidPose { translation: by.scale * pose.translation, ..*pose }).collect(),
            },
        };
        Self { times_s: self.times_s.clone(), states }
    }

    /// What is wrong with it, if anything.
    fn problem(&self) -> Option<String> {
        let (times, count) = (&self.times_s, self.count());
        if times.is_empty() || times.len() != count {
            return Some(format!("{} moments for {count} states; expected as many of both, and at least one", times.len()));
        }
        if let Some(at) = times.iter().position(|time| !time.is_finite()) {
            return Some(format!("moment {at} is {}, expected a finite number of seconds", times[at]));
        }
        if let Some(at) = times.windows(2).position(|pair| pair[1] < pair[0]) {
            return Some(format!("moment {} ({} s) comes before the one ahead of it ({} s)", at + 1, times[at + 1], times[at]));
        }
        let off = |length: f64| (length - 1.0).abs() > UNIT || !length.is_finite();
        let numbers = |values: &[f64]| values.iter().position(|value| !value.is_finite());
        let bad = |at: usize| Some(format!("state {at} (at {} s) is not finite", times[at]));
        match &self.states {
            BodyStates::Hinge { axis, point, .. } if off(axis.length()) || !point.is_finite() => {
                Some(format!("no axis: {axis} at {point}"))
            }
            BodyStates::Slide { axis, .. } if off(axis.length()) => Some(format!("no axis: {axis}")),
            BodyStates::Hinge { angles_rad: values, .. } | BodyStates::Slide { distances_m: values, .. } => numbers(values).and_then(bad),
            BodyStates::Free { position, rotation, .. } if !position.is_finite() || off(rotation.length()) => {
                Some(format!("no frame: {rotation} at {position}"))
            }
            // With its part, by the scene.
            BodyStates::Deform { .. } => None,
            BodyStates::Free { poses, .. } => {
                let wrong = |pose: &RigidPose| !pose.translation.is_finite() || off(pose.rotation.length());
                let at = poses.iter().position(wrong)?;
                Some(format!("state {at} (at {} s) is not a rigid pose: {} {}", times[at], poses[at].rotation, poses[at].translation))
            }
        }
    }
}

/// A map that keeps shapes: rotation, one scale, translation.
struct Similarity {
    map: DAffine3,
    scale: f64,
    rotation: DQuat,
}

impl Similarity {
    /// The map, if it keeps shapes and does not mirror.
    fn of(map: &DAffine3) -> Option<Self> {
        let m = map.matrix3;
        let scale = m.determinant().cbrt();
        let turn = m * (1.0 / scale);
        let off = (turn * turn.transpose() - DMat3::IDENTITY).to_cols_array().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        (scale > 0.0 && off <= UNIT).then(|| Self { map: *map, scale, rotation: DQuat::from_mat3(&turn).normalize() })
    }
}

impl Body {
    /// The body after the world was carried away by `map`; `None` if the map distorts or mirrors, so that the motion would not be rigid.
    pub fn carried(&self, map: &DAffine3) -> Option<Self> {
        let by = Similarity::of(map)?;
        let limits = match self.motion.states {
            BodyStates::Slide { .. } => self.limits.map(|ends| ends.map(|end| by.scale * end)),
            _ => self.limits,
        };
        Some(Self { limits, motion: self.motion.carried(&by), ..self.clone() })
    }

    /// What is wrong with the joint, if anything.
    pub(crate) fn problem(&self) -> Option<String> {
        match (self.limits, &self.motion.states) {
            (Some(_), BodyStates::Free { .. } | BodyStates::Deform { .. }) => {
                Some("a free body has no limits, nor has one that deforms; expected a hinge or a slide".into())
            }
            (Some([least, greatest]), _) if !least.is_finite() || !greatest.is_finite() || least > greatest => {
                Some(format!("limits {least} to {greatest}; expected two finite numbers, the least first"))
            }
            _ => self.motion.problem(),
        }
    }
}

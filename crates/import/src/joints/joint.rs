//! Joints of robots, as bodies of the scene: what they carry moves by the states that are given for them, and is at rest without.

use crate::assembly::Assembly;
use enfilade_math::{DAffine3, DQuat, DVec3};
use enfilade_scene::{BodyId, BodyMotion, BodyStates, RigidPose};

/// Kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Turns about an axis; one angle, radians.
    Hinge,
    /// Slides along an axis; one distance, metres.
    Slide,
    /// Turns about a point; a quaternion (w, x, y, z).
    Ball,
    /// Any pose in the world; a position, metres, and a quaternion (w, x, y, z).
    Free,
}

/// A joint of a robot.
pub(crate) struct Joint {
    pub name: String,
    pub kind: Kind,
    /// Frame at rest: its origin is a point of the axis, or that of the body of a free one.
    pub file_from_frame: DAffine3,
    /// Unit length, in the frame.
    pub axis: DVec3,
    /// The state at rest of hinges and slides.
    pub zero: f64,
    /// Units of the file in one of the states': a metre of slides. 1 of all else.
    pub per_metre: f64,
    /// Least and greatest state relative to rest, if it has limits.
    pub limits: Option<[f64; 2]>,
    /// The joint that it follows where it has no states of its own.
    pub mimic: Option<Mimic>,
    /// The body that it moves, unless that cannot move rigidly.
    pub body: Option<BodyId>,
}

/// A joint that follows another: its state is `multiplier` × the other's + `offset`.
pub(crate) struct Mimic {
    pub of: String,
    pub multiplier: f64,
    pub offset: f64,
}

/// A body of a robot (a link in URDF).
pub(crate) struct Link {
    pub name: String,
    /// At rest.
    pub file_from_link: DAffine3,
    /// Whether joints move it in relation to the body that it is in.
    pub jointed: bool,
    /// Whether a program moves it (MuJoCo's mocap bodies).
    pub mocap: bool,
    /// The body of the scene that it moves with.
    pub body: Option<BodyId>,
    /// The one that it is in; of the first, itself.
    pub parent: usize,
}

impl Link {
    /// Whether anything moves it in relation to the body that it is in.
    pub(crate) fn moves(&self) -> bool {
        self.jointed || self.mocap
    }
}

impl Kind {
    /// Number of values of a state.
    pub(crate) const fn width(self) -> usize {
        match self {
            Self::Hinge | Self::Slide => 1,
            Self::Ball => 4,
            Self::Free => 7,
        }
    }
}

impl Joint {
    /// A joint of any pose in the world.
    pub(crate) fn free(name: &str, file_from_frame: DAffine3) -> Self {
        Self {
            name: name.into(),
            kind: Kind::Free,
            file_from_frame,
            axis: DVec3::Z,
            zero: 0.0,
            per_metre: 1.0,
            limits: None,
            mimic: None,
            body: None,
        }
    }

    /// Adds its body to the scene, at rest.
    pub(crate) fn push(&mut self, body: &str, parent: Option<BodyId>, a: &mut Assembly) {
        let states = self.states(&[]);
        let motion = BodyMotion { times_s: vec![0.0], states: states.unwrap_or_else(|_| BodyMotion::rest().states) };
        self.body = a.push_jointed(body, parent, self.file_from_frame, motion, self.limits).or_else(|| a.no_body(body));
    }

    /// States by the values of each step; the state of rest without any.
    ///
    /// # Errors
    /// The step whose quaternion has no length.
    pub(crate) fn states(&self, steps: &[&[f64]]) -> Result<BodyStates, usize> {
        let single = |values: &[&[f64]]| {
            let relative: Vec<f64> = values.iter().map(|step| step[0] * self.per_metre - self.zero).collect();
            if relative.is_empty() { vec![0.0] } else { relative }
        };
        let poses = |pose: &dyn Fn(&[f64]) -> Option<RigidPose>| {
            let poses: Result<Vec<_>, usize> = steps.iter().enumerate().map(|(step, values)| pose(values).ok_or(step)).collect();
            let poses = poses.map(|poses| if poses.is_empty() { vec![RigidPose::IDENTITY] } else { poses });
            Ok(BodyStates::Free { position: DVec3::ZERO, rotation: DQuat::IDENTITY, poses: poses? })
        };
        match self.kind {
            Kind::Hinge => Ok(BodyStates::Hinge { point: DVec3::ZERO, axis: self.axis, angles_rad: single(steps) }),
            Kind::Slide => Ok(BodyStates::Slide { axis: self.axis, distances_m: single(steps) }),
            Kind::Ball => poses(&|q| Some(RigidPose { rotation: quaternion(q)?, translation: DVec3::ZERO })),
            Kind::Free => {
                let frame_from_file = self.file_from_frame.inverse();
                poses(&|q| Some(relative(frame_from_file, DVec3::from_slice(q), quaternion(&q[3..])?)))
            }
        }
    }
}

/// The pose within a rigid frame of what the file has at a position and rotation.
pub(crate) fn relative(frame_from_file: DAffine3, position: DVec3, rotation: DQuat) -> RigidPose {
    let turn = DQuat::from_mat3(&frame_from_file.matrix3).normalize();
    RigidPose { rotation: (turn * rotation).normalize(), translation: frame_from_file.transform_point3(position) }
}

/// The rotation of a quaternion (w, x, y, z) of any length; `None` of zero.
pub(crate) fn quaternion(q: &[f64]) -> Option<DQuat> {
    let turn = DQuat::from_xyzw(q[1], q[2], q[3], q[0]);
    (turn.length() > 1e-12).then(|| turn.normalize())
}

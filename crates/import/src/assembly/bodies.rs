//! What moves: bodies of the file, with what they carry.

use super::Assembly;
use enfilade_math::{DAffine3, DQuat, DVec3};
use enfilade_scene::{Body, BodyId, BodyMotion, BodyStates, RigidPose};

/// Moments, seconds, and the pose at each.
pub(crate) type TimedPoses = (Vec<f64>, Vec<RigidPose>);

/// Numbers of parts and lights that were there at a moment of the import.
#[derive(Clone, Copy)]
pub(crate) struct Contents {
    parts: u32,
    lights: u32,
}

impl Assembly<'_> {
    /// The parts and lights that are there so far.
    pub(crate) fn contents(&self) -> Contents {
        Contents { parts: self.scene.parts.len() as u32, lights: self.scene.lights.len() as u32 }
    }

    /// A body that moves by `poses` in a frame of the file: the identity is rest. `None`, with a warning, if the frame is distorted or
    /// mirrored, so that the motion is not rigid.
    pub(crate) fn push_body(
        &mut self,
        name: &str,
        parent: Option<BodyId>,
        file_from_frame: DAffine3,
        (times_s, poses): TimedPoses,
    ) -> Option<BodyId> {
        let states = BodyStates::Free { position: DVec3::ZERO, rotation: DQuat::IDENTITY, poses };
        let taken = |name: &str| self.scene.bodies.iter().any(|body| body.name == name);
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let unique = std::iter::once(name.to_string()).chain(numbered).find(|name| !taken(name)).unwrap_or_default();
        let motion = BodyMotion { times_s, states };
        let body = Body { name: unique, parent, parts: Vec::new(), lights: Vec::new(), limits: None, motion };
        let Some(body) = body.carried(&(self.world_from_file * file_from_frame)) else {
            self.warn(
                format!("node {name:?}"),
                "it moves within something that is stretched or mirrored, which is no rigid motion; it stays",
            );
            return None;
        };
        self.scene.bodies.push(body);
        Some(self.scene.bodies.len() as BodyId - 1)
    }

    /// Gives a body the parts and lights that came after `before`.
    pub(crate) fn carry(&mut self, body: BodyId, before: Contents) {
        let now = self.contents();
        let body = &mut self.scene.bodies[body as usize];
        body.parts.extend(before.parts..now.parts);
        body.lights.extend(before.lights..now.lights);
    }

    /// Number of the bodies that carry something, themselves or by others.
    pub(crate) fn drop_unused_bodies(&mut self) -> usize {
        self.scene.remove_unused_bodies();
        self.scene.bodies.len()
    }
}

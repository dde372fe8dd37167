//! What moves: bodies of the file, with what they carry.

use super::Assembly;
use enfilade_math::{DAffine3, DQuat, DVec3};
use enfilade_scene::{Body, BodyId, BodyMotion, BodyStates, PartId, RigidPose, Shape};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Moments, seconds, and the pose at each.
pub(crate) type TimedPoses = (Vec<f64>, Vec<RigidPose>);

/// Moments, seconds, and the shape of a mesh at each.
pub(crate) type TimedShapes = (Vec<f64>, Vec<Arc<Shape>>);

/// Numbers of parts, lights and cameras that were there at a moment of the import.
#[derive(Clone, Copy)]
pub(crate) struct Contents {
    parts: u32,
    lights: u32,
    cameras: u32,
}

impl Contents {
    /// What remains of a span when spans within it, in their order, are taken out.
    pub(crate) fn without([mut begin, end]: [Self; 2], holes: &[[Self; 2]]) -> Vec<[Self; 2]> {
        let mut kept = Vec::new();
        for [from, to] in holes {
            let is_within = begin.is_before(from) && from.is_before(to) && to.is_before(&end);
            if is_within {
                kept.push([begin, *from]);
                begin = *to;
            }
        }
        kept.push([begin, end]);
        kept
    }

    fn is_before(&self, other: &Self) -> bool {
        self.parts <= other.parts && self.lights <= other.lights && self.cameras <= other.cameras
    }
}

/// Why a node is no body.
pub(crate) const STRETCHED: &str = "it moves within something that is stretched or mirrored, which is no rigid motion; it stays";

impl Assembly<'_> {
    /// The parts, lights and cameras that are there so far.
    pub(crate) fn contents(&self) -> Contents {
        let [parts, lights, cameras] = [self.scene.parts.len(), self.scene.lights.len(), self.scene.cameras.len()].map(|n| n as u32);
        Contents { parts, lights, cameras }
    }

    /// Whether lights or cameras came after `before`.
    pub(crate) fn has_more_than_parts(&self, before: Contents) -> bool {
        let now = self.contents();
        now.lights > before.lights || now.cameras > before.cameras
    }

    /// A body that moves by `poses` in a frame of the file: the identity is rest. `None` if the frame is distorted or mirrored, so that the
    /// motion is not rigid.
    #[must_use]
    pub(crate) fn push_body(
        &mut self,
        name: &str,
        parent: Option<BodyId>,
        file_from_frame: DAffine3,
        (times_s, poses): TimedPoses,
    ) -> Option<BodyId> {
        let states = BodyStates::Free { position: DVec3::ZERO, rotation: DQuat::IDENTITY, poses };
        self.push_jointed(name, parent, file_from_frame, BodyMotion { times_s, states }, None)
    }

    /// A body whose motion is stated in a frame of the file, as [`Assembly::push_body`] adds it, with the least and greatest of its states.
    #[must_use]
    pub(crate) fn push_jointed(
        &mut self,
        name: &str,
        parent: Option<BodyId>,
        file_from_frame: DAffine3,
        motion: BodyMotion,
        limits: Option<[f64; 2]>,
    ) -> Option<BodyId> {
        let body =
            Body { name: self.unique_body(name), parent, parts: Vec::new(), lights: Vec::new(), cameras: Vec::new(), limits, motion };
        let body = body.carried(&(self.world_from_file * file_from_frame))?;
        self.scene.bodies.push(body);
        Some(self.scene.bodies.len() as BodyId - 1)
    }

    /// Warns of a node that could not be added as a body; gives none.
    pub(crate) fn no_body(&mut self, name: &str) -> Option<BodyId> {
        self.warn(format!("node {name:?}"), STRETCHED);
        None
    }

    /// Makes a part deform in its own mesh's space, borne by a body if there is one. False, with a warning, if the mesh that the part has
    /// became another one than that of the shapes.
    pub(crate) fn deform(&mut self, part: PartId, parent: Option<BodyId>, (times_s, shapes): TimedShapes) -> bool {
        let placed = &self.scene.parts[part as usize];
        let (name, vertices) = (placed.name.clone(), self.scene.meshes[placed.mesh as usize].positions.len());
        if shapes.iter().any(|shape| shape.positions.len() != vertices) {
            self.warn(format!("part {name:?}"), "its shape changes, but its mesh was repaired or painted; it keeps its shape of rest");
            return false;
        }
        let (name, motion) = (self.unique_body(&name), BodyMotion { times_s, states: BodyStates::Deform { shapes } });
        let (parts, lights, cameras) = (vec![part], Vec::new(), Vec::new());
        self.scene.bodies.push(Body { name, parent, parts, lights, cameras, limits: None, motion });
        true
    }

    /// A name that no body has, made from `name`.
    fn unique_body(&self, name: &str) -> String {
        let taken = |name: &str| self.scene.bodies.iter().any(|body| body.name == name);
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        std::iter::once(name.to_string()).chain(numbered).find(|name| !taken(name)).unwrap_or_default()
    }

    /// Gives a body another motion, which is stated in a frame of the file as in [`Assembly::push_jointed`].
    pub(crate) fn move_body(&mut self, body: Option<BodyId>, file_from_frame: DAffine3, motion: BodyMotion) {
        let Some(body) = body.map(|body| &mut self.scene.bodies[body as usize]) else { return };
        let limits = body.limits;
        let moved = Body { motion, ..body.clone() }.carried(&(self.world_from_file * file_from_frame));
        *body = Body { limits, ..moved.unwrap_or_else(|| body.clone()) };
    }

    /// Gives a body the parts, lights and cameras that came after `before`, but parts that deform.
    pub(crate) fn carry(&mut self, body: BodyId, before: Contents) {
        let now = self.contents();
        self.carry_between(body, [before, now]);
    }

    /// Gives a body the parts, lights and cameras that came between two moments of the import, but parts that deform. After calls that are not
    /// in this order, [`Assembly::sort_bodies`] has to follow.
    pub(crate) fn carry_between(&mut self, body: BodyId, [before, after]: [Contents; 2]) {
        let deform = |body: &&Body| matches!(body.motion.states, BodyStates::Deform { .. });
        let taken: BTreeSet<PartId> = self.scene.bodies.iter().filter(deform).flat_map(|body| body.parts.iter().copied()).collect();
        let body = &mut self.scene.bodies[body as usize];
        body.parts.extend((before.parts..after.parts).filter(|part| !taken.contains(part)));
        body.lights.extend(before.lights..after.lights);
        body.cameras.extend(before.cameras..after.cameras);
    }

    /// Gives a body a part; [`Assembly::sort_bodies`] has to follow.
    pub(crate) fn carry_part(&mut self, body: BodyId, part: PartId) {
        self.scene.bodies[body as usize].parts.push(part);
    }

    /// Makes the states of bodies at their first moment the rest of the scene.
    pub(crate) fn settle_bodies(&mut self) {
        self.drop_unused_bodies();
        if self.scene.bodies.iter().any(|body| !body.motion.is_rest()) {
            self.scene = self.scene.still_at(0.0);
        }
    }

    /// Puts the contents of bodies in their order.
    pub(crate) fn sort_bodies(&mut self) {
        for body in &mut self.scene.bodies {
            [&mut body.parts, &mut body.lights, &mut body.cameras].into_iter().for_each(|numbers| numbers.sort_unstable());
        }
    }

    /// Whether a body has anything that came between two moments of the import.
    pub(crate) fn is_carried(&self, [before, after]: [Contents; 2]) -> bool {
        let has = |numbers: &[u32], span: std::ops::Range<u32>| numbers.iter().any(|number| span.contains(number));
        self.scene.bodies.iter().any(|body| {
            has(&body.parts, before.parts..after.parts)
                || has(&body.lights, before.lights..after.lights)
                || has(&body.cameras, before.cameras..after.cameras)
        })
    }

    /// Makes a moment of the bodies' time, seconds, the first one of the scene.
    pub(crate) fn begin_at(&mut self, start_s: f64) {
        self.scene.bodies.iter_mut().flat_map(|body| &mut body.motion.times_s).for_each(|time_s| *time_s -= start_s);
    }

    /// Takes out the bodies that carry nothing, themselves or by others; the number of those that move.
    pub(crate) fn drop_unused_bodies(&mut self) -> usize {
        self.scene.remove_unused_bodies();
        // What deforms is called as its part is, unless a body that is left has that name.
        for number in 0..self.scene.bodies.len() {
            let Body { parts, motion, .. } = &self.scene.bodies[number];
            if let (BodyStates::Deform { .. }, [part]) = (&motion.states, parts.as_slice()) {
                let part = self.scene.parts[*part as usize].name.clone();
                if self.unique_body(&part) == part {
                    self.scene.bodies[number].name = part;
                }
            }
        }
        self.scene.bodies.iter().filter(|body| !body.motion.is_rest()).count()
    }
}

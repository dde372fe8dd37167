//! Joints of `UsdPhysics`: rigid bodies that move, with axis and limits, <https://openusd.org/release/api/usd_physics_page_front.html>.
//!
//! | feature | what becomes of it |
//! |---|---|
//! | `PhysicsRevoluteJoint`, `PhysicsPrismaticJoint` | hinges and slides about `physics:axis` through the frame of the body that is borne. The stage's own poses are rest: limits (degrees, or units of the stage) and states count from where both frames of the joint meet |
//! | `PhysicsSphericalJoint` | a ball, without its cone |
//! | `PhysicsFixedJoint` | holds both bodies together |
//! | other joints, drives, masses, colliders | without effect |
//! | `physics:body0`, `physics:body1` | prims with `PhysicsRigidBodyAPI`, or below one; any other prim, or none, is the world. What is below a body moves with it, but for bodies of their own |
//! | `physics:jointEnabled` | false leaves a joint out |
//! | circles | refused, unless a joint of the circle has `physics:excludeFromArticulation`, which is left out |

use super::layer::field;
use super::operation::rotation;
use super::stage::{Prim, Stage};
use crate::ImportError;
use crate::assembly::{Assembly, Contents, orthonormal};
use crate::joints::graph::{Edge, Piece, Trees};
use crate::joints::joint::{Joint, Kind};
use crate::joints::states::{self, States, Tree};
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// Schema of rigid bodies.
const BODY: &str = "PhysicsRigidBodyAPI";
/// The frames of a joint may be so far apart at rest, metres and radians.
const APART: [f64; 2] = [1e-3, 1e-2];

/// Rigid bodies and joints that a walk has met.
#[derive(Default)]
pub(super) struct Joints {
    /// Paths and contents of bodies; what is within another one comes before it.
    bodies: Vec<(String, Piece)>,
    prims: Vec<Rc<Prim>>,
}

impl Joints {
    /// Notes a prim whose contents, from `before` on, and those of all prims below it are there.
    pub(super) fn met(&mut self, prim: &Rc<Prim>, file_from_prim: DAffine3, before: Contents, a: &Assembly) {
        if prim.kind().starts_with("Physics") && prim.kind().ends_with("Joint") {
            self.prims.push(prim.clone());
        } else if prim.schemas().iter().any(|schema| schema == BODY) {
            let piece = Piece { name: prim.name().into(), file_from_link: file_from_prim, contents: vec![[before, a.contents()]] };
            self.bodies.push((prim.path.clone(), piece));
        }
    }

    /// Adds the bodies of the joints to the scene, with the motion of the states.
    ///
    /// # Errors
    /// When a joint has no body, joints are in a circle, or the states are of other ones.
    pub(super) fn add(mut self, stage: &mut Stage, a: &mut Assembly) -> Result<(), ImportError> {
        self.leave_inner_out();
        let numbers: BTreeMap<String, usize> = self.bodies.iter().enumerate().map(|(number, (path, _))| (path.clone(), number)).collect();
        let names: Vec<String> = self.prims.iter().map(|prim| prim.name().to_string()).collect();
        let (mut edges, mut last, mut open) = (Vec::new(), Vec::new(), BTreeSet::new());
        for prim in &self.prims {
            let is_only = names.iter().filter(|name| *name == prim.name()).count() == 1;
            let name = if is_only { prim.name() } else { prim.path.as_str() };
            let Some(edge) = self.edge(prim, name, &numbers, stage, a)? else { continue };
            let animated = edge.ends[1].or(edge.ends[0]).is_some_and(|body| self.bodies[body].1.contents.iter().any(|c| a.is_carried(*c)));
            if animated {
                a.warn(&prim.path, "what it holds moves by an animation already, so the joint was left out");
            } else if prim.value("physics:excludeFromArticulation").and_then(|v| v.as_bool()) == Some(true) {
                open.insert(name.to_string());
                last.push(edge);
            } else {
                edges.push(edge);
            }
        }
        edges.extend(last);
        let pieces: Vec<Piece> = self.bodies.into_iter().map(|(_, piece)| piece).collect();
        let (mut trees, left) = Trees::grown(&pieces, edges);
        for name in left {
            let Some(prim) = self.prims.iter().find(|prim| prim.name() == name || prim.path == name) else { continue };
            if !open.contains(&name) {
                let problem = "it closes a circle of joints, but bodies bear each other as a tree; set physics:excludeFromArticulation on one \
                               joint of the circle, which is left out then";
                return Err(a.malformed(&prim.path, problem));
            }
            a.warn(&prim.path, "it closes a circle of joints, and was left out as physics:excludeFromArticulation has it");
        }
        trees.add(&pieces, a);
        if let Some(states) = States::read(None, a)? {
            states::apply(&states, &Tree { joints: &trees.joints, links: &trees.links, ordered: false }, a)?;
        }
        a.drop_unused_bodies();
        Ok(())
    }

    /// Takes what is of a body within another one out of the outer one's contents.
    fn leave_inner_out(&mut self) {
        for inner in 0..self.bodies.len() {
            let hole = self.bodies[inner].1.contents.clone();
            let is_around = |outer: &String| self.bodies[inner].0.strip_prefix(outer).is_some_and(|rest| rest.starts_with('/'));
            let around: Vec<usize> = (inner + 1..self.bodies.len()).filter(|outer| is_around(&self.bodies[*outer].0)).collect();
            for outer in around {
                let kept = &mut self.bodies[outer].1.contents;
                *kept = kept.iter().flat_map(|span| Contents::without(*span, &hole)).collect();
            }
        }
    }

    /// A joint, if it is one that is read.
    fn edge(
        &self,
        prim: &Prim,
        name: &str,
        numbers: &BTreeMap<String, usize>,
        stage: &mut Stage,
        a: &mut Assembly,
    ) -> Result<Option<Edge>, ImportError> {
        if prim.value("physics:jointEnabled").and_then(|v| v.as_bool()) == Some(false) {
            return Ok(None);
        }
        let targets = [0, 1].map(|end| prim.targets(&format!("physics:body{end}"), field::TARGETS).into_iter().next());
        let mut ends = [None; 2];
        for (end, target) in ends.iter_mut().zip(&targets) {
            let Some(target) = target else { continue };
            *end = std::iter::successors(Some(target.as_str()), |path| path.rsplit_once('/').map(|(outer, _)| outer))
                .find_map(|path| numbers.get(path).copied());
            let Some(found) = stage.at(target, a)? else {
                return Err(a.malformed(&prim.path, format!("its body <{target}> is not there; expected a prim with {BODY}")));
            };
            if end.is_none() && found.schemas().iter().any(|schema| schema == BODY) {
                a.warn(&prim.path, format!("its body <{target}> is not shown, and was taken for the world"));
            }
        }
        if ends == [None; 2] {
            let found = targets.map(|target| target.map_or("none".into(), |target| format!("<{target}>")));
            let problem = format!(
                "found {} as physics:body0 and {} as physics:body1, expected a prim with {BODY} as one of them",
                found[0], found[1]
            );
            return Err(a.malformed(&prim.path, problem));
        }
        let kind = match prim.kind() {
            "PhysicsRevoluteJoint" => Some(Kind::Hinge),
            "PhysicsPrismaticJoint" => Some(Kind::Slide),
            "PhysicsSphericalJoint" => Some(Kind::Ball),
            "PhysicsFixedJoint" => None,
            other => {
                a.warn(&prim.path, format!("joints of the type {other} are not read; it was left out"));
                return Ok(None);
            }
        };
        let frames = self.frames(prim, &targets, ends, stage, a)?;
        let joint = Joint { kind: kind.unwrap_or(Kind::Ball), ..Joint::free(name, frames[1]) };
        let joint = if matches!(joint.kind, Kind::Hinge | Kind::Slide) { moving(joint, prim, frames, a)? } else { joint };
        Ok(Some(Edge { joint, is_fixed: kind.is_none(), ends }))
    }

    /// The frames of a joint, on its first and on its second body, at rest in the file; of one body that of the other.
    fn frames(
        &self,
        prim: &Prim,
        targets: &[Option<String>; 2],
        ends: [Option<usize>; 2],
        stage: &mut Stage,
        a: &mut Assembly,
    ) -> Result<[DAffine3; 2], ImportError> {
        let mut frames = [None; 2];
        for (end, frame) in frames.iter_mut().enumerate() {
            let position =
                prim.value(&format!("physics:localPos{end}")).and_then(|v| v.as_tuple::<3>()).map_or(DVec3::ZERO, DVec3::from_array);
            let turn = prim.value(&format!("physics:localRot{end}")).and_then(|v| v.as_tuple::<4>()).map_or(DMat3::IDENTITY, rotation);
            let file_from_target = match (&targets[end], ends[end]) {
                (None, _) => DAffine3::IDENTITY,
                (Some(target), Some(body)) if *target == self.bodies[body].0 => self.bodies[body].1.file_from_link,
                // Something else than the prim of the body itself.
                (Some(target), _) => stage_placement(stage, target, a)?,
            };
            let m = file_from_target.matrix3;
            let axes = orthonormal(m.y_axis, m.z_axis).unwrap_or(DMat3::IDENTITY);
            *frame = Some(DAffine3 { matrix3: axes * turn, translation: file_from_target.transform_point3(position) });
        }
        Ok(frames.map(|frame| frame.unwrap_or(DAffine3::IDENTITY)))
    }
}

/// The placement of a prim by its path, from the outermost prim on.
fn stage_placement(stage: &mut Stage, path: &str, a: &mut Assembly) -> Result<DAffine3, ImportError> {
    let mut placement = DAffine3::IDENTITY;
    let ends = path.char_indices().filter(|(at, c)| *at > 0 && *c == '/').map(|(at, _)| at).chain([path.len()]);
    for end in ends.collect::<Vec<_>>() {
        let Some(prim) = stage.at(&path[..end], a)? else { break };
        let own = super::xform::Xform::of(&prim, a);
        placement = if own.resets { own.rest() } else { placement * own.rest() };
    }
    Ok(placement)
}

/// A hinge or slide with its axis, its state at rest and its limits.
fn moving(joint: Joint, prim: &Prim, [first, second]: [DAffine3; 2], a: &mut Assembly) -> Result<Joint, ImportError> {
    let axis = match prim.text("physics:axis").unwrap_or("X") {
        "X" => DVec3::X,
        "Y" => DVec3::Y,
        "Z" => DVec3::Z,
        other => return Err(a.malformed(&prim.path, format!("found {other:?} as physics:axis, expected X, Y or Z"))),
    };
    let relative = first.inverse() * second;
    let turn = DQuat::from_mat3(&relative.matrix3).normalize();
    let twist = 2.0 * DVec3::new(turn.x, turn.y, turn.z).dot(axis).atan2(turn.w);
    let twist = (twist + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    let along = relative.translation.dot(axis);
    let metres_per_unit = a.meters_per_unit();
    let is_hinge = joint.kind == Kind::Hinge;
    // What should be one: the frames but for the joint's own motion.
    let off_m = if is_hinge { relative.translation.length() } else { (relative.translation - axis * along).length() } * metres_per_unit;
    let off_rad = if is_hinge { (relative.matrix3 * axis).angle_between(axis) } else { turn.angle_between(DQuat::IDENTITY) };
    if off_m > APART[0] || off_rad > APART[1] {
        let message = format!(
            "its frames on both bodies do not meet at rest: {off_m:.3} m and {:.1} degrees apart; that on the second was taken",
            off_rad.to_degrees()
        );
        a.warn(&prim.path, message);
    }
    let zero = if is_hinge { twist } else { along };
    let end = |name: &str| prim.number(&format!("physics:{name}Limit")).filter(|end| end.is_finite());
    let own = |end: f64| if is_hinge { end.to_radians() } else { end };
    let limits = match (end("lower"), end("upper")) {
        // Both the same, or descending, lock or free a joint in simulators; as limits they mean nothing.
        (Some(low), Some(high)) if low > high => {
            a.warn(&prim.path, format!("its limits {low} to {high} descend; it moves without end"));
            None
        }
        (Some(low), Some(high)) => Some([low, high].map(|end| own(end) - zero)),
        _ => None,
    };
    let per_metre = if is_hinge { 1.0 } else { 1.0 / metres_per_unit };
    Ok(Joint { axis, zero, per_metre, limits, ..joint })
}

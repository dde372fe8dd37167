//! Scenes for simulators: what stands in a scene as rigid bodies with convex pieces, masses, friction and joints.
//!
//! [`simulated`] makes the bodies from a scene and its labels; [`mjcf`], [`urdf`] and [`usd`] write them. `bodies` says which parts are one body,
//! `pieces` cuts parts into convex solids, `matter` has the densities, `rest` finds what would not stay where it is, and `limits` how far
//! joints go.
//!
//! Positions are metres in the world of the scene, z up, at rest. Every body has the axes of the world there.

mod bodies;
mod files;
mod limits;
mod looks;
mod matter;
mod mjcf;
mod model;
mod pieces;
mod rest;
mod skin;
#[cfg(test)]
mod tests;
mod urdf;
mod usd;

pub use looks::{Look, Looks, Surface, Visual};
pub use mjcf::mjcf;
pub use model::{Joint, JointKind, Model, PhysicsError, Piece, Rigid};
pub use urdf::urdf;
pub use usd::usd;

use enfilade_compose::Moments;
use enfilade_scene::{Labels, Scene};

/// A scene as bodies for simulators. Without labels, and where they do not tell things apart, everything is fixed but what
/// [`Scene::bodies`] have.
///
/// # Errors
/// When something that moves has no volume, or a body moves freely on another.
pub fn simulated(scene: &Scene, labels: &Labels) -> Result<Model, PhysicsError> {
    let (mut groups, mut notes) = bodies::groups(scene, labels)?;
    let mut parts = pieces::of_parts(scene, labels, &groups);
    refuse_nothing(scene, &mut groups, &parts)?;
    rest::settle(&mut groups, &mut parts, &mut notes);
    bodies::in_order(&mut groups);
    let touching = rest::touching(&groups, &parts);
    limits::shorten(&mut groups, &parts, &touching, &mut notes);
    // What is free would fall through what it lies in or on.
    let free = |number: usize| groups[number].joint == bodies::Hold::Free;
    let excluded = touching.into_iter().filter(|[a, b]| !free(*a) && !free(*b)).collect();
    let (looks, visuals) = looks::of(scene, &mut notes);
    let bodies = groups.iter().map(|group| body(group, &parts, &visuals)).collect();
    Ok(Model { bodies, excluded, looks, notes })
}

/// Refuses bodies that move and have no volume; instances without any are fixed.
fn refuse_nothing(scene: &Scene, groups: &mut [bodies::Group], parts: &[Vec<Piece>]) -> Result<(), PhysicsError> {
    for group in groups.iter_mut().filter(|group| group.joint != bodies::Hold::Fixed) {
        if group.parts.iter().all(|part| parts[*part as usize].is_empty()) {
            if group.is_body {
                return Err(PhysicsError::NoVolume { body: group.name.clone(), parts: group.names(scene) });
            }
            group.joint = bodies::Hold::Fixed;
        }
    }
    Ok(())
}

/// The body of a group.
fn body(group: &bodies::Group, parts: &[Vec<Piece>], visuals: &[Visual]) -> Rigid {
    let own = |part: &u32| &parts[*part as usize];
    let whole: Vec<Moments> = group.parts.iter().flat_map(own).map(|piece| piece.solid.moments(piece.mass_kg)).collect();
    let moments = Moments::joined(&whole);
    let origin = group.origin(moments.map(|m| m.center));
    let moved = |piece: &Piece| {
        let mut piece = piece.clone();
        piece.solid.corners.iter_mut().for_each(|corner| *corner -= origin);
        piece
    };
    let seen = |part: &u32| {
        let visual = visuals[*part as usize];
        Visual { place: visual.place + group.shift - origin, ..visual }
    };
    Rigid {
        name: group.name.clone(),
        parent: group.parent,
        joint: group.joint.joint(origin, moments),
        origin,
        pieces: group.parts.iter().flat_map(own).map(moved).collect(),
        visuals: group.parts.iter().map(seen).collect(),
    }
}

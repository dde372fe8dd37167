//! Houses of 3D-FRONT: the outlines of the floor meshes of each room, and where meshes of doors, windows and holes are.
//!
//! Metres, y up: (x, y, z) is (x, −z) from above. A room's kind is its `type`. Holes that reach the floor are passages. Some houses have
//! only the linings of their openings, as `Pocket`: those that reach the floor are taken for doors, others for windows.

use super::loops::{area, around, outlines};
use super::source::Source;
use crate::ImportError;
use crate::collections::front3d::house::{Child, House, Surface};
use crate::collections::json;
use enfilade_math::{DAffine3, DQuat, DVec2, DVec3};
use enfilade_scene::{DrawnPlan, DrawnRoom, OpeningKind};
use std::collections::HashMap;

/// Holes that begin below this height are passages, and lower ones are thresholds of others, metres.
const STEP: f64 = 0.3;
/// Meshes this near to each other are of one opening, metres.
const SAME: f64 = 0.4;

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let house: House = json::parse(source.bytes, source.file, "a house of 3D-FRONT")?;
    let surfaces: HashMap<&str, &Surface> = house.mesh.iter().map(|mesh| (mesh.uid.as_str(), mesh)).collect();
    let mut plan = DrawnPlan::default();
    let mut linings = Vec::new();
    for (number, room) in house.scene.room.iter().enumerate() {
        let meshes = || room.children.iter().filter_map(|child| Some((child, *surfaces.get(child.r#ref.as_str())?)));
        let name = if room.instanceid.is_empty() { format!("room {number}") } else { room.instanceid.clone() };
        let kind = if room.r#type.is_empty() { name.split('-').next().unwrap_or_default().to_string() } else { room.r#type.clone() };
        let floors = meshes().filter(|(_, mesh)| mesh.r#type == "Floor").flat_map(|(child, mesh)| triangles(&points(child, mesh), mesh));
        let found = outlines(&floors.map(|t| t.map(flat)).collect::<Vec<_>>());
        let heights =
            || meshes().filter(|(_, mesh)| mesh.r#type.starts_with("Wall")).flat_map(|(child, mesh)| points(child, mesh)).map(|p| p.y);
        let (low, high) = heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        match found.into_iter().next().filter(|outline| area(outline).abs() > 0.05) {
            Some(polygon) => plan.rooms.push(DrawnRoom { name, kind, polygon, height_m: (high - low > 1.0).then_some(high - low) }),
            None => plan.notes.push(format!("room {name:?} has no floor; it is left out")),
        }
        for (child, mesh) in meshes() {
            let kind = match mesh.r#type.as_str() {
                "Door" => OpeningKind::Door,
                "Window" | "BayWindow" => OpeningKind::Window,
                "Hole" => OpeningKind::Passage,
                "Pocket" => OpeningKind::Door,
                _ => continue,
            };
            let points = points(child, mesh);
            let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
            let kind = if kind != OpeningKind::Window && low > STEP && mesh.r#type != "Door" { OpeningKind::Window } else { kind };
            let opening = around(kind, &points.iter().copied().map(flat).collect::<Vec<_>>(), Some([low.max(0.0), high]));
            let opening = opening.filter(|_| high - low > STEP);
            if mesh.r#type == "Pocket" {
                linings.extend(opening);
                continue;
            }
            // A mesh may be among the children of both rooms, and an opening may have several.
            let known = |at: DVec2| plan.openings.iter().any(|other| other.at.distance(at) < SAME && other.kind == kind);
            plan.openings.extend(opening.filter(|opening| !known(opening.at)));
        }
    }
    let before = plan.openings.len();
    for lining in linings {
        if !plan.openings.iter().any(|other| other.at.distance(lining.at) < SAME) {
            plan.openings.push(lining);
        }
    }
    if plan.openings.len() > before {
        let count = plan.openings.len() - before;
        plan.notes.push(format!("{count} openings have only linings: those that reach the floor were taken for doors, others for windows"));
    }
    Ok(plan)
}

fn flat(p: DVec3) -> DVec2 {
    DVec2::new(p.x, -p.z)
}

fn points(child: &Child, mesh: &Surface) -> Vec<DVec3> {
    let turn = DQuat::from_array(child.rot).normalize();
    let turn = if turn.is_finite() { turn } else { DQuat::IDENTITY };
    let placed = DAffine3::from_scale_rotation_translation(child.scale, turn, child.pos);
    mesh.xyz.chunks_exact(3).map(|p| placed.transform_point3(DVec3::from_slice(p))).collect()
}

fn triangles(points: &[DVec3], mesh: &Surface) -> Vec<[DVec3; 3]> {
    let corner = |i: u32| points.get(i as usize).copied();
    mesh.faces.chunks_exact(3).filter_map(|t| Some([corner(t[0])?, corner(t[1])?, corner(t[2])?])).collect()
}

//! What rooms of a drawn plan lack: outlines that people draw may have no place for what a room is for.

use crate::Home;
use crate::room::kind;
use enfilade_furniture::{RoomKind, family_of, object_of};
use enfilade_scene::Part;
use std::collections::{BTreeMap, BTreeSet};

/// A line for each room that has not what it is for, and for each without a camera.
pub fn lacks(home: &Home) -> Vec<String> {
    let place = |part: &Part| part.world_from_mesh.translation.as_vec3().truncate();
    let mut numbers: BTreeMap<RoomKind, u32> = BTreeMap::new();
    let mut lines = Vec::new();
    for room in &home.plan.rooms {
        let number = numbers.entry(room.kind).or_default();
        *number += 1;
        let name = format!("{}_{number}", room.kind.name());
        let within = home.scene.parts.iter().filter(|part| room.contains(place(part), 0.0));
        let families: BTreeSet<&str> = within.map(|part| family_of(object_of(&part.name))).collect();
        let missing = kind::row(room.kind).needs.iter().filter(|(_, any)| !any.iter().any(|family| families.contains(family)));
        let missing: Vec<&str> = missing.map(|(name, _)| *name).collect();
        if !missing.is_empty() {
            lines.push(format!("{name} ({:.1} m2) has no place for: {}", room.area, missing.join(", ")));
        }
        if !home.scene.cameras.iter().any(|camera| room.contains(camera.position.as_vec3().truncate(), 0.0)) {
            lines.push(format!("{name} ({:.1} m2) has no place for a camera", room.area));
        }
    }
    lines
}

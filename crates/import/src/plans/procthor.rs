//! Houses of ProcTHOR: `rooms`, and the holes of `doors` and `windows`, measured from the start of their `wall0`.
//!
//! Unity's axes are left-handed with y up: x is mirrored and z goes along −y, as our importer of whole houses does it. Rooms are drawn by
//! the middles of walls. A door without a model is a passage.

use super::source::Source;
use crate::ImportError;
use crate::collections::json;
use crate::collections::procthor::house::{House, Opening, Xyz};
use enfilade_math::DVec2;
use enfilade_scene::{DrawnOpening, DrawnPlan, DrawnRoom, OpeningKind};

fn flat(p: Xyz) -> DVec2 {
    DVec2::new(-p.x, -p.z)
}

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let house: House = json::parse(source.bytes, source.file, "a house of ProcTHOR")?;
    let mut plan = DrawnPlan::default();
    for room in &house.rooms {
        let heights = house.walls.iter().filter(|wall| wall.room == room.id).flat_map(|wall| &wall.polygon).map(|p| p.y);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        plan.rooms.push(DrawnRoom {
            name: format!("{} ({})", room.kind, room.id),
            kind: room.kind.clone(),
            polygon: room.floor.iter().copied().map(flat).collect(),
            height_m: (high > low).then_some(high - low),
        });
    }
    let doors = house.doors.iter().map(|door| (door, if door.asset.is_empty() { OpeningKind::Passage } else { OpeningKind::Door }));
    for (opening, kind) in doors.chain(house.windows.iter().map(|window| (window, OpeningKind::Window))) {
        match placed(&house, opening, kind) {
            Some(opening) => plan.openings.push(opening),
            None => plan.notes.push(format!("{} has no wall or no hole; it is left out", opening.id)),
        }
    }
    Ok(plan)
}

fn placed(house: &House, opening: &Opening, kind: OpeningKind) -> Option<DrawnOpening> {
    let wall = house.walls.iter().find(|wall| Some(&wall.id) == opening.wall0.as_ref())?;
    let [first, second, ..] = wall.polygon[..] else { return None };
    let (start, end) = (flat(first), flat(second));
    let [p, q] = opening.corners()?;
    let at = start + (end - start).normalize_or_zero() * (0.5 * (p.x + q.x));
    Some(DrawnOpening { width_m: Some((q.x - p.x).abs()), z_m: Some([p.y.min(q.y).max(0.0), p.y.max(q.y)]), ..DrawnOpening::new(kind, at) })
}

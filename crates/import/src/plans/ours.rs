//! Plans that people write by hand.
//!
//! ```json
//! {
//!   "format": "enfilade plan 1",
//!   "height": 2.6,
//!   "rooms": [
//!     { "kind": "living", "polygon": [[0, 0], [6, 0], [6, 3], [3.5, 3], [3.5, 5], [0, 5]] },
//!     { "kind": "hall", "name": "entrance hall", "polygon": [[3.6, 3.1], [6, 3.1], [6, 5], [3.6, 5]] }
//!   ],
//!   "doors": [{ "at": [4.5, 3.05] }, { "at": [6, 4], "width": 1.01 }],
//!   "windows": [{ "at": [4, 0], "width": 2.2, "sill": 0.6, "head": 2.2 }],
//!   "roof": [{ "from": [0, 5], "to": [0, 0], "knee": 1.3, "pitch": 35 }]
//! }
//! ```
//!
//! Metres. A room's `kind` is one of ours, `polygon` its corners in either order, `height` its own; `name` is for messages. An opening is
//! `at` a point in or near its wall, the middle of it; `width`, `sill` (of windows) and `head` are optional, and so are `open` (how far a
//! door is open, degrees), `into` (the name of the room into which it swings) and `hinge` (`"left"` or `"right"` for someone in that room).
//! `passages` are like doors, without a leaf. A slope of the `roof` rises from the line through `from` and `to`, where it is `knee` metres
//! high, towards the rooms, at `pitch` degrees; it is the ceiling wherever it is lower than the level one, of the `rooms` with these names
//! or of all.

use super::source::Source;
use crate::ImportError;
use enfilade_math::DVec2;
use enfilade_options::{proposal, with_nearest};
use enfilade_scene::{CeilingSlope, DrawnOpening, DrawnPlan, DrawnRoom, Hinge, OpeningKind, Slope};
use serde::Deserialize;

/// First key of the file, and its version.
const FORMAT: &str = "enfilade plan 1";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Plan {
    format: Option<String>,
    height: Option<f64>,
    rooms: Vec<Room>,
    #[serde(default)]
    doors: Vec<Opening>,
    #[serde(default)]
    passages: Vec<Opening>,
    #[serde(default)]
    windows: Vec<Opening>,
    #[serde(default)]
    roof: Vec<RoofSlope>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RoofSlope {
    from: [f64; 2],
    to: [f64; 2],
    knee: f64,
    pitch: f64,
    rooms: Option<Vec<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Room {
    kind: String,
    name: Option<String>,
    polygon: Vec<[f64; 2]>,
    height: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Opening {
    at: [f64; 2],
    width: Option<f64>,
    sill: Option<f64>,
    head: Option<f64>,
    into: Option<String>,
    hinge: Option<Hinge>,
    open: Option<f64>,
}

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let plan: Plan = serde_json::from_str(source.text).map_err(|error| {
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        source.error(format!("line {}, column {}", error.line(), error.column()), with_nearest(message))
    })?;
    if plan.format.as_deref().is_some_and(|format| format != FORMAT) {
        return Err(source.error("format", format!("found {:?}, expected {FORMAT:?}", plan.format.unwrap_or_default())));
    }
    let names: Vec<String> = plan
        .rooms
        .iter()
        .enumerate()
        .map(|(i, room)| {
            let earlier = plan.rooms[..i].iter().filter(|other| other.kind == room.kind).count();
            room.name.clone().unwrap_or_else(|| format!("{}_{}", room.kind, earlier + 1))
        })
        .collect();
    let height = plan.height;
    let rooms = plan.rooms.into_iter().zip(&names).map(|(room, name)| DrawnRoom {
        name: name.clone(),
        kind: room.kind,
        polygon: room.polygon.into_iter().map(DVec2::from).collect(),
        height_m: room.height.or(height),
    });
    let rooms: Vec<DrawnRoom> = rooms.collect();
    let lists = [(OpeningKind::Door, plan.doors), (OpeningKind::Passage, plan.passages), (OpeningKind::Window, plan.windows)];
    let mut openings = Vec::new();
    for (kind, list) in lists {
        for (i, opening) in list.into_iter().enumerate() {
            openings.push(read_opening(source, kind, i, opening, &names)?);
        }
    }
    let mut slopes = Vec::new();
    for (i, slope) in plan.roof.iter().enumerate() {
        slopes.extend(read_slope(source, i, slope, &rooms)?);
    }
    Ok(DrawnPlan { rooms, openings, slopes, strict: true, notes: Vec::new() })
}

/// A slope over each of its rooms. It rises to the side of the line on which they are.
fn read_slope(source: &Source, number: usize, slope: &RoofSlope, rooms: &[DrawnRoom]) -> Result<Vec<CeilingSlope>, ImportError> {
    let place = format!("roof[{number}]");
    let numbers: Vec<usize> = match &slope.rooms {
        None => (0..rooms.len()).collect(),
        Some(names) => {
            let known: Vec<&str> = rooms.iter().map(|room| room.name.as_str()).collect();
            let find = |name: &String| {
                let found = known.iter().position(|known| known == name);
                found.ok_or_else(|| source.error(&place, format!("there is no room {name:?}; {}", proposal(name, &known))))
            };
            names.iter().map(find).collect::<Result<_, _>>()?
        }
    };
    let [from, to] = [slope.from, slope.to].map(DVec2::from);
    let corners: Vec<DVec2> = numbers.iter().flat_map(|&room| &rooms[room].polygon).copied().collect();
    let middle = corners.iter().sum::<DVec2>() / corners.len().max(1) as f64;
    let (from, to) = if (to - from).perp_dot(middle - from) < 0.0 { (slope.to, slope.from) } else { (slope.from, slope.to) };
    let slope = Slope { from, to, low_z_m: slope.knee, pitch_deg: slope.pitch };
    Ok(numbers.into_iter().map(|room| CeilingSlope { room, slope }).collect())
}

fn read_opening(
    source: &Source,
    kind: OpeningKind,
    number: usize,
    opening: Opening,
    names: &[String],
) -> Result<DrawnOpening, ImportError> {
    let place = format!("{}s[{number}]", kind.name());
    let into = match &opening.into {
        None => None,
        Some(name) => {
            let known: Vec<&str> = names.iter().map(String::as_str).collect();
            let found = names.iter().position(|known| known == name);
            Some(found.ok_or_else(|| source.error(&place, format!("there is no room {name:?}; {}", proposal(name, &known))))?)
        }
    };
    if kind != OpeningKind::Door && (into.is_some() || opening.hinge.is_some() || opening.open.is_some()) {
        return Err(source.error(&place, "`into`, `hinge` and `open` are of doors"));
    }
    if into.is_none() && opening.hinge.is_some() {
        return Err(source.error(&place, "`hinge` needs `into`, the name of the room into which the door swings"));
    }
    if opening.sill.is_some() && kind != OpeningKind::Window {
        return Err(source.error(&place, "only windows have a `sill`"));
    }
    let z_m = match (kind, opening.sill, opening.head) {
        (_, None, None) => None,
        (OpeningKind::Window, Some(sill), Some(head)) => Some([sill, head]),
        (OpeningKind::Window, ..) => return Err(source.error(&place, "a window has both `sill` and `head`, or neither")),
        (_, _, Some(head)) => Some([0.0, head]),
        (_, Some(_), None) => None,
    };
    Ok(DrawnOpening { kind, at: opening.at.into(), width_m: opening.width, z_m, into, hinge: opening.hinge, open_deg: opening.open })
}

//! Floor plans of files: outlines of rooms with doors and windows, on which homes are built.
//!
//! [`read_plan`] recognises the file by its content. Metres, seen from above; what a reader leaves out or guesses is among the plan's notes.
//!
//! | file | what is read |
//! |---|---|
//! | a plan of ours (`"format": "enfilade plan 1"`), see [`ours`] | `rooms`, `doors`, `passages`, `windows` |
//! | a layout of ours (`_detail/layout.json`) | `rooms` and `openings`; its walls follow from them |
//! | Structured3D's `annotation_3d.json` | the floor planes of its rooms, heights, doors and windows; `outwall` is not needed |
//! | SpatialLM's layout text | walls, whose loops are rooms; doors and windows; the kinds of rooms are guessed from its boxes |
//! | a house of 3D-FRONT | the outlines of its floors; meshes of doors, windows and holes, or linings of openings |
//! | a house of ProcTHOR | `rooms`, `doors`, `windows` |
//! | SVG | shapes with a name, and those of CubiCasa5k's `model.svg`; `svg` has names and units |
//! | DXF as text | closed polylines and circles, the texts in them, and lines on layers of doors and windows; see `dxf.rs` |

mod curves;
mod dxf;
mod front3d;
mod layout;
mod loops;
pub mod ours;
mod procthor;
mod source;
mod spatiallm;
mod structured3d;
mod svg;
#[cfg(test)]
mod tests;

use crate::ImportError;
use enfilade_scene::{DrawnPlan, decoded_text, without_padding};
use source::Source;
use std::path::Path;

/// A kind of file with a plan.
struct Reader {
    name: &'static str,
    is: fn(&Source) -> bool,
    read: fn(&Source) -> Result<DrawnPlan, ImportError>,
}

/// The kinds of files, in the order in which they are tried.
const READERS: [Reader; 8] = [
    Reader { name: "a layout of ours (layout.json)", is: |s| s.states("enfilade layout"), read: layout::read },
    Reader { name: "Structured3D's annotation_3d.json", is: |s| s.has(&["junctions", "planes"]), read: structured3d::read },
    Reader { name: "a house of ProcTHOR", is: |s| s.rooms_have("floorPolygon"), read: procthor::read },
    Reader { name: "a house of 3D-FRONT", is: |s| s.has(&["scene", "mesh"]), read: front3d::read },
    Reader {
        name: "a plan of ours (\"format\": \"enfilade plan 1\")",
        is: |s| s.states("enfilade plan") || s.has(&["rooms"]),
        read: ours::read,
    },
    Reader { name: "SVG", is: |s| s.text.contains("<svg"), read: svg::read },
    Reader { name: "SpatialLM's layout text", is: |s| s.text.contains("=Wall("), read: spatiallm::read },
    Reader { name: "DXF", is: |s| dxf::is(s.text), read: dxf::read },
];

/// The plan in the bytes of `file`.
///
/// # Errors
/// When the file is of no known kind, or not what its kind should be: place, what was found, and what was expected.
pub fn read_plan(bytes: &[u8], file: &Path) -> Result<DrawnPlan, ImportError> {
    let decoded = decoded_text(bytes);
    let text = without_padding(&decoded);
    let json = if text.trim_start().starts_with(['{', '[']) { Some(serde_json::from_str::<serde_json::Value>(text)) } else { None };
    let json = json.transpose().map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        ImportError::malformed(file, place, format!("{message}; expected JSON with a floor plan"))
    })?;
    let source = Source { file, bytes, text, json };
    let Some(reader) = READERS.iter().find(|reader| (reader.is)(&source)) else {
        let known: Vec<&str> = READERS.iter().map(|reader| reader.name).collect();
        return Err(source.error("its content", format!("it is no floor plan that is read; expected {}", known.join(", "))));
    };
    let plan = (reader.read)(&source)?;
    if plan.rooms.is_empty() {
        let notes: String = plan.notes.iter().map(|note| format!("; {note}")).collect();
        return Err(source.error("its content", format!("it was read as {}, but no room was found{notes}", reader.name)));
    }
    Ok(plan)
}

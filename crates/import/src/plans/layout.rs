//! Layouts of our datasets: the rooms of a generated home, or those fitted to a scene's labels.

use super::source::Source;
use crate::ImportError;
use enfilade_scene::{DrawnPlan, Rooms};

/// Floors within this are one storey, metres.
const LEVEL: f64 = 0.05;

pub(super) fn read(source: &Source) -> Result<DrawnPlan, ImportError> {
    let layout: Rooms = serde_json::from_str(source.text).map_err(|error| {
        source.error(format!("line {}, column {}", error.line(), error.column()), format!("{error}; expected a layout of a dataset"))
    })?;
    layout.check().map_err(|problem| source.error("its content", problem))?;
    let floors = || layout.outlines.iter().map(|room| room.floor_z_m);
    let (low, high) = (floors().fold(f64::INFINITY, f64::min), floors().fold(f64::NEG_INFINITY, f64::max));
    if high - low > LEVEL {
        let problem = format!("its floors lie between {low:.2} m and {high:.2} m; a plan is of one storey: keep the rooms of one");
        return Err(source.error("rooms", problem));
    }
    Ok(DrawnPlan::from(&layout))
}

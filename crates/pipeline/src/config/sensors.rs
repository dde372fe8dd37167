//! `sensors.toml`: what frames are shown to, with errors that name the place.

use super::locate::Source;
use crate::error::Error;
use enfilade_scene::decoded_text;
use enfilade_sensors::Sensors;
use std::path::Path;

/// Reads and checks `file`.
///
/// # Errors
/// When it cannot be read, is not TOML, holds an unknown key or a value out of its range, or no sensor.
pub fn read_sensors(file: &Path) -> Result<Sensors, Error> {
    let hint = "name a TOML file with sensors, such as [[camera]] with a name; docs/sensors.md has them all";
    let unreadable = |e| Error::usage(format!("cannot read {}: {e}", file.display()), hint);
    let bytes = std::fs::read(file).map_err(unreadable)?;
    let text = decoded_text(&bytes);
    let source = Source { file, text: &text };
    let sensors: Sensors = toml::from_str(&text).map_err(|error| source.toml_error(&error))?;
    sensors.check().map_err(|error| source.error(None, error.to_string()))?;
    if sensors.all().next().is_none() {
        return Err(Error::usage(format!("{} has no sensor", file.display()), hint));
    }
    Ok(sensors)
}

//! Texts that people write by hand: poses as CSV and JSON, floor plans, and configurations as TOML.

use crate::Run;
use enfilade_explore::parse_keyframes;
use std::path::Path;

/// Reads poses made by hand, in both forms.
pub fn keyframes(_: &Path) -> Run {
    Box::new(|bytes| {
        let text = String::from_utf8_lossy(bytes);
        drop((parse_keyframes("poses.csv", &text), parse_keyframes("poses.json", &text)));
    })
}

/// Reads a floor plan of whatever kind.
pub fn plan(_: &Path) -> Run {
    Box::new(|bytes| drop(enfilade_import::read_plan(bytes, Path::new("plan"))))
}

/// Reads a configuration, and as one of sensors.
#[cfg(feature = "program")]
pub fn config(folder: &Path) -> Run {
    use enfilade_pipeline::{Config, Overrides, read_sensors};
    let file = folder.join("dataset.toml");
    Box::new(move |bytes| {
        std::fs::write(&file, bytes).expect("a folder that can be written");
        drop((Config::read(&file, &Overrides::default()), read_sensors(&file)));
    })
}

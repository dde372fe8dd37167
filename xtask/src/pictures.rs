//! `cargo xtask pictures`: the pictures of README, made by the demo that README tells to run; `check` tells when they are old.
//!
//! Beside them `docs/pictures.txt` says what they were made from: the demo's choices and the version of every stage, which rises whenever
//! the same inputs give other bytes. They are old when either has changed since.

use crate::house::House;
use crate::step::finish;
use std::path::{Path, PathBuf};

/// The demo's choices, and the versions of stages.
const MAKERS: [&str; 2] = ["crates/pipeline/src/config/demo.rs", "crates/pipeline/src/stages/stage.rs"];
/// What the pictures were made from, as text.
const STAMP: &str = "docs/pictures.txt";
/// The pictures, by their place in the demo's dataset.
const PICTURES: [(&str, &str); 2] = [
    ("docs/home.jpg", "scenes/home/images/scene_cam_00_final_preview/frame.0000.display.jpg"),
    ("docs/demo.jpg", "scenes/home/images/scene_cam_00_contact_sheet.jpg"),
];

/// Makes the demo as users do, and takes its pictures to `docs`.
///
/// # Errors
/// When the demo cannot be made or a file cannot be written.
pub fn make(house: &House) -> Result<(), String> {
    let out = house.target()?.join("pictures");
    if out.exists() {
        std::fs::remove_dir_all(&out).map_err(|error| format!("cannot remove the pictures made before: {error}"))?;
    }
    let mut run = house.cargo(&["run", "--release", "--locked", "--", "run", "--demo"]);
    run.arg(&out);
    finish(run)?;
    for (picture, place) in PICTURES {
        std::fs::copy(out.join(place), house.root.join(picture)).map_err(|error| format!("cannot copy {place} to {picture}: {error}"))?;
    }
    std::fs::write(house.root.join(STAMP), stamp(house)?).map_err(|error| format!("cannot write {STAMP}: {error}"))
}

/// Compares what the pictures were made from with what they would be made from today.
///
/// # Errors
/// With what differs.
pub fn check(house: &House) -> Result<String, String> {
    let missing: Vec<&Path> = PICTURES.iter().map(|(picture, _)| Path::new(picture)).filter(|p| !house.root.join(p).is_file()).collect();
    if !missing.is_empty() {
        return Err(format!("{missing:?} are not there"));
    }
    let (then, now) = (house.read(STAMP)?, stamp(house)?);
    let changed: Vec<&str> = now.lines().filter(|line| !then.lines().any(|old| old == *line)).collect();
    match changed.is_empty() && then == now {
        true => Ok(format!("{} pictures", PICTURES.len())),
        false => Err(format!("{STAMP} differs from today's: {}", changed.join("; "))),
    }
}

/// The constants of the demo and the arms of the table of versions, as they stand in the code.
fn stamp(house: &House) -> Result<String, String> {
    let mut lines = vec!["Made by `cargo xtask pictures`: what the pictures in this folder were made from.".to_string()];
    for maker in MAKERS.map(PathBuf::from) {
        let text = house.read(&maker)?;
        let found = text.lines().map(str::trim).filter(|line| decides(line)).map(str::to_string);
        lines.extend(found);
    }
    Ok(lines.join("\n") + "\n")
}

/// True of `pub const SEED: u64 = 16;` and of `Self::Import => 10,`.
fn decides(line: &str) -> bool {
    let number = |text: &str| text.trim_end_matches(',').parse::<u32>().is_ok();
    line.starts_with("pub const ") && line.ends_with(';') || line.split_once("=> ").is_some_and(|(_, value)| number(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_and_versions_are_found_and_nothing_else() {
        assert!(decides("pub const SEED: u64 = 16;") && decides("Self::Import => 10,"));
        assert!(!decides("Self::Import => \"import\",") && !decides("pub const fn name(self) -> &'static str {"));
        let stamp = stamp(&House::find().unwrap()).unwrap();
        for part in ["SEED", "SIZE", "Self::Render => ", "Self::Preview => "] {
            assert!(stamp.contains(part), "{part} is not in\n{stamp}");
        }
    }
}

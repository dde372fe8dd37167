//! `cargo xtask pictures`: the pictures of README and of the pages about the demo and about layers, made by the demo that README describes;
//! `check` reports when they are out of date.
//!
//! Beside them `docs/pictures.txt` records their inputs: the demo's choices and the version of every stage, which rises whenever the same
//! inputs give other bytes. They are out of date if either has changed since.

use crate::docs::layers;
use crate::house::House;
use crate::python;
use crate::step::finish;
use std::path::PathBuf;

/// The demo's choices, and the versions of stages.
const MAKERS: [&str; 2] = ["crates/pipeline/src/config/demo.rs", "crates/pipeline/src/stage.rs"];
/// The record of the pictures' inputs, as text.
const STAMP: &str = "docs/pictures.txt";

/// A run of the demo, and a picture that is copied from it unchanged.
struct Shot {
    /// Arguments in addition to those of every run.
    arguments: &'static [&'static str],
    picture: &'static str,
    /// In the demo's dataset.
    place: &'static str,
}

/// Shots of the demo as users run it, and of its first view, larger and cleaner.
const SHOTS: [Shot; 2] = [
    Shot { arguments: &[], picture: "docs/demo.jpg", place: "scenes/home/images/scene_cam_00_contact_sheet.jpg" },
    Shot {
        arguments: &["--frames", "1", "--size", "1280x960", "--quality", "normal"],
        picture: "docs/home.jpg",
        place: "scenes/home/images/scene_cam_00_final_preview/frame.0000.display.jpg",
    },
];

/// The run with every layer: two frames, since flow leads from one to the next, at the size at which they are shown.
const LAYERS: [&str; 8] = ["--frames", "2", "--size", "192x144", "--quality", "high", "--extra", "--light-parts"];

/// Makes the demo as users do, and takes its pictures to `docs`.
///
/// # Errors
/// When the demo cannot be made or a file cannot be written.
pub fn make(house: &House) -> Result<(), String> {
    for Shot { arguments, picture, place } in SHOTS {
        let from = demo(house, arguments)?.join(place);
        std::fs::copy(from, house.root.join(picture)).map_err(|error| format!("cannot copy {place} to {picture}: {error}"))?;
    }
    let images = demo(house, &LAYERS)?.join("scenes/home/images");
    let python = python::made(house, "venv-pictures", "import PIL", &["pillow"])?;
    let mut shrink = house.command(python, &["xtask/python/layer_pictures.py"]);
    shrink.arg(images).arg(layers::PICTURES).args(layers::read(house)?.into_iter().map(|layer| layer.name));
    finish(shrink)?;
    std::fs::write(house.root.join(STAMP), stamp(house)?).map_err(|error| format!("cannot write {STAMP}: {error}"))
}

/// The demo made anew with these arguments; gives its folder.
fn demo(house: &House, arguments: &[&str]) -> Result<PathBuf, String> {
    let out = house.target()?.join("pictures");
    if out.exists() {
        std::fs::remove_dir_all(&out).map_err(|error| format!("cannot remove the pictures made before: {error}"))?;
    }
    let mut run = house.cargo(&["run", "--locked", "--", "run", "--demo"]);
    run.arg(&out).args(arguments);
    finish(run)?;
    Ok(out)
}

/// Compares what the pictures were made from with what they would be made from today.
///
/// # Errors
/// With what differs.
pub fn check(house: &House) -> Result<String, String> {
    let layers = layers::read(house)?.into_iter().filter(|layer| layers::picture(house, &layer.name).is_none());
    let shots = SHOTS.iter().map(|shot| shot.picture.to_string()).filter(|picture| !house.root.join(picture).is_file());
    let missing: Vec<String> = shots.chain(layers.map(|layer| format!("{}/{}.jpg", layers::PICTURES, layer.name))).collect();
    if !missing.is_empty() {
        return Err(format!("{} are not there", missing.join(", ")));
    }
    let (then, now) = (house.read(STAMP)?, stamp(house)?);
    let changed: Vec<&str> = now.lines().filter(|line| !then.lines().any(|old| old == *line)).collect();
    match changed.is_empty() && then == now {
        true => Ok(String::new()),
        false => Err(format!("{STAMP} differs from today's: {}", changed.join("; "))),
    }
}

/// The constants of the demo and the arms of the table of versions, as written in the code.
fn stamp(house: &House) -> Result<String, String> {
    let mut lines = vec!["Made by `cargo xtask pictures`: what the pictures in this folder were made from.".to_string()];
    for maker in MAKERS.map(PathBuf::from) {
        let text = house.read(&maker)?;
        let found = text.lines().map(str::trim).filter(|line| decides(line)).map(str::to_string);
        lines.extend(found);
    }
    Ok(lines.join("\n") + "\n")
}

/// True of `pub const SEED: u64 = 16;` and of `Self::Import => 10,`; the stage that judges makes no picture.
fn decides(line: &str) -> bool {
    if line.starts_with("Self::Verify") {
        return false;
    }
    let number = |text: &str| text.trim_end_matches(',').parse::<u32>().is_ok();
    line.starts_with("pub const ") && line.ends_with(';') || line.split_once("=> ").is_some_and(|(_, value)| number(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_and_versions_are_found_and_nothing_else() {
        assert!(decides("pub const SEED: u64 = 16;") && decides("Self::Import => 10,"));
        assert!(
            !decides("Self::Verify => 6,")
                && !decides("Self::Import => \"import\",")
                && !decides("pub const fn name(self) -> &'static str {")
        );
        let stamp = stamp(&House::find().unwrap()).unwrap();
        for part in ["SEED", "SIZE", "Self::Render => ", "Self::Preview => "] {
            assert!(stamp.contains(part), "{part} is not in\n{stamp}");
        }
    }
}

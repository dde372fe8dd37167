//! `cargo xtask bench`: the instruments of `crates/bench` that measure something, in release.

use crate::house::House;
use crate::step::finish;
use crate::{embree, python};
use std::process::Command;

/// One measurement.
struct Bench {
    /// The instrument.
    name: &'static str,
    /// The quantity that it measures.
    about: &'static str,
}

/// All measurements; each is an instrument of that name.
const BENCHES: [Bench; 9] = [
    Bench {
        name: "rays",
        about: "millions of rays per second of one thread, ours and Embree's, which it fetches: camera, bounced, shadow",
    },
    Bench { name: "explore", about: "core-seconds of carving and walking, beside those recorded of Hypersim's programs" },
    Bench { name: "place", about: "objects placed on tables: time, how deep they are in anything, and how far they move afterwards" },
    Bench { name: "noise", about: "noise that a second of rendering leaves, in the demo's room" },
    Bench { name: "memory", about: "memory for a million triangles under eight textures of 4096x4096" },
    Bench { name: "suggest", about: "how good suggested labels are on held-out scenes; needs ENFILADE_SCENES" },
    Bench { name: "denoise", about: "error with and without denoising, in the demo's room" },
    Bench { name: "flicker", about: "how much delivered surfaces change between the frames of a walk, in the demo's room" },
    Bench {
        name: "network",
        about: "what the denoiser in the binary costs beside Open Image Denoise, which it installs, and how far it is from it",
    },
];

/// Measurements that run only when they are named, and what they measure; `main` starts them.
const ALONE: [(&str, &str); 8] = [
    ("render", "what pictures of rooms and homes cost, rendered and denoised, against Mitsuba 3"),
    ("cycles", "what pictures of homes cost, rendered and denoised, against Blender's Cycles"),
    ("bop", "heaps of models as BOP: lines, time and memory, against BlenderProc's published recipe"),
    ("mujoco", "depth and segmentation of a run of MuJoCo, against its own renderer"),
    ("homes", "cost and contents of 200 generated homes, beside published numbers"),
    ("products", "what each kind of ground truth costs, in the demo's room, with a picture"),
    ("loader", "layers as arrays by the Python module, against h5py"),
    ("storage", "size and reading time of the files of layers, against Hypersim's"),
];

/// Lists the measurements, runs the one that is named, or runs all.
///
/// # Errors
/// When there is none of that name, or one fails.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let chosen: Vec<&Bench> = match words {
        ["--list"] => {
            BENCHES.iter().for_each(|bench| println!("{:<8} {}", bench.name, bench.about));
            ALONE.iter().for_each(|(name, about)| println!("{name:<8} {about}; runs only when named"));
            return Ok(());
        }
        [] => BENCHES.iter().collect(),
        [name] => BENCHES.iter().filter(|bench| bench.name == *name).collect(),
        _ => return Err("expected at most one name".into()),
    };
    if chosen.is_empty() {
        let known: Vec<&str> = BENCHES.iter().map(|bench| bench.name).chain(ALONE.map(|(name, _)| name)).collect();
        return Err(format!("no measurement `{}`; expected one of {}", words.join(" "), known.join(", ")));
    }
    for bench in chosen {
        println!("\n== {}: {}", bench.name, bench.about);
        let mut command = instrument(house, bench.name);
        let kept = house.target()?.join("peers/network");
        if bench.name == "network" {
            std::fs::create_dir_all(&kept).map_err(|error| format!("{}: {error}", kept.display()))?;
            command.arg("--keep").arg(&kept);
        }
        if bench.name == "rays" {
            command.env(embree::VARIABLE, embree::made(house)?);
        }
        finish(command)?;
        if bench.name == "network" {
            let mut library = house.command(python::with_peers(house)?, &["xtask/python/library.py"]);
            library.arg(&kept);
            finish(library)?;
        }
    }
    Ok(())
}

/// The command that runs an instrument of `crates/bench` in release; further arguments are its own.
pub fn instrument(house: &House, name: &str) -> Command {
    house.cargo(&["run", "--release", "--locked", "--package", PACKAGE, "--", name])
}

/// The package of the instruments, and their program.
pub const PACKAGE: &str = "enfilade-bench";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_measurement_is_told_with_all_that_there_are() {
        let message = run(&House::find().unwrap(), &["nonsense"]).unwrap_err();
        assert!(BENCHES.iter().all(|bench| message.contains(bench.name)), "{message}");
        assert!(ALONE.iter().all(|(name, _)| message.contains(name)), "{message}");
    }

    #[test]
    fn every_measurement_is_there() {
        let table = House::find().unwrap().read("crates/bench/src/main.rs").unwrap();
        for bench in BENCHES {
            assert!(table.contains(&format!("name: \"{}\"", bench.name)), "{}", bench.name);
        }
    }
}

//! The checks of the house, as `cargo xtask check`, `test`, `python`, `browser`, `docs`, `fuzz`, `pictures`, `bench`, `oracle`, `readers`
//! and `cluster`.
//!
//! [`check`] has the quick checks, which do not run the tests; [`test`](mod@test) has everything else; [`wheel`] tests the Python module as
//! installed; [`browser`] tests the pages; [`docs`](mod@docs) makes the documentation site; [`fuzz`] searches for bytes that break their
//! readers; [`bench`](mod@bench) measures. Most are a table of [`Step`](step::Step)s; each step prints what it does, how long it took and,
//! on failure, what to do.

mod acceptance;
mod bench;
mod bop;
mod browser;
mod check;
mod circles;
mod cluster;
mod cycles;
mod dependencies;
mod docs;
mod embree;
mod floors;
mod fuzz;
mod homes;
mod house;
mod loader;
mod mujoco;
mod peers;
mod pictures;
mod products;
mod python;
mod readers;
mod seed;
mod simulate;
mod spdx;
mod step;
mod storage;
mod test;
mod wheel;
mod workflows;

use house::House;
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask check [--no-tests] [STEP...]   format, lints, import directions, dependency policy, docs, quick tests
       cargo xtask test [--all] [STEP...]         tests, then the demo; --all: searches over all their seeds
       cargo xtask python [STEP...]               the module as pip installs it: types, torch's loader, notebooks, training
       cargo xtask browser [STEP...]              the pages: types, bundle, tests in a browser
       cargo xtask docs [STEP...]                 the documentation site, below target/docs/site
       cargo xtask fuzz [--seconds N] [--quick | --as-tested] [TARGET...]   searches for bytes that break what reads them
       cargo xtask pictures                       the pictures of README and of layers, by the demo
       cargo xtask signatures                     options in the Python module's stub, from their declarations
       cargo xtask bench [NAME]                   measurements: all, or one; --list names them
       cargo xtask oracle [SCENE...]              our pictures against Mitsuba 3's, scene by scene
       cargo xtask readers FOLDER [--only TEXT]   our readers of scene files beside other programs', on public files
       cargo xtask cluster [--program PATH] [TEST...]   a farm on Slurm, S3 and by other engines' files, with faults
       cargo xtask simulate                       the same on thousands of nodes, simulated
       cargo xtask bench render [CASE...]         what pictures of rooms and homes cost, against Mitsuba 3
       cargo xtask bench cycles [CASE...]         what pictures of homes cost, against Blender's Cycles
       cargo xtask bench bop [--program PATH] [SCENE...]   heaps of models as BOP: lines and time, against BlenderProc
       cargo xtask bench mujoco [--program PATH]   depth and segmentation of a run of MuJoCo, against its own renderer
       cargo xtask bench storage [DATASET...]     size and reading time of the files, against Hypersim's
       cargo xtask bench products                 what each kind of ground truth costs, with a picture
       cargo xtask bench loader [DATASET...]      the Python module's reading of layers, against h5py
       cargo xtask bench homes [COUNT] [FIRST]    what generated homes cost and what is in them, beside published numbers";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if asks_for_usage(&words) {
        println!("{USAGE}");
        return ExitCode::SUCCESS;
    }
    let outcome = House::find().and_then(|house| match words.as_slice() {
        ["check", rest @ ..] => check::run(&house, rest),
        ["test", rest @ ..] => test::run(&house, rest),
        ["python", rest @ ..] => wheel::run(&house, rest),
        ["browser", rest @ ..] => browser::run(&house, rest),
        ["docs", rest @ ..] => docs::run(&house, rest),
        ["fuzz", rest @ ..] => fuzz::run(&house, rest),
        ["bench", "render", rest @ ..] => peers::run(&house, "bench_render", rest),
        ["bench", "cycles", rest @ ..] => cycles::run(&house, rest),
        ["bench", "bop", rest @ ..] => bop::run(&house, rest),
        ["bench", "mujoco", rest @ ..] => mujoco::run(&house, rest),
        ["bench", "homes", rest @ ..] => homes::run(&house, rest),
        ["bench", "loader", rest @ ..] => loader::run(&house, rest),
        ["bench", "products"] => products::run(&house),
        ["bench", "storage", rest @ ..] => storage::run(&house, rest),
        ["pictures"] => pictures::make(&house),
        ["signatures"] => docs::signatures::write(&house),
        ["simulate"] => simulate::run(&house),
        ["cluster", rest @ ..] => cluster::run(&house, rest),
        ["oracle", rest @ ..] => peers::run(&house, "oracle", rest),
        ["readers", rest @ ..] => readers::run(&house, rest),
        ["bench", rest @ ..] => bench::run(&house, rest),
        _ => Err(format!("unknown command `{}`\n{USAGE}", words.join(" "))),
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

/// True if only the usage is requested; the programs of `oracle` and of some measurements have their own usage.
fn asks_for_usage(words: &[&str]) -> bool {
    match words {
        [] | ["help"] => true,
        ["oracle", ..] | ["bench", "render" | "cycles" | "bop" | "mujoco", ..] => false,
        words => words.iter().any(|word| matches!(*word, "--help" | "-h")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_is_given_before_anything_is_installed_or_built() {
        assert!(asks_for_usage(&[]) && asks_for_usage(&["help"]));
        for words in [&["-h"][..], &["check", "--help"], &["cluster", "--help"], &["fuzz", "gltf", "--help"], &["bench", "-h"]] {
            assert!(asks_for_usage(words), "{words:?}");
        }
        for words in [&["check"][..], &["oracle", "--help"], &["bench", "cycles", "--help"], &["bench", "--list"]] {
            assert!(!asks_for_usage(words), "{words:?}");
        }
    }
}

//! Compares the costs of carving and walking with those of Hypersim's own programs: `cargo xtask bench explore`
//!
//! The rooms, the programs' results and their times are in the folder that `ENFILADE_GOLDEN` names (`golden` beside the folder that
//! `ENFILADE_SCENES` names, if that is unset). The programs themselves are not run: their times were recorded with their results.
//! Ours are CPU seconds of one thread with the programs' parameters, everything counted: the hierarchy is built for every run, and an
//! octree is written or read. A figure is the median of several runs. Writes `docs/benchmarks/explore.md` and `explore.json`.

mod measure;
mod report;
#[allow(dead_code, reason = "what the tests read of it")]
mod room;

use report::Report;
use room::{ROOMS, Room, folder};
use std::path::Path;

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn std::error::Error>> {
    let Some(folder) = folder() else {
        let message = "no results of Hypersim's programs to compare with: ENFILADE_GOLDEN must name their folder, which holds ";
        return Err(format!("{message}{}", ROOMS.join(", ")).into());
    };
    let mut report = Report::default();
    for name in ROOMS {
        let room = Room::read(&folder, name);
        report.push(measure::room(&room));
    }
    println!("{}", report.markdown());
    report.write(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/benchmarks"))?;
    Ok(())
}

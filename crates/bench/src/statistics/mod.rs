//! Costs and contents of homes, compared with published numbers: `cargo xtask bench homes [COUNT] [FIRST]`
//!
//! `statistics measure ROWS [COUNT] [FIRST]` makes homes of consecutive seeds with the defaults, and a tenth as many of each other kind of
//! building, each in a process of its own, and writes what it finds to ROWS, a line of JSON for each. `statistics report ROWS FOLDER` makes
//! `homes.md` and `homes.json` of them.
//! Processor time and memory are asked of Linux.

mod buildings;
mod measure;
mod published;
mod remarks;
mod report;
mod sizes;
mod spread;

use enfilade_home::{Building, HomeConfig};

/// Runs the instrument.
pub fn run() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = crate::arguments::arguments().collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["one", seed, building] => {
            let building = crate::arguments::building(Some(building))?;
            let config = HomeConfig { building, ..HomeConfig::of_seed(seed.parse()?) };
            println!("{}", serde_json::to_string(&measure::measure(&config)?)?);
            Ok(())
        }
        ["measure", rows] => all(rows, 200, 0),
        ["measure", rows, count] => all(rows, count.parse()?, 0),
        ["measure", rows, count, first] => all(rows, count.parse()?, first.parse()?),
        ["report", rows, folder] => {
            let text = std::fs::read_to_string(rows).map_err(|error| format!("cannot read {rows}: {error}"))?;
            let homes =
                text.lines().map(serde_json::from_str).collect::<Result<Vec<_>, _>>().map_err(|error| format!("{rows}: {error}"))?;
            Ok(report::write(homes, std::path::Path::new(folder))?)
        }
        _ => Err("expected `measure ROWS [COUNT] [FIRST]` or `report ROWS FOLDER`".into()),
    }
}

/// Measures homes and other buildings one after the other. A home that fails is reported and left out, and the run fails at the end.
fn all(rows: &str, count: u64, first: u64) -> Result<(), Box<dyn std::error::Error>> {
    use std::io::Write as _;
    let own = std::env::current_exe()?;
    let mut file = std::fs::File::create(rows).map_err(|error| format!("cannot write {rows}: {error}"))?;
    let mut failed = Vec::new();
    let seeds = |building: Building| {
        let count = if building == Building::Home { count } else { count.div_ceil(10) };
        (first..first + count).map(move |seed| (building.name(), seed))
    };
    for (building, seed) in Building::ALL.into_iter().flat_map(seeds) {
        let output = std::process::Command::new(&own).args(["statistics", "one", &seed.to_string(), building]).output()?;
        if output.status.success() {
            file.write_all(&output.stdout)?;
            println!("{building} {seed}");
        } else {
            println!("{building} {seed}: {}: {}", output.status, String::from_utf8_lossy(&output.stderr).trim());
            failed.push(format!("{building} {seed}"));
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("not made: {}", failed.join(", ")).into()) }
}

//! `cargo xtask fuzz [--seconds N] [--seed N] [--quick | --as-tested] [TARGET...]`: searches for bytes that break their readers.
//!
//! libFuzzer on the stable toolchain: LLVM's coverage pass is enabled by flags of the compiler that need no `-Z`. The program is built
//! below `target/fuzz/build`, each target's files are in `target/fuzz/<target>/`. The corpus there is kept, so that a longer search
//! continues where a shorter one ended. Two targets are searched at a time. With `--seed` the random choices repeat: from the same corpus
//! the same inputs are tried, as far as the time permits. `--quick` leaves out the readers of datasets and of the whole program; without
//! them the searching program builds much faster. `--as-tested` searches with the program that `cargo xtask test` has built on unattended
//! machines: without coverage, so seeds are only varied and nothing is learned, but nothing is built either.

mod report;
mod search;

use crate::house::House;
use crate::step::finish;
use crate::test;
use report::Row;
use search::Target;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Default time of the search of each target, seconds.
const SECONDS: u64 = 60;
/// Targets at a time.
const AT_A_TIME: usize = 2;

/// Coverage by counters in the code, a table of places, and what is compared with what; checks of the debug build come with the
/// profile.
const FLAGS: [&str; 6] = [
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    "--cfg=fuzzing",
];

/// The parsed arguments.
#[derive(Debug, PartialEq)]
struct Asked {
    seconds: u64,
    /// Random seed; a new one every time if none is given.
    seed: Option<u32>,
    /// Only importers and V-Ray.
    quick: bool,
    /// With the program that the tests have built, without coverage.
    as_tested: bool,
    /// All where none is named.
    names: Vec<String>,
}

impl Asked {
    fn parse(words: &[&str]) -> Result<Self, String> {
        let mut asked = Self { seconds: SECONDS, seed: None, quick: false, as_tested: false, names: Vec::new() };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            if *word == "--seconds" {
                asked.seconds = above_zero(word, words.next())?;
            } else if *word == "--seed" {
                asked.seed = Some(above_zero(word, words.next())?);
            } else if *word == "--quick" {
                asked.quick = true;
            } else if *word == "--as-tested" {
                asked.as_tested = true;
            } else {
                asked.names.push((*word).to_string());
            }
        }
        Ok(asked)
    }
}

/// The number after a flag; libFuzzer takes a seed of zero for none.
fn above_zero<T: FromStr + Default + PartialOrd>(flag: &str, word: Option<&&str>) -> Result<T, String> {
    let found = word.copied().unwrap_or("nothing");
    let number = found.parse().ok().filter(|number| *number > T::default());
    number.ok_or_else(|| format!("{flag}: found {found}, expected a whole number above zero"))
}

/// Searches the targets that are named, or all, and writes the table: below `target/fuzz/`, but to `docs/benchmarks/` when it is of all
/// targets and the machine is not an unattended one.
///
/// # Errors
/// When the program cannot be built, a target is unknown, or something was found.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let asked = Asked::parse(words)?;
    let folder = house.target()?.join("fuzz");
    let program = if asked.as_tested { as_tested(house)? } else { build(house, &folder.join("build"), asked.quick)? };
    let all = search::targets(&program, &folder)?;
    if let Some(unknown) = asked.names.iter().find(|name| !all.iter().any(|target| target.name == **name)) {
        let known: Vec<&str> = all.iter().map(|target| target.name.as_str()).collect();
        return Err(format!("unknown target `{unknown}`; expected some of {}", known.join(", ")));
    }
    let chosen: Vec<Target> = all.into_iter().filter(|t| asked.names.is_empty() || asked.names.contains(&t.name)).collect();
    let rows = search_all(&program, &chosen, &asked)?;
    let whole = asked.names.is_empty() && !asked.quick && !asked.as_tested;
    let docs = if whole && !House::unattended() { house.root.join("docs/benchmarks") } else { folder };
    report::write(&docs, asked.seconds, &rows)?;
    println!("{}\nwritten to {}", report::table(&rows), docs.join("fuzz.md").display());
    let found: Vec<String> = rows.iter().filter_map(|row| row.found.as_ref().map(|found| found.message(&row.name))).collect();
    if found.is_empty() { Ok(()) } else { Err(found.join("\n")) }
}

/// Builds the program that searches, and returns its path.
fn build(house: &House, target: &Path, quick: bool) -> Result<PathBuf, String> {
    let arguments = ["build", "--locked", "--profile", "fuzz", "--package", "enfilade-fuzz", "--features", "libfuzzer", "--bin", "fuzz"];
    let mut command = house.cargo(&arguments);
    if quick {
        command.arg("--no-default-features");
    }
    // Naming the platform keeps coverage out of what runs while it is built.
    let platform = platform(house)?;
    command.args(["--target", &platform]).env("CARGO_TARGET_DIR", target).env("RUSTFLAGS", FLAGS.join(" "));
    command.env_remove("CARGO_ENCODED_RUSTFLAGS");
    finish(command).map_err(|error| format!("{error}; a C++ compiler is needed, on Debian: apt install g++"))?;
    Ok(target.join(platform).join("fuzz/fuzz"))
}

/// The program as [`test::build`] leaves it; builds what of it is missing.
fn as_tested(house: &House) -> Result<PathBuf, String> {
    test::build(house)?;
    house.tested("fuzz")
}

/// The platform of the compiler.
fn platform(house: &House) -> Result<String, String> {
    let output = house.command("rustc", &["--version", "--verbose"]).output().map_err(|error| format!("cannot run rustc: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_string).ok_or_else(|| "rustc does not say its platform".into())
}

/// Searches, [`AT_A_TIME`]; the rows are in the order of the targets.
fn search_all(program: &Path, targets: &[Target], asked: &Asked) -> Result<Vec<Row>, String> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Result<Row, String>)>> = Mutex::default();
    let work = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(target) = targets.get(i) else { break };
            println!("   {} of {}: {} ({} s)", i + 1, targets.len(), target.name, asked.seconds);
            let row = search::search(program, target, asked.seconds, asked.seed);
            done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((i, row));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..AT_A_TIME {
            scope.spawn(work);
        }
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|(i, _)| *i);
    done.into_iter().map(|(_, row)| row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_and_targets_are_told_apart() {
        let asked = |words: &[&str]| Asked::parse(words);
        assert_eq!(asked(&[]).unwrap(), Asked { seconds: 60, seed: None, quick: false, as_tested: false, names: vec![] });
        let some = Asked { seconds: 5, seed: Some(7), quick: true, as_tested: false, names: vec!["gltf".into()] };
        assert_eq!(asked(&["gltf", "--seconds", "5", "--seed", "7", "--quick"]).unwrap(), some);
        assert_eq!(asked(&["--seconds", "0"]).unwrap_err(), "--seconds: found 0, expected a whole number above zero");
        assert!(asked(&["--seconds"]).unwrap_err().contains("found nothing"));
    }
}

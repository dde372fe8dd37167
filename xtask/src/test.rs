//! `cargo xtask test`: all tests, then the program that they were built with on the demo.

use crate::house::House;
use crate::step::{Step, choose, finish};
use crate::{acceptance, python};
use std::process::Command;

/// Asks the tests for their long searches too; `enfilade-testkit` reads it.
const ALL: &str = "ENFILADE_ALL_TESTS";

/// All steps, in the order in which a failure is most informative.
const STEPS: [Step; 5] = [
    Step { name: "build", about: "the tests and the programs that they run build", remedy: "fix what the messages above show", run: build },
    Step {
        name: "tests",
        about: "all tests of the workspace pass",
        remedy: "fix the code or the test; `cargo test -p CRATE NAME` runs one, failing pictures and counts are in target/evidence",
        run: all_tests,
    },
    Step {
        name: "examples",
        about: "the examples in the documentation are true",
        remedy: "fix the code or the example; `cargo test -p CRATE --doc` runs those of a crate",
        run: |house| finish(cargo(house, &["test", "--doc", "--quiet"])),
    },
    Step {
        name: "demo",
        about: "the program makes a small demo dataset, does nothing the second time, and finds it true",
        remedy: "the dataset is left in target/acceptance/demo; `enfilade inspect` shows single pixels of it",
        run: acceptance::demo,
    },
    Step {
        name: "acceptance",
        about: "a program that shares no code with this project finds the demo dataset true",
        remedy: "the dataset is left in target/acceptance/demo; ENFILADE_ACCEPT names the program",
        run: acceptance::independent,
    },
];

/// The cargo command with the packages and features to test: the same for every step, so that everything is built once. On unattended
/// machines the program of `cargo xtask fuzz --as-tested` is built with the tests.
fn cargo(house: &House, arguments: &[&str]) -> Command {
    let mut command = house.cargo(arguments);
    command.args(["--workspace", "--locked"]);
    if House::unattended() {
        command.args(["--features", "enfilade-fuzz/libfuzzer"]);
    }
    command
}

/// The test runner: nextest if it is installed. Examples, which `check` covers, are not linked for it.
fn runner(house: &House) -> &'static [&'static str] {
    match house.has_cargo_command("nextest") {
        true => &["nextest", "run", "--tests"],
        false => &["test", "--tests"],
    }
}

/// Builds all tests, and the programs of the packages that have any: `enfilade` among them.
///
/// # Errors
/// When something does not build.
pub fn build(house: &House) -> Result<String, String> {
    finish(cargo(house, &[runner(house), &["--no-run"]].concat()))
}

/// Takes the steps that `words` name, or all, and long searches over all their seeds with `--all`; ends with the first that fails.
///
/// # Errors
/// With the step that failed.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let (flags, names): (Vec<&str>, Vec<&str>) = words.iter().partition(|word| **word == "--all");
    let house = House { searches: !flags.is_empty(), ..house.clone() };
    choose(&STEPS, &names)?.iter().try_for_each(|step| step.take(&house))?;
    println!("\ntest: all well");
    Ok(())
}

/// Runs every test with nextest where it is installed, else with cargo; the runner's own summary comes last.
fn all_tests(house: &House) -> Result<String, String> {
    let python = python::with_h5py(house)?;
    let mut command = cargo(house, &[runner(house), &["--no-fail-fast"]].concat());
    if let Some(python) = &python {
        command.env(python::VARIABLE, python);
    }
    if house.searches {
        command.env(ALL, "1");
    }
    finish(command)
}

//! `cargo xtask test`: all tests, then the release binary on the demo.

use crate::house::House;
use crate::step::{Step, choose, finish};
use crate::{acceptance, oidn, python};

/// All steps, in the order in which a failure tells most.
const STEPS: [Step; 4] = [
    Step {
        name: "tests",
        about: "all tests of the workspace pass",
        remedy: "mend the code or the test; `cargo test -p CRATE NAME` runs one, failing pictures and counts lie in target/evidence",
        run: all_tests,
    },
    Step {
        name: "release",
        about: "the release binary builds",
        remedy: "mend what the messages above show",
        run: |house| finish(house.cargo(&["build", "--release", "--locked", "--package", "enfilade"])),
    },
    Step {
        name: "demo",
        about: "the binary makes a small demo dataset, does nothing the second time, and finds it true",
        remedy: "the dataset is left in target/acceptance/demo; `enfilade inspect` tells about single pixels of it",
        run: acceptance::demo,
    },
    Step {
        name: "acceptance",
        about: "a program that shares no code with this project finds the demo dataset true",
        remedy: "the dataset is left in target/acceptance/demo; ENFILADE_ACCEPT names the program",
        run: acceptance::independent,
    },
];

/// Takes the steps with these names, or all; ends with the first that fails.
///
/// # Errors
/// With the step that failed.
pub fn run(house: &House, names: &[&str]) -> Result<(), String> {
    choose(&STEPS, names)?.iter().try_for_each(|step| step.take(house))?;
    println!("\ntest: all well");
    Ok(())
}

/// Runs every test with nextest where it is installed, else with cargo; the runner's own summary comes last.
fn all_tests(house: &House) -> Result<String, String> {
    let python = python::with_h5py(house)?;
    let denoiser = oidn::found(house);
    let cargo = |arguments: &[&str]| {
        let mut command = house.cargo(arguments);
        if let Some(python) = &python {
            command.env(python::VARIABLE, python);
        }
        if let Some(denoiser) = &denoiser {
            command.env(oidn::VARIABLE, denoiser);
        }
        finish(command)
    };
    if !house.has_cargo_command("nextest") {
        return cargo(&["test", "--workspace", "--locked", "--no-fail-fast"]);
    }
    // nextest does not run the examples in the documentation.
    cargo(&["test", "--workspace", "--locked", "--doc", "--quiet"])?;
    cargo(&["nextest", "run", "--workspace", "--locked", "--no-fail-fast"])
}

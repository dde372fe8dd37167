//! `cargo xtask check`: what is quick.

use crate::docs::signatures;
use crate::house::House;
use crate::step::{Step, choose, finish};
use crate::{circles, dependencies, floors, pictures, seed, workflows};

/// The last and slowest step, left out by `--no-tests` where all tests follow anyway.
const QUICK_TESTS: &str = "tests";

/// All steps.
const STEPS: [Step; 11] = [
    Step {
        name: "format",
        about: "files are formatted",
        remedy: "run `cargo fmt --all`",
        run: |house| finish(house.cargo(&["fmt", "--all", "--check"])),
    },
    Step {
        name: "directions",
        about: "imports point down",
        remedy: "move the code to the floor that needs it, or hand it down as an argument; the floors are in xtask/src/floors.rs",
        run: floors::check,
    },
    Step {
        name: "circles",
        about: "no file or module of a crate imports another in a circle",
        remedy: "move what both need to a file of its own, below them; if the circle is right, say why in xtask/src/circles/mod.rs",
        run: circles::check,
    },
    Step {
        name: "dependencies",
        about: "licences are allowed, sources are crates.io, versions are in one place",
        remedy: "choose another crate, or change deny.toml and say why there",
        run: dependencies::check,
    },
    Step {
        name: "pictures",
        about: "the pictures of README and of layers are those of today's demo",
        remedy: "run `cargo xtask pictures`, look at them, and commit docs/",
        run: pictures::check,
    },
    Step {
        name: "workflows",
        about: "the forge's workflows and the scripts that they call are sound",
        remedy: "fix what the messages above show; https://github.com/rhysd/actionlint and https://www.shellcheck.net explain each",
        run: workflows::check,
    },
    Step {
        name: "signatures",
        about: "the Python module's stub has the options that are declared",
        remedy: "run `cargo xtask signatures`, and commit crates/python/enfilade/__init__.pyi",
        run: signatures::check,
    },
    Step {
        name: "seed",
        about: "what docs/seed.md names is there",
        remedy: "correct the row: files, the symbols they declare, tests with their crate, laws of crates/verify/src/law.rs",
        run: seed::check,
    },
    Step {
        name: "lints",
        about: "the compiler and clippy have nothing to say",
        remedy: "fix what the warnings above show; if a lint is wrong for this project, allow it in Cargo.toml and say why there",
        run: |house| finish(house.cargo(&["clippy", "--workspace", "--all-targets", "--locked", "--keep-going", "--", "-D", "warnings"])),
    },
    Step {
        name: "docs",
        about: "the documentation builds and its links lead somewhere",
        remedy: "fix what the warnings above show",
        run: |house| {
            let mut command = house.cargo(&["doc", "--workspace", "--no-deps", "--locked", "--keep-going"]);
            command.env("RUSTDOCFLAGS", "-D warnings");
            finish(command)
        },
    },
    Step {
        name: QUICK_TESTS,
        about: "the unit tests of the lower floors pass",
        remedy: "fix the code or the test; `cargo test -p CRATE` runs the tests of one crate",
        run: |house| {
            let mut command = house.cargo(&["test", "--lib", "--locked"]);
            for package in floors::packages_up_to(2) {
                command.args(["-p", &package]);
            }
            finish(command)
        },
    },
];

/// Takes the steps named in `words`, or all; continues after a failure, so that one run shows everything there is to fix.
///
/// # Errors
/// With every step that failed.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let (flags, names): (Vec<&str>, Vec<&str>) = words.iter().partition(|word| **word == "--no-tests");
    let mut chosen = choose(&STEPS, &names)?;
    chosen.retain(|step| flags.is_empty() || step.name != QUICK_TESTS);
    if chosen.is_empty() {
        return Err(format!("--no-tests leaves out the only step that is named; expected another one beside `{QUICK_TESTS}`, or no flag"));
    }
    let failures: Vec<String> = chosen.iter().filter_map(|step| step.take(house).err()).collect();
    println!();
    match failures.len() {
        0 => {
            println!("check: all well");
            Ok(())
        }
        n => Err(format!("{n} of {} steps failed\n{}", chosen.len(), failures.join("\n"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_of_nothing_is_refused() {
        let message = run(&House::find().unwrap(), &["--no-tests", "tests"]).unwrap_err();
        assert!(message.contains("--no-tests") && message.contains("`tests`"), "{message}");
    }
}

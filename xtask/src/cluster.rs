//! `cargo xtask cluster`: a job of a farm on a real Slurm cluster, an S3 server and other engines' files, with faults.
//!
//! It runs on a bare Debian machine: missing parts of Slurm are installed (as root), Python packages are installed below the target folder.
//! The tests are Python programs in `xtask/python`, because moto, `openjd` and botocore are Python packages; `xtask/cluster` has the
//! scenes.

use crate::house::House;
use crate::python;
use crate::step::finish;
use std::path::PathBuf;
use std::time::Instant;

/// Programs that are needed, and Debian's packages that have them.
const PROGRAMS: [(&str, &str); 7] = [
    ("slurmctld", "slurmctld"),
    ("slurmd", "slurmd"),
    ("sbatch", "slurm-client"),
    ("munged", "munge"),
    ("faketime", "faketime"),
    ("parallel", "parallel"),
    ("mmdebstrap", "mmdebstrap"),
];

/// Packages from the Python package index: an S3 server, the validator of the files for engines, and engines.
const PACKAGES: [&str; 6] =
    ["moto[server]==5.2.5", "openjd-cli==0.8.0", "kubernetes-validate==1.37.0", "boto3", "ray==2.60.0", "hyperqueue==0.27.0"];
const IMPORTS: &str = "import moto.server, flask, openjd.cli, botocore, kubernetes_validate, ray, hyperqueue";

/// Runs the tests whose names begin with one of `words`, or all; `--program PATH` takes that binary instead of building one.
///
/// # Errors
/// When something cannot be installed or built, or a test fails.
pub fn run(house: &House, words: &[&str]) -> Result<(), String> {
    let (program, names) = match words {
        ["--program", path, names @ ..] => (Some(PathBuf::from(path)), names),
        ["--program"] => return Err("--program names no file".into()),
        names => (None, names),
    };
    if !cfg!(target_os = "linux") {
        return Err("the cluster needs Linux: Slurm's daemons run nowhere else".into());
    }
    let begun = Instant::now();
    let target = house.target()?;
    let (venv, condor) = (target.join("venv-cluster"), target.join("cluster-condor"));
    let mut there = [(venv.is_dir(), "the Python packages"), (condor.is_dir(), "HTCondor's folder"), (program.is_some(), "the program")]
        .iter()
        .filter_map(|&(is_there, what)| is_there.then_some(what))
        .collect::<Vec<_>>();
    if install(house)? {
        there.insert(0, "Debian's packages");
    }
    let python = python::made(house, "venv-cluster", IMPORTS, &PACKAGES)?;
    let condor = condor_root(house, condor);
    let (program, which) = match program {
        Some(path) => (path, "the one that `--program` named"),
        None => {
            finish(house.cargo(&["build", "--release", "--locked", "--package", "enfilade"]))?;
            (target.join("release/enfilade"), "the release binary")
        }
    };
    let mut command = house.command("python3", &["xtask/python/cluster.py", "--config", "xtask/cluster/dataset.toml"]);
    command.arg("--program").arg(program).arg("--python").arg(python).arg("--work").arg(target.join("cluster"));
    command.args(["--docs", "docs/benchmarks", "--program-is", which, "--there", &there.join(", ")]);
    command.args(["--before", &begun.elapsed().as_secs().to_string()]).args(names);
    if let Some(root) = condor {
        command.arg("--condor").arg(root);
    }
    finish(command).map(|_| ())
}

/// Installs what is missing, where that may be done; true when nothing was.
fn install(house: &House) -> Result<bool, String> {
    let missing: Vec<&str> = PROGRAMS.iter().filter(|(program, _)| !installed(program)).map(|&(_, package)| package).collect();
    if missing.is_empty() {
        return Ok(true);
    }
    let line = format!("apt-get install --no-install-recommends {}", missing.join(" "));
    if !is_root(house) || !installed("apt-get") {
        return Err(format!("{} is missing; on Debian, as root: {line}", missing.join(", ")));
    }
    finish(house.command("apt-get", &["update", "--quiet"]))?;
    let mut install = house.command("apt-get", &["install", "--yes", "--quiet", "--no-install-recommends"]);
    // Nothing is asked: the tests bring a configuration of their own, and start the daemons themselves.
    install.args(&missing).env("DEBIAN_FRONTEND", "noninteractive");
    finish(install).map(|_| false)
}

fn is_root(house: &House) -> bool {
    house.command("id", &["-u"]).output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// A folder with Debian 13, of which HTCondor is taken, since Debian 12 has none, and with a user for it: it does no work for root.
/// `None` where it cannot be made, which is reported.
fn condor_root(house: &House, folder: PathBuf) -> Option<PathBuf> {
    if folder.is_dir() {
        return Some(folder);
    }
    let aside = folder.with_extension("part");
    let make = || -> Result<(), String> {
        if !is_root(house) {
            return Err("that needs root".into());
        }
        let mut debian = house.command("mmdebstrap", &["--quiet", "--variant=minbase", "--include=htcondor"]);
        debian.arg("--customize-hook=chroot \"$1\" useradd --create-home farm").arg("trixie").arg(&aside);
        finish(debian)?;
        std::fs::rename(&aside, &folder).map_err(|error| error.to_string())
    };
    make().inspect_err(|reason| println!("   note: no folder with HTCondor: {reason}; its test is left out")).ok()?;
    Some(folder)
}

/// True when a program is found, also among those for administrators.
fn installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).chain(["/usr/sbin", "/sbin"].map(PathBuf::from)).any(|folder| folder.join(program).is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_line_without_a_file_is_told() {
        let house = House::find().unwrap();
        assert_eq!(run(&house, &["--program"]).unwrap_err(), "--program names no file");
        assert!(installed("sh") && !installed("no-such-program"));
    }

    #[test]
    fn what_the_tests_are_made_of_is_there() {
        let root = House::find().unwrap().root;
        for file in
            ["python/cluster.py", "python/slurm.py", "python/faults.py", "python/stores.py", "python/engines.py", "python/schedulers.py"]
        {
            assert!(root.join("xtask").join(file).is_file(), "{file}");
        }
        for file in ["xtask/cluster/dataset.toml", "xtask/cluster/machines.csv", "examples/farm/with_condor.sub"] {
            assert!(root.join(file).is_file(), "{file}");
        }
    }
}

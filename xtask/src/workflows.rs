//! The workflows of the forge, which run only there: `actionlint` looks at them here, and `shellcheck` at the shell in them.

use crate::house::House;
use crate::step::finish;
use std::path::Path;
use std::process::{Command, Stdio};

/// The scripts that workflows call.
const SCRIPTS: &str = "packaging";

/// Runs both if they are installed.
///
/// # Errors
/// If one of them finds something, or the scripts cannot be listed.
pub fn check(house: &House) -> Result<String, String> {
    let mut remarks = Vec::new();
    match is_installed("actionlint") {
        true => drop(finish(house.command("actionlint", &[]))?),
        false => remarks.push("workflows not looked at (CONTRIBUTING.md says how to get actionlint)"),
    }
    match is_installed("shellcheck") {
        true => {
            let mut command = house.command("shellcheck", &[".ci/run"]);
            command.args(scripts(&house.root.join(SCRIPTS))?);
            finish(command)?;
        }
        false => remarks.push("shell scripts not looked at (shellcheck does)"),
    }
    Ok(remarks.join("; "))
}

/// Paths of the shell scripts in `folder`, relative to the root.
fn scripts(folder: &Path) -> Result<Vec<String>, String> {
    let unreadable = |error: std::io::Error| format!("cannot list {}: {error}", folder.display());
    let entries: Vec<_> = std::fs::read_dir(folder).and_then(Iterator::collect).map_err(unreadable)?;
    let mut names: Vec<String> = entries.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| name.ends_with(".sh"));
    names.sort();
    Ok(names.iter().map(|name| format!("{SCRIPTS}/{name}")).collect())
}

fn is_installed(program: &str) -> bool {
    Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

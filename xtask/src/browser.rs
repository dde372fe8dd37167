//! `cargo xtask browser`: the pages' types, and their tests in a real browser.

use crate::house::House;
use crate::step::{Step, choose, finish};
use crate::test;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Names the browser; the tests read it too.
const BROWSER_VARIABLE: &str = "ENFILADE_CHROMIUM";
/// Variable with the program that the tests serve with.
const PROGRAM_VARIABLE: &str = "ENFILADE_BINARY";
/// Folder of the tests and their packages, from the root.
const ROOM: &str = "crates/serve/browser";
/// Names of the browsers for the tests.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// All steps, in the order in which a failure is most informative.
const STEPS: [Step; 5] = [
    Step {
        name: "packages",
        about: "node, the packages that the lock file names and a browser are there",
        remedy: "install node 20 or later with npm, and Chromium (on Debian: apt install nodejs npm chromium); the packages come from the npm registry",
        run: packages,
    },
    Step {
        name: "types",
        about: "the pages' types hold",
        remedy: "fix what the messages above show",
        run: |house| npm(house, &["run", "--silent", "types"]),
    },
    Step {
        name: "vendor",
        about: "web/vendor/three.js is what its package gives",
        remedy: "run `npm run vendor` in crates/serve/browser and commit what it writes",
        run: vendor,
    },
    Step { name: "program", about: "the program builds, as for the tests", remedy: "fix what the messages above show", run: test::build },
    Step {
        name: "pages",
        about: "the pages do what they should, in a browser",
        remedy: "fix the page or the test; `cargo xtask browser pages` runs them again",
        run: pages,
    },
];

/// Takes the steps with these names, or all; ends with the first that fails. A missing node or browser is reported as a failure.
///
/// # Errors
/// With the step that failed.
pub fn run(house: &House, names: &[&str]) -> Result<(), String> {
    let steps = choose(&STEPS, names)?;
    steps.iter().try_for_each(|step| step.take(house))?;
    println!("\nbrowser: all well");
    Ok(())
}

fn packages(house: &House) -> Result<String, String> {
    for tool in ["node", "npm"] {
        if !answers(house, tool) {
            return Err(format!("`{tool} --version` does not answer"));
        }
    }
    npm(house, &["ci", "--silent", "--no-audit", "--no-fund"])?;
    browser(house).map(|found| found.display().to_string())
}

/// Bundles three.js anew beside the bundle that is kept, and compares.
fn vendor(house: &House) -> Result<String, String> {
    let fresh = house.target()?.join("three.js");
    let mut command = house.command(npm_program(), &["run", "--silent", "vendor", "--"]);
    command.arg(format!("--outfile={}", fresh.display())).current_dir(house.root.join(ROOM));
    finish(command)?;
    let read = |path: &Path| std::fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()));
    let same = read(&fresh)? == read(&house.root.join("crates/serve/web/vendor/three.js"))?;
    if same { Ok(String::new()) } else { Err("the bundle that is kept differs from the one made now".into()) }
}

fn pages(house: &House) -> Result<String, String> {
    let browser = browser(house)?;
    let program = house.tested("enfilade")?;
    let mut command = house.command("node", &["--test", "--test-concurrency=1"]);
    command.args(tests(house)?).current_dir(house.root.join(ROOM)).env(BROWSER_VARIABLE, browser).env(PROGRAM_VARIABLE, program);
    finish(command)
}

/// The files of tests, from their room.
fn tests(house: &House) -> Result<Vec<PathBuf>, String> {
    let folder = house.root.join(ROOM).join("tests");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("cannot read {}: {error}", folder.display()))?;
    let mut tests: Vec<PathBuf> = entries.filter_map(|entry| Some(Path::new("tests").join(entry.ok()?.file_name()))).collect();
    tests.retain(|path| path.to_string_lossy().ends_with(".test.mjs"));
    tests.sort();
    Ok(tests)
}

/// The browser that [`BROWSER_VARIABLE`] names, or one that is installed. On an unattended machine, Debian's is installed if there is none;
/// people's own machines are not changed.
fn browser(house: &House) -> Result<PathBuf, String> {
    if let Some(named) = std::env::var_os(BROWSER_VARIABLE) {
        return Ok(named.into());
    }
    if let Some(found) = installed() {
        return Ok(found);
    }
    if House::unattended() && cfg!(target_os = "linux") {
        finish(house.command("apt-get", &["update", "--quiet"]))?;
        finish(house.command("apt-get", &["install", "--yes", "--quiet", "--no-install-recommends", "chromium"]))?;
    }
    installed().ok_or_else(|| {
        format!("there is no Chromium: install it (on Debian: apt install chromium), or name a browser by {BROWSER_VARIABLE}")
    })
}

fn installed() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    BROWSERS.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

fn npm(house: &House, arguments: &[&str]) -> Result<String, String> {
    let mut command = house.command(npm_program(), arguments);
    command.current_dir(house.root.join(ROOM));
    finish(command)
}

fn npm_program() -> &'static str {
    if cfg!(windows) { "npm.cmd" } else { "npm" }
}

fn answers(house: &House, tool: &str) -> bool {
    let program = if tool == "npm" { npm_program() } else { tool };
    let mut command: Command = house.command(program, &["--version"]);
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

//! `cargo xtask docs`: the documentation site, from `docs/`, the code and the notebooks, by mdBook, below `target/docs/site`.
//!
//! Generated pages are not kept in the repository, so they cannot be out of date: keys of `dataset.toml`, layers, the Python module and the
//! command line are described from the code, and by the program that is built for it. mdBook and nbconvert are installed below the target
//! folder.

mod commands;
mod fields;
mod keys;
pub mod layers;
mod links;
mod pages;
mod python_api;
pub mod signatures;
mod sources;
mod tables;

use crate::house::House;
use crate::python;
use crate::step::{Step, choose, finish};
use pages::{Site, place, stem};
use std::path::PathBuf;

/// mdBook's version, with which the pages were checked.
const MDBOOK: &str = "0.5.4";
const NBCONVERT: &str = "nbconvert==7.17.2";

/// All steps, in their order.
const STEPS: [Step; 6] = [
    Step {
        name: "tools",
        about: "mdBook and nbconvert are installed",
        remedy: "see what cargo or pip says above; both are taken from the network the first time",
        run: |house| mdbook(house).and_then(|_| nbconvert(house)).map(|_| String::new()),
    },
    Step {
        name: "programs",
        about: "what describes itself is built, with the features that the tests are built with",
        remedy: "fix what the compiler says above",
        run: |house| finish(house.cargo(&["build", "--locked", "--workspace", "--bin", "enfilade", "--example", "resolve"])),
    },
    Step {
        name: "pages",
        about: "pages are made from docs/ and from the code, and their links lead to files",
        remedy: "fix the page; docs/SUMMARY.md lists all",
        run: |house| Site::new(house)?.compose(),
    },
    Step { name: "notebooks", about: "the notebooks become pages as they are stored", remedy: "fix examples/notebooks", run: notebooks },
    Step { name: "site", about: "mdBook makes the site", remedy: "fix what it says above", run: build },
    Step {
        name: "links",
        about: "every link of the site leads to a file and to a heading of it",
        remedy: "fix the link in the page of that name in docs/",
        run: |house| links::check(&site(house)?),
    },
];

/// Takes the steps with these names, or all; ends with the first that fails.
///
/// # Errors
/// With the step that failed.
pub fn run(house: &House, names: &[&str]) -> Result<(), String> {
    choose(&STEPS, names)?.iter().try_for_each(|step| step.take(house))?;
    if names.is_empty() {
        println!("\ndocs: open {}", site(house)?.join("index.html").display());
    }
    Ok(())
}

fn site(house: &House) -> Result<PathBuf, String> {
    Ok(house.target()?.join("docs/site"))
}

/// mdBook, without its server.
fn mdbook(house: &House) -> Result<PathBuf, String> {
    let root = house.target()?.join(format!("mdbook-{MDBOOK}"));
    let program = root.join(format!("bin/mdbook{}", std::env::consts::EXE_SUFFIX));
    if !program.is_file() {
        let mut install =
            house.cargo(&["install", "mdbook", "--version", MDBOOK, "--locked", "--no-default-features", "--features", "search"]);
        install.arg("--root").arg(&root);
        finish(install)?;
    }
    Ok(program)
}

fn nbconvert(house: &House) -> Result<PathBuf, String> {
    python::made(house, "venv-docs", "import nbconvert, IPython", &[NBCONVERT, "ipython"])
}

fn notebooks(house: &House) -> Result<String, String> {
    let (site, python) = (Site::new(house)?, nbconvert(house)?);
    let notebooks: Vec<&String> = site.chapters.iter().filter(|chapter| chapter.ends_with(".ipynb")).collect();
    let folder = site.folder.join("src/notebooks");
    let mut convert = house.command(python, &["-m", "nbconvert", "--to", "markdown", "--log-level", "WARN", "--output-dir"]);
    convert.arg(&folder).args(&notebooks);
    finish(convert)?;
    for notebook in &notebooks {
        let name = stem(notebook);
        let made = folder.join(format!("{name}.md"));
        let text = std::fs::read_to_string(&made).map_err(|error| format!("cannot read {}: {error}", made.display()))?;
        let own = format!("[This page as a notebook]({name}.ipynb), to run.\n\n");
        site.write(&place(notebook), &own_after_title(&site.led(notebook, &text)?, &own))?;
        std::fs::copy(house.root.join(notebook), folder.join(format!("{name}.ipynb")))
            .map_err(|error| format!("cannot copy {notebook}: {error}"))?;
    }
    Ok(format!("{} notebooks", notebooks.len()))
}

/// `text` with `own` below its first line, which is its title.
fn own_after_title(text: &str, own: &str) -> String {
    let text = text.trim_start();
    let end = text.find('\n').map_or(text.len(), |at| at + 1);
    format!("{}\n{own}{}", &text[..end], &text[end..])
}

fn build(house: &House) -> Result<String, String> {
    let mut command = house.command(mdbook(house)?, &["build", "--dest-dir"]);
    command.arg(site(house)?).arg(Site::new(house)?.folder);
    finish(command)
}

//! The words of the command line.

use anyhow::{Context, Result};
use enfilade_home::{HomeConfig, home};
use enfilade_import::{ImportOptions, load};
use enfilade_scene::{Quiet, Scene};

/// The words behind the instrument's name.
pub fn arguments() -> impl Iterator<Item = String> {
    std::env::args().skip(2)
}

/// The scenes of these names, each with its name: files, or `home` for the demo's room, which is also what no name means.
pub fn scenes(mut names: Vec<String>) -> impl Iterator<Item = Result<(String, Scene)>> {
    if names.is_empty() {
        names.push("home".into());
    }
    names.into_iter().map(|name| {
        let scene = match name.as_str() {
            "home" => home(&HomeConfig::default()).scene,
            file => load(file.as_ref(), &ImportOptions::default(), &Quiet)?.scene,
        };
        Ok((name, scene))
    })
}

/// Width and height as `--size` has them.
pub fn size(text: &str) -> Result<[u32; 2]> {
    let (width, height) = text.split_once('x').with_context(|| format!("--size {text}: expected WIDTHxHEIGHT"))?;
    Ok([width.parse()?, height.parse()?])
}

/// The building of this name; a home unless one is named.
pub fn building(name: Option<&str>) -> std::io::Result<enfilade_home::Building> {
    let Some(name) = name else { return Ok(enfilade_home::Building::Home) };
    let known = enfilade_home::Building::ALL;
    known.into_iter().find(|building| building.name() == name).ok_or_else(|| {
        let names = known.map(enfilade_home::Building::name).join(", ");
        std::io::Error::other(format!("--building is {name:?}, expected one of {names}"))
    })
}

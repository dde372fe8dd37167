//! Import directions: a crate depends only on crates of strictly lower floors.
//!
//! [`FLOORS`] is the law; the table in `ARCHITECTURE.md` must agree. Development dependencies are free, because a test may use any crate.

use crate::house::House;
use std::collections::BTreeMap;
use toml::Table;

/// The floor of a crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Floor {
    /// A floor of the house.
    Number(u8),
    /// A crate beside the house, for tests and checks: others may only have it as a development dependency.
    Dev,
}

/// Every crate by the name of its folder.
const FLOORS: [(&str, Floor); 42] = [
    ("math", Floor::Number(0)),
    ("options", Floor::Number(0)),
    ("parallel", Floor::Number(0)),
    ("geometry", Floor::Number(1)),
    ("frame", Floor::Number(1)),
    ("vrscene", Floor::Number(1)),
    ("scene", Floor::Number(2)),
    ("import", Floor::Number(3)),
    ("textures", Floor::Number(3)),
    ("explore", Floor::Number(3)),
    ("render", Floor::Number(3)),
    ("denoise", Floor::Number(3)),
    ("dataset", Floor::Number(3)),
    ("suggest", Floor::Number(3)),
    ("shapes", Floor::Number(3)),
    ("furniture", Floor::Number(4)),
    ("label", Floor::Number(4)),
    ("loader", Floor::Number(4)),
    ("multiview", Floor::Number(4)),
    ("sensors", Floor::Number(4)),
    ("vray", Floor::Number(4)),
    ("compose", Floor::Number(4)),
    ("home", Floor::Number(5)),
    ("physics", Floor::Number(5)),
    ("describe", Floor::Number(5)),
    ("verify", Floor::Number(5)),
    ("show", Floor::Number(6)),
    ("vary", Floor::Number(6)),
    ("pipeline", Floor::Number(7)),
    ("export", Floor::Number(7)),
    ("animate", Floor::Number(7)),
    ("serve", Floor::Number(7)),
    ("label_page", Floor::Number(8)),
    ("view_page", Floor::Number(8)),
    ("farm", Floor::Number(8)),
    ("cli", Floor::Number(9)),
    ("python", Floor::Number(10)),
    ("testkit", Floor::Dev),
    ("testroom", Floor::Dev),
    ("fuzz", Floor::Dev),
    ("bench", Floor::Dev),
    ("xtask", Floor::Dev),
];

/// Prefix of package names, except the program's and this one's.
const PREFIX: &str = "enfilade-";

/// The folder of a package of ours; packages of several words have hyphens where folders have underscores.
fn folder_of(package: &str) -> Option<String> {
    if package == "enfilade" { Some("cli".into()) } else { Some(package.strip_prefix(PREFIX)?.replace('-', "_")) }
}

/// The packages of the floors from the ground to `highest`.
pub fn packages_up_to(highest: u8) -> impl Iterator<Item = String> {
    let low = move |floor| matches!(floor, Floor::Number(n) if n <= highest);
    FLOORS.iter().filter(move |(_, floor)| low(*floor)).map(|(name, _)| format!("{PREFIX}{}", name.replace('_', "-")))
}

/// Checks all crates and the table of the architecture page.
///
/// # Errors
/// With every import that points up or sideways, every crate without a floor and every row that differs.
pub fn check(house: &House) -> Result<String, String> {
    let manifests = manifests(house)?;
    let mut found: Vec<String> = manifests.iter().flat_map(|(name, manifest)| wrong_imports(name, manifest)).collect();
    let gone = FLOORS.iter().filter(|(name, _)| !manifests.contains_key(*name));
    found.extend(gone.map(|(name, _)| format!("xtask/src/floors.rs has a row for `{name}`, but there is no such crate")));
    found.extend(wrong_rows(&house.read("ARCHITECTURE.md")?));
    if found.is_empty() { Ok(format!("{} crates", manifests.len())) } else { Err(found.join("\n  ")) }
}

/// The manifest of every crate, by the name of its folder.
///
/// # Errors
/// When a file cannot be read or understood.
pub fn manifests(house: &House) -> Result<BTreeMap<String, Table>, String> {
    let folder = std::fs::read_dir(house.root.join("crates")).map_err(|error| format!("cannot list crates: {error}"))?;
    let names = folder.filter_map(Result::ok).filter(|entry| entry.path().join("Cargo.toml").is_file());
    let paths = names.map(|entry| entry.file_name().to_string_lossy().into_owned()).map(|name| (format!("crates/{name}/Cargo.toml"), name));
    paths
        .chain([("xtask/Cargo.toml".into(), "xtask".into())])
        .map(|(path, name)| {
            let table = house.read(&path)?.parse::<Table>().map_err(|error| format!("{path}: {error}"))?;
            Ok((name, table))
        })
        .collect()
}

/// The dependencies that a manifest lists under `kinds`, on every platform: key and description.
pub fn listed<'a>(manifest: &'a Table, kinds: &'a [&str]) -> impl Iterator<Item = (&'a String, &'a toml::Value)> {
    let platforms =
        manifest.get("target").and_then(toml::Value::as_table).into_iter().flat_map(|t| t.values()).filter_map(toml::Value::as_table);
    let sections = std::iter::once(manifest).chain(platforms);
    sections.flat_map(|section| kinds.iter().filter_map(|kind| section.get(*kind)?.as_table())).flatten()
}

/// The problems with the imports of one crate.
fn wrong_imports(name: &str, manifest: &Table) -> Vec<String> {
    let Some(own) = floor(name) else {
        return vec![format!("crate `{name}` has no floor: give it a row in xtask/src/floors.rs and in ARCHITECTURE.md")];
    };
    let kinds = ["dependencies", "build-dependencies"];
    let packages = listed(manifest, &kinds).map(|(key, value)| value.get("package").and_then(toml::Value::as_str).unwrap_or(key));
    packages.filter_map(|package| wrong_import(name, own, &folder_of(package)?)).collect()
}

fn wrong_import(name: &str, own: Floor, other: &str) -> Option<String> {
    match (own, floor(other)) {
        (_, None) => Some(format!("`{name}` depends on `{other}`, which has no floor")),
        (Floor::Number(_), Some(Floor::Dev)) => Some(format!("`{name}` depends on `{other}`, which is for development dependencies only")),
        (Floor::Number(own), Some(Floor::Number(below))) if below >= own => {
            Some(format!("`{name}` (floor {own}) depends on `{other}` (floor {below}); imports point to strictly lower floors"))
        }
        _ => None,
    }
}

fn floor(name: &str) -> Option<Floor> {
    FLOORS.iter().find(|(known, _)| *known == name).map(|&(_, floor)| floor)
}

/// Differences between the architecture page's table of crates (``| floor | `crate` | …``) and [`FLOORS`].
fn wrong_rows(page: &str) -> Vec<String> {
    let rows: BTreeMap<&str, &str> = page.lines().filter_map(row).collect();
    let mut found = Vec::new();
    for (name, floor) in FLOORS {
        let expected = match floor {
            Floor::Number(n) => n.to_string(),
            Floor::Dev => "dev".into(),
        };
        match rows.get(name) {
            None => found.push(format!("the table of crates in ARCHITECTURE.md lacks `{name}` (floor {expected})")),
            Some(written) if *written != expected => {
                found.push(format!("ARCHITECTURE.md puts `{name}` on floor {written}, xtask/src/floors.rs on {expected}"));
            }
            Some(_) => {}
        }
    }
    let strange = rows.keys().filter(|name| floor(name).is_none());
    found.extend(strange.map(|name| format!("ARCHITECTURE.md has a crate `{name}` that xtask/src/floors.rs does not know")));
    found
}

/// Crate and floor of one row of the table; `None` for other lines.
fn row(line: &str) -> Option<(&str, &str)> {
    let mut cells = line.strip_prefix('|')?.split('|').map(str::trim);
    let floor = cells.next().filter(|cell| *cell == "dev" || cell.parse::<u8>().is_ok())?;
    let name = cells.next()?.strip_prefix('`')?.strip_suffix('`')?;
    Some((name, floor))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong(name: &str, manifest: &str) -> Vec<String> {
        wrong_imports(name, &manifest.parse().unwrap())
    }

    #[test]
    fn imports_that_point_down_are_allowed_and_tests_may_use_anything() {
        let manifest = "[dependencies]\nenfilade-math.workspace = true\nenfilade-scene.workspace = true\nglam = \"1\"\n\
            [dev-dependencies]\nenfilade-testkit.workspace = true\nenfilade-pipeline.workspace = true";
        assert!(wrong("render", manifest).is_empty());
        assert!(wrong("testkit", "[dependencies]\nenfilade-math.workspace = true").is_empty());
    }

    #[test]
    fn imports_that_point_up_or_sideways_are_found_on_every_platform_and_under_other_names() {
        assert_eq!(
            wrong("math", "[dependencies]\nenfilade-geometry.workspace = true"),
            ["`math` (floor 0) depends on `geometry` (floor 1); imports point to strictly lower floors"]
        );
        assert_eq!(wrong("render", "[target.'cfg(unix)'.dependencies]\nenfilade-dataset = { path = \"../dataset\" }").len(), 1);
        assert_eq!(wrong("farm", "[dependencies]\nenfilade.workspace = true").len(), 1);
        assert_eq!(wrong("render", "[build-dependencies]\nhouse = { package = \"enfilade-home\", path = \"../home\" }").len(), 1);
        assert!(wrong("render", "[dependencies]\nenfilade-testkit.workspace = true")[0].contains("development dependencies only"));
    }

    #[test]
    fn a_crate_without_a_floor_is_found() {
        assert!(wrong("attic", "")[0].contains("crate `attic` has no floor"));
        assert!(wrong("cli", "[dependencies]\nenfilade-attic.workspace = true")[0].contains("`attic`, which has no floor"));
    }

    #[test]
    fn the_page_must_say_the_same() {
        let line = |(name, floor): &(&str, Floor)| match floor {
            Floor::Number(n) => format!("| {n} | `{name}` | … |\n"),
            Floor::Dev => format!("| dev | `{name}` | … |\n"),
        };
        let page: String = std::iter::once("| floor | crate | |\n|---|---|---|\n".into()).chain(FLOORS.iter().map(line)).collect();
        assert!(wrong_rows(&page).is_empty());
        assert_eq!(
            wrong_rows(&page.replace("| 2 | `scene`", "| 3 | `scene`")),
            ["ARCHITECTURE.md puts `scene` on floor 3, xtask/src/floors.rs on 2"]
        );
        assert_eq!(wrong_rows(&page.replace("`scene`", "`attic`")).len(), 2);
    }

    #[test]
    fn quick_tests_are_those_of_the_lower_floors() {
        let expected = [
            "enfilade-math",
            "enfilade-options",
            "enfilade-parallel",
            "enfilade-geometry",
            "enfilade-frame",
            "enfilade-vrscene",
            "enfilade-scene",
        ];
        assert_eq!(packages_up_to(2).collect::<Vec<_>>(), expected);
    }
}

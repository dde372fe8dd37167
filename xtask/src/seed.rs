//! `docs/seed.md`: checks that every file, symbol, test and law named in its tables exists.
//!
//! A row is `| statement | where | test | departure |`. *Where* has files, each followed by the symbols it declares; `explore/carve/mod.rs`
//! is `crates/explore/src/carve/mod.rs`, `training/…` is below `training/enfilade_training`. *Test* has names, followed by the crate or
//! folder of them in parentheses. A departure may name laws and tests.

use crate::house::House;
use std::path::{Path, PathBuf};

const PAGE: &str = "docs/seed.md";
const LAWS: &str = "crates/verify/src/law.rs";
/// Words before a name that is declared, in Rust and Python.
const KEYWORDS: [&str; 10] = ["fn", "struct", "enum", "trait", "const", "static", "type", "mod", "def", "class"];

/// Fails with every name that leads nowhere.
///
/// # Errors
/// If a row names something that does not exist, or something cannot be read.
pub fn check(house: &House) -> Result<String, String> {
    let page = house.read(PAGE)?;
    let rows: Vec<(usize, &str)> = (1..).zip(page.lines()).filter(|(_, line)| line.starts_with("| (")).collect();
    let problems: Vec<String> = rows
        .iter()
        .flat_map(|(line, row)| problems(house, row).into_iter().map(move |problem| format!("{PAGE}:{line}: {problem}")))
        .collect();
    if problems.is_empty() { Ok(format!("{} statements", rows.len())) } else { Err(problems.join("\n")) }
}

/// The problems of a row.
fn problems(house: &House, row: &str) -> Vec<String> {
    let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
    let [statement, places, tests, departure] = cells[..] else {
        return vec![format!("{} cells, expected a statement, where, test and departure", cells.len())];
    };
    let marks: Vec<&str> = statement.trim_start_matches('(').split(')').next().unwrap_or("").split(", ").collect();
    let mut found = Vec::new();
    if !marks.iter().all(|mark| ["S", "P", "T"].contains(mark)) {
        found.push(format!("marked {}, expected (S), (P), (T) or several of them, as (P, S)", marks.join(", ")));
    }
    found.extend(missing_places(house, places));
    found.extend(missing_tests(house, tests, 1));
    found.extend(missing_tests(house, departure, 3));
    found.extend(missing_laws(house, departure));
    found
}

/// Files that do not exist, and symbols that their files do not declare.
fn missing_places(house: &House, cell: &str) -> Vec<String> {
    let (mut found, mut last): (Vec<String>, Option<(&str, String)>) = (Vec::new(), None);
    for (name, _) in quoted(cell) {
        if name.contains('/') {
            let place = place(&house.root, name);
            match text_below(&place) {
                Some(text) => last = Some((name, text)),
                None => found.push(format!("there is no {}", place.strip_prefix(&house.root).unwrap_or(&place).display())),
            }
        } else if let Some((file, text)) = &last {
            let unknown = name.split("::").filter(|part| !declares(text, part) && !text.contains(&format!("impl {part}")));
            found.extend(unknown.map(|part| format!("{file} does not declare {part}")));
        } else {
            found.push(format!("{name} follows no file"));
        }
    }
    found
}

/// Tests that the folder behind them does not have. Names of fewer underscores than `from` are something else.
fn missing_tests(house: &House, cell: &str, from: usize) -> Vec<String> {
    let (mut found, mut waiting) = (Vec::new(), Vec::new());
    for (name, after) in quoted(cell) {
        if name.matches('_').count() < from || !name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_') {
            continue;
        }
        waiting.push(name);
        let Some(folder) = after.strip_prefix(" (").and_then(|rest| rest.split(')').next()) else { continue };
        let below = if folder.contains('/') { house.root.join(folder) } else { house.root.join("crates").join(folder) };
        match text_below(&below) {
            Some(text) => {
                let missing = waiting.drain(..).filter(|name| !declares(&text, name));
                found.extend(missing.map(|name| format!("{folder} has no test {name}")));
            }
            None => found.push(format!("there is no {folder} to have {}", std::mem::take(&mut waiting).join(", "))),
        }
    }
    found.extend(waiting.iter().map(|name| format!("no crate or folder follows {name}")));
    found
}

/// Laws that `verify` does not have: names in CamelCase in cells that mention laws.
fn missing_laws(house: &House, cell: &str) -> Vec<String> {
    let Some((_, laws)) = cell.split_once("Law") else { return Vec::new() };
    let text = house.read(LAWS).unwrap_or_default();
    let is_law = |name: &&str| name.starts_with(|first: char| first.is_ascii_uppercase()) && !name.contains('/');
    let missing = |name: &&str| !text.contains(&format!("    {name},"));
    quoted(laws).map(|(name, _)| name).filter(is_law).filter(missing).map(|name| format!("{LAWS} has no law {name}")).collect()
}

/// The texts in backticks, each with the text after it.
fn quoted(cell: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut rest = cell;
    std::iter::from_fn(move || {
        let (_, begun) = rest.split_once('`')?;
        let (name, after) = begun.split_once('`')?;
        rest = after;
        Some((name, after))
    })
}

/// Path of a file or folder that the page abbreviates.
fn place(root: &Path, name: &str) -> PathBuf {
    let in_root = ["docs/", "examples/", "xtask/"].iter().any(|folder| name.starts_with(folder));
    match name.split_once('/') {
        _ if in_root => root.join(name),
        Some(("training", rest)) => root.join("training/enfilade_training").join(rest),
        Some((package, rest)) => root.join("crates").join(package).join("src").join(rest),
        None => root.join(name),
    }
}

/// The text of a file, or of all Rust and Python files below a folder; `None` where there is neither.
fn text_below(path: &Path) -> Option<String> {
    if path.is_file() {
        return std::fs::read_to_string(path).ok();
    }
    let mut text = String::new();
    for entry in std::fs::read_dir(path).ok()?.flatten() {
        let path = entry.path();
        let is_source = path.extension().is_some_and(|ending| ending == "rs" || ending == "py");
        if path.is_dir() && !path.ends_with("target") || is_source {
            text.push_str(&text_below(&path)?);
        }
    }
    Some(text)
}

/// Whether a source declares a name: as an item, or as a field.
fn declares(text: &str, name: &str) -> bool {
    text.match_indices(name).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + name.len()..]);
        let part_of_a_name = |c: char| c.is_alphanumeric() || c == '_';
        if before.ends_with(part_of_a_name) || after.starts_with(part_of_a_name) {
            return false;
        }
        let line = before.rsplit('\n').next().unwrap_or("").trim_start();
        let word = line.trim_end().rsplit(' ').next().unwrap_or("");
        let is_field = after.starts_with(':') && !after.starts_with("::") && (line.is_empty() || line.starts_with("pub"));
        KEYWORDS.contains(&word) || is_field
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_page_names_is_there() {
        check(&House::find().unwrap()).unwrap_or_else(|problems| panic!("{problems}"));
    }

    #[test]
    fn names_that_lead_nowhere_are_told() {
        let house = House::find().unwrap();
        let sound = "| (P, S) a | `explore/carve/mod.rs` `carve`, `Carving::next_position`, `geometry/octree/` | `bad_starts_are_named` (explore) | none. Law `WalkBox` |";
        assert_eq!(problems(&house, sound), Vec::<String>::new());
        for (from, to, told) in [
            ("(P, S)", "(X)", "marked X"),
            ("carve/mod.rs", "carve/mud.rs", "there is no crates/explore/src/carve/mud.rs"),
            ("`carve`", "`Carve`", "explore/carve/mod.rs does not declare Carve"),
            ("next_position", "position_next", "does not declare position_next"),
            ("bad_starts_are", "good_starts_are", "explore has no test good_starts_are_named"),
            (" (explore)", "", "no crate or folder follows bad_starts_are_named"),
            ("WalkBox", "WalkBoxes", "has no law WalkBoxes"),
            (" | none", "", "3 cells"),
        ] {
            let broken = problems(&house, &sound.replacen(from, to, 1)).join("\n");
            assert!(broken.contains(told), "{to}: {broken}");
        }
    }
}

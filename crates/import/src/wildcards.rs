//! Paths with `*` and `?`: the files and folders that they mean, in one order whatever the file system's.

use std::path::{Path, PathBuf};
use wildmatch::WildMatch;

/// At most this many names are looked at for one pattern: enough for the largest collections, and an end for patterns that go through a
/// whole disk.
const MAX_NAMES: usize = 1 << 19;

/// A file or folder that a pattern means.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Match {
    /// Path of the file as the pattern spells it, with its wildcards replaced.
    pub path: String,
    /// The last name in it that a wildcard matched; the file's own name where the pattern has none.
    pub name: String,
}

/// The files and folders that `pattern` means, sorted by their paths. `*` matches any characters within a name and `?` a single one;
/// names that begin with a dot are only matched by patterns that do. Relative patterns begin in `folder`.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # for name in ["b.json", "a.json", "a.txt"] { std::fs::write(folder.path().join(name), "")?; }
/// let found = enfilade_import::matches(folder.path(), "*.json")?;
/// assert_eq!(found.iter().map(|m| m.path.as_str()).collect::<Vec<_>>(), ["a.json", "b.json"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the pattern leads to more names than any collection has.
pub fn matches(folder: &Path, pattern: &str) -> Result<Vec<Match>, String> {
    let (root, rest) = if pattern.starts_with('/') { ("/", pattern.trim_start_matches('/')) } else { ("", pattern) };
    let mut found = vec![(Match { path: root.to_string(), name: String::new() }, folder.join(root))];
    let mut looked_at = 0;
    for component in rest.split('/').filter(|component| !component.is_empty()) {
        let is_wild = component.contains(['*', '?']);
        let mut next = Vec::new();
        for (known, place) in found {
            let names = if is_wild { names_in(&place) } else { vec![component.to_string()] };
            looked_at += names.len();
            if looked_at > MAX_NAMES {
                return Err(format!("{pattern:?} leads to more than {MAX_NAMES} names; name the folders more exactly"));
            }
            for name in names.into_iter().filter(|name| !is_wild || fits(component, name)) {
                let slash = if known.path.is_empty() || known.path.ends_with('/') { "" } else { "/" };
                let path = format!("{}{slash}{name}", known.path);
                let place = place.join(&name);
                next.push((Match { path, name: if is_wild { name } else { known.name.clone() } }, place));
            }
        }
        found = next;
    }
    let mut there: Vec<Match> = found.into_iter().filter(|(_, place)| place.exists()).map(|(found, _)| named(found)).collect();
    there.sort_unstable();
    Ok(there)
}

/// A match under the file's own name where no wildcard matched one.
fn named(found: Match) -> Match {
    let own = || found.path.rsplit('/').next().unwrap_or_default().to_string();
    if found.name.is_empty() { Match { name: own(), ..found } } else { found }
}

/// Names in a folder; none where it is no folder.
fn names_in(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_path_buf() };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().into_string().ok()).collect()
}

/// True where a name fits a pattern.
fn fits(pattern: &str, name: &str) -> bool {
    (pattern.starts_with('.') || !name.starts_with('.')) && WildMatch::new(pattern).matches(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_any_run_of_characters_and_marks_for_one() {
        for (pattern, name) in
            [("*", "a"), ("a*c", "abcbc"), ("*.scene_instance.json", "1.scene_instance.json"), ("?.x", "ü.x"), ("a", "a")]
        {
            assert!(fits(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("a*c", "abcb"), ("?", ""), ("*", ".hidden"), ("a", "ab"), ("*b", "a")] {
            assert!(!fits(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn matches_are_sorted_spelled_as_the_pattern_and_named_after_the_last_wildcard() {
        let folder = tempfile::tempdir().unwrap();
        for file in ["s/scene_2/a.json", "s/scene_1/a.json", "s/scene_3/b.json", "t.json"] {
            let path = folder.path().join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        let found = |pattern: &str| -> Vec<(String, String)> {
            matches(folder.path(), pattern).unwrap().into_iter().map(|m| (m.path, m.name)).collect()
        };
        let pair = |path: &str, name: &str| (path.to_string(), name.to_string());
        assert_eq!(found("s/*/a.json"), [pair("s/scene_1/a.json", "scene_1"), pair("s/scene_2/a.json", "scene_2")]);
        assert_eq!(found("./s/../*.json"), [pair("./s/../t.json", "t.json")]);
        assert_eq!(found("t.json"), [pair("t.json", "t.json")]);
        assert_eq!(found("none/*"), []);
        let whole = format!("{}/s/*", folder.path().display());
        assert_eq!(found(&whole)[0].1, "scene_1");
    }
}

//! Paths in scenes are valid on the machine that wrote them; this module changes them to paths on the machine that renders.

use enfilade_vrscene::{Document, Item, Place, Value};

/// How a machine writes its paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Platform {
    /// `/mnt/scene/a.png`, on Linux and macOS.
    Unix,
    /// `D:\scene\a.png`.
    Windows,
}

impl Platform {
    /// Platform that a path is written for, as far as it can be recognised.
    pub fn of(path: &str) -> Self {
        let drive = path.as_bytes().get(1) == Some(&b':');
        if drive || path.contains('\\') { Self::Windows } else { Self::Unix }
    }

    /// The separator between folders.
    pub fn separator(self) -> char {
        match self {
            Self::Unix => '/',
            Self::Windows => '\\',
        }
    }

    /// The path of a file in a folder.
    pub fn join(self, folder: &str, file: &str) -> String {
        format!("{}{}{file}", folder.trim_end_matches(['/', '\\']), self.separator())
    }
}

/// True for a parameter whose value is the path of a file, in any plugin: its name begins with `file`, as in the toolkit, or ends in
/// `_file` and does not name the picture that V-Ray writes; or it is the cache of a simulation.
fn holds_path(parameter: &[u8]) -> bool {
    parameter.starts_with(b"file") || parameter == b"cache_path" || parameter.ends_with(b"_file") && parameter != b"img_file"
}

/// A file that a scene refers to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileReference {
    /// The path as it is written.
    pub path: String,
    /// The plugin's name; `#include` for an included file.
    pub plugin: String,
    /// The parameter with the path; `#include` for an included file.
    pub parameter: String,
    /// The position in the scene file.
    pub place: Place,
}

/// Every file that the scene refers to, in its order: these must exist on the machine that renders. Empty paths are skipped.
pub fn file_references(scene: &Document) -> Vec<FileReference> {
    let mut found = Vec::new();
    for item in &scene.items {
        match item {
            Item::Include(include) => found.push(FileReference {
                path: String::from_utf8_lossy(include.path()).into_owned(),
                plugin: "#include".into(),
                parameter: "#include".into(),
                place: include.place(),
            }),
            Item::Time(_) => {}
            Item::Plugin(plugin) => {
                for parameter in plugin.parameters().iter().filter(|p| holds_path(p.name())) {
                    if let Ok(Value::Text(path)) = parameter.value() {
                        let path = String::from_utf8_lossy(&path).into_owned();
                        found.push(FileReference {
                            path,
                            plugin: String::from_utf8_lossy(plugin.name()).into_owned(),
                            parameter: String::from_utf8_lossy(parameter.name()).into_owned(),
                            place: parameter.place(),
                        });
                    }
                }
            }
        }
    }
    found.retain(|reference| !reference.path.is_empty());
    found
}

/// Replaces the folder `old` by `new` at the beginning of every path of a file; returns how many were changed.
///
/// Slashes and backslashes are the same, and so are large and small letters where `old` is a path of Windows. What follows the folder
/// is written as the platform of `new` writes it.
pub fn replace_paths(scene: &mut Document, old: &str, new: &str) -> usize {
    let mut changed = 0;
    for item in &mut scene.items {
        match item {
            Item::Include(include) => {
                if let Some(path) = replaced(include.path(), old, new) {
                    include.set_path(&path);
                    changed += 1;
                }
            }
            Item::Time(_) => {}
            Item::Plugin(plugin) => {
                for parameter in plugin.parameters_mut().iter_mut().filter(|p| holds_path(p.name())) {
                    let Ok(Value::Text(path)) = parameter.value() else { continue };
                    if let Some(path) = replaced(&path, old, new) {
                        parameter.set(&super::text(&path));
                        changed += 1;
                    }
                }
            }
        }
    }
    changed
}

/// The path with another beginning; `None` where it does not begin with the folder.
fn replaced(path: &[u8], old: &str, new: &str) -> Option<String> {
    let path = std::str::from_utf8(path).ok()?;
    let old = old.trim_end_matches(['/', '\\']);
    let ignore_case = Platform::of(old) == Platform::Windows;
    let same = |a: char, b: char| {
        let slash = |c| matches!(c, '/' | '\\');
        a == b || slash(a) && slash(b) || ignore_case && a.eq_ignore_ascii_case(&b)
    };
    let mut rest = path.chars();
    for expected in old.chars() {
        rest.next().filter(|&found| same(found, expected))?;
    }
    let rest = rest.as_str();
    if !rest.is_empty() && !rest.starts_with(['/', '\\']) {
        return None;
    }
    let platform = Platform::of(new);
    let rest: String = rest.chars().map(|c| if matches!(c, '/' | '\\') { platform.separator() } else { c }).collect();
    Some(format!("{}{rest}", new.trim_end_matches(['/', '\\'])))
}

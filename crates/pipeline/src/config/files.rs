//! `files` of a `[[scene]]`: every file that a pattern means is a scene of its own, named after its file.

use super::document::SceneKeys;
use enfilade_import::{Format, Match, matches, scene_name};
use std::path::Path;
use toml::Spanned;

/// One scene of the file: the keys that it shares with others of its table, its own name and its own file.
pub(super) struct Entry<'a> {
    pub keys: &'a SceneKeys,
    pub name: Spanned<String>,
    /// File as it would be written: with the variables of the pattern.
    pub file: Option<Spanned<String>>,
    /// Among the homes of its table.
    pub nth: u32,
}

/// The scenes that `pattern` means, in the order of their paths. `expanded` is the pattern without variables; relative ones begin in
/// `folder`.
///
/// # Errors
/// Message and help, when it means none.
pub(super) fn entries<'a>(
    keys: &'a SceneKeys,
    pattern: &Spanned<String>,
    expanded: &str,
    folder: &Path,
) -> Result<Vec<Entry<'a>>, (String, String)> {
    let help = "`*` matches any characters within a name and `?` a single one; paths begin in the folder of the configuration";
    let found = matches(folder, expanded).map_err(|problem| (problem, help.to_string()))?;
    if found.is_empty() {
        let message = format!("no file is called {expanded:?} in {}", whole(folder).display());
        return Err((message, format!("{}{help}", nearest(folder, expanded))));
    }
    let spanned = |text: String| Spanned::new(pattern.span(), text);
    let written = Written::new(pattern.get_ref(), expanded);
    Ok(found.iter().map(|found| Entry { keys, name: spanned(name(found)), file: Some(spanned(written.path(found))), nth: 0 }).collect())
}

/// The models that `pattern` means, as they would be written, in the order of their paths; of a folder, those in it. `expanded` is the pattern
/// without variables; relative ones begin in `folder`.
///
/// # Errors
/// Message and help, when it means none.
pub(crate) fn models(pattern: &str, expanded: &str, folder: &Path) -> Result<Vec<String>, (String, String)> {
    let help = "name models, with `*` and `?`, or a folder of them; paths begin in the folder of the configuration";
    let mut found = Vec::new();
    for one in matches(folder, expanded).map_err(|problem| (problem, help.to_string()))? {
        if folder.join(&one.path).is_dir() {
            let within = matches(folder, &format!("{}/*", one.path)).map_err(|problem| (problem, help.to_string()))?;
            found.extend(within.into_iter().filter(|model| Format::of(&folder.join(&model.path)).is_ok()));
        } else {
            found.push(one);
        }
    }
    if found.is_empty() {
        let message = format!("no model is called {expanded:?} in {}", whole(folder).display());
        return Err((message, format!("{}{help}", nearest(folder, expanded))));
    }
    let written = Written::new(pattern, expanded);
    Ok(found.iter().map(|found| written.path(found)).collect())
}

/// The name of a scene: that of its file, or of the folder that told it from others; what a name cannot hold becomes `_`.
fn name(found: &Match) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' };
    scene_name(Path::new(&found.name)).chars().map(plain).collect()
}

/// How a pattern begins before its first wildcard: as it is written, with variables, and without them.
struct Written<'p> {
    written: &'p str,
    expanded: String,
}

impl<'p> Written<'p> {
    fn new(written: &'p str, expanded: &str) -> Self {
        let folders = |text: &str| {
            let wild = text.find(['*', '?']).unwrap_or(text.len());
            text[..wild].rfind('/').map_or(0, |slash| slash + 1)
        };
        let (in_written, in_expanded) = (&written[..folders(written)], &expanded[..folders(expanded)]);
        // Slashes that the search leaves out.
        let tidy = matches(Path::new("/"), in_expanded).ok().and_then(|mut m| m.pop());
        let expanded = tidy.filter(|_| in_expanded.starts_with('/')).map_or_else(|| in_expanded.to_string(), |m| format!("{}/", m.path));
        Self { written: in_written, expanded }
    }

    /// The path of a match as it would be written.
    fn path(&self, found: &Match) -> String {
        match found.path.strip_prefix(&self.expanded) {
            Some(rest) => format!("{}{}", self.written, rest.replace('$', "$$")),
            None => found.path.replace('$', "$$"),
        }
    }
}

/// What is there of the folders of a pattern that means nothing, as the first sentence of a help.
fn nearest(folder: &Path, pattern: &str) -> String {
    let parts: Vec<&str> = pattern.split('/').collect();
    for end in (1..parts.len()).rev() {
        let before = parts[..end].join("/");
        let is_there = if before.is_empty() { pattern.starts_with('/') } else { matches(folder, &before).is_ok_and(|m| !m.is_empty()) };
        if is_there {
            return if end + 1 == parts.len() {
                format!("there is {before:?}, but nothing in it is called {:?}; ", parts[end])
            } else {
                format!("there is {before:?}, but nothing in it is called {:?}, so the rest was not looked for; ", parts[end])
            };
        }
    }
    String::new()
}

fn whole(folder: &Path) -> std::path::PathBuf {
    std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf())
}

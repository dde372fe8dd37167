//! MTL material libraries: their entries, statement by statement.

use super::blender::Gloss;
use super::map::Map;
use super::text::{lines, number, unquoted, without_comment};
use crate::ImportError;
use crate::assembly::{Assembly, is_absolute};
use crate::disguise::Content;
use enfilade_math::Rgb;
use enfilade_scene::decoded_text;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// One `newmtl`: its statements by keyword in lower case, later ones replacing earlier ones.
#[derive(Clone)]
pub(crate) struct Entry {
    pub(super) name: String,
    /// Folder of the library, to which pictures are relative, as the scene file would spell it.
    pub(super) folder: String,
    /// Meaning of `Ns` and `Ks`.
    pub(super) gloss: Gloss,
    pub(super) statements: BTreeMap<String, String>,
}

/// Materials by name.
pub(crate) type Library = HashMap<String, Entry>;

/// The materials that Java 3D's loader of OBJ files knows by name, and under the empty name the material of faces without one. Programs
/// based on it, such as Sweet Home 3D, have many models that rely on them. Colours are rounded to a thousandth. Their `d` is opacity, as in
/// Sweet Home 3D's loader; in Java 3D's it is transparency.
pub(super) fn java3d() -> Library {
    let mut library = Library::new();
    parse_text(include_str!("java3d.mtl"), ("", None), &mut library);
    let unnamed = library.get("default").cloned();
    library.extend(unnamed.map(|entry| (String::new(), entry)));
    library
}

/// Reads the libraries `names` of the OBJ file at `obj`, a path as the scene file would spell it. Their materials replace those of
/// `library`. A missing library is replaced, with a warning, by the one with the name of the OBJ file.
///
/// `blender` is the version of Blender in the head of the OBJ file, if it has one.
pub(super) fn read_libraries(
    names: &[String],
    (obj, blender): (&str, Option<[u32; 2]>),
    mut library: Library,
    a: &mut Assembly,
) -> Result<Library, ImportError> {
    let folder = folder_of(obj);
    for line in names {
        // The rest of the line is one name with spaces, or, if there is no such file, several names.
        let whole = a.exists(&spelled(&folder, unquoted(line))) || is_absolute(unquoted(line)) || !line.contains(char::is_whitespace);
        let candidates: Vec<&str> = if whole { vec![line] } else { line.split_whitespace().collect() };
        for name in candidates.into_iter().map(|name| spelled(&folder, unquoted(name))) {
            let path = a.find(&[&name], &[&folder]).unwrap_or(name);
            match a.read(&path) {
                Ok((file, bytes)) => match Content::of(&bytes) {
                    Some(content) => {
                        let problem = format!("the material library {} is {}", file.display(), content.words());
                        stand_in((obj, blender), line, &problem, &mut library, a)?;
                    }
                    None => parse(&bytes, (&folder_of(&path), blender), &mut library, a),
                },
                Err(ImportError::Read { file, source, .. }) => {
                    let missing = format!("the material library {} cannot be read ({source})", file.display());
                    stand_in((obj, blender), line, &missing, &mut library, a)?;
                }
                Err(other) => return Err(other),
            }
        }
    }
    Ok(library)
}

/// The materials of `library` and those of the library that is called like the OBJ file at `obj`, where there is one, for a file that names
/// materials and no library.
pub(super) fn read_own_library(
    (obj, blender): (&str, Option<[u32; 2]>),
    library: Library,
    a: &mut Assembly,
) -> Result<Library, ImportError> {
    let own = Path::new(&obj.replace('\\', "/")).with_extension("mtl").to_string_lossy().into_owned();
    if !a.exists(&own) {
        return Ok(library);
    }
    a.warn("mtllib", format!("the file names no material library; {own}, which is called like it, was read"));
    let mut library = library;
    let (_, bytes) = a.read(&own)?;
    parse(&bytes, (&folder_of(&own), blender), &mut library, a);
    Ok(library)
}

/// The only material whose name differs from `name` in case alone.
pub(super) fn in_other_case<'l>(library: &'l Library, name: &str) -> Option<&'l Entry> {
    let mut alike = library.values().filter(|entry| entry.name.eq_ignore_ascii_case(name));
    alike.next().filter(|_| alike.next().is_none())
}

/// Takes the library that is called like the OBJ file for one that is missing, where there is one.
fn stand_in(
    (obj, blender): (&str, Option<[u32; 2]>),
    line: &str,
    missing: &str,
    library: &mut Library,
    a: &mut Assembly,
) -> Result<(), ImportError> {
    let own = Path::new(&obj.replace('\\', "/")).with_extension("mtl").to_string_lossy().into_owned();
    let bytes = if a.exists(&own) { Some(a.read(&own)?.1).filter(|bytes| Content::of(bytes).is_none()) } else { None };
    let Some(bytes) = bytes else {
        a.warn(format!("mtllib {line}"), format!("{missing}; grey stands in for its materials"));
        return Ok(());
    };
    a.warn(format!("mtllib {line}"), format!("{missing}; {own}, which is called like the OBJ file, was read in its place"));
    let mut found = Library::new();
    parse(&bytes, (&folder_of(&own), blender), &mut found, a);
    for (name, entry) in found {
        library.entry(name).or_insert(entry);
    }
    Ok(())
}

/// A path in a file of `folder`, as the scene file would spell it.
pub(super) fn spelled(folder: &str, path: &str) -> String {
    if is_absolute(path) { path.to_string() } else { format!("{folder}{path}") }
}

/// The folder of a file as the scene file spells it, with a slash at its end; empty where that is the scene file's own.
pub(super) fn folder_of(path: &str) -> String {
    path.replace('\\', "/").rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"))
}

/// Adds the entries of the library that these bytes of a file in `folder` are.
fn parse(bytes: &[u8], of: (&str, Option<[u32; 2]>), library: &mut Library, a: &mut Assembly) {
    let stray = parse_text(&decoded_text(bytes), of, library);
    if let Some(line) = stray {
        a.warn("mtllib", format!("statements before the first newmtl of a material library were ignored, such as {line:?}"));
    }
}

/// Adds the entries of a library, and returns the first statement that belongs to none.
fn parse_text(text: &str, (folder, blender): (&str, Option<[u32; 2]>), library: &mut Library) -> Option<String> {
    let gloss = Gloss::of(text, blender);
    let (mut current, mut stray): (Option<String>, Option<String>) = (None, None);
    for line in lines(text) {
        let line = without_comment(line, is_text).trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let (keyword, rest) = (keyword.to_ascii_lowercase(), rest.trim().to_string());
        if keyword == "newmtl" {
            let entry = Entry { name: rest.clone(), folder: folder.to_string(), gloss, statements: BTreeMap::new() };
            library.insert(rest.clone(), entry);
            current = Some(rest);
        } else if let Some(entry) = current.as_ref().and_then(|name| library.get_mut(name)) {
            if !keyword.is_empty() {
                entry.statements.insert(keyword, rest);
            }
        } else if !keyword.is_empty() && !keyword.starts_with('#') {
            stray.get_or_insert_with(|| line.to_string());
        }
    }
    stray
}

/// True for keywords that a name or path follows.
fn is_text(keyword: &str) -> bool {
    let keyword = keyword.to_ascii_lowercase();
    keyword.starts_with("map_") || matches!(keyword.as_str(), "newmtl" | "bump" | "norm" | "disp" | "decal" | "refl")
}

/// The text after a keyword that numbers follow.
#[derive(Debug, PartialEq)]
pub(super) enum Numbers {
    /// One number or several.
    These(Vec<f32>),
    /// A colour by its tristimulus values.
    Xyz([f32; 3]),
    /// A colour as a file of spectral samples.
    Spectral,
    /// Anything else.
    Other,
}

impl Numbers {
    pub(super) fn parse(statement: &str) -> Self {
        let words: Vec<&str> = statement.split_whitespace().collect();
        let finite = |words: &[&str]| -> Vec<f32> {
            words.iter().map_while(|word| number(word)).map(|v| v as f32).filter(|v: &f32| v.is_finite()).collect()
        };
        match words[..] {
            ["spectral", ..] => Self::Spectral,
            // One number applies to all three.
            ["xyz", ref values @ ..] => match finite(values)[..] {
                [x, y, z, ..] => Self::Xyz([x, y, z]),
                [x, ..] => Self::Xyz([x; 3]),
                [] => Self::Other,
            },
            ["-halo", ref values @ ..] | ref values @ [..] => {
                Some(finite(values)).filter(|v| !v.is_empty()).map_or(Self::Other, Self::These)
            }
        }
    }
}

impl Entry {
    pub(super) fn has(&self, key: &str) -> bool {
        self.statements.contains_key(key)
    }

    pub(super) fn numbers(&self, key: &str) -> Option<Numbers> {
        self.statements.get(key).map(|statement| Numbers::parse(statement))
    }

    pub(super) fn number(&self, key: &str) -> Option<f32> {
        match self.numbers(key)? {
            Numbers::These(values) => values.first().copied(),
            _ => None,
        }
    }

    pub(super) fn rgb(&self, key: &str) -> Option<Rgb> {
        match self.numbers(key)? {
            Numbers::These(values) => match values[..] {
                [r, g, b, ..] => Some(Rgb::new(r, g, b)),
                [grey, ..] => Some(Rgb::splat(grey)),
                [] => None,
            },
            Numbers::Xyz(xyz) => Some(Rgb::from_xyz(xyz.map(f64::from))),
            Numbers::Spectral | Numbers::Other => None,
        }
    }

    pub(super) fn map(&self, key: &str) -> Option<Map<'_>> {
        Map::parse(self.statements.get(key)?)
    }
}

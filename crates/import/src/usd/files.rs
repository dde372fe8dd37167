//! Finding and reading layers and other files: beside the layer that names them, or within its archive.
//!
//! A location is a path relative to the scene file's folder; what is in an archive has its name there in brackets behind it.

use super::archive::Archive;
use super::layer::Layer;
use super::{binary, text};
use crate::ImportError;
use crate::assembly::Assembly;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

/// Byte order marks of text.
const MARKS: [&[u8]; 3] = [b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff"];
/// The first bytes of a zip archive.
const ARCHIVE: &[u8] = b"PK\x03\x04";

/// The archives and layers read so far.
#[derive(Default)]
pub(super) struct Files {
    archives: HashMap<String, Rc<Archive>>,
    layers: HashMap<String, Rc<Layer>>,
    /// Locations of layers that are not there.
    absent: HashSet<String>,
}

/// Why a layer is not there: what would be an error where the scene cannot be read without it.
pub(super) enum Unread {
    /// Nothing is at its location, or nothing that could be fetched. Programs show the scene without it.
    Absent(ImportError),
    /// Something is there that is no layer.
    Broken(ImportError),
}

impl From<ImportError> for Unread {
    fn from(error: ImportError) -> Self {
        match error {
            ImportError::Read { .. } => Self::Absent(error),
            other => Self::Broken(other),
        }
    }
}

impl Files {
    /// The layer at a location that a layer names; `None`, with a warning, where there is none. `user` is the layer and prim that want it.
    ///
    /// # Errors
    /// When what is there cannot be understood.
    pub(super) fn find(&mut self, location: &str, user: &str, a: &mut Assembly) -> Result<Option<Rc<Layer>>, ImportError> {
        if self.absent.contains(location) {
            return Ok(None);
        }
        let error = match self.layer(location, user, a) {
            Ok(layer) => return Ok(Some(layer)),
            Err(Unread::Broken(error)) => return Err(error),
            Err(Unread::Absent(error)) => error,
        };
        let problem = match error {
            ImportError::Read { file, source, .. } => {
                format!("it refers to {}, which cannot be read ({source}); put the file there or correct the reference", file.display())
            }
            ImportError::Malformed { problem, .. } => problem,
            other => other.to_string(),
        };
        a.warn(user, format!("{problem}; the scene is without it, here and wherever else it is referred to"));
        self.absent.insert(location.to_string());
        Ok(None)
    }

    /// The layer at a location. `user` is the layer and prim that want it.
    ///
    /// # Errors
    /// When it cannot be read or is not USD.
    pub(super) fn layer(&mut self, location: &str, user: &str, a: &mut Assembly) -> Result<Rc<Layer>, Unread> {
        if let Some(known) = self.layers.get(location) {
            return Ok(known.clone());
        }
        if let Some(scheme) = scheme(location) {
            let problem =
                format!("it refers to {location}; {scheme} is not fetched, so save the scene with its files beside it (a usdz holds all)");
            return Err(Unread::Absent(a.malformed(user, problem)));
        }
        if location.ends_with('`') {
            let problem = format!(
                "it refers to {location}, an expression of variables, which is not evaluated; flatten the scene (usdcat --flatten)"
            );
            return Err(Unread::Absent(a.malformed(user, problem)));
        }
        let (bytes, location) = self.bytes(location, user, a)?;
        let place = |place: String| match location.split_once('[') {
            Some((_, inner)) => format!("[{inner}, {place}"),
            None => place,
        };
        let file = a.path_of(outer(&location));
        let read = if bytes.starts_with(binary::MAGIC) {
            binary::parse(&bytes)
        } else if bytes.starts_with(b"#") || MARKS.iter().any(|mark| bytes.starts_with(mark)) {
            text::parse(&enfilade_scene::decoded_text(&bytes))
        } else if is_materialx(&location) {
            a.warn(
                &location,
                "MaterialX documents are not read: materials that are in it are grey; with a USD that reads them, `usdcat --flatten` brings \
                 them into the scene",
            );
            Ok(Layer::default())
        } else if bytes.starts_with(ARCHIVE) {
            let problem = "found an archive within an archive, or one without the extension usdz; expected a layer, so name it .usdz and put it \
                           beside the scene";
            Err(("byte 0".into(), problem.into()))
        } else {
            let problem =
                "found neither `#usda` nor `PXR-USDC` at its beginning, expected a layer of USD; check that the file is one and whole";
            Err(("byte 0".into(), problem.into()))
        };
        let mut layer = read.map_err(|(at, problem)| ImportError::malformed(&file, place(at), problem))?;
        layer.location.clone_from(&location);
        if layer.specs.values().flatten().any(|(name, _)| matches!(&**name, "relocates" | "layerRelocates")) {
            a.warn(&location, "relocates were left out: prims stay where they were before; flatten the scene (usdcat --flatten)");
        }
        let layer = Rc::new(layer);
        self.layers.insert(location, layer.clone());
        Ok(layer)
    }

    /// The bytes of a layer, with its location, which for an archive is its first file's.
    fn bytes(&mut self, location: &str, user: &str, a: &mut Assembly) -> Result<(Vec<u8>, String), Unread> {
        let file = outer(location);
        if !is_archive(file) {
            return Ok(a.read(file).map(|(_, bytes)| (bytes, location.to_string()))?);
        }
        let archive = self.archive(file, a)?;
        let inner = inner(location).unwrap_or(&archive.first);
        if let Some((nested, _)) = inner.split_once('[') {
            let problem = format!("it refers to {nested}, an archive within the archive {file}; put it beside the scene");
            return Err(Unread::Absent(a.malformed(user, problem)));
        }
        match archive.get(inner) {
            Some(bytes) => Ok((bytes.to_vec(), format!("{file}[{inner}]"))),
            None => {
                let problem = format!("it refers to {inner}, which is not in the archive {file}; pack the archive again");
                Err(Unread::Absent(a.malformed(user, problem)))
            }
        }
    }

    fn archive(&mut self, file: &str, a: &mut Assembly) -> Result<Rc<Archive>, ImportError> {
        if let Some(known) = self.archives.get(file) {
            return Ok(known.clone());
        }
        let (path, bytes) = a.read(file)?;
        let archive = Archive::open(bytes).map_err(|(place, problem)| ImportError::malformed(&path, place, problem))?;
        let archive = Rc::new(archive);
        self.archives.insert(file.to_string(), archive.clone());
        Ok(archive)
    }

    /// The bytes of a file in an archive that has been opened.
    pub(super) fn embedded(&self, location: &str) -> Option<Vec<u8>> {
        self.archives.get(outer(location))?.get(inner(location)?).map(<[u8]>::to_vec)
    }
}

/// The location of an asset path in a layer: `./a` and `a` are beside the layer, in its archive if it is in one.
pub(super) fn resolve(asset: &str, layer: &str) -> String {
    let asset = asset.replace('\\', "/");
    if scheme(&asset).is_some() || Path::new(&asset).is_absolute() {
        return asset;
    }
    match (outer(layer), inner(layer)) {
        (file, Some(inner)) => format!("{file}[{}]", joined(inner, &asset)),
        (file, None) => joined(file, &asset),
    }
}

/// True where the location is inside of an archive.
pub(super) fn is_embedded(location: &str) -> bool {
    inner(location).is_some() && is_archive(outer(location))
}

fn joined(file: &str, asset: &str) -> String {
    let mut steps: Vec<&str> = file.split('/').collect();
    steps.pop();
    for step in asset.split('/').filter(|s| !s.is_empty() && *s != ".") {
        if step == ".." && steps.last().is_some_and(|s| *s != ".." && !s.is_empty()) {
            steps.pop();
        } else {
            steps.push(step);
        }
    }
    steps.join("/")
}

fn outer(location: &str) -> &str {
    location.split_once('[').map_or(location, |(file, _)| file)
}

fn inner(location: &str) -> Option<&str> {
    location.split_once('[')?.1.strip_suffix(']')
}

fn is_archive(file: &str) -> bool {
    Path::new(file).extension().is_some_and(|e| e.eq_ignore_ascii_case("usdz"))
}

/// True for the location of a document of MaterialX.
pub(super) fn is_materialx(location: &str) -> bool {
    location.trim_end_matches(']').ends_with(".mtlx")
}

fn scheme(location: &str) -> Option<&str> {
    let (scheme, _) = location.split_once("://")?;
    (scheme.len() > 1).then_some(scheme)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asset_paths_start_at_their_layer() {
        for (asset, layer, expected) in [
            ("./tex/a.png", "room.usda", "tex/a.png"),
            ("../b.usd", "sub/deep/x.usda", "sub/b.usd"),
            ("../b.usd", "x.usda", "../b.usd"),
            ("c.png", "room.usdz[in/a.usdc]", "room.usdz[in/c.png]"),
            ("..\\c.png", "room.usdz[in/a.usdc]", "room.usdz[c.png]"),
            ("/abs/c.png", "x.usda", "/abs/c.png"),
            ("https://x/y.usd", "x.usda", "https://x/y.usd"),
            ("chair.usdz[a.usda]", "sub/x.usda", "sub/chair.usdz[a.usda]"),
        ] {
            assert_eq!(resolve(asset, layer), expected);
        }
    }
}

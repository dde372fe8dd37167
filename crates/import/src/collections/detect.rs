//! Detection of the layout of a file or folder, by its name or by the keys of its JSON.

use super::{habitat, hm3d, json, replica};
use crate::wildcards::matches;
use crate::{Format, ImportError};
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Scenes, or keys, that a message names.
const NAMED: usize = 3;
const KEYS: usize = 12;

/// The layouts of scenes that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
    /// A scene instance of Habitat.
    Habitat,
    /// A house of 3D-FRONT.
    Front3d,
    /// A house of ProcTHOR.
    ProcThor,
    /// The names of a scan of Replica.
    Replica,
    /// The house of a scan of Matterport3D.
    Matterport,
    /// The text of an annotated scan of HM3D.
    Hm3d,
    /// The structure of a house of Structured3D.
    Structured3d,
}

/// Files of Habitat's datasets that are no scenes, by the ends of their names, and what they are.
const NO_SCENES: [(&str, &str); 5] = [
    (habitat::DATASET, "the configuration of a Habitat dataset"),
    (".stage_config.json", "the stage of Habitat scenes"),
    (".object_config.json", "an object of Habitat scenes"),
    (".ao_config.json", "an articulated object of Habitat scenes"),
    (".lighting_config.json", "the lights of Habitat scenes"),
];

/// Layouts that are recognised by keys of their JSON, all of which they have, and what they are.
const BY_KEYS: [(Layout, &[&str], &str); 5] = [
    (Layout::Habitat, &["stage_instance"], "a Habitat scene instance"),
    (Layout::Front3d, &["scene", "mesh"], "a house of 3D-FRONT"),
    (Layout::ProcThor, &["rooms", "walls"], "a house of ProcTHOR"),
    (Layout::Structured3d, &["junctions", "planes", "semantics"], "a house of Structured3D"),
    (Layout::Replica, &["classes", "objects"], "the names of a scan of Replica"),
];

/// The layout of a file with these bytes.
///
/// # Errors
/// When it is none that is known: what it is instead, and what to give.
pub(super) fn layout(file: &Path, bytes: &[u8]) -> Result<Layout, ImportError> {
    let name = file.file_name().map_or(String::new(), |name| name.to_string_lossy().to_lowercase());
    if name.ends_with(".house") {
        return Ok(Layout::Matterport);
    }
    if name.ends_with(hm3d::TEXT) {
        return Ok(Layout::Hm3d);
    }
    if let Some((_, what)) = NO_SCENES.iter().find(|(end, _)| name.ends_with(end)) {
        let scenes = habitat_scenes(file.parent().unwrap_or(Path::new("")));
        let such = if scenes.is_empty() { String::new() } else { format!(": {}", some(&scenes)) };
        let problem = format!("this is {what}, not a scene; give one of its scene instances (*{}){such}", habitat::SCENE);
        return Err(ImportError::malformed(file, "whole file", problem));
    }
    let keys: BTreeMap<String, IgnoredAny> = json::parse(bytes, file, "a scene of a collection, which is a table")?;
    let has = |wanted: &[&str]| wanted.iter().all(|key| keys.contains_key(*key));
    BY_KEYS.iter().find(|(_, wanted, _)| has(wanted)).map(|(layout, ..)| *layout).ok_or_else(|| {
        let found: Vec<&str> = keys.keys().map(String::as_str).take(KEYS).collect();
        let known: Vec<String> = BY_KEYS.iter().map(|(_, wanted, what)| format!("{what} ({})", wanted.join(", "))).collect();
        let problem = format!("it has the keys {}, which no known layout of scenes has; expected {}", found.join(", "), known.join(", "));
        ImportError::malformed(file, "whole file", problem)
    })
}

/// The file to import of a folder with a scene of a collection; `None` if the folder has none.
///
/// # Errors
/// When it contains several scenes, with their names.
pub(crate) fn scene_in_folder(folder: &Path) -> Result<Option<PathBuf>, ImportError> {
    let names = "info_semantic.json";
    let replicas = [folder.join("habitat"), folder.to_path_buf()].into_iter().filter(|place| place.join(replica::MESH).is_file());
    let single = replicas.map(|place| place.join(names)).chain([folder.join("annotation_3d.json")]);
    if let Some(file) = single.into_iter().find(|file| file.is_file()) {
        return Ok(Some(file));
    }
    for pattern in [format!("*{}", hm3d::TEXT), "*.house".to_string(), "house_segmentations/*.house".to_string()] {
        if let Some(file) = one(folder, paths(folder, &pattern))? {
            return Ok(Some(file));
        }
    }
    one(folder, habitat_scenes(folder))
}

/// The only scene of a list; `None` of none.
fn one(folder: &Path, scenes: Vec<String>) -> Result<Option<PathBuf>, ImportError> {
    match &scenes[..] {
        [] => Ok(None),
        [only] => Ok(Some(folder.join(only))),
        several => {
            let problem = format!(
                "it holds {} scenes ({}): give one of them, or write all of them into dataset.toml: [[scene]] files = \"…/*\"",
                several.len(),
                some(several)
            );
            Err(ImportError::malformed(folder, "folder", problem))
        }
    }
}

/// The error for a folder without a scene.
pub(crate) fn no_scene_in_folder(folder: &Path) -> ImportError {
    let problem = format!(
        "found no scene in the folder; expected one scene file ({}), or a collection's: *{}, annotation_3d.json, *{}, *.house, or \
         habitat/info_semantic.json with {}",
        Format::extensions(),
        habitat::SCENE,
        hm3d::TEXT,
        replica::MESH
    );
    ImportError::malformed(folder, "folder", problem)
}

/// The first of a list of scenes.
fn some(scenes: &[String]) -> String {
    let more = if scenes.len() > NAMED { ", …" } else { "" };
    format!("{}{more}", scenes.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", "))
}

fn paths(folder: &Path, pattern: &str) -> Vec<String> {
    matches(folder, pattern).unwrap_or_default().into_iter().map(|m| m.path).collect()
}

/// The scene instances in a folder of Habitat's, or in folders in it.
fn habitat_scenes(folder: &Path) -> Vec<String> {
    let own = paths(folder, &format!("*{}", habitat::SCENE));
    if own.is_empty() { paths(folder, &format!("*/*{}", habitat::SCENE)) } else { own }
}

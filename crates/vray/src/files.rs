//! Scene files on this machine, and the files that they lead to.

use crate::edit::{Platform, file_references};
use crate::error::VrayError;
use enfilade_scene::{GIT_LFS_POINTER, is_git_lfs_pointer};
use enfilade_vrscene::{Document, Include, IncludeError, SceneTextError, inline_includes};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Reads a scene.
///
/// # Errors
/// When the file cannot be read, or is not a scene: the error has line and column.
pub fn read_scene(path: &Path) -> Result<Document, VrayError> {
    let unreadable = |e: std::io::Error| VrayError::usage(format!("cannot read {}: {e}", path.display()), "check the path");
    let bytes = std::fs::read(path).map_err(unreadable)?;
    if is_git_lfs_pointer(&bytes) {
        return Err(VrayError::usage(format!("{} is {GIT_LFS_POINTER}", path.display()), "fetch the file, and do this again"));
    }
    Document::parse(bytes).map_err(|error| damaged(path, &error))
}

/// The error of a scene file.
pub(crate) fn damaged(path: &Path, error: &SceneTextError) -> VrayError {
    VrayError::usage(format!("{}:{error}", path.display()), "export the scene again, or correct it at this place")
}

/// The scene in `path` with the contents of its included files in place of the `#include` lines.
///
/// An included file is looked for at the path as written, then beside the including file.
///
/// # Errors
/// As [`read_scene`], and when an included file is not found or includes itself.
pub fn inline_scene(scene: Document, path: &Path) -> Result<Document, VrayError> {
    let mut load = |from: &PathBuf, include: &Include| {
        let found = included_file(from, include)?;
        Ok::<_, VrayError>((read_scene(&found)?, found))
    };
    inline_includes(scene, known(path), &mut load).map_err(|error| match error {
        IncludeError::Load(error) => error,
        error => VrayError::usage(format!("{}: {error}", path.display()), "remove that line"),
    })
}

/// A file that must exist on the machine that renders.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Asset {
    /// The path as it is written in the scene.
    pub path: String,
    /// The plugin that names it; `#include` for an included scene.
    pub named_by: String,
}

/// Every file that the scene in `path` and its included files refer to, sorted, each once; and the paths of included files that are not
/// on this machine, which may refer to more. What V-Ray writes itself (`auto_save_file`) is not among them.
///
/// # Errors
/// When an included file that is here is damaged.
pub fn scene_assets(scene: &Document, path: &Path) -> Result<(Vec<Asset>, Vec<String>), VrayError> {
    let (mut assets, mut unseen) = (BTreeSet::new(), BTreeSet::new());
    let (mut visited, mut open) = (BTreeSet::from([known(path)]), vec![(scene.clone(), known(path))]);
    while let Some((scene, at)) = open.pop() {
        let needed = file_references(&scene).into_iter().filter(|reference| reference.parameter != "auto_save_file");
        assets.extend(needed.map(|reference| Asset { path: reference.path, named_by: reference.plugin }));
        for include in scene.includes() {
            match included_file(&at, include) {
                Ok(found) if visited.insert(found.clone()) => open.push((read_scene(&found)?, found)),
                Ok(_) => {}
                Err(_) => drop(unseen.insert(String::from_utf8_lossy(include.path()).into_owned())),
            }
        }
    }
    Ok((assets.into_iter().collect(), unseen.into_iter().collect()))
}

/// Path of an included file on this machine.
fn included_file(from: &Path, include: &Include) -> Result<PathBuf, VrayError> {
    let written = String::from_utf8_lossy(include.path()).into_owned();
    let folder = from.parent().unwrap_or(Path::new(""));
    let plain = if Platform::of(&written) == Platform::Windows { written.replace('\\', "/") } else { written.clone() };
    let name = plain.rsplit('/').next().unwrap_or_default();
    // Joining an absolute path gives that path.
    let candidates = [folder.join(&plain), folder.join(name)];
    let found = candidates.iter().find(|candidate| candidate.is_file());
    found.map(|found| known(found)).ok_or_else(|| {
        let looked = candidates.map(|candidate| candidate.display().to_string()).join(" and ");
        VrayError::usage(
            format!("{}:{}: the included file {written:?} is not there; looked for {looked}", from.display(), include.place()),
            "put it beside the scene, or say where it is: enfilade vray replace-paths",
        )
    })
}

/// The canonical path of a file, to notice files that include each other; the path as written if the system cannot resolve it.
fn known(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn included_files_are_found_beside_the_scene_and_lead_to_theirs() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        std::fs::write(file("main.vrscene"), "#include \"C:\\jobs\\mats.vrscene\"\n#include \"gone.vrscene\"\n").unwrap();
        std::fs::write(file("mats.vrscene"), "BitmapBuffer b { file=\"wood.png\"; }\nSettingsLightCache l { auto_save_file=\"x\"; }\n")
            .unwrap();
        let scene = read_scene(&file("main.vrscene")).unwrap();
        let (assets, unseen) = scene_assets(&scene, &file("main.vrscene")).unwrap();
        let paths: Vec<&str> = assets.iter().map(|asset| asset.path.as_str()).collect();
        assert_eq!(paths, ["C:\\jobs\\mats.vrscene", "gone.vrscene", "wood.png"]);
        assert_eq!(unseen, ["gone.vrscene"]);
        let message = inline_scene(scene, &file("main.vrscene")).unwrap_err().to_string();
        assert!(message.contains("main.vrscene:2:1: the included file \"gone.vrscene\" is not there"), "{message}");
        std::fs::write(file("gone.vrscene"), "#include \"main.vrscene\"\n").unwrap();
        let scene = read_scene(&file("main.vrscene")).unwrap();
        let message = inline_scene(scene, &file("main.vrscene")).unwrap_err().to_string();
        assert!(message.contains("includes itself"), "{message}");
        std::fs::write(file("gone.vrscene"), "Node n { }\n").unwrap();
        let whole = inline_scene(read_scene(&file("main.vrscene")).unwrap(), &file("main.vrscene")).unwrap();
        assert_eq!((whole.plugins().count(), whole.includes().count()), (3, 0));
    }
}

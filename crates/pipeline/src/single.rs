//! `import` of a single file, and a single home, without a dataset.

use crate::assets;
use crate::config::FileSource;
use crate::error::Error;
use crate::intake::{self, Held, labels_by_part, load_file, settle};
use crate::stages::describe;
use enfilade_dataset::{WORKDIR, write_bytes, write_json};
use enfilade_home::HomeConfig;
use enfilade_import::{scene_in_folder, scene_name};
use enfilade_scene::{Cx, EncodedScene, Labels, PictureFiles, Scene, SceneFiles, Warning};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Result of importing a file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// One line about the scene.
    pub summary: String,
    /// The report beside the output.
    pub report: PathBuf,
    /// Everything that was dropped, guessed or fixed.
    pub warnings: Vec<Warning>,
    /// What the output cannot represent.
    pub lost: Vec<String>,
}

#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    import: &'a enfilade_import::ImportReport,
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    lost: &'a [String],
}

/// Default output of importing a scene file: a package of its name, in the current folder.
pub fn scene_file_of(input: &Path) -> PathBuf {
    let name = input.file_name().map_or_else(|| "scene".into(), |_| scene_name(input));
    format!("{name}.scene").into()
}

/// True for a folder that is not a dataset and has the scene of a collection.
///
/// # Errors
/// If it has several scenes.
pub fn holds_scene(folder: &Path) -> Result<bool, Error> {
    Ok(!folder.join(WORKDIR).exists() && scene_in_folder(folder).map_err(Error::stage)?.is_some())
}

/// Imports the file of `source` (its path is used unchanged) to `output` and a report `<output>.report.json`. `encode` returns the
/// output and files beside it from the scene and its labels, and what they cannot represent.
///
/// # Errors
/// When the file cannot be imported, or the output is a file that was read for it or cannot be written.
pub fn import_file(
    source: &FileSource,
    output: &Path,
    encode: impl FnOnce(&Scene, Option<&Labels>, &PictureFiles) -> EncodedScene,
    cx: &dyn Cx,
) -> Result<Imported, Error> {
    let held = Held::over(cx);
    let mut imported = load_file(source, Path::new(&source.file), &|path| Ok(path.into()), &held)?;
    refuse_overwriting(output, &imported.inputs)?;
    settle(source, &mut imported, cx);
    drop(held);
    let summary = describe(&imported.scene);
    let labels = imported.labels.map(|labels| labels_by_part(&imported.scene, &labels));
    let files = encode(&imported.scene, labels.as_ref(), &imported.picture_files).map_err(Error::Stage)?;
    let lost = write_files(output, files)?;
    let report = output.with_extension("report.json");
    write_json(&report, &Report { scene: &summary, import: &imported.report, lost: &lost })?;
    Ok(Imported { summary, report, warnings: imported.report.warnings, lost })
}

/// Result of checking a file.
#[derive(Clone, Debug)]
pub struct Checked {
    /// One line about the scene.
    pub summary: String,
    /// Everything that would be dropped, guessed or fixed, and what is odd about the geometry.
    pub warnings: Vec<Warning>,
}

/// Reads a scene as [`import_file`] does, but writes nothing.
///
/// # Errors
/// When the file cannot be imported.
pub fn check_file(source: &FileSource, cx: &dyn Cx) -> Result<Checked, Error> {
    let imported = intake::read(source, Path::new(&source.file), &|path| Ok(path.into()), cx)?;
    Ok(Checked { summary: describe(&imported.scene), warnings: imported.report.warnings })
}

/// Refuses an output that is one of the files that it is made from.
///
/// # Errors
/// When it is, however the two are spelled.
pub fn refuse_overwriting(output: &Path, inputs: &[PathBuf]) -> Result<(), Error> {
    // An output that does not exist is not one of the inputs.
    let Ok(place) = output.canonicalize() else { return Ok(()) };
    match inputs.iter().find(|input| input.canonicalize().is_ok_and(|input| input == place)) {
        Some(input) => Err(Error::usage(
            format!("the output {} is the file {} that it would be made from", output.display(), input.display()),
            "nothing was written; choose another file with -o",
        )),
        None => Ok(()),
    }
}

/// Writes the output of a verb. Its folder has to be there: one that was mistyped is not made.
pub(crate) fn write_output(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let folder = path.parent().unwrap_or(Path::new(""));
    folder.join(".").metadata().map_err(Error::io("write", path))?;
    Ok(write_bytes(path, bytes)?)
}

/// Writes a scene's file and those beside it, which come first; returns what they cannot represent.
pub(crate) fn write_files(output: &Path, files: SceneFiles) -> Result<Vec<String>, Error> {
    let folder = output.parent().unwrap_or(Path::new(""));
    for (name, bytes) in &files.beside {
        let path = folder.join(name);
        let within = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(within).map_err(Error::io("create the folder", within))?;
        write_bytes(&path, bytes)?;
    }
    write_output(output, &files.main)?;
    Ok(files.notes)
}

/// Result of making a home.
#[derive(Clone, Debug)]
pub struct MadeHome {
    /// One line about the scene.
    pub summary: String,
    /// One line about the rooms.
    pub rooms: String,
    /// What the output cannot represent.
    pub lost: Vec<String>,
    /// The models of others that are in it, with their licences.
    pub credits: Vec<String>,
}

/// Makes a home and writes it to `output`; `encode` returns its files (see [`import_file`]). All its parts are labelled.
///
/// # Errors
/// When a library of models cannot be used (see [`HomeConfig::assets`]; the paths are used unchanged), or the file cannot be written.
pub fn make_home(
    config: &HomeConfig,
    output: &Path,
    encode: impl FnOnce(&Scene, Option<&Labels>, &PictureFiles) -> EncodedScene,
    cx: &dyn Cx,
) -> Result<MadeHome, Error> {
    let home = assets::home(config, &|path| Ok(path.into()), cx)?;
    let lost = write_files(output, encode(&home.scene, Some(&home.labels), &PictureFiles::new()).map_err(Error::Stage)?)?;
    let rooms = home.plan.rooms.iter().map(|room| format!("{} {:.1} m2", room.kind.name(), room.area));
    Ok(MadeHome { summary: describe(&home.scene), rooms: rooms.collect::<Vec<_>>().join(", "), lost, credits: home.credits })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_that_is_an_input_is_refused_however_it_is_spelled() {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("room.glb");
        let inputs = [folder.path().join("gone.png"), input.clone()];
        // Before anything is there, nothing can be lost.
        refuse_overwriting(&input, &inputs).unwrap();
        std::fs::write(&input, "glTF").unwrap();
        std::fs::create_dir(folder.path().join("out")).unwrap();
        let error = refuse_overwriting(&folder.path().join("out/../room.glb"), &inputs).unwrap_err();
        assert!(error.is_usage() && error.to_string().contains("room.glb that it would be made from"), "{error}");
        refuse_overwriting(&folder.path().join("other.glb"), &inputs).unwrap();
    }
}

//! Libraries of models that replace our own furniture: folders of glTF, and the furniture catalogues of Sweet Home 3D.
//!
//! The `home` crate defines models and decides when one is used; here the files are found, and read when a home uses them. glTF files are
//! also read once before and dropped again, because their sizes are known only from the files. The files' contents are inputs of the stage,
//! and their names are part of its settings, because names decide the class of a model.

mod gltf;
mod notes;
mod sweethome;
mod table;
#[cfg(test)]
mod tests;

use crate::error::Error;
use enfilade_furniture::assets::Library;
use enfilade_furniture::models::Model;
use enfilade_home::{Home, HomeConfig};
use enfilade_scene::{Cx, Warning};
use notes::Notes;
use std::path::{Path, PathBuf};
use table::Table;

/// Most places that an error or warning lists.
const LISTED: usize = 8;

/// Makes a home with the models that its configuration names; `locate` finds the named files.
///
/// # Errors
/// If a library does not exist, has no usable model, or a model that the home uses is broken.
pub(crate) fn home(config: &HomeConfig, locate: &dyn Fn(&str) -> Result<PathBuf, Error>, cx: &dyn Cx) -> Result<Home, Error> {
    let notes = Notes::default();
    let library = library(config, locate, &notes, cx)?;
    let home = match &config.plan {
        None => enfilade_home::home_with(config, &library),
        Some(written) => on_plan(config, &library, &locate(written)?)?,
    };
    home.notes.iter().for_each(|note| cx.warn(Warning { place: "plan".into(), message: note.clone() }));
    home.state_notes.iter().for_each(|note| cx.warn(Warning { place: "states".into(), message: note.clone() }));
    let dropped = notes.take();
    if !dropped.is_empty() {
        cx.warn(Warning { place: "assets".into(), message: format!("models are not as their files say: {}", listed(&dropped)) });
    }
    let broken = library.broken();
    if config.allow_broken_assets {
        broken
            .into_iter()
            .for_each(|message| cx.warn(Warning { place: "assets".into(), message: format!("{message}; our own piece is used instead") }));
    } else if let Some(first) = broken.first() {
        return Err(refuse_broken(first));
    }
    Ok(home)
}

/// A home on the plan in a file.
fn on_plan(config: &HomeConfig, library: &Library, file: &Path) -> Result<Home, Error> {
    let bytes = std::fs::read(file).map_err(|error| {
        let hint = "name a file with a floor plan in `plan`; docs/homes.md lists the kinds that are read";
        Error::usage(format!("cannot read the plan {} ({error})", file.display()), hint)
    })?;
    let drawn = enfilade_import::read_plan(&bytes, file).map_err(Error::stage)?;
    enfilade_home::home_on(config, library, &drawn).map_err(|problem| {
        Error::usage(format!("{}: {problem}", file.display()), "correct the plan; docs/homes.md explains what plans have to be")
    })
}

/// Reads every model of the library at `root`, as homes read the models that they use: returns names of the broken ones, with reasons. It
/// is not for users, who make homes, but for fuzzing.
///
/// # Errors
/// If the library does not exist or its catalogues and tables cannot be read.
#[doc(hidden)]
pub fn read_library(root: &Path, cx: &dyn Cx) -> Result<Vec<String>, Error> {
    let models = of_root(root, true, &Notes::default(), cx)?;
    Ok(models.iter().filter_map(|model| model.body().err().map(str::to_string)).collect())
}

/// Every file that a home is made from: those of the libraries, in the order of their names, and the plan.
pub(crate) fn files(config: &HomeConfig, locate: &dyn Fn(&str) -> Result<PathBuf, Error>) -> Result<Vec<PathBuf>, Error> {
    let mut files: Vec<PathBuf> = named_files(config, locate)?.into_iter().map(|(_, file)| file).collect();
    if let Some(plan) = &config.plan {
        files.push(locate(plan)?);
    }
    Ok(files)
}

/// The names of the files of the libraries, each within its library; empty if a library does not exist, which is reported when it is read.
pub(crate) fn names(config: &HomeConfig, locate: &dyn Fn(&str) -> Result<PathBuf, Error>) -> Vec<String> {
    named_files(config, locate).unwrap_or_default().into_iter().map(|(name, _)| name).collect()
}

fn named_files(config: &HomeConfig, locate: &dyn Fn(&str) -> Result<PathBuf, Error>) -> Result<Vec<(String, PathBuf)>, Error> {
    let mut all = Vec::new();
    for written in &config.assets {
        let root = locate(written)?;
        let beside = Some(folder_of(&root).join(table::NAME)).filter(|table| root.is_file() && table.is_file());
        all.extend(walk(&root)?.into_iter().chain(beside).map(|file| (name_in(&root, &file), file)));
    }
    Ok(all)
}

/// Name of a file within its library: its path from there, with `/`.
fn name_in(root: &Path, file: &Path) -> String {
    let inside = file.strip_prefix(root).ok().filter(|path| path.components().next().is_some());
    let inside = inside.unwrap_or_else(|| file.file_name().map_or(file, Path::new));
    inside.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// All files below `root`, or `root` itself if it is one, by name; hidden ones are left out.
fn walk(root: &Path) -> Result<Vec<PathBuf>, Error> {
    let kind = std::fs::metadata(root).map_err(|error| {
        Error::usage(
            format!("there is no library of models at {} ({error})", root.display()),
            "name a folder of glTF files, or a .sh3f file, in `assets`",
        )
    })?;
    if kind.is_file() {
        return Ok(vec![root.into()]);
    }
    let mut entries: Vec<PathBuf> = std::fs::read_dir(root)
        .map_err(Error::io("list", root))?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()
        .map_err(Error::io("list", root))?;
    entries.retain(|path| path.file_name().is_some_and(|name| !name.to_string_lossy().starts_with('.')));
    entries.sort();
    let mut files = Vec::new();
    for path in entries {
        if path.is_dir() {
            files.extend(walk(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

fn library(config: &HomeConfig, locate: &dyn Fn(&str) -> Result<PathBuf, Error>, notes: &Notes, cx: &dyn Cx) -> Result<Library, Error> {
    if config.assets.is_empty() {
        return Ok(Library::default());
    }
    let mut models = Vec::new();
    for written in &config.assets {
        let root = locate(written)?;
        let found = of_root(&root, config.allow_broken_assets, notes, cx)?;
        if found.is_empty() {
            return Err(Error::usage(
                format!("there are no models in {}", root.display()),
                "a library holds .gltf or .glb files, or catalogues of Sweet Home 3D (.sh3f)",
            ));
        }
        models.extend(found);
    }
    let total = models.len();
    let library = Library::new(models, config.assets_share);
    let unfit = library.unfit();
    if library.usable() == 0 {
        let hint = "say in assets.toml beside them what they are (family or class), how large (size), and for lamps take some with light";
        return Err(Error::usage(format!("none of the {total} models can be used: {}", listed(unfit)), hint));
    }
    if !unfit.is_empty() {
        let message = format!("{} of {total} models are not used: {}", unfit.len(), listed(unfit));
        cx.warn(Warning { place: "assets".into(), message });
    }
    Ok(library)
}

fn listed(lines: &[String]) -> String {
    let more = lines.len().saturating_sub(LISTED);
    let text = lines.iter().take(LISTED).map(String::as_str).collect::<Vec<_>>().join("; ");
    if more > 0 { format!("{text}; and {more} more") } else { text }
}

/// Folder of a library's table: the library itself, or the folder beside it if the library is one file.
fn folder_of(root: &Path) -> &Path {
    if root.is_file() { root.parent().unwrap_or(root) } else { root }
}

/// The models of one library.
fn of_root(root: &Path, allow_broken: bool, notes: &Notes, cx: &dyn Cx) -> Result<Vec<Model>, Error> {
    let files = walk(root)?;
    let is =
        |path: &Path, extensions: &[&str]| path.extension().is_some_and(|found| extensions.iter().any(|e| found.eq_ignore_ascii_case(e)));
    let mut scenes: Vec<(String, PathBuf)> =
        files.iter().filter(|path| is(path, &["gltf", "glb"])).map(|path| (name_in(root, path), path.clone())).collect();
    let catalogues: Vec<&PathBuf> = files.iter().filter(|path| is(path, &["sh3f"])).collect();
    let mut pieces = sweethome::pieces(&catalogues)?;
    let known: Vec<&str> = scenes.iter().map(|(name, _)| name.as_str()).chain(pieces.iter().map(|piece| piece.name.as_str())).collect();
    let table = Table::read(&folder_of(root).join(table::NAME), &known, root.is_dir())?;
    scenes.retain(|(name, _)| table.of(name).wanted);
    pieces.retain(|piece| table.of(&piece.name).wanted);
    let mut models = Vec::new();
    for (result, (name, _)) in gltf::models(&scenes, &table).into_iter().zip(&scenes) {
        match result {
            Ok(model) => models.push(model),
            Err(message) if allow_broken => cx.warn(Warning { place: name.clone(), message: format!("{message}; left out") }),
            Err(message) => return Err(refuse_broken(&message)),
        }
    }
    models.extend(pieces.into_iter().map(|piece| piece.model(&table, notes.clone())));
    Ok(models)
}

fn refuse_broken(message: &str) -> Error {
    let hint = "repair or remove the file, write `use = false` for it in assets.toml, or set allow_broken_assets to continue without it";
    Error::usage(message.to_string(), hint)
}

//! The scene in what people download: a ZIP archive, or a folder that one was unpacked to, with a scene file among its textures.
//!
//! Sketchfab has `scene.gltf` with `textures/`, or `source/<name>.fbx` with `textures/`, sometimes `source/<name>.zip`; others have one folder
//! around it all, or the same model in several formats. Nothing is unpacked to the disk.

use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::others::{Others, named};
use crate::{Format, ImportError, Imported, disguise, sweethome};
use std::path::{Path, PathBuf};

/// Greatest depth of folders that are searched, and greatest number of files that are listed: a scene is near the top.
const DEPTH: usize = 4;
const MAX_FILES: usize = 20_000;
/// Names of the file that includes the others.
const MAIN: [&str; 5] = ["scene", "main", "root", "model", "index"];
/// Formats of whole scenes, the fuller ones first; of the same scene in several, the first is read.
const SCENES: [Format; 10] = [
    Format::Gltf,
    Format::Usd,
    Format::VRay,
    Format::Pbrt,
    Format::Mitsuba,
    Format::Mjcf,
    Format::Sdf,
    Format::Urdf,
    Format::Fbx,
    Format::Collada,
];
/// Formats of meshes: where there is a scene, these are parts of it.
const MESHES: [Format; 3] = [Format::Obj, Format::Ply, Format::Stl];

/// Imports the scene of a ZIP archive; `by_format` imports what is chosen of it.
pub(crate) fn load_zip(
    mut assembly: Assembly,
    by_format: impl FnOnce(Format, Assembly) -> Result<Imported, ImportError>,
) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let mut archive =
        Archive::new(&file, bytes).map_err(|e| assembly.malformed("whole file", format!("{e}; copy or download it again")))?;
    if sweethome::is_of_sweethome(&archive) {
        return sweethome::load_archive(&archive, assembly);
    }
    let own = file.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
    let mut chosen = choose(archive.names(), &own, &|name| archive.read(name).ok());
    if matches!(chosen, Err(Unclear::None)) {
        archive.open_inner();
        chosen = choose(archive.names(), &own, &|name| archive.read(name).ok());
    }
    let chosen =
        chosen.map_err(|unclear| assembly.malformed("archive", unclear.message("unpack it and give the scene file", archive.names())))?;
    let entry = file.join(&chosen.name);
    let format = disguise::checked_head(&entry, &archive.head(&chosen.name, disguise::HEAD), chosen.format)?;
    let mut inside = assembly.inside(format, format.up_axis(), &archive, &chosen.name);
    inside.chosen_among(chosen.others_in("archive", &file));
    by_format(format, inside)
}

/// The file to import of a folder that has one scene file, with the others where there was a choice; `None` where it has none.
///
/// # Errors
/// When it has several, and none is the one that is meant.
pub(crate) fn scene_in_folder(folder: &Path) -> Result<Option<(PathBuf, Others)>, ImportError> {
    let mut names = Vec::new();
    list(folder, "", DEPTH, &mut names);
    let own = folder.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    match choose(&names, &own, &|name| std::fs::read(folder.join(name)).ok()) {
        Ok(chosen) => Ok(Some((folder.join(&chosen.name), chosen.others_in("folder", folder)))),
        Err(Unclear::None) if foreign(&names).or(packed(&names)).is_none() => Ok(None),
        Err(unclear) => Err(ImportError::malformed(folder, "folder", unclear.message("give one of them", &names))),
    }
}

/// The scene file among others.
#[derive(Debug)]
struct Chosen {
    name: String,
    format: Format,
    /// Names of other files that are scenes or meshes too.
    others: Vec<String>,
}

/// Why none was chosen.
#[derive(Debug)]
enum Unclear {
    /// No scene.
    None,
    /// There are several, such as these.
    Several(Vec<String>),
}

impl Chosen {
    /// Other scene files in an archive or a folder. Meshes beside a scene that is put together of mesh files are its parts, read or not,
    /// unless they are called like the scene.
    fn others_in(&self, place: &'static str, home: &Path) -> Others {
        let has_parts = matches!(self.format, Format::Mitsuba | Format::Pbrt | Format::Urdf | Format::Sdf | Format::Mjcf);
        let is_mesh = |name: &str| Format::of(Path::new(name)).is_ok_and(|format| MESHES.contains(&format));
        let others = self.others.iter().filter(|name| !(has_parts && is_mesh(name) && stem(name) != stem(&self.name)));
        let files = others.map(|name| (name.clone(), home.join(name))).collect();
        Others { place, chosen: self.name.clone(), files }
    }
}

impl Unclear {
    /// The message about files of these `names`.
    fn message(&self, remedy: &str, names: &[String]) -> String {
        match self {
            Self::None => match foreign(names) {
                Some((name, remedy)) => format!("found {name}, which is not read: {remedy}, and give what you exported"),
                None => match packed(names) {
                    Some((name, remedy)) => format!("found no scene file but {name}: {remedy}"),
                    None => format!("found no scene file; expected one of {}", Format::extensions()),
                },
            },
            Self::Several(names) => format!("found {} scene files ({}); {remedy}", names.len(), named(names)),
        }
    }
}

/// Chooses the scene among files: of scenes before meshes, the nearest to the top, one that is called like the download or `scene`, and of
/// the same scene in several formats the most complete. `read` returns the bytes of a file, for names that do not identify the format.
fn choose(names: &[String], own: &str, read: &dyn Fn(&str) -> Option<Vec<u8>>) -> Result<Chosen, Unclear> {
    let mut candidates: Vec<(usize, &String)> = names.iter().filter_map(|name| Some((rank(name, read)?, name))).collect();
    let all: Vec<String> = candidates.iter().map(|(_, name)| (*name).clone()).collect();
    let are_meshes = candidates.iter().all(|(rank, _)| *rank >= SCENES.len());
    candidates.retain(|(rank, _)| are_meshes || *rank < SCENES.len());
    let depth = |name: &str| name.matches('/').count();
    let Some(top) = candidates.iter().map(|(_, name)| depth(name)).min() else { return Err(Unclear::None) };
    candidates.retain(|(_, name)| depth(name) == top);
    let stems = |candidates: &[(usize, &String)]| candidates.iter().map(|(_, name)| stem(name)).collect::<std::collections::BTreeSet<_>>();
    if stems(&candidates).len() > 1 {
        let meant = [own.to_lowercase()].into_iter().chain(MAIN.map(str::to_string));
        let found = meant.map(|wanted| candidates.iter().filter(|(_, name)| stem(name) == wanted).copied().collect::<Vec<_>>());
        match found.into_iter().find(|found| !found.is_empty()) {
            Some(found) => candidates = found,
            None => return Err(Unclear::Several(candidates.into_iter().map(|(_, name)| name.clone()).collect())),
        }
    }
    candidates.sort();
    let Some(&(_, name)) = candidates.first() else { return Err(Unclear::None) };
    let format = Format::of(Path::new(name)).map_err(|_| Unclear::None)?;
    Ok(Chosen { name: name.clone(), format, others: all.into_iter().filter(|other| other != name).collect() })
}

/// Rank of a scene file's format, the most complete first; `None` for files that are no scenes.
fn rank(name: &str, read: &dyn Fn(&str) -> Option<Vec<u8>>) -> Option<usize> {
    if is_hidden(name) {
        return None;
    }
    let format = Format::of(Path::new(name)).ok()?;
    let format = if format == Format::Mitsuba { of_xml(&read(name)?)? } else { format };
    SCENES.iter().chain(&MESHES).position(|known| *known == format)
}

/// A scene of another program among files, the nearest to the top, and advice on it.
fn foreign(names: &[String]) -> Option<(&String, &'static str)> {
    let known = names.iter().filter(|name| !is_hidden(name)).filter_map(|name| Some((name, Format::remedy(Path::new(name))?)));
    known.min_by_key(|(name, _)| name.matches('/').count())
}

/// An archive among files, the nearest to the top, and what to do with it.
fn packed(names: &[String]) -> Option<(&String, &'static str)> {
    let archives = names.iter().filter(|name| !is_hidden(name) && Format::of(Path::new(name)).is_ok_and(|format| format == Format::Zip));
    archives.min_by_key(|name| name.matches('/').count()).map(|name| (name, "give it, or unpack it there if its pictures are beside it"))
}

/// True for hidden files, and for what macOS adds to archives.
fn is_hidden(name: &str) -> bool {
    name.starts_with("__MACOSX/") || name.rsplit('/').next().unwrap_or(name).starts_with('.')
}

/// The format of XML whose outermost element is a scene of Mitsuba or a model of MuJoCo; many programs write XML.
fn of_xml(bytes: &[u8]) -> Option<Format> {
    let text = crate::xml::xml_text(bytes);
    let mut rest = text.trim_start();
    while rest.starts_with("<?") || rest.starts_with("<!") {
        let end = if rest.starts_with("<!--") { "-->" } else { ">" };
        rest = rest.split_once(end)?.1.trim_start();
    }
    let begins =
        |tag: &str| rest.strip_prefix(tag).is_some_and(|rest| rest.starts_with(|c: char| c.is_whitespace() || matches!(c, '>' | '/')));
    [("<scene", Format::Mitsuba), ("<mujoco", Format::Mjcf)].into_iter().find(|(tag, _)| begins(tag)).map(|(_, format)| format)
}

fn stem(name: &str) -> String {
    let last = name.rsplit('/').next().unwrap_or(name);
    crate::scene_name(Path::new(last)).to_lowercase()
}

/// Adds the files below a folder, by their paths from the first one, in order.
fn list(folder: &Path, prefix: &str, depth: usize, names: &mut Vec<String>) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<(String, bool)> =
        entries.filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.path().is_dir()))).collect();
    found.sort();
    for (name, is_folder) in found {
        if names.len() >= MAX_FILES || name.starts_with('.') {
            continue;
        }
        match is_folder {
            false => names.push(format!("{prefix}{name}")),
            true if depth > 0 => list(&folder.join(&name), &format!("{prefix}{name}/"), depth - 1, names),
            true => (),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(names: &[&str], own: &str) -> Result<String, usize> {
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        let read = |name: &str| {
            Some(if name.contains("room") {
                b"<?xml version=\"1.0\"?>\n<!-- a > b -->\n<scene version=\"3.0.0\"/>".to_vec()
            } else {
                b"<a/>".to_vec()
            })
        };
        choose(&names, own, &read).map(|chosen| chosen.name).map_err(|unclear| match unclear {
            Unclear::None => 0,
            Unclear::Several(names) => names.len(),
        })
    }

    #[test]
    fn the_scene_is_found_among_its_parts() {
        let found = |names: &[&str]| chosen(names, "download");
        assert_eq!(found(&["scene.bin", "textures/a.png", "scene.gltf", "license.txt"]), Ok("scene.gltf".into()));
        assert_eq!(found(&["source/Chair v2.FBX", "textures/a.png"]), Ok("source/Chair v2.FBX".into()));
        assert_eq!(found(&["__MACOSX/._a.obj", "pack/a.obj", "pack/a.mtl", ".DS_Store"]), Ok("pack/a.obj".into()));
        // A scene and the meshes that it is made of; what includes the rest.
        assert_eq!(found(&["kitchen/models/a.obj", "kitchen/models/b.obj", "kitchen/room.xml"]), Ok("kitchen/room.xml".into()));
        assert_eq!(found(&["geometry.pbrt", "materials.pbrt", "scene.pbrt"]), Ok("scene.pbrt".into()));
        assert_eq!(found(&["download.usda", "chair.usda", "table.usda"]), Ok("download.usda".into()));
        assert_eq!(found(&["robot.urdf", "meshes/a.dae", "meshes/b.stl"]), Ok("robot.urdf".into()));
        assert_eq!(found(&["top.glb", "parts/other.glb"]), Ok("top.glb".into()));
        // The same in several formats.
        assert_eq!(found(&["sofa.obj", "sofa.fbx", "sofa.glb", "sofa.blend"]), Ok("sofa.glb".into()));
        assert_eq!(found(&["a.xml", "a.png"]), Err(0));
        assert_eq!(found(&["a.glb", "b.glb", "c.obj"]), Err(2));
        assert_eq!(found(&[]), Err(0));
    }
}

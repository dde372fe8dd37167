//! Pictures that are not at the path in the scene file: found by their names in the folders in which downloads keep them.
//!
//! Sketchfab has a scene in `source/` and its pictures in `textures/` beside it, Gazebo's models theirs in `materials/textures/` beside
//! `meshes/`, and paths are often those of the machine that the scene was made on.

use super::Assembly;
use std::path::Path;

/// Names of folders of pictures, in lower case: beside the scene file or beside its folder, and within one another.
const FOLDERS: [&str; 8] = ["textures", "texture", "tex", "maps", "images", "materials", "material", "assets"];

/// Extensions of pictures, in lower case, the likelier ones first.
const EXTENSIONS: [&str; 13] = ["png", "jpg", "jpeg", "tga", "tif", "tiff", "webp", "bmp", "dds", "gif", "hdr", "exr", "pfm"];

/// A folder as the scene file would spell it, with a slash at its end, and the names of the files within.
type Listing = (String, Vec<String>);

impl Assembly<'_> {
    /// The path, as the scene file would spell it, of a picture that does not exist at `path`: found by its name in any case; else by its
    /// name with an extension appended (`wood.tga.png`, as Sketchfab converts pictures); else by its name with another extension, if
    /// exactly one file has it.
    pub(super) fn elsewhere(&self, path: &str) -> Option<String> {
        let name = path.rsplit(['/', '\\']).next().filter(|name| !name.is_empty())?;
        let listings = self.picture_folders();
        let named = |wanted: &str| as_named(wanted, &listings);
        let behind = || EXTENSIONS.iter().find_map(|extension| named(&format!("{name}.{extension}")));
        named(name).or_else(behind).or_else(|| {
            let stem = stem_of_picture(name)?;
            let files = listings.iter().flat_map(|(folder, files)| files.iter().map(move |file| (folder, file)));
            let mut alike = files.filter(|(_, file)| stem_of_picture(file).as_ref() == Some(&stem));
            let (folder, file) = alike.next()?;
            alike.next().is_none().then(|| format!("{folder}{file}"))
        })
    }

    /// The folders in which pictures are looked for, the nearer ones first.
    fn picture_folders(&self) -> Vec<Listing> {
        let mut listings = Vec::new();
        for place in self.places() {
            // An archive contains only the download; on the disk, folders farther up may contain anything.
            let around: &[&str] = if self.archive.is_some() { &["", "../", "../../"] } else { &["", "../"] };
            for beside in around {
                let at = place.join(beside);
                if beside.is_empty() {
                    listings.push((String::new(), self.names_in(&at, false)));
                }
                for folder in self.folders_in(&at) {
                    let inner = self.folders_in(&at.join(&folder)).into_iter().map(|inner| format!("{folder}/{inner}"));
                    let all = std::iter::once(folder.clone()).chain(inner);
                    listings.extend(all.map(|folder| (format!("{beside}{folder}/"), self.names_in(&at.join(&folder), false))));
                }
            }
        }
        listings
    }

    /// Folders of pictures in a folder, in the order of [`FOLDERS`].
    fn folders_in(&self, folder: &Path) -> Vec<String> {
        let names = self.names_in(folder, true);
        FOLDERS.iter().flat_map(|wanted| names.iter().filter(move |name| name.to_lowercase() == *wanted).cloned()).collect()
    }

    /// Names of the files, or of the folders, in a folder, in order.
    fn names_in(&self, folder: &Path, folders: bool) -> Vec<String> {
        self.archive.map_or_else(|| names_in(folder, folders), |archive| archive.names_in(folder, folders))
    }
}

/// The file of this name in the first folder that has one, in whatever case; `None` where that folder has several and none is spelled so.
fn as_named(wanted: &str, listings: &[Listing]) -> Option<String> {
    let lower = wanted.to_lowercase();
    let alike = |files: &[String]| files.iter().filter(|file| file.to_lowercase() == lower).cloned().collect::<Vec<_>>();
    let (folder, alike) = listings.iter().map(|(folder, files)| (folder, alike(files))).find(|(_, alike)| !alike.is_empty())?;
    let file = if let [only] = &alike[..] { only } else { alike.iter().find(|file| *file == wanted)? };
    Some(format!("{folder}{file}"))
}

/// The part of a picture's name before its extension, in lower case; `None` for other files.
fn stem_of_picture(name: &str) -> Option<String> {
    let name = name.to_lowercase();
    let (stem, extension) = name.rsplit_once('.')?;
    (EXTENSIONS.contains(&extension) && !stem.is_empty()).then(|| stem.to_string())
}

/// Names of the files, or of the folders, in a folder of the disk, in order.
fn names_in(folder: &Path, folders: bool) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let of_kind = entries.filter(|entry| entry.path().is_dir() == folders);
    let mut names: Vec<String> = of_kind.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort_unstable();
    names
}

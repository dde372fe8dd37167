//! Sweet Home 3D.
mod home;
mod model;
mod opening;
mod paint;
mod piece;
mod room;
mod surface;
mod view;
mod wall;
mod xml;

use crate::archive::Archive;
use crate::assembly::Assembly;
use crate::{Format, ImportError, Imported, UpAxis};

const HOME: &str = "Home.xml";

/// Imports a home or a library of furniture.
pub(crate) fn load(mut assembly: Assembly) -> Result<Imported, ImportError> {
    let file = assembly.file().to_path_buf();
    let bytes = assembly.read_scene_file()?;
    let archive = Archive::new(&file, bytes).map_err(|e| assembly.malformed("whole file", format!("{e}; copy or save it again")))?;
    if let Some(entry) = archive.find(HOME) {
        let bytes = archive.read(entry).map_err(|e| assembly.malformed(HOME, format!("cannot be read ({e}); save the home again")))?;
        let text = String::from_utf8_lossy(&bytes);
        return home::load(&text, &archive, assembly.inside(Format::SweetHome, UpAxis::Y, &archive, entry));
    }
    if archive.find("Home").is_some() {
        let problem =
            "the home is stored as Java objects alone, as versions before 5.3 of Sweet Home 3D did; open it in a newer one and save it";
        return Err(assembly.malformed("Home", problem));
    }
    let problem =
        "found neither Home.xml nor a furniture catalogue; expected a home (.sh3d) or a furniture library (.sh3f) of Sweet Home 3D";
    Err(assembly.malformed("whole file", problem))
}

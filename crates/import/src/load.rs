//! From the path of a scene file to the importer of its format.

use crate::assembly::Assembly;
use crate::{Format, ImportError, ImportOptions, Imported, UpAxis};
use crate::{collections, disguise, fbx, gltf, mitsuba, obj, package, pbrt, ply, sweethome, usd, vray};
use enfilade_scene::Cx;
use std::path::Path;

/// Imports a scene file by the importer that its extension calls for; of a folder the scene of a collection in it.
///
/// # Errors
/// When the file or one that it refers to cannot be read, is not what its format calls for, or leaves nothing visible; the
/// message names file and place and says what to do.
pub fn load(path: &Path, options: &ImportOptions, cx: &dyn Cx) -> Result<Imported, ImportError> {
    options.validate()?;
    let is_folder = path.is_dir() && Format::of(path).is_err();
    let within = if is_folder { Some(collections::the_scene_in_folder(path)?) } else { None };
    let path = within.as_deref().unwrap_or(path);
    let format = Format::of(path)?;
    disguise::refuse(path, format)?;
    let assembly = Assembly::new(format, path, UpAxis::Y, options, cx);
    match format {
        Format::Gltf => gltf::load(assembly),
        Format::Obj => obj::load(assembly),
        Format::Mitsuba => mitsuba::load(assembly),
        Format::Pbrt => pbrt::load(assembly),
        Format::Ply => ply::load(assembly),
        Format::VRay => vray::load(assembly),
        Format::Usd => usd::load(assembly),
        Format::Fbx => fbx::load(assembly),
        Format::SweetHome => sweethome::load(assembly),
        Format::Collection => collections::load(assembly),
        Format::Package => package::load(assembly, options),
    }
}

//! From the path of a scene file to the importer of its format.

use crate::assembly::Assembly;
use crate::{Format, ImportError, ImportOptions, Imported, UpAxis};
use crate::{fbx, gltf, mitsuba, obj, package, pbrt, ply, sweethome, usd, vray};
use enfilade_scene::Cx;
use std::path::Path;

/// Imports a scene file by the importer that its extension calls for.
///
/// # Errors
/// When the file or one that it refers to cannot be read, is not what its format calls for, or leaves nothing visible; the
/// message names file and place and says what to do.
pub fn load(path: &Path, options: &ImportOptions, cx: &dyn Cx) -> Result<Imported, ImportError> {
    options.validate()?;
    let format = Format::of(path)?;
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
        Format::Package => package::load(assembly, options),
    }
}

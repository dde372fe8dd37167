//! From the path of a scene file to the importer of its format.

use crate::assembly::Assembly;
use crate::others::Others;
use crate::{Format, ImportError, ImportOptions, Imported};
use crate::{
    collada, collections, disguise, download, fbx, gltf, joints, mitsuba, obj, package, pbrt, ply, robot, stl, sweethome, usd, vray,
};
use enfilade_scene::Cx;
use std::path::{Path, PathBuf};

/// Imports a scene file by the importer that its extension calls for; of a folder the scene of a collection in it, or the scene file among
/// its textures, of a ZIP archive too.
///
/// # Errors
/// When the file or one that it refers to cannot be read, is not what its format calls for, or leaves nothing visible; the
/// message names file and place and says what to do.
pub fn load(path: &Path, options: &ImportOptions, cx: &dyn Cx) -> Result<Imported, ImportError> {
    options.validate()?;
    if path.is_dir() && Format::of(path).is_err() {
        let (file, others) = in_folder(path)?.ok_or_else(|| collections::no_scene_in_folder(path))?;
        let format = disguise::checked(&file, Format::of(&file)?)?;
        let mut assembly = Assembly::new(format, &file, format.up_axis(), options, cx);
        others.into_iter().for_each(|others| assembly.chosen_among(others));
        return by_format(format, assembly);
    }
    let format = disguise::checked(path, Format::of(path)?)?;
    by_format(format, Assembly::new(format, path, format.up_axis(), options, cx))
}

/// The file that [`load`] imports of a folder; `None` if it contains no scene.
///
/// # Errors
/// When it contains several scenes, with their names.
pub fn scene_in_folder(folder: &Path) -> Result<Option<PathBuf>, ImportError> {
    Ok(in_folder(folder)?.map(|(file, _)| file))
}

/// The scene of a folder, and the files that it was chosen among.
fn in_folder(folder: &Path) -> Result<Option<(PathBuf, Option<Others>)>, ImportError> {
    if let Some(file) = collections::scene_in_folder(folder)? {
        return Ok(Some((file, None)));
    }
    Ok(download::scene_in_folder(folder)?.map(|(file, others)| (file, Some(others))))
}

/// Imports by the importer of a format.
fn by_format(format: Format, assembly: Assembly) -> Result<Imported, ImportError> {
    let moves = matches!(format, Format::Mjcf | Format::Urdf | Format::Sdf | Format::Usd | Format::Zip);
    if let Some(states) = assembly.options().states.as_ref().filter(|_| !moves) {
        return Err(joints::states::refuse(states, format.words()));
    }
    match format {
        Format::Gltf => gltf::load(assembly),
        Format::Obj => obj::load(assembly),
        Format::Mitsuba => mitsuba::load(assembly),
        Format::Pbrt => pbrt::load(assembly),
        Format::Ply => ply::load(assembly),
        Format::VRay => vray::load(assembly),
        Format::Usd => usd::load(assembly),
        Format::Fbx => fbx::load(assembly),
        Format::Collada => collada::load(assembly),
        Format::Stl => stl::load(assembly),
        Format::Urdf => robot::load_urdf(assembly),
        Format::Sdf => robot::load_sdf(assembly),
        Format::Mjcf => robot::mjcf::load(assembly),
        Format::Zip => download::load_zip(assembly, by_format),
        Format::SweetHome => sweethome::load(assembly),
        Format::Collection => collections::load(assembly),
        Format::Package => package::load(assembly),
    }
}

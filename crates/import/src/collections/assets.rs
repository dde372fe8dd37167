//! The models of a collection: each file is read once, by the importer of its format, and may be placed many times.

use crate::assembly::{Assembly, Piece};
use crate::{Format, ImportError, ImportOptions, Imported, UpAxis, collada, fbx, gltf, obj, ply, stl, usd};
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::Quiet;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A model in its own unit and axes.
pub(crate) struct Model {
    pub pieces: Vec<Piece>,
}

/// The models met so far; `None` for those that cannot be used.
#[derive(Default)]
pub(crate) struct Models {
    known: HashMap<PathBuf, Option<Rc<Model>>>,
}

impl Models {
    /// The model in a file. `None`, with a warning the first time, when it is not there or cannot be used.
    ///
    /// # Errors
    /// When a picture of it is missing and has to be there, or the file is a pointer of Git LFS, as all others will be.
    pub fn get(&mut self, file: &Path, a: &mut Assembly) -> Result<Option<Rc<Model>>, ImportError> {
        if let Some(known) = self.known.get(file) {
            return Ok(known.clone());
        }
        let read = read(file, a.allows_missing_textures(), a);
        if read.is_err() && !a.is_file(file) {
            a.note_missing(file);
        }
        let model = match unless_odd(read, "models", "a model", a)? {
            Some(imported) => Some(Rc::new(adopted(imported, file, a)?)),
            None => None,
        };
        self.known.insert(file.to_path_buf(), model.clone());
        Ok(model)
    }
}

/// The value that was read; `None`, with a warning, if it is odd: one such thing does not stop the import. `what` describes it, such as "a
/// template".
///
/// # Errors
/// When a picture is missing and has to be there, or the file is a pointer of Git LFS, as all others will be.
pub(crate) fn unless_odd<T>(read: Result<T, ImportError>, place: &str, what: &str, a: &mut Assembly) -> Result<Option<T>, ImportError> {
    match read {
        Ok(read) => Ok(Some(read)),
        Err(error @ (ImportError::Texture { .. } | ImportError::GitLfs { .. })) => Err(error),
        Err(error) => {
            a.warn(place, format!("{what} cannot be used and is left out ({error})"));
            Ok(None)
        }
    }
}

/// Reads a model as a scene of its own, without turning or scaling it.
///
/// # Errors
/// When it cannot be read.
pub(crate) fn read(file: &Path, allow_missing_textures: bool, a: &Assembly) -> Result<Imported, ImportError> {
    let options = ImportOptions { up_axis: Some(UpAxis::Z), allow_missing_textures, ..ImportOptions::default() };
    let format = Format::of(file)?;
    let assembly = Assembly::new(format, file, UpAxis::Z, &options, &Quiet);
    let assembly = match a.archive() {
        Some(archive) => assembly.within(archive),
        None => assembly,
    };
    match format {
        Format::Gltf => gltf::load(assembly),
        Format::Obj => obj::load(assembly),
        Format::Ply => ply::load(assembly),
        Format::Usd => usd::load(assembly),
        Format::Fbx => fbx::load(assembly),
        Format::Collada => collada::load(assembly),
        Format::Stl => stl::load(assembly),
        _ => {
            let found = "no model of a collection is read from such a file".to_string();
            Err(ImportError::UnknownFormat {
                file: file.to_path_buf(),
                found,
                known: ".gltf, .glb, .obj, .ply, .usd, .fbx, .dae, .stl".into(),
            })
        }
    }
}

fn adopted(imported: Imported, file: &Path, a: &mut Assembly) -> Result<Model, ImportError> {
    let (lights, cameras) = (imported.scene.lights.len(), imported.scene.cameras.len());
    if lights + cameras > 0 {
        a.warn("models", format!("{} has {lights} lights and {cameras} cameras, which were left out", file.display()));
    }
    Ok(Model { pieces: a.adopt(imported, file)? })
}

impl Model {
    /// The box around the model as it is placed.
    pub fn bounds_at(&self, placement: DAffine3, a: &Assembly) -> (DVec3, DVec3) {
        let points = self.pieces.iter().flat_map(|piece| {
            let place = placement * piece.model_from_mesh;
            a.mesh_at(piece.mesh).positions.iter().map(move |p| place.transform_point3(p.as_dvec3()))
        });
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
    }
}

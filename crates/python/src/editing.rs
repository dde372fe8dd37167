//! What `Scene.add` takes besides scenes: meshes and files.

use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, watched};
use crate::material::Material;
use crate::mesh::Mesh;
use crate::progress::Bar;
use enfilade_options::{Given, Options};
use enfilade_pipeline::{FilePlace, FileSource, LoadedScene};
use enfilade_scene::NewPart;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Keywords for files.
pub struct FileOptions<'a> {
    /// Metres per unit of the file, as in `Scene.read`.
    pub meters_per_unit: f64,
    /// Axis that points up, as in `Scene.read`.
    pub up_axis: Option<&'a str>,
    /// Whether textures may be missing, as in `Scene.read`.
    pub allow_missing_textures: bool,
    /// Whether to show how far reading has come.
    pub progress: Option<bool>,
}

/// Adds a mesh or a file to a scene.
pub fn add(
    scene: &LoadedScene,
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    place: FilePlace,
    options: &FileOptions<'_>,
) -> PyResult<LoadedScene> {
    if let Some(mesh) = Mesh::of(source)? {
        let FilePlace { name, material, world_from_file: world_from_mesh, class } = place;
        let (name, material) = (name.unwrap_or_else(|| "part".into()), material.unwrap_or_else(Material::plain));
        let new = NewPart { name, mesh, material, world_from_mesh, class };
        return py.detach(|| scene.edited(|scene| scene.with_part(&new))).map_err(IntoPy::into_py);
    }
    let file: PathBuf = source
        .extract()
        .map_err(|_| PyTypeError::new_err(format!("cannot add {source:?}; expected a mesh, the path of a scene file, or a scene")))?;
    let source = options.source(&file)?;
    let bar = Bar::new(py, options.progress, "add")?;
    watched(py, &bar, |cx: &Interrupt| scene.with_file(&source, &place, cx))
}

impl FileOptions<'_> {
    fn source(&self, file: &std::path::Path) -> PyResult<FileSource> {
        let Self { meters_per_unit, up_axis, allow_missing_textures, .. } = *self;
        if !(meters_per_unit.is_finite() && meters_per_unit > 0.0) {
            return Err(PyValueError::new_err(format!("meters_per_unit is {meters_per_unit}; expected more than 0")));
        }
        let mut source = FileSource { meters_per_unit, allow_missing_textures, ..FileSource::of(file.to_string_lossy()) };
        if let Some(axis) = up_axis {
            let wrong = |expected: String| PyValueError::new_err(format!("up_axis is {axis:?}; {expected}"));
            source.set("up_axis", &Given::Text(axis.into())).map_err(wrong)?;
        }
        Ok(source)
    }
}

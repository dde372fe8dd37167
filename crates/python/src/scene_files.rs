//! The functions that make scene files: `enfilade.import_scene` and `enfilade.home`.

use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, interruptible};
use crate::{json, keywords};
use enfilade_export::scene_encoder;
use enfilade_pipeline::{FileSource, HomeConfig, scene_file_of};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Imports a scene file (.gltf, .glb, .obj, .xml, .pbrt, .pbrt.gz, .ply, .usd, .usda, .usdc, .usdz, .fbx, .dae, .stl, .urdf, .sdf, .world,
/// .mjcf, .zip, .sh3d, .sh3f, .vrscene, .json, .house, .semantic.txt, .scene) to a scene package (.scene), binary glTF (.glb) or for simulators (.xml
/// of MuJoCo, .urdf, .usda), and writes a
/// report beside it.
///
/// output: the file to write; the input's name with .scene, in the current folder, unless given.
/// {options}
///
/// Gives a dictionary: `scene` and `report` (paths), `summary`, `warnings` (dropped, guessed or fixed), `lost` (what the output cannot hold).
/// The scenes of a dataset are imported by `enfilade.stage("import", dataset)`.
#[pyfunction]
#[pyo3(signature = (file, output=None, **options))]
pub fn import_scene<'py>(
    py: Python<'py>,
    file: PathBuf,
    output: Option<PathBuf>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let output = output.unwrap_or_else(|| scene_file_of(&file));
    let source = file_source(&file, options, "import_scene", &["file", "output"])?;
    let encode = scene_encoder(&output).map_err(IntoPy::into_py)?;
    let imported = interruptible(py, |cx: &Interrupt| enfilade_pipeline::import_file(&source, &output, encode, cx))?;
    let done = json!({ "scene": output, "report": imported.report, "summary": imported.summary, "warnings": imported.warnings, "lost": imported.lost });
    json::to_python(py, &done)
}

/// Makes a furnished home of a seed, with its labels, as a scene package (.scene), binary glTF (.glb) or for simulators (.xml of MuJoCo, .urdf, .usda).
///
/// {options}
///
/// Gives a dictionary: `scene` (path), `summary`, `rooms`, `lost` (what the output cannot hold), `credits` (of the models that are in it).
#[pyfunction]
#[pyo3(signature = (output=PathBuf::from("home.scene"), **options))]
pub fn home<'py>(py: Python<'py>, output: PathBuf, options: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
    let config = home_config(options, "home", &["output"])?;
    let encode = scene_encoder(&output).map_err(IntoPy::into_py)?;
    let made = interruptible(py, |cx: &Interrupt| enfilade_pipeline::make_home(&config, &output, encode, cx))?;
    let done = json!({ "scene": output, "summary": made.summary, "rooms": made.rooms, "lost": made.lost, "credits": made.credits });
    json::to_python(py, &done)
}

/// The scene file with the options from keywords of `function`, which also takes the keywords `own`.
pub fn file_source(file: &Path, options: Option<&Bound<'_, PyDict>>, function: &str, own: &[&str]) -> PyResult<FileSource> {
    let mut source = FileSource::of(file.to_string_lossy());
    keywords::apply(&mut [&mut source], options, function, own)?;
    Ok(source)
}

/// The home from keywords of `function`, which also takes the keywords `own`.
pub fn home_config(options: Option<&Bound<'_, PyDict>>, function: &str, own: &[&str]) -> PyResult<HomeConfig> {
    let config: HomeConfig = keywords::options(options, function, own)?;
    config.problem().map_or(Ok(config), |problem| Err(PyValueError::new_err(problem)))
}

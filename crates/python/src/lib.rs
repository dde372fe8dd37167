//! The Python module `enfilade`: datasets as numpy arrays, and the verbs of the command line.
//!
//! This crate only converts: samples come from `enfilade-loader`, stages from `enfilade-pipeline`, layouts from `enfilade-export`,
//! shapes from `enfilade-shapes`, jobs of many machines from `enfilade-farm`. Arrays are handed over without a copy, and the interpreter is
//! released while anything is read, decoded or rendered. `enfilade/__init__.pyi` is the public interface with its types; the doc strings
//! are here.

mod arguments;
mod arrays;
mod camera;
mod config;
mod dataset;
mod dataset_options;
mod editing;
mod errors;
mod farm;
mod interrupt;
mod json;
mod keywords;
mod light;
mod loader;
mod make;
mod map_style;
mod material;
mod mesh;
mod metrics;
mod numbers;
mod nyu;
mod parts;
mod progress;
mod render_options;
mod rendering;
mod scene;
mod scene_files;
mod shapes;
mod verbs;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::ffi::OsString;
use std::path::PathBuf;

/// 3D interiors as photorealistic datasets with dense ground truth.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add_class::<dataset::Dataset>()?;
    module.add_class::<loader::Loader>()?;
    module.add_class::<loader::LoaderIterator>()?;
    module.add_class::<nyu::NyuV2>()?;
    module.add_class::<metrics::Confusion>()?;
    module.add_class::<config::Config>()?;
    module.add_class::<camera::Camera>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<parts::Parts>()?;
    module.add_class::<parts::Part>()?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<material::Material>()?;
    module.add_class::<light::Light>()?;
    module.add("DamagedFileError", py.get_type::<errors::DamagedFileError>())?;
    module.add("StageError", py.get_type::<errors::StageError>())?;
    module.add("LAYERS", layers(py)?)?;
    nyu::add_tables(module)?;
    module.add("STAGES", PyList::new(py, enfilade_pipeline::STAGES.iter().map(|spec| spec.name))?)?;
    module.add("FORMATS", formats(py)?)?;
    module.add("PIX3D_CATEGORIES", enfilade_shapes::CATEGORIES)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    for function in [
        wrap_pyfunction!(main, module)?,
        wrap_pyfunction!(verbs::run, module)?,
        wrap_pyfunction!(verbs::stage, module)?,
        wrap_pyfunction!(verbs::verify, module)?,
        wrap_pyfunction!(verbs::partition, module)?,
        wrap_pyfunction!(make::make, module)?,
        wrap_pyfunction!(verbs::repack, module)?,
        wrap_pyfunction!(verbs::export, module)?,
        wrap_pyfunction!(keywords::declared, module)?,
        wrap_pyfunction!(scene_files::import_scene, module)?,
        wrap_pyfunction!(scene_files::home, module)?,
        wrap_pyfunction!(shapes::compare_meshes, module)?,
        wrap_pyfunction!(shapes::judge_shapes, module)?,
        wrap_pyfunction!(shapes::shape_precision, module)?,
        wrap_pyfunction!(shapes::read_voxels, module)?,
        wrap_pyfunction!(rendering::render, module)?,
        wrap_pyfunction!(rendering::pictures, module)?,
    ] {
        module.add_function(function)?;
    }
    farm::add_module(module)
}

/// Does what the words of a command line say, as the program `enfilade`, and gives the exit code. It is for the command that is installed with the
/// package: signals end the process, and the number of threads holds for all that is done after it.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<OsString>, program: Option<PathBuf>) -> u8 {
    py.detach(|| enfilade_cli::main(words, program))
}

/// What each format of `export` is, by name.
fn formats(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let table = PyDict::new(py);
    enfilade_export::FORMATS.iter().try_for_each(|spec| table.set_item(spec.name, spec.about))?;
    Ok(table)
}

/// The table of layers, by name.
fn layers(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let table = PyDict::new(py);
    for spec in &enfilade_frame::LAYERS {
        let row = PyDict::new(py);
        row.set_item("channels", spec.channels)?;
        row.set_item("dtype", arrays::dtype_name(spec.dtype))?;
        row.set_item("unit", spec.unit)?;
        row.set_item("space", spec.space)?;
        row.set_item("sentinel", spec.sentinel)?;
        row.set_item("description", spec.description)?;
        table.set_item(spec.name, row)?;
    }
    Ok(table)
}

//! `enfilade.Config`: the configuration of a run, from TOML, the demo or a dictionary.

use crate::errors::IntoPy;
use crate::{json, keywords};
use enfilade_pipeline::{Overrides, RenderChoices};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// What a dataset is made from: the configuration of `enfilade run`, with all defaults filled in.
///
/// `Config.read(file)` reads TOML, `Config.demo()` is the demo; both take as keywords what is to be otherwise, as `enfilade run` takes it. `to_dict` and `from_dict` have every setting.
#[pyclass(module = "enfilade", frozen, from_py_object)]
#[derive(Clone)]
pub struct Config(pub enfilade_pipeline::Config);

/// Changes of the configuration by keywords of `function`, which also takes the keywords `own`.
fn overrides(options: Option<&Bound<'_, PyDict>>, function: &str, own: &[&str]) -> PyResult<Overrides> {
    let (mut overrides, mut render) = (Overrides::default(), RenderChoices::default());
    keywords::apply(&mut [&mut overrides, &mut render], options, function, own)?;
    Ok(Overrides { render, ..overrides })
}

#[pymethods]
impl Config {
    /// The configuration in a TOML file.
    ///
    /// {options}
    #[staticmethod]
    #[pyo3(signature = (file, **options))]
    fn read(file: PathBuf, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let overrides = overrides(options, "Config.read", &["file"])?;
        enfilade_pipeline::Config::read(&file, &overrides).map(Self).map_err(IntoPy::into_py)
    }

    /// The demo: one generated home.
    ///
    /// {options}
    #[staticmethod]
    #[pyo3(signature = (**options))]
    fn demo(options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let overrides = overrides(options, "Config.demo", &[])?;
        enfilade_pipeline::Config::demo(&overrides).map(Self).map_err(IntoPy::into_py)
    }

    /// The configuration that `to_dict` gave, changed or not; unknown keys, and values that `read` refuses, are a ValueError. `base` is the
    /// folder where relative paths in it start.
    #[staticmethod]
    #[pyo3(signature = (settings, base=PathBuf::from(".")))]
    fn from_dict(settings: &Bound<'_, PyAny>, base: PathBuf) -> PyResult<Self> {
        let config: enfilade_pipeline::Config = json::from_python(settings)?;
        config.check().map_err(IntoPy::into_py)?;
        Ok(Self(enfilade_pipeline::Config { base: std::path::absolute(base)?, ..config }))
    }

    /// Every setting, as plain data.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        json::to_python(py, &self.0)
    }

    /// Name of the dataset.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Names of the scenes.
    #[getter]
    fn scenes(&self) -> Vec<&str> {
        self.0.scenes.iter().map(|scene| scene.name.as_str()).collect()
    }

    fn __repr__(&self) -> String {
        format!("<enfilade.Config {:?}: {}>", self.0.name, self.scenes().join(", "))
    }
}

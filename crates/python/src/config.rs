//! `enfilade.Config`: the configuration of a run, from TOML, the demo or a dictionary.

use crate::errors::IntoPy;
use crate::json;
use enfilade_pipeline::{Overrides, Quality, RenderChoices};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::PathBuf;

/// What a dataset is made from: the configuration of `enfilade run`, with all defaults filled in.
///
/// `Config.read(file)` reads TOML, `Config.demo()` is the demo; both take what is to be otherwise: seed, frames per trajectory, size
/// (width, height), quality ("draft", "normal", "high" or "reference") or samples per pixel. `to_dict` and `from_dict` have every setting.
#[pyclass(module = "enfilade", frozen, from_py_object)]
#[derive(Clone)]
pub struct Config(pub enfilade_pipeline::Config);

/// The quality of that name.
pub fn quality(name: Option<&str>) -> PyResult<Option<Quality>> {
    Ok(Some(match name {
        None => return Ok(None),
        Some("draft") => Quality::Draft,
        Some("normal") => Quality::Normal,
        Some("high") => Quality::High,
        Some("reference") => Quality::Reference,
        Some(other) => {
            return Err(PyValueError::new_err(format!("quality is {other:?}; expected \"draft\", \"normal\", \"high\" or \"reference\"")));
        }
    }))
}

fn overrides(
    seed: Option<u64>,
    frames: Option<u32>,
    size: Option<[u32; 2]>,
    quality: Option<&str>,
    samples: Option<u32>,
) -> PyResult<Overrides> {
    let quality = self::quality(quality)?;
    Ok(Overrides { seed, frames, size, quality, render: RenderChoices { samples, ..RenderChoices::default() } })
}

#[pymethods]
impl Config {
    /// The configuration in a TOML file.
    #[staticmethod]
    #[pyo3(signature = (file, *, seed=None, frames=None, size=None, quality=None, samples=None))]
    fn read(
        file: PathBuf,
        seed: Option<u64>,
        frames: Option<u32>,
        size: Option<[u32; 2]>,
        quality: Option<&str>,
        samples: Option<u32>,
    ) -> PyResult<Self> {
        let overrides = overrides(seed, frames, size, quality, samples)?;
        enfilade_pipeline::Config::read(&file, &overrides).map(Self).map_err(IntoPy::into_py)
    }

    /// The demo: one generated home.
    #[staticmethod]
    #[pyo3(signature = (*, seed=None, frames=None, size=None, quality=None, samples=None))]
    fn demo(seed: Option<u64>, frames: Option<u32>, size: Option<[u32; 2]>, quality: Option<&str>, samples: Option<u32>) -> PyResult<Self> {
        let overrides = overrides(seed, frames, size, quality, samples)?;
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

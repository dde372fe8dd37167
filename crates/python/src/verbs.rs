//! The commands of the command line as functions: run, stage, verify, partition, repack, export.

use crate::arguments::{Frames, Names, layers};
use crate::config::Config;
use crate::errors::{IntoPy, StageError};
use crate::interrupt::{Interrupt, interruptible, watched};
use crate::progress::Bar;
use crate::{json, keywords};
use enfilade_dataset::Dataset;
use enfilade_export::{Existing, ExportOptions, FORMATS, Format, Selection};
use enfilade_pipeline::{STAGES, Stage, Summary};
use enfilade_show::report_card::write_report;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Makes the dataset `config` in the folder `output`: all stages of all scenes that are not up to date. A run that is ended, as by Ctrl-C, goes on
/// where it was when it is run again.
///
/// config: an `enfilade.Config`; the demo unless given.
/// scenes: only these; `*` stands for any run of characters.
/// progress: shows how far it has come; unless given, in notebooks and terminals.
///
/// Gives what was done, as a dictionary. Raises StageError when a scene fails.
#[pyfunction]
#[pyo3(signature = (output, config=None, *, scenes=None, progress=None))]
pub fn run<'py>(
    py: Python<'py>,
    output: PathBuf,
    config: Option<Config>,
    scenes: Option<Names>,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let config = match config {
        Some(config) => config.0,
        None => enfilade_pipeline::Config::demo(&Default::default()).map_err(IntoPy::into_py)?,
    };
    let pattern = scenes.map(|scenes| scenes.pattern());
    let bar = Bar::new(py, progress, "run")?;
    let summary = watched(py, &bar, |reporter| enfilade_pipeline::run(&config, &output, pattern.as_deref(), reporter))?;
    conclude(py, &summary)
}

/// Runs one stage of a dataset again with the configuration stored there: a name of `enfilade.STAGES`.
///
/// scenes: only these. force: also where it is up to date. progress: shows how far it has come; unless given, in notebooks and terminals.
#[pyfunction]
#[pyo3(signature = (name, dataset, *, scenes=None, force=false, progress=None))]
pub fn stage<'py>(
    py: Python<'py>,
    name: &str,
    dataset: PathBuf,
    scenes: Option<Names>,
    force: bool,
    progress: Option<bool>,
) -> PyResult<Bound<'py, PyAny>> {
    let found: Option<Stage> = STAGES.iter().find(|spec| spec.name == name).map(|spec| spec.stage);
    let names = || STAGES.map(|spec| spec.name).join(", ");
    let stage = found.ok_or_else(|| PyValueError::new_err(format!("there is no stage {name:?}; the stages are: {}", names())))?;
    let pattern = scenes.map(|scenes| scenes.pattern());
    let run = |reporter: &Interrupt| enfilade_pipeline::run_stage(&dataset, stage, pattern.as_deref(), force, reporter);
    let bar = Bar::new(py, progress, name)?;
    conclude(py, &watched(py, &bar, run)?)
}

/// Checks a dataset, ours or Hypersim's, against laws that every dataset must obey, and gives the report as a dictionary: `passed`, `laws`,
/// `gates` and the values of all frames.
///
/// scenes: only these; otherwise the report is also written to verify.json and verify.html, and a warning tells where that cannot be done.
#[pyfunction]
#[pyo3(signature = (dataset, *, scenes=None))]
pub fn verify<'py>(py: Python<'py>, dataset: PathBuf, scenes: Option<Names>) -> PyResult<Bound<'py, PyAny>> {
    let (report, unstored) = interruptible(py, |cx: &Interrupt| {
        let dataset = Dataset::open(&dataset).map_err(IntoPy::into_py)?;
        let all = dataset.scenes().map_err(IntoPy::into_py)?;
        let pattern = scenes.map(|scenes| scenes.pattern());
        let chosen = enfilade_pipeline::select("scene", &all, pattern.as_deref()).map_err(IntoPy::into_py)?;
        let report = enfilade_pipeline::verify(&dataset, &chosen, cx).map_err(IntoPy::into_py)?;
        let stored = if pattern.is_none() { write_report(&dataset, &report) } else { Ok(()) };
        Ok::<_, PyErr>((report, stored.err()))
    })?;
    // A dataset of others may be in a read-only folder.
    if let Some(error) = unstored {
        py.import("warnings")?.call_method1("warn", (format!("the report is not stored: {error}"),))?;
    }
    json::to_python(py, &report)
}

/// Divides a dataset by scene into train, val and test, and gives scenes and images of each side.
///
/// seed: of the draw. shares: of the sides, such as (0.8, 0.1, 0.1). What is not given stays as it was.
#[pyfunction]
#[pyo3(signature = (dataset, *, seed=None, shares=None))]
pub fn partition<'py>(py: Python<'py>, dataset: PathBuf, seed: Option<u64>, shares: Option<[f64; 3]>) -> PyResult<Bound<'py, PyAny>> {
    let change = |config: &mut enfilade_pipeline::PartitionConfig| {
        config.seed = seed.unwrap_or(config.seed);
        config.shares = shares.unwrap_or(config.shares);
    };
    let report = py.detach(|| enfilade_pipeline::partition(&dataset, change)).map_err(IntoPy::into_py)?;
    json::to_python(py, &report)
}

/// Copies frames, cameras and tables of a dataset, ours or Hypersim's, to the folder `output`, with images that are stored as they are (depth, and
/// what hardly shrinks, as colours) or under LZ4: larger than Hypersim's gzip, and ten and more times as fast to read by `enfilade.Dataset` as that
/// is by h5py. Values and names are the same. h5py reads the copy with the package hdf5plugin.
///
/// An earlier copy in `output` is replaced as a whole, when the new one is complete; what is no copy is refused.
///
/// layers: only these. Gives the number of files and their bytes before and after.
#[pyfunction]
#[pyo3(signature = (dataset, output, *, layers=None))]
pub fn repack<'py>(py: Python<'py>, dataset: PathBuf, output: PathBuf, layers: Option<Names>) -> PyResult<Bound<'py, PyAny>> {
    let layers = self::layers(layers.as_ref())?;
    let copied = interruptible(py, |cx: &Interrupt| {
        let dataset = Dataset::open(&dataset).map_err(IntoPy::into_py)?;
        dataset.repack(&output, layers.as_deref(), cx).map_err(IntoPy::into_py)
    })?;
    let counts = json!({ "files": copied.files, "bytes_before": copied.bytes_before, "bytes_after": copied.bytes_after });
    json::to_python(py, &counts)
}

/// Keywords of `export` besides its options.
const EXPORT: [&str; 9] = ["dataset", "format", "output", "scenes", "cameras", "frames", "force", "camera_table", "progress"];

/// Writes a dataset, ours or Hypersim's, in another layout to the folder `output`; an earlier export there is replaced. Nothing is rendered.
///
/// format: a name of `enfilade.FORMATS`, which tells what each is; docs/export.md has units and axes.
/// scenes, cameras: only these; `*` stands for any run of characters.
/// frames: only these numbers: one, or a range such as range(0, 10).
/// {options}
/// force: if `output` exists and is no export, renames it to `output`.old.
/// camera_table: another metadata_camera_parameters.csv.
/// progress: shows how far it has come; unless given, in notebooks and terminals.
///
/// Gives numbers of `frames`, `files` and `bytes`.
#[pyfunction]
#[pyo3(signature = (dataset, format, output, *, scenes=None, cameras=None, frames=None, force=false, camera_table=None, progress=None, **options))]
pub fn export<'py>(
    py: Python<'py>,
    dataset: PathBuf,
    format: &str,
    output: PathBuf,
    scenes: Option<Names>,
    cameras: Option<Names>,
    frames: Option<Frames>,
    force: bool,
    camera_table: Option<PathBuf>,
    progress: Option<bool>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let known = || FORMATS.map(|spec| spec.name).join(", ");
    let unknown = || PyValueError::new_err(format!("there is no format {format:?}; the formats are: {}", known()));
    let format = Format::from_name(format).ok_or_else(unknown)?;
    let options: ExportOptions = keywords::options(options, "export", &EXPORT)?;
    let frames = frames.map(|frames| frames.range()).transpose()?;
    let select = |what, names: &[String], chosen: Option<&Names>| {
        enfilade_pipeline::select(what, names, chosen.map(Names::pattern).as_deref()).map_err(IntoPy::into_py)
    };
    let opened = Dataset::open(&dataset).map_err(IntoPy::into_py)?;
    let opened = match camera_table {
        Some(table) => opened.with_camera_table(table),
        None => opened,
    };
    let scenes = select("scene", &opened.scenes().map_err(IntoPy::into_py)?, scenes.as_ref())?;
    let cameras = match &cameras {
        None => None,
        chosen => Some(select("camera", &opened.camera_names(&scenes).map_err(IntoPy::into_py)?, chosen.as_ref())?),
    };
    let config = options.config(format, Selection { scenes, cameras, frames, layers: None }).map_err(IntoPy::into_py)?;
    let existing = if force { Existing::SetAside } else { Existing::Refuse };
    let bar = Bar::new(py, progress, "export")?;
    let exported = watched(py, &bar, |cx: &Interrupt| enfilade_export::export(&opened, &config, &output, existing, cx))?;
    json::to_python(py, &json!({ "frames": exported.frames, "files": exported.files, "bytes": exported.bytes }))
}

/// The summary as a dictionary; a StageError if a scene failed.
pub fn conclude<'py>(py: Python<'py>, summary: &Summary) -> PyResult<Bound<'py, PyAny>> {
    let scenes = summary.scenes.iter().map(|scene| -> Value {
        let stages = scene.stages.iter().map(|stage| {
            json!({ "stage": stage.stage.name(), "up_to_date": stage.up_to_date, "summary": stage.summary, "warnings": stage.warnings, "wall_s": stage.wall_s })
        });
        json!({ "scene": scene.name, "stages": stages.collect::<Vec<_>>() })
    });
    let products = summary.all_products().map(|outcome| -> Value {
        json!({ "product": outcome.product.name(), "scene": outcome.scene, "made": outcome.made, "lines": outcome.lines })
    });
    let done = json::to_python(
        py,
        &json!({ "scenes": scenes.collect::<Vec<_>>(), "products": products.collect::<Vec<_>>(), "warnings": summary.warnings, "wall_s": summary.wall_s }),
    )?;
    let failures = summary.scenes.iter().filter_map(|scene| Some((scene, scene.failure.as_ref()?)));
    let unmade = summary.all_products().filter_map(|outcome| {
        let (message, hint) = outcome.failure.as_ref()?;
        let hint = hint.as_ref().map(|hint| format!("; {hint}")).unwrap_or_default();
        Some(format!("{}: {} could not be made: {message}{hint}", outcome.scene.as_deref().unwrap_or("dataset"), outcome.product.name()))
    });
    let failures: Vec<String> = failures
        .map(|(scene, failure)| {
            let hint = failure.hint.as_ref().map(|hint| format!("; {hint}")).unwrap_or_default();
            format!("{}: {} failed: {}{hint}", scene.name, failure.stage.name(), failure.message)
        })
        .chain(unmade)
        .collect();
    if failures.is_empty() {
        return Ok(done);
    }
    let error = StageError::new_err(failures.join("\n"));
    error.value(py).setattr("summary", done)?;
    Err(error)
}

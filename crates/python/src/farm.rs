//! `enfilade.farm`: one dataset on many machines, as `enfilade farm` of the command line makes it.

use crate::config::Config;
use crate::errors::IntoPy;
use crate::interrupt::{Interrupt, interruptible};
use crate::verbs::conclude;
use crate::{json, keywords};
use enfilade_dataset::{Price, read_prices};
use enfilade_farm::{
    Assignment, Attempt, Engine, EngineName, FarmError, Job, PlanOptions, Ranges, Store, SubmitOptions, Submitted, Work, default_scratch,
    environment, parse_ranges,
};
use enfilade_options::{Given, Value as _};
use enfilade_pipeline::Silent;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// One dataset on many machines.
pub fn add_module(parent: &Bound<'_, PyModule>) -> PyResult<()> {
    let module = PyModule::new(parent.py(), "farm")?;
    for function in [
        wrap_pyfunction!(plan, &module)?,
        wrap_pyfunction!(submit, &module)?,
        wrap_pyfunction!(work, &module)?,
        wrap_pyfunction!(status, &module)?,
        wrap_pyfunction!(collect, &module)?,
        wrap_pyfunction!(statistics, &module)?,
    ] {
        module.add_function(function)?;
    }
    parent.add_submodule(&module)
}

/// A price: dollars per vCPU-hour, rates as text, or the file of a table.
#[derive(FromPyObject)]
pub enum GivenPrice {
    /// A price as a number.
    Dollars(f64),
    /// A price as the command line has it.
    Text(PathBuf),
}

/// The given prices; empty if none are given.
fn prices(given: Option<&GivenPrice>) -> PyResult<Vec<Price>> {
    let text = match given {
        None => return Ok(Vec::new()),
        Some(GivenPrice::Dollars(dollars)) => dollars.to_string(),
        Some(GivenPrice::Text(text)) => place(text)?.to_string(),
    };
    read_prices(&text).map_err(|error| PyValueError::new_err(format!("{error}; {}", error.help())))
}

/// A place of a job as text.
fn place(path: &Path) -> PyResult<&str> {
    path.to_str().ok_or_else(|| PyValueError::new_err(format!("{} is not UTF-8; name it otherwise", path.display())))
}

fn open(job: &str) -> Result<Job, FarmError> {
    Job::open(Store::open(job, environment())?)
}

/// Packages the scenes of `config`, plans what to film, and divides the work into tasks: the job, which lies in a folder that all nodes see, or
/// in a bucket (`s3://bucket/prefix`, `gs://`, `az://`; keys and regions come from the environment). Planning again into the same place leaves
/// it as it is.
///
/// config: an `enfilade.Config`; the demo unless given.
/// {options}
/// price: dollars per vCPU-hour, or text as `--price` of the command line takes it, such as "0.0165,licence=0.00015/core-minute" or the file
/// of a table.
///
/// Gives numbers of `tasks`, `frames` and `scenes`, `vcpu_hours` with mean and standard deviation, `prices` with the dollars of each, `warnings`, and
/// where the `job` is. Raises StageError when a scene fails before rendering.
#[pyfunction]
#[pyo3(signature = (job, config=None, *, price=None, **options))]
pub fn plan<'py>(
    py: Python<'py>,
    job: PathBuf,
    config: Option<Config>,
    price: Option<GivenPrice>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let config = match config {
        Some(config) => config.0,
        None => enfilade_pipeline::Config::demo(&Default::default()).map_err(IntoPy::into_py)?,
    };
    let options: PlanOptions = keywords::options(options, "plan", &["job", "config", "price"])?;
    let (prices, place) = (prices(price.as_ref())?, place(&job)?);
    options.check().map_err(IntoPy::into_py)?;
    let (summary, planned) =
        interruptible(py, |reporter: &Interrupt| enfilade_farm::plan(&config, Store::begin(place, environment())?, &options, reporter))?;
    let done = conclude(py, &summary)?;
    let Some(planned) = planned else { return Ok(done) };
    let told = json::to_python(py, &planned.plan.statement(&prices))?;
    told.set_item("warnings", &summary.warnings)?;
    told.set_item("job", planned.store.url())?;
    Ok(told)
}

/// Writes what an engine needs to render the missing tasks of a job into the folder `output`, and submits it to Slurm where that is the engine.
///
/// engine: "slurm", "kubernetes" (needs `image`), "aws-batch" (needs `queue` and `definition`) or "openjd".
/// output: folder for the files; the current one unless given.
/// {options}
///
/// Gives the `files` that were written, none where nothing is missing, and the numbers of the `jobs` that were submitted.
#[pyfunction]
#[pyo3(signature = (job, engine, *, output=PathBuf::from("."), **options))]
pub fn submit<'py>(
    py: Python<'py>,
    job: PathBuf,
    engine: &str,
    output: PathBuf,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options: SubmitOptions = keywords::options(options, "submit", &["job", "engine", "output"])?;
    let given = Given::Text(engine.into());
    let unknown = || PyValueError::new_err(format!("engine is {engine:?}; {}", EngineName::FORM.refusal(&given)));
    let engine = Engine::of(EngineName::read(&given).ok_or_else(unknown)?, &options).map_err(IntoPy::into_py)?;
    let place = place(&job)?;
    let (mut files, mut jobs) = (Vec::new(), Vec::new());
    let mut done = |done: Submitted| match done {
        Submitted::File(path) => files.push(path),
        Submitted::Job(number) => jobs.push(number),
    };
    py.detach(|| enfilade_farm::submit(&open(place)?, &engine, &options, &output, &mut done)).map_err(IntoPy::into_py)?;
    json::to_python(py, &json!({ "files": files, "jobs": jobs }))
}

/// Tasks by their numbers.
#[derive(FromPyObject)]
pub enum Tasks {
    /// One.
    One(u32),
    /// Task numbers as the command line has them: "0-3", "0-8:2" or "1,5,9-12".
    Text(String),
    /// Several.
    Several(Vec<u32>),
}

/// Renders tasks of a job, or goes on with them, and commits their frames: what `enfilade farm work` does on a node. Interrupted, as by Ctrl-C, it
/// keeps the frame in the making in the job, and the next worker goes on within it.
///
/// tasks: a number, several, or text such as "0-3" or "1,5,9-12". shard: instead of them the i-th of n shares of all tasks, as (i, n),
/// counted from 0. scratch: a folder of this node, for scenes and frames in the making; `enfilade-farm` in the temporary folder unless given.
///
/// Gives a dictionary for each task: how it `ended` ("done", "transient" or "permanent"), the `error` if it failed, numbers of frames,
/// seconds, memory.
#[pyfunction]
#[pyo3(signature = (job, tasks=None, *, shard=None, scratch=None))]
pub fn work<'py>(
    py: Python<'py>,
    job: PathBuf,
    tasks: Option<Tasks>,
    shard: Option<(u32, u32)>,
    scratch: Option<PathBuf>,
) -> PyResult<Bound<'py, PyAny>> {
    let assignment = match (tasks, shard) {
        (Some(Tasks::One(task)), None) => Assignment::Tasks(Ranges::from([task])),
        (Some(Tasks::Several(tasks)), None) => Assignment::Tasks(tasks.into_iter().collect()),
        (Some(Tasks::Text(text)), None) => Assignment::Tasks(parse_ranges(&text).map_err(IntoPy::into_py)?),
        (None, Some((i, n))) if i < n => Assignment::Shard(i, n),
        (None, Some((i, n))) => {
            return Err(PyValueError::new_err(format!(
                "shard is ({i}, {n}); expected (i, n) with i below n, as in (0, 4) for the first of four"
            )));
        }
        _ => return Err(PyValueError::new_err("name either tasks, as in tasks=\"0-3\", or a shard, as in shard=(0, 4)")),
    };
    let (place, attempt, scratch) = (place(&job)?, Attempt::here(), scratch.unwrap_or_else(default_scratch));
    let records = interruptible(py, |interrupt: &Interrupt| {
        let work = Work { scratch: &scratch, attempt: &attempt, stop: interrupt.flag() };
        enfilade_farm::work(&open(place)?, &assignment, &work, &Silent)
    })?;
    json::to_python(py, &records)
}

/// How far a job has come: numbers of `frames`, `frames_done` and `tasks`, the numbers of the `missing` tasks, whether it is `complete`, attempts by
/// how they ended, the last error of each task that has failed, and what is left in processor seconds.
#[pyfunction]
pub fn status(py: Python<'_>, job: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let place = place(&job)?;
    let status = interruptible(py, |_: &Interrupt| enfilade_farm::status(&open(place)?))?;
    let told = json::to_python(py, &status)?;
    told.set_item("complete", status.is_complete())?;
    Ok(told)
}

/// Brings all frames of a job into the folder `output` and makes the rest of the dataset there, as one machine would have made it.
///
/// Gives what was done, as `enfilade.run` does. Raises ValueError while tasks are missing, and StageError when a scene fails.
#[pyfunction]
pub fn collect(py: Python<'_>, job: PathBuf, output: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let place = place(&job)?;
    let summary = interruptible(py, |reporter: &Interrupt| enfilade_farm::collect(&open(place)?, &output, reporter))?;
    conclude(py, &summary)
}

/// What a job has cost until now, attempt by attempt and in all: `vcpu_hours` that were paid, the share of them that was used, vCPU-seconds that went
/// into frames that count, into the program after them, and into what came to nothing.
///
/// price: dollars per vCPU-hour, or text as `--price` of the command line takes it, such as "0.0165,licence=0.00015/core-minute" or the file
/// of a table; `prices` has the dollars of each, and of each of its rates, and `machines` the smallest machine, where the table tells sizes.
/// table: also write a CSV file with a row per attempt, at the first price.
#[pyfunction]
#[pyo3(signature = (job, *, price=None, table=None))]
pub fn statistics<'py>(py: Python<'py>, job: PathBuf, price: Option<GivenPrice>, table: Option<PathBuf>) -> PyResult<Bound<'py, PyAny>> {
    let (prices, place) = (prices(price.as_ref())?, place(&job)?);
    let told: Value = interruptible(py, |_: &Interrupt| {
        let job = open(place).map_err(IntoPy::into_py)?;
        let costs = enfilade_farm::costs(&job).map_err(IntoPy::into_py)?;
        if let Some(path) = &table {
            let unwritten =
                |error: std::io::Error| PyErr::from(std::io::Error::new(error.kind(), format!("cannot write {}: {error}", path.display())));
            std::fs::write(path, costs.table(&job, &prices)).map_err(unwritten)?;
        }
        serde_json::to_value(costs.statement(&prices)).map_err(|error| PyValueError::new_err(error.to_string()))
    })?;
    json::to_python(py, &told)
}

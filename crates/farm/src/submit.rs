//! Files for an engine, and for Slurm their submission: what `farm submit` does.

use crate::engines::{Submission, aws_batch_job, kubernetes_job, openjd_template, slurm_collect_script, slurm_scripts};
use crate::{FarmError, Job, status};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What starts the workers, and what it must be told.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Job arrays of Slurm.
    Slurm {
        /// Collect the dataset into this folder when the arrays have ended.
        collect: Option<String>,
        /// Only write the files.
        dry_run: bool,
    },
    /// An Indexed Job of Kubernetes.
    Kubernetes {
        /// The image that holds the program.
        image: String,
    },
    /// Array jobs of AWS Batch.
    AwsBatch {
        /// The queue.
        queue: String,
        /// The job definition.
        definition: String,
    },
    /// Open Job Description, for AWS Deadline Cloud.
    Openjd,
}

/// What else may be chosen; `None` is the forecast's, or the engine's own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SubmitOptions {
    /// The program on the nodes; otherwise `enfilade`, which they find by PATH.
    pub program: Option<String>,
    /// Workers at once.
    pub at_once: Option<u32>,
    /// Memory of a worker, MiB.
    pub memory_mib: Option<u64>,
    /// After how many minutes an engine may end a worker.
    pub minutes: Option<u64>,
    /// Tasks of one array at most.
    pub array_limit: Option<u32>,
}

impl SubmitOptions {
    /// What is chosen, over what the forecast says.
    fn lay_over(&self, forecast: Submission) -> Submission {
        Submission {
            program: self.program.clone().unwrap_or(forecast.program),
            at_once: self.at_once,
            memory_mib: self.memory_mib.unwrap_or(forecast.memory_mib),
            minutes: self.minutes.unwrap_or(forecast.minutes),
            array_limit: self.array_limit.unwrap_or(forecast.array_limit),
            ..forecast
        }
    }
}

/// Something that was done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Submitted {
    /// A file was written.
    File(PathBuf),
    /// The job was submitted, under this number.
    Job(String),
}

/// What to do with the files where nobody can submit them from here; `None` for Slurm.
pub fn how_to_submit(engine: &Engine) -> Option<&'static str> {
    match engine {
        Engine::Slurm { .. } => None,
        Engine::Kubernetes { .. } => Some("submit it: kubectl apply -f FILE"),
        Engine::AwsBatch { .. } => Some("submit each: aws batch submit-job --cli-input-json file://FILE"),
        Engine::Openjd => Some("submit it: deadline bundle submit FOLDER; or run it here: openjd run template.json"),
    }
}

/// Writes what the engine needs for the tasks that are missing into `folder`, and submits it where that can be done from here. `done` hears
/// of every step as soon as it is taken. False when nothing is missing, and nothing was written.
///
/// # Errors
/// When the store does not answer, a file cannot be written, or Slurm refuses one.
pub fn submit(
    job: &Job,
    engine: &Engine,
    options: &SubmitOptions,
    folder: &Path,
    done: &mut dyn FnMut(Submitted),
) -> Result<bool, FarmError> {
    let missing = status(job)?.missing;
    if missing.is_empty() {
        return Ok(false);
    }
    let submission = options.lay_over(Submission::of(job, missing));
    std::fs::create_dir_all(folder).map_err(|source| FarmError::io("make the folder", folder, source))?;
    let mut file = |name: String, text: &str| -> Result<PathBuf, FarmError> {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|source| FarmError::io("write", &path, source))?;
        done(Submitted::File(path.clone()));
        Ok(path)
    };
    let name = &submission.name;
    match engine {
        Engine::Kubernetes { image } => drop(file(format!("{name}.job.json"), &json(&kubernetes_job(&submission, image)))?),
        Engine::AwsBatch { queue, definition } => {
            for (k, request) in aws_batch_job(&submission, queue, definition).iter().enumerate() {
                file(format!("{name}.{k}.batch.json"), &json(request))?;
            }
        }
        Engine::Openjd => drop(file("template.json".into(), &json(&openjd_template(&submission)))?),
        Engine::Slurm { collect, dry_run } => {
            let scripts = slurm_scripts(&submission).into_iter().enumerate();
            let arrays = scripts.map(|(k, script)| file(format!("{name}.{k}.sbatch"), &script)).collect::<Result<Vec<_>, _>>()?;
            let collect = collect.as_ref().map(|out| file(format!("{name}.collect.sbatch"), &slurm_collect_script(&submission, out)));
            let collect = collect.transpose()?;
            if !dry_run {
                submit_to_slurm(&arrays, collect.as_deref(), done)?;
            }
        }
    }
    Ok(true)
}

fn json(value: &Value) -> String {
    format!("{value:#}\n")
}

/// Submits the scripts of arrays, and then the one that collects when all of them have ended.
fn submit_to_slurm(arrays: &[PathBuf], collect: Option<&Path>, done: &mut dyn FnMut(Submitted)) -> Result<(), FarmError> {
    let mut numbers: Vec<String> = Vec::new();
    for script in arrays {
        numbers.push(sbatch(script, &[], &numbers)?);
        done(Submitted::Job(numbers.last().cloned().unwrap_or_default()));
    }
    if let Some(script) = collect {
        let after = format!("--dependency=afterok:{}", numbers.join(":"));
        done(Submitted::Job(sbatch(script, &[&after, "--kill-on-invalid-dep=yes"], &numbers)?));
    }
    Ok(())
}

/// Submits a script, after those of the numbers `before`; the number of its job.
fn sbatch(script: &Path, options: &[&str], before: &[String]) -> Result<String, FarmError> {
    let before = if before.is_empty() { String::new() } else { format!("; submitted before it: {}", before.join(", ")) };
    let refuse = |problem: String, advice: &str| FarmError::Request(format!("{problem}{before}; {advice}"));
    let output = Command::new("sbatch").arg("--parsable").args(options).arg(script).output();
    let output = output
        .map_err(|error| refuse(format!("cannot start sbatch: {error}"), "is Slurm installed here? A dry run only writes the files"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).trim().to_string();
        let problem = format!("sbatch refused {}: {said}", script.display());
        return Err(refuse(problem, "change the script and submit it by hand, or give other limits"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().split(';').next().unwrap_or_default().to_string())
}

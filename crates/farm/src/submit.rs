//! Files for an engine, and for Slurm their submission: what `farm submit` does.

use crate::engines::{Submission, aws_batch_job, kubernetes_job, openjd_template, slurm_collect_script, slurm_scripts};
use crate::{FarmError, Job, status};
use enfilade_options::{MEBIBYTES, Whole, named, options, words};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The engine that starts the workers, with its settings.
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
        /// The image that contains the program.
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

words! {
    /// An engine by its name.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum EngineName {
        /// Slurm: job arrays.
        Slurm = "slurm",
        /// Kubernetes: an Indexed Job.
        Kubernetes = "kubernetes",
        /// AWS Batch: array jobs.
        AwsBatch = "aws-batch",
        /// Open Job Description, for AWS Deadline Cloud.
        Openjd = "openjd",
    }
}

options! {
    /// Options of a submission; `None` uses the forecast's value, or the engine's own.
    #[derive(Clone, Debug, PartialEq, Eq)]
    pub struct SubmitOptions {
        /// Only write the files.
        pub dry_run: bool = false,
        /// The program on the nodes; `enfilade`, which they find by PATH, unless given.
        pub program: Option<String> = None => named("PATH"),
        /// Workers at once.
        pub at_once: Option<u32> = None,
        /// Memory of a worker, MiB; by the forecast unless given.
        pub memory_mib: Option<u64> = None => MEBIBYTES,
        /// Minutes after which a worker may be ended; by the forecast unless given.
        pub minutes: Option<u64> = None,
        /// Tasks of one array at most (Slurm: MaxArraySize - 1).
        pub array_limit: Whole<1> = Whole::new(1000),
        /// Slurm: collect into this folder when the arrays have ended.
        pub collect: Option<PathBuf> = None => named("OUT"),
        /// Kubernetes: the image that holds the program.
        pub image: Option<String> = None => named("IMAGE"),
        /// AWS Batch: the queue.
        pub queue: Option<String> = None => named("QUEUE"),
        /// AWS Batch: the job definition.
        pub definition: Option<String> = None => named("DEFINITION"),
    }
}

impl Engine {
    /// The engine of that name, with its settings.
    ///
    /// # Errors
    /// When one that it needs is not given, or the folder to collect into has no name in UTF-8.
    pub fn of(name: EngineName, options: &SubmitOptions) -> Result<Self, FarmError> {
        let needed = |setting: &Option<String>, what: &str| {
            setting.clone().ok_or_else(|| FarmError::Request(format!("{what} is not given, which {:?} needs", name.name())))
        };
        let text = |folder: &PathBuf| {
            let wrong = || FarmError::Request(format!("{} is not UTF-8; name it otherwise", folder.display()));
            folder.to_str().map(String::from).ok_or_else(wrong)
        };
        Ok(match name {
            EngineName::Slurm => Self::Slurm { collect: options.collect.as_ref().map(text).transpose()?, dry_run: options.dry_run },
            EngineName::Kubernetes => Self::Kubernetes { image: needed(&options.image, "image")? },
            EngineName::AwsBatch => {
                Self::AwsBatch { queue: needed(&options.queue, "queue")?, definition: needed(&options.definition, "definition")? }
            }
            EngineName::Openjd => Self::Openjd,
        })
    }
}

impl SubmitOptions {
    /// The forecast, with the chosen settings in place of its own.
    fn lay_over(&self, forecast: Submission) -> Submission {
        Submission {
            program: self.program.clone().unwrap_or(forecast.program),
            at_once: self.at_once,
            memory_mib: self.memory_mib.unwrap_or(forecast.memory_mib),
            minutes: self.minutes.unwrap_or(forecast.minutes),
            array_limit: self.array_limit.get(),
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

/// How to submit the files, if this program cannot; `None` for Slurm.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_engine_has_the_settings_that_it_needs_or_names_the_one_that_is_missing() {
        let options = SubmitOptions { image: Some("rooms:1".into()), collect: Some("out".into()), ..SubmitOptions::default() };
        let of = |name| Engine::of(name, &options).map_err(|error| error.to_string());
        assert_eq!(of(EngineName::Kubernetes), Ok(Engine::Kubernetes { image: "rooms:1".into() }));
        assert_eq!(of(EngineName::Slurm), Ok(Engine::Slurm { collect: Some("out".into()), dry_run: false }));
        assert_eq!(of(EngineName::AwsBatch), Err("queue is not given, which \"aws-batch\" needs".into()));
    }
}

//! `farm submit`: files for engines.

use crate::args::{EngineArg, FarmSubmitArgs};
use crate::outcome::{Problem, Verdict, say};
use enfilade_dataset::quoted;
use enfilade_farm::Job;
use enfilade_farm::engines::{Submission, aws_batch_job, kubernetes_job, openjd_template, slurm_collect_script, slurm_scripts};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Writes what the engine needs for the tasks that are missing, and submits it where that can be done from here.
pub fn submit(job: &Job, args: &FarmSubmitArgs) -> Result<Verdict, Problem> {
    let missing = enfilade_farm::status(job)?.missing;
    if missing.is_empty() {
        say(&format!("nothing is missing; collect the dataset: enfilade farm collect {} -o OUT", quoted(&args.job)));
        return Ok(Verdict::Done);
    }
    let here = || std::env::current_exe().ok().map(|path| path.display().to_string());
    let default = if args.engine == EngineArg::Slurm { here() } else { None };
    let mut submission = Submission::of(job, missing);
    submission.program = args.program.clone().or(default).unwrap_or_else(|| "enfilade".into());
    submission.at_once = args.at_once;
    submission.memory_mib = args.memory.unwrap_or(submission.memory_mib);
    submission.minutes = args.minutes.unwrap_or(submission.minutes);
    submission.array_limit = args.array_limit;
    std::fs::create_dir_all(&args.output).map_err(|error| cannot("make", &args.output, &error))?;
    let file = |name: String, text: &str| -> Result<PathBuf, Problem> {
        let path = args.output.join(name);
        std::fs::write(&path, text).map_err(|error| cannot("write", &path, &error))?;
        say(&path.display().to_string());
        Ok(path)
    };
    let named = |option: &Option<String>, flag: &str| {
        option.clone().ok_or_else(|| Problem::new(format!("{flag} is not given"), "see enfilade farm submit --help"))
    };
    let json = |value: &serde_json::Value| serde_json::to_string_pretty(value).unwrap_or_default() + "\n";
    match args.engine {
        EngineArg::Kubernetes => {
            file(format!("{}.job.json", submission.name), &json(&kubernetes_job(&submission, &named(&args.image, "--image")?)))?;
            say("submit it: kubectl apply -f FILE");
        }
        EngineArg::AwsBatch => {
            let requests = aws_batch_job(&submission, &named(&args.queue, "--queue")?, &named(&args.definition, "--definition")?);
            for (k, request) in requests.iter().enumerate() {
                file(format!("{}.{k}.batch.json", submission.name), &json(request))?;
            }
            say("submit each: aws batch submit-job --cli-input-json file://FILE");
        }
        EngineArg::Openjd => {
            file("template.json".into(), &json(&openjd_template(&submission)))?;
            say("submit it: deadline bundle submit FOLDER; or run it here: openjd run template.json");
        }
        EngineArg::Slurm => {
            let scripts = slurm_scripts(&submission);
            let mut arrays = Vec::new();
            for (k, script) in scripts.iter().enumerate() {
                let path = file(format!("{}.{k}.sbatch", submission.name), script)?;
                if !args.dry_run {
                    arrays.push(sbatch(&path, &[])?);
                }
            }
            if let Some(out) = &args.collect {
                let path = file(format!("{}.collect.sbatch", submission.name), &slurm_collect_script(&submission, out))?;
                if !args.dry_run {
                    let after = format!("--dependency=afterok:{}", arrays.join(":"));
                    sbatch(&path, &[&after, "--kill-on-invalid-dep=yes"])?;
                }
            }
        }
    }
    Ok(Verdict::Done)
}

/// Submits a script; the number of its job.
fn sbatch(script: &Path, options: &[&str]) -> Result<String, Problem> {
    let help = "is Slurm installed here? --dry-run only writes the files";
    let output = Command::new("sbatch").arg("--parsable").args(options).arg(script).output();
    let output = output.map_err(|error| Problem::new(format!("cannot start sbatch: {error}"), help))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).trim().to_string();
        return Err(Problem::new(
            format!("sbatch refused {}: {said}", script.display()),
            "change the script and submit it by hand, or give other limits",
        ));
    }
    let number = String::from_utf8_lossy(&output.stdout).trim().split(';').next().unwrap_or_default().to_string();
    say(&format!("submitted as job {number}"));
    Ok(number)
}

fn cannot(action: &str, path: &Path, error: &std::io::Error) -> Problem {
    Problem::new(format!("cannot {action} {}: {error}", path.display()), "choose another folder with -o")
}

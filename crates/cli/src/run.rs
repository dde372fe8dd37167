//! `run` and `label`: the stages of a dataset, all of them or some.

use crate::args::{LabelArgs, RunArgs, SettingFlags, StageArg};
use crate::estimate::estimate;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use crate::released::refuse_released;
use crate::{pictures, summary};
use enfilade_dataset::quoted;
use enfilade_pipeline::{Config, Stage, Summary};
use std::path::{Path, PathBuf};

/// `run`: all stages or some, of a configuration, of the demo or of a dataset made before.
pub fn run(args: &RunArgs, quiet: bool) -> Result<Verdict, Problem> {
    if let Some(folder) = folder_of_pictures(args)? {
        return pictures::elsewhere(args, folder, quiet);
    }
    let (config, out) = asked_for(args)?;
    if args.estimate {
        return estimate(&config, &out, args.scenes.as_deref(), args.price.as_deref(), quiet);
    }
    let (result, pages) = {
        let progress = Progress::new(quiet);
        let result = made(args, &config, &out, &progress)?;
        let pages = if args.draw_plan { enfilade_pipeline::draw_plans(&config, &out, &result, &progress)? } else { Vec::new() };
        (result, pages)
    };
    summary::print_table(&result);
    let is_whole = args.only.is_empty();
    if is_whole {
        summary::print_where_to_look(&out, &result)?;
    }
    if is_whole && args.demo.is_some() && result.ok() {
        summary::print_after_demo();
    }
    pages.iter().for_each(|page| say(&format!("see  {}", page.display())));
    if is_whole {
        summary::print_failures(&result);
    }
    Ok(Verdict::of(result.ok()))
}

/// Runs all stages, or those that are named.
fn made(args: &RunArgs, config: &Config, out: &Path, progress: &Progress) -> Result<Summary, Problem> {
    let pattern = args.scenes.as_deref();
    if args.only.is_empty() {
        return Ok(enfilade_pipeline::run(config, out, pattern, progress)?);
    }
    let stages: Vec<Stage> = args.only.iter().map(|&StageArg(stage)| stage).collect();
    Ok(enfilade_pipeline::run_stages(config, out, &stages, pattern, args.force, progress)?)
}

/// The folder that previews are to be written to, where they are not to be in the dataset.
fn folder_of_pictures(args: &RunArgs) -> Result<Option<&Path>, Problem> {
    let is_preview = args.only == [StageArg(Stage::Preview)];
    match (&args.output, &args.from) {
        (Some(folder), Some(dataset)) if is_preview && dataset.is_dir() => Ok(Some(folder)),
        _ if args.table.cameras_csv.is_some() => {
            let problem = "--cameras-csv is for previews that are written elsewhere; a dataset of ours has its own cameras";
            Err(Problem::new(problem, "leave it out, or name a folder for the pictures: enfilade run DATASET --only preview -o FOLDER"))
        }
        _ => Ok(None),
    }
}

/// The configuration to run, and the output folder.
fn asked_for(args: &RunArgs) -> Result<(Config, PathBuf), Problem> {
    if let Some(folder) = args.from.as_deref().filter(|from| from.is_dir()) {
        return Ok((made_before(args, folder)?, folder.to_path_buf()));
    }
    let config = configuration(args.from.as_deref(), &args.settings)?;
    let out = args.demo.clone().or(args.output.clone()).unwrap_or_else(|| PathBuf::from(&config.name));
    Ok((config, out))
}

/// The settings of the dataset in `folder`, with the overrides of the command line.
fn made_before(args: &RunArgs, folder: &Path) -> Result<Config, Problem> {
    refuse_released(folder, args.only.first().map(|&StageArg(stage)| stage))?;
    if args.output.is_some() {
        let message = format!("-o names the folder of a new dataset, but {} is one already", folder.display());
        return Err(Problem::new(message, "leave -o out; only with --only preview it names a folder, that of the pictures"));
    }
    let overrides = args.settings.overrides()?;
    if overrides.seed.is_some() {
        let hint = format!(
            "make another one: enfilade run DATASET.TOML -o OTHER --seed N; or leave --seed out: enfilade run {}",
            quoted(folder.display())
        );
        return Err(Problem::new(format!("--seed decides what a dataset is of, and {} is made already", folder.display()), hint));
    }
    Ok(enfilade_pipeline::stored_config(folder, &overrides, args.scenes.as_deref())?)
}

/// The configuration of a file, or the demo's, with the overrides of the command line.
pub fn configuration(file: Option<&Path>, flags: &SettingFlags) -> Result<Config, Problem> {
    let overrides = flags.overrides()?;
    Ok(file.map_or_else(|| Config::demo(&overrides), |file| Config::read(file, &overrides))?)
}

/// `label`, with another table if wanted.
pub fn label(args: &LabelArgs, quiet: bool) -> Result<Verdict, Problem> {
    refuse_released(&args.dataset, Some(Stage::Label))?;
    let (dataset, scene, force) = (&args.dataset, args.scene.as_deref(), args.force);
    let result = {
        let progress = Progress::new(quiet);
        match &args.table {
            None => enfilade_pipeline::run_stage(dataset, Stage::Label, scene, force, &progress)?,
            Some(table) => enfilade_pipeline::relabel(dataset, table, scene, force, &progress)?,
        }
    };
    summary::print_table(&result);
    Ok(Verdict::of(result.ok()))
}

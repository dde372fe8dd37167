//! What each verb does: arguments to calls of the pipeline and back to words.

use crate::args::{
    InspectArgs, LabelArgs, MakeFlags, PlanArgs, QualityArg, RenderArgs, RenderFlags, ReplayArgs, RunArgs, SplitArgs, StageArgs, VerifyArgs,
};
use crate::estimate::estimate;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use crate::released::refuse_released;
use crate::summary;
use enfilade_dataset::{CameraTable, ColorKind};
use enfilade_export::intrinsics_csv;
use enfilade_pipeline::{Config, Event, Overrides, Quality, RenderChoices, Reporter, Stage, Summary};
use enfilade_show::drivers::inspect_pixel;
use enfilade_show::report_card::write_report;
use std::path::{Path, PathBuf};

/// `run`: all stages.
pub fn run(args: &RunArgs, quiet: bool) -> Result<Verdict, Problem> {
    let config = configuration(args.config.as_deref(), &args.make)?;
    let out = args.demo.clone().or(args.output.clone()).unwrap_or_else(|| PathBuf::from(&config.name));
    if args.estimate {
        return estimate(&config, &out, args.scenes.as_deref(), args.price.as_deref(), quiet);
    }
    let result = {
        let progress = Progress::new(quiet);
        enfilade_pipeline::run(&config, &out, args.scenes.as_deref(), &progress)?
    };
    summary::print_table(&result);
    summary::print_where_to_look(&out, &result)?;
    if args.demo.is_some() && result.ok() {
        summary::print_after_demo();
    }
    summary::print_failures(&result);
    Ok(Verdict::of(result.ok()))
}

/// That of a file, or the demo's, with what the command line says otherwise.
pub fn configuration(file: Option<&Path>, flags: &MakeFlags) -> Result<Config, Problem> {
    let overrides = Overrides {
        seed: flags.seed,
        frames: flags.frames,
        size: flags.size,
        quality: flags.quality.map(|q| match q {
            QualityArg::Draft => Quality::Draft,
            QualityArg::Normal => Quality::Normal,
            QualityArg::High => Quality::High,
            QualityArg::Reference => Quality::Reference,
        }),
        render: choices(&flags.render),
    };
    Ok(file.map_or_else(|| Config::demo(&overrides), |file| Config::read(file, &overrides))?)
}

/// One stage of a dataset.
pub fn stage(args: &StageArgs, stage: Stage, quiet: bool) -> Result<Verdict, Problem> {
    refuse_released(&args.dataset, stage)?;
    let progress = Progress::new(quiet);
    let result = enfilade_pipeline::run_stage(&args.dataset, stage, args.scene.as_deref(), args.force, &progress)?;
    drop(progress);
    Ok(conclude(&result))
}

/// `plan`, with pictures of it if wanted.
pub fn plan(args: &PlanArgs, quiet: bool) -> Result<Verdict, Problem> {
    if !args.preview {
        return stage(&args.stage, Stage::Plan, quiet);
    }
    let StageArgs { dataset, scene, force } = &args.stage;
    let progress = Progress::new(quiet);
    let (result, pages) = enfilade_pipeline::plan_and_draw(dataset, scene.as_deref(), *force, &progress)?;
    drop(progress);
    let verdict = conclude(&result);
    pages.iter().for_each(|page| say(&format!("see  {}", page.display())));
    Ok(verdict)
}

/// `render`, with other settings from now on if wanted.
pub fn render(args: &RenderArgs, quiet: bool) -> Result<Verdict, Problem> {
    let choices = choices(&args.render);
    match choices == RenderChoices::default() {
        true => stage(&args.stage, Stage::Render, quiet),
        false => chosen(&args.stage, &choices, &[Stage::Render, Stage::Denoise], quiet),
    }
}

/// `denoise`, from now on.
pub fn denoise(args: &StageArgs, quiet: bool) -> Result<Verdict, Problem> {
    chosen(args, &RenderChoices { color: Some(ColorKind::Denoised), ..RenderChoices::default() }, &[Stage::Denoise], quiet)
}

/// Stages of a dataset for which choices are made.
fn chosen(args: &StageArgs, choices: &RenderChoices, stages: &[Stage], quiet: bool) -> Result<Verdict, Problem> {
    let progress = Progress::new(quiet);
    let result = enfilade_pipeline::run_chosen(&args.dataset, choices, stages, args.scene.as_deref(), args.force, &progress)?;
    drop(progress);
    Ok(conclude(&result))
}

fn choices(flags: &RenderFlags) -> RenderChoices {
    RenderChoices {
        samples: flags.samples,
        noise: flags.noise,
        max_bounces: flags.max_bounces,
        clamp: flags.clamp,
        time_limit_s: flags.time_limit,
        splits: flags.splits,
        fixtures: flags.fixtures,
        extra: flags.extra,
        lambertian: flags.lambertian,
        color: flags.color.map(ColorKind::from),
    }
}

fn conclude(result: &Summary) -> Verdict {
    summary::print_table(result);
    Verdict::of(result.ok())
}

/// `label`, with another table if wanted.
pub fn label(args: &LabelArgs, quiet: bool) -> Result<Verdict, Problem> {
    let Some(table) = &args.table else { return stage(&args.stage, Stage::Label, quiet) };
    let progress = Progress::new(quiet);
    let StageArgs { dataset, scene, force } = &args.stage;
    let result = enfilade_pipeline::relabel(dataset, table, scene.as_deref(), *force, &progress)?;
    drop(progress);
    Ok(conclude(&result))
}

/// `verify`: the card of a dataset.
pub fn verify(args: &VerifyArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    let report = {
        let progress = Progress::new(quiet);
        let name = args.dataset.display().to_string();
        progress.on(&name, Stage::Verify, Event::Started);
        enfilade_pipeline::verify(&dataset, &scenes, &progress.cx(&name, Stage::Verify))?
    };
    say(report.to_text().trim_end());
    if args.scene.is_none() {
        match write_report(&dataset, &report) {
            Ok(()) => say(&format!("see  {}", dataset.layout().verify_page().display())),
            // Data of others may lie where nothing can be written.
            Err(error) => say(&format!("warning: the card is not stored: {error}")),
        }
    }
    Ok(Verdict::of(if args.strict { report.accepted } else { report.passed }))
}

/// `split`: who learns from what.
pub fn split(args: &SplitArgs) -> Result<Verdict, Problem> {
    let report = enfilade_pipeline::split(&args.dataset, |config| {
        config.seed = args.seed.unwrap_or(config.seed);
        config.shares = args.shares.unwrap_or(config.shares);
    })?;
    for (side, scenes) in &report.scenes {
        let images = report.images.get(side).copied().unwrap_or(0);
        say(&format!("{side:5}  {} scenes, {images} images", scenes.len()));
    }
    report.leaks().iter().chain(&report.empty_sides()).for_each(|warning| say(&format!("warning: {warning}")));
    Ok(Verdict::Done)
}

/// `inspect`: all about one pixel.
pub fn inspect(args: &InspectArgs) -> Result<Verdict, Problem> {
    let Some((x, y)) = args.pixel else { return list_cameras(args) };
    let dataset = args.table.open(&args.dataset)?;
    let scenes = dataset.scenes()?;
    let scene = match (&args.scene, scenes.as_slice()) {
        (Some(scene), _) => enfilade_pipeline::select("scene", &scenes, Some(scene))?.remove(0),
        (None, [only]) => only.clone(),
        (None, several) => {
            return Err(Problem::new("the dataset has several scenes", format!("name one with --scene: {}", several.join(", "))));
        }
    };
    let camera = enfilade_pipeline::select("camera", &dataset.cameras(&scene)?, Some(&args.camera))?.remove(0);
    let report = inspect_pixel(&dataset, &scene, &camera, args.frame, [x, y]).map_err(|e| Problem::found(&e))?;
    say(report.to_string().trim_end());
    Ok(Verdict::Done)
}

/// `inspect --cameras`: K of every scene that the table has.
fn list_cameras(args: &InspectArgs) -> Result<Verdict, Problem> {
    let table = match &args.table.cameras_csv {
        Some(table) => table.clone(),
        None if args.dataset.is_file() => args.dataset.clone(),
        None => args.table.open(&args.dataset)?.camera_table(),
    };
    say(intrinsics_csv(&CameraTable::read(&table)?).trim_end());
    Ok(Verdict::Done)
}

/// `replay`: one frame once more.
pub fn replay(args: &ReplayArgs, quiet: bool) -> Result<Verdict, Problem> {
    let replay = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.record.display().to_string(), "replay");
        enfilade_pipeline::replay(&args.record, args.output.as_deref(), &cx)?
    };
    for file in &replay.files {
        say(&format!("{}  {}", if file.same { "same bytes" } else { "DIFFERS   " }, file.name));
    }
    let same = replay.files.iter().filter(|file| file.same).count();
    say(&format!("{}: {same} of {} files have the same bytes", replay.frame, replay.files.len()));
    if let Some(out) = &args.output {
        say(&format!("written below  {}", out.display()));
    }
    Ok(Verdict::of(replay.is_same()))
}

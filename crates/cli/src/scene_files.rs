//! The verbs of scene files: `look`, `import` and `home`.

use crate::args::{HomeArgs, ImportArgs, LookArgs, file_source};
use crate::ingest;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::quoted;
use enfilade_export::scene_encoder;
use enfilade_pipeline::{Event, FileSource, Reporter, Stage, holds_scene, scene_file_of};
use enfilade_scene::{Cx, Warning};
use std::path::PathBuf;

/// `look`: one picture of a scene file.
pub fn look(args: &LookArgs, quiet: bool) -> Result<Verdict, Problem> {
    let source = file_source(&args.input, &args.choices)?;
    let name = args.input.file_stem().map_or_else(|| "look".into(), PathBuf::from);
    let output = args.output.clone().unwrap_or_else(|| name.with_extension("jpg"));
    let looked = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&source.file, "look");
        enfilade_pipeline::look(&source, args.camera.as_deref(), args.seconds, &output, &cx)?
    };
    say(&looked.summary);
    say(&format!("view     {}", looked.view));
    looked.light.iter().for_each(|light| say(&format!("light    {light}")));
    say(&format!("picture  {} ({:.0} samples per pixel, denoised; {:.1} s)", output.display(), looked.samples, looked.wall_s));
    Ok(Verdict::Done)
}

/// `import`: of one file or folder of a collection, or of a real data set.
pub fn import(args: &ImportArgs, quiet: bool) -> Result<Verdict, Problem> {
    if ingest::is_pix3d(args) {
        return ingest::pix3d(args);
    }
    if args.input.is_dir() && !holds_scene(&args.input)? {
        let datasets = format!("scenes of a dataset are imported by: enfilade run {} --only import", quoted(args.input.display()));
        let hint = format!("name a scene file, or the folder of Pix3D, in which pix3d.json is; {datasets}");
        return Err(Problem::new(format!("{} is a folder in which no scene is", args.input.display()), hint));
    }
    let source = file_source(&args.input, &args.choices)?;
    if args.check {
        return check(&source, quiet);
    }
    let output = args.output.clone().unwrap_or_else(|| scene_file_of(&args.input));
    let encode = scene_encoder(&output)?;
    let name = args.input.display().to_string();
    let imported = {
        let progress = Progress::new(quiet);
        progress.on(&name, Stage::Import, Event::Started);
        enfilade_pipeline::import_file(&source, &output, encode, &progress.cx(&name, Stage::Import))?
    };
    say(&imported.summary);
    imported.lost.iter().for_each(|lost| say(&format!("lost     {lost}")));
    say(&format!("scene    {}", output.display()));
    say(&format!("report   {} ({} warnings)", imported.report.display(), imported.warnings.len()));
    Ok(Verdict::Done)
}

/// `import --check`.
fn check(source: &FileSource, quiet: bool) -> Result<Verdict, Problem> {
    let checked = {
        let progress = Progress::new(quiet);
        enfilade_pipeline::check_file(source, &Unwarned(&progress.begin(&source.file, "check")))?
    };
    say(&checked.summary);
    checked.warnings.iter().for_each(|warning| say(&warning.to_string()));
    say(&format!("checked  {} warnings; nothing was written", checked.warnings.len()));
    Ok(Verdict::Done)
}

/// Progress without the warnings, which are results here.
struct Unwarned<'a>(&'a dyn Cx);

impl Cx for Unwarned<'_> {
    fn progress(&self, what: &str, done: u64, total: u64) {
        self.0.progress(what, done, total);
    }

    fn warn(&self, _warning: Warning) {}
}

/// `home`: a furnished home of a seed.
pub fn home(args: &HomeArgs, quiet: bool) -> Result<Verdict, Problem> {
    let config = args.choices.options()?;
    if let Some(problem) = config.problem() {
        return Err(Problem::new(problem, "see enfilade home --help"));
    }
    let encode = scene_encoder(&args.output)?;
    let name = args.output.display().to_string();
    let progress = Progress::new(quiet);
    let made = enfilade_pipeline::make_home(&config, &args.output, encode, &progress.cx(&name, Stage::Import))?;
    drop(progress);
    say(&made.summary);
    say(&format!("rooms    {}", made.rooms));
    made.lost.iter().for_each(|lost| say(&format!("lost     {lost}")));
    made.credits.iter().for_each(|credit| say(&format!("model    {credit}")));
    say(&format!("scene    {}", args.output.display()));
    Ok(Verdict::Done)
}

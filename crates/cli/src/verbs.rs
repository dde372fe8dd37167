//! The verbs that verify, partition, inspect and replay a dataset: from arguments to calls of the pipeline and back to words.

use crate::args::{InspectArgs, PartitionArgs, ReplayArgs, VerifyArgs};
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::CameraTable;
use enfilade_export::intrinsics_csv;
use enfilade_pipeline::{Event, Reporter, Stage};
use enfilade_show::drivers::inspect_pixel;
use enfilade_show::report_card::write_report;

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
            // Other people's data may be in a folder where nothing can be written.
            Err(error) => say(&format!("warning: the card is not stored: {error}")),
        }
    }
    Ok(Verdict::of(if args.strict { report.accepted } else { report.passed }))
}

/// `partition`: which frames are for learning, validation and testing.
pub fn partition(args: &PartitionArgs) -> Result<Verdict, Problem> {
    let report = enfilade_pipeline::partition(&args.dataset, |config| {
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

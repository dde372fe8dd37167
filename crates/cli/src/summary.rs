//! The last words of a run: a table of scenes, what failed and why, and where to look.

use crate::outcome::{Problem, say};
use enfilade_dataset::{Dataset, DatasetError, counted, quoted};
use enfilade_frame::{LAYERS, Layer};
use enfilade_pipeline::{SceneOutcome, Summary};
use std::ffi::OsStr;
use std::path::Path;
use std::sync::OnceLock;

/// One line per scene on standard output, then each failure with what to do on standard error.
pub fn print_table(summary: &Summary) {
    let width = summary.scenes.iter().map(|s| s.name.len()).max().unwrap_or(0).max(5);
    say(&format!("{:width$}  result", "scene"));
    for scene in &summary.scenes {
        say(&format!("{:width$}  {}", scene.name, result_of(scene)));
    }
    for scene in &summary.scenes {
        if let Some(failure) = &scene.failure {
            Problem::of_scene(&scene.name, failure).print();
        }
    }
    summary.all_products().filter_map(Problem::of_product).for_each(|problem| problem.print());
    print_warnings(summary);
    let failed = summary.scenes.iter().filter(|s| s.failure.is_some()).count();
    if failed > 0 {
        say(&format!("{failed} of {} scenes failed.", summary.scenes.len()));
    }
}

/// Failed scenes that the last lines name.
const NAMED: usize = 3;

/// The last lines of a run that is not as it should be: which scenes failed, and why.
pub fn print_failures(summary: &Summary) {
    let failed: Vec<_> = summary.scenes.iter().filter_map(|scene| Some((&scene.name, scene.failure.as_ref()?))).collect();
    for (name, failure) in failed.iter().take(NAMED) {
        say(&format!("NOT OK: {name}: {}: {}", failure.stage.name(), failure.message));
    }
    if failed.len() > NAMED {
        say(&format!("NOT OK: and {} more scenes", failed.len() - NAMED));
    }
}

/// Prints the warnings about the dataset as a whole, one per line.
pub fn print_warnings(summary: &Summary) {
    summary.warnings.iter().for_each(|warning| say(&format!("warning: {warning}")));
}

fn result_of(scene: &SceneOutcome) -> String {
    if let Some(failure) = &scene.failure {
        return format!("FAILED in {}", failure.stage.name());
    }
    let seconds: f64 = scene.stages.iter().map(|s| s.wall_s).sum();
    let warnings: usize = scene.stages.iter().map(|s| s.warnings).sum();
    let last = scene.stages.last().map_or("", |s| s.summary.as_str());
    let up_to_date = scene.stages.iter().all(|s| s.up_to_date);
    let time = if up_to_date { "nothing to do".to_string() } else { format!("{seconds:.1} s") };
    let warned = match warnings {
        0 => String::new(),
        1 => ", 1 warning".into(),
        n => format!(", {n} warnings"),
    };
    format!("ok: {last}{warned} ({time})")
}

/// Prints what is in the dataset at `out`, and where to look first.
///
/// # Errors
/// When the dataset cannot be read.
pub fn print_where_to_look(out: &Path, summary: &Summary) -> Result<(), DatasetError> {
    let dataset = Dataset::open(out)?;
    let layout = dataset.layout();
    let (mut frames, mut sheets, mut first) = (0, Vec::new(), None);
    for scene in dataset.scenes()? {
        for camera in dataset.cameras(&scene)? {
            let numbers = dataset.frame_numbers(&scene, &camera)?;
            frames += numbers.len();
            let sheet = layout.contact_sheet(&scene, &camera);
            if sheet.is_file() {
                sheets.push(sheet);
            }
            if let (None, Some(&frame)) = (&first, numbers.first()) {
                first = Some((scene.clone(), camera, frame));
            }
        }
    }
    let Some((scene, camera, frame)) = first else { return Ok(()) };
    let layers = LAYERS.iter().filter(|spec| dataset.has_layer(&scene, &camera, frame, spec.layer)).count();
    let (out, frames) = (out.display(), counted(frames, "frame"));
    match summary.nothing_done() {
        true => say(&format!("\nNothing to do: {out} is up to date, {frames} with {layers} layers each.\n")),
        false => say(&format!("\nDone in {:.0} s: {out} holds {frames} with {layers} layers each.\n", summary.wall_s)),
    }
    let overview = (sheets.len() > 1).then(|| layout.overview()).filter(|path| path.is_file());
    for (i, sheet) in overview.iter().chain(&sheets).take(2).enumerate() {
        say(&format!("{}  {}", if i == 0 { "see at a glance" } else { "               " }, sheet.display()));
    }
    if sheets.len() > 1 {
        say(&format!("                 and a contact sheet for each of the {} trajectories", sheets.len()));
    }
    say(&format!("a frame's files  {}", layout.layer(&scene, &camera, frame, Layer::Color).display()));
    say(&format!("                 {}", layout.layer(&scene, &camera, frame, Layer::DepthMeters).display()));
    if layout.verify_page().is_file() {
        say(&format!("report card      {}", layout.verify_page().display()));
    }
    let size = dataset.read_camera(&scene, &camera).map_or([2, 2], |camera| camera.size());
    let at = format!("--scene {scene} --camera {camera} --frame {frame} --pixel {},{}", size[0] / 2, size[1] / 2);
    say(&format!("ask a pixel      {} inspect {} {at}", program(), quoted(out)));
    Ok(())
}

/// The name by which the program was called.
static CALLED: OnceLock<String> = OnceLock::new();

/// Keeps the first word of the command line, which advice begins with. Of an interpreter's process it is not the first.
pub fn called(word: &OsStr) {
    let _ = CALLED.set(word.to_string_lossy().into_owned()); // the first call counts
}

/// Name of this program in commands.
fn program() -> String {
    quoted(CALLED.get().map_or("enfilade", String::as_str))
}

/// Prints what to try after the demo.
pub fn print_after_demo() {
    let program = program();
    say(&format!("another room     {program} run --demo out2 --seed 7 --frames 8 --quality high"));
    say(&format!("rooms of yours   {program} run dataset.toml      (see examples/real-rooms/dataset.toml)"));
}

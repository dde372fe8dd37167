//! `export`: from arguments to a call of the crate `export`, and its output.

use crate::args::ExportArgs;
use crate::make::cameras;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_export::{Existing, Format, Selection, export as export_dataset};

/// `export`: the dataset in another layout.
pub fn export(args: &ExportArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    let cameras = cameras(&dataset, &scenes, args.chosen.camera.as_deref())?;
    let unknown = || Problem::new(format!("no format is named {:?}", args.format), "see `enfilade export --help`");
    let format = Format::from_name(&args.format).ok_or_else(unknown)?;
    let frames = Selection { scenes, cameras, frames: args.chosen.frames.clone(), layers: None };
    let config = args.options.options()?.config(format, frames)?;
    let existing = if args.force { Existing::SetAside } else { Existing::Refuse };
    let exported = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "export");
        export_dataset(&dataset, &config, &args.output, existing, &cx)?
    };
    let (frames, files, megabytes) = (exported.frames, exported.files, exported.bytes as f64 / 1e6);
    say(&format!("{}: {frames} frames, {files} files, {megabytes:.1} MB; its README.md says what is in it", args.output.display()));
    Ok(Verdict::Done)
}

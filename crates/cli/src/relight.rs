//! `relight`: from arguments to a call of the pipeline, and what came of it.

use crate::args::RelightArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::cameras;
use crate::progress::Progress;
use enfilade_dataset::{Dataset, counted};
use enfilade_pipeline::Relight;

/// `relight`: frames with other lamps on.
pub fn relight(args: &RelightArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = Dataset::open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    let cameras = cameras(&dataset, &scenes, args.chosen.camera.as_deref())?;
    let chosen = Relight { scenes, cameras, frames: args.chosen.frames.clone() };
    let frames = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "relight");
        enfilade_pipeline::relight(&dataset, &args.mixes, &chosen, &cx)?
    };
    if frames == 0 {
        return Err(Problem::of_data("no frame that is there was chosen", "choose others, or render them: enfilade run"));
    }
    say(&format!("{} by every mix", counted(frames, "frame")));
    say(&format!("see  {}", dataset.layout().relit_dir().display()));
    Ok(Verdict::Done)
}

//! `relight`: from arguments to a call of the pipeline, and what came of it.

use crate::args::RelightArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{chosen_frames, nothing_chosen};
use crate::progress::Progress;
use enfilade_dataset::{Dataset, counted};

/// `relight`: frames with other lamps on.
pub fn relight(args: &RelightArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = Dataset::open(&args.dataset)?;
    let chosen = chosen_frames(&dataset, &args.chosen)?;
    let frames = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "relight");
        enfilade_pipeline::relight(&dataset, &args.mixes, &chosen, &cx)?
    };
    if frames == 0 {
        return Err(nothing_chosen());
    }
    say(&format!("{} by every mix", counted(frames, "frame")));
    say(&format!("see  {}", dataset.layout().relit_dir().display()));
    Ok(Verdict::Done)
}

//! `surfaces`: from arguments to calls of the crate `multiview`, and what came of them.

use crate::args::SurfacesArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{chosen_frames, each_filmed, nothing_chosen};
use crate::progress::Progress;
use enfilade_dataset::counted;
use enfilade_multiview::write_surfaces;

/// `surfaces`: what lies along the rays of the frames.
pub fn surfaces(args: &SurfacesArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let chosen = chosen_frames(&dataset, &args.chosen)?;
    let mut lines = Vec::new();
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "surfaces");
        each_filmed(&dataset, &chosen, &cx, |scene, filmed, frames, package| {
            write_surfaces(filmed, package, frames, args.layers, &cx)?;
            lines.push(format!("{scene}: {} with up to {} surfaces per pixel", counted(frames.len(), "frame"), args.layers));
            Ok(())
        })?;
    }
    if lines.is_empty() {
        return Err(nothing_chosen());
    }
    lines.iter().for_each(|line| say(line));
    say("see  _detail/CAMERA/surfaces of each scene");
    Ok(Verdict::Done)
}

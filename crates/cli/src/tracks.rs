//! `tracks`: from arguments to calls of the crate `multiview`, and what came of them.

use crate::args::TracksArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{chosen_frames, each_filmed, nothing_chosen};
use crate::progress::Progress;
use enfilade_dataset::counted;
use enfilade_multiview::{TracksConfig, tracks as follow};

/// `tracks`: points on surfaces through the frames of each camera.
pub fn tracks(args: &TracksArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let chosen = chosen_frames(&dataset, &args.chosen)?;
    let config = TracksConfig { points: args.points, seed: args.seed };
    let mut lines = Vec::new();
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "tracks");
        each_filmed(&dataset, &chosen, &cx, |scene, filmed, frames, package| {
            let lookout = package.lookout()?;
            for frames in frames.chunk_by(|&a, &b| filmed.name(a).0 == filmed.name(b).0) {
                let camera = filmed.name(frames[0]).0;
                let found = follow(filmed, &lookout, frames, config, &cx)?;
                dataset.write_tracks(scene, camera, &found)?;
                let (points, frames) = (counted(found.positions.len(), "point"), counted(found.frames.len(), "frame"));
                lines.push(format!("{scene}/{camera}: {points} through {frames}"));
            }
            Ok(())
        })?;
    }
    if lines.is_empty() {
        return Err(nothing_chosen());
    }
    lines.iter().for_each(|line| say(line));
    say("see  _detail/CAMERA/tracks.npz of each scene");
    Ok(Verdict::Done)
}

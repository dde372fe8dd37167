//! `tracks`: from arguments to calls of the crate `multiview`, and what came of them.

use crate::args::TracksArgs;
use crate::outcome::{Problem, Verdict, say};
use crate::pairs::{cameras, package};
use crate::progress::Progress;
use enfilade_dataset::counted;
use enfilade_multiview::{Filmed, TracksConfig, tracks as follow};

/// `tracks`: points on surfaces through the frames of each camera.
pub fn tracks(args: &TracksArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = args.table.open(&args.dataset)?;
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.chosen.scene.as_deref())?;
    let cameras = cameras(&dataset, &scenes, args.chosen.camera.as_deref())?;
    let config = TracksConfig { points: args.points, seed: args.seed };
    let mut lines = Vec::new();
    {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "tracks");
        for scene in &scenes {
            let filmed = Filmed::read(&dataset, scene, cameras.as_deref(), &cx)?;
            let frames = filmed.numbered(args.chosen.frames.as_ref());
            if frames.is_empty() {
                continue;
            }
            let package = package(&dataset, scene, &filmed, &cx)?;
            let lookout = package.lookout()?;
            for frames in frames.chunk_by(|&a, &b| filmed.name(a).0 == filmed.name(b).0) {
                let camera = filmed.name(frames[0]).0;
                let found = follow(&filmed, &lookout, frames, config, &cx)?;
                dataset.write_tracks(scene, camera, &found)?;
                let (points, frames) = (counted(found.positions.len(), "point"), counted(found.frames.len(), "frame"));
                lines.push(format!("{scene}/{camera}: {points} through {frames}"));
            }
        }
    }
    if lines.is_empty() {
        return Err(Problem::of_data("no frame that is there was chosen", "choose others, or render them: enfilade run"));
    }
    lines.iter().for_each(|line| say(line));
    say("see  _detail/CAMERA/tracks.npz of each scene");
    Ok(Verdict::Done)
}

//! `make tracks`: points on surfaces through the frames of each camera.

use super::frames::{chosen_frames, each_filmed, nothing_chosen};
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, counted};
use enfilade_multiview::{TracksConfig, tracks as follow};
use enfilade_scene::Cx;

/// Follows points through the chosen frames.
pub fn tracks(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let chosen = chosen_frames(dataset, &args.chosen)?;
    let usual = TracksConfig::default();
    let config = TracksConfig { points: args.tracks.points.unwrap_or(usual.points), seed: args.tracks.seed.unwrap_or(usual.seed) };
    each_filmed(dataset, &chosen, cx, |scene, filmed, frames, package| {
        let lookout = package.lookout()?;
        for frames in frames.chunk_by(|&a, &b| filmed.name(a).0 == filmed.name(b).0) {
            let camera = filmed.name(frames[0]).0;
            let found = follow(filmed, &lookout, frames, config, cx)?;
            dataset.write_tracks(scene, camera, &found)?;
            let (points, frames) = (counted(found.positions.len(), "point"), counted(found.frames.len(), "frame"));
            lines.push(format!("{scene}/{camera}: {points} through {frames}"));
        }
        Ok(())
    })?;
    if lines.is_empty() {
        return Err(nothing_chosen());
    }
    lines.push("see  _detail/CAMERA/tracks.npz of each scene".into());
    Ok(())
}

//! `make surfaces`: every surface along the rays of frames.

use super::frames::{chosen_frames, each_filmed, nothing_chosen};
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, counted};
use enfilade_multiview::write_surfaces;
use enfilade_scene::Cx;

/// Surfaces of a pixel at most, unless another number is given.
const LAYERS: u32 = 8;

/// Writes the surfaces along the rays of the chosen frames.
pub fn surfaces(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let chosen = chosen_frames(dataset, &args.chosen)?;
    let layers = args.surfaces.layers.unwrap_or(LAYERS);
    each_filmed(dataset, &chosen, cx, |scene, filmed, frames, package| {
        write_surfaces(filmed, package, frames, layers, cx)?;
        lines.push(format!("{scene}: {} with up to {layers} surfaces per pixel", counted(frames.len(), "frame")));
        Ok(())
    })?;
    if lines.is_empty() {
        return Err(nothing_chosen());
    }
    lines.push("see  _detail/CAMERA/surfaces of each scene".into());
    Ok(())
}

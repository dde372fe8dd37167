//! `make relit`: frames with other lamps on.

use super::frames::{chosen_frames, nothing_chosen};
use crate::args::MakeArgs;
use crate::outcome::Problem;
use enfilade_dataset::{Dataset, counted};
use enfilade_scene::Cx;

/// Mixes the light of the fixtures of the chosen frames anew.
pub fn relit(args: &MakeArgs, dataset: &Dataset, lines: &mut Vec<String>, cx: &dyn Cx) -> Result<(), Problem> {
    let mixes = args.relit.mixes.as_ref().ok_or_else(|| Problem::new("no mixes are named", "give --mixes examples/mixes.csv"))?;
    let frames = enfilade_pipeline::relight(dataset, mixes, &chosen_frames(dataset, &args.chosen)?, cx)?;
    if frames == 0 {
        return Err(nothing_chosen());
    }
    lines.push(format!("{} by every mix", counted(frames, "frame")));
    lines.push(format!("see  {}", dataset.layout().relit_dir().display()));
    Ok(())
}

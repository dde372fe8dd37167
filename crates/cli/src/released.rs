//! Datasets that others made, such as Hypersim's release: which stages make no sense for them, and what to do instead.

use crate::outcome::Problem;
use enfilade_dataset::{Dataset, WORKDIR};
use enfilade_pipeline::Stage;
use std::path::Path;

/// Refuses `stage`, or a whole run, of datasets that others made: its output exists already, or its inputs do not.
pub fn refuse_released(folder: &Path, stage: Option<Stage>) -> Result<(), Problem> {
    // If the folder is no dataset, the stage reports that.
    let Ok(dataset) = Dataset::open(folder) else { return Ok(()) };
    let scenes = dataset.scenes()?;
    if scenes.is_empty() || !scenes.iter().all(|scene| dataset.is_released(scene)) || folder.join(WORKDIR).exists() {
        return Ok(());
    }
    let help = match stage {
        Some(Stage::Preview) => "its previews have the same names as ours; name another folder with -o",
        Some(Stage::Label) => "its labels are in the layers semantic and semantic_instance already; `enfilade annotate` edits label tables",
        Some(Stage::Boxes) => "its boxes are in _detail/mesh already; `enfilade export --format coco` has those of each image",
        Some(Stage::Verify) => "check it with `enfilade verify`",
        _ => "stages go with datasets that `enfilade run` made; `enfilade make`, `verify`, `stats`, `view` and `export` read this one",
    };
    Err(Problem::new(format!("{} was not made by `enfilade run`: it is Hypersim's release, or like it", folder.display()), help))
}

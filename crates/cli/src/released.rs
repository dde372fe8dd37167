//! Datasets that others made, such as Hypersim's release: which stages make no sense for them, and what to do instead.

use crate::outcome::Problem;
use enfilade_dataset::{Dataset, WORKDIR};
use enfilade_pipeline::Stage;
use std::path::Path;

/// Refuses stages of datasets that others made: what they would write is there already, or needs what is not there.
pub fn refuse_released(folder: &Path, stage: Stage) -> Result<(), Problem> {
    // Where the folder is no dataset, the stage says so.
    let Ok(dataset) = Dataset::open(folder) else { return Ok(()) };
    let scenes = dataset.scenes()?;
    if scenes.is_empty() || !scenes.iter().all(|scene| dataset.is_released(scene)) || folder.join(WORKDIR).exists() {
        return Ok(());
    }
    let help = match stage {
        Stage::Preview => "its previews have the same names as ours; name another folder with -o".to_string(),
        Stage::Label => {
            "its labels are in the layers semantic and semantic_instance already; `enfilade annotate` edits label tables".into()
        }
        Stage::Boxes => "its boxes are in _detail/mesh already; `enfilade export --format coco` has those of each image".into(),
        other => format!("`enfilade {}` goes with datasets that `enfilade run` made", other.name()),
    };
    Err(Problem::new(format!("{} was not made by `enfilade run`: it is Hypersim's release, or like it", folder.display()), help))
}

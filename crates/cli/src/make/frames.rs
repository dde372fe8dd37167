//! The cameras that a verb works on.

use crate::outcome::Problem;
use enfilade_dataset::Dataset;

/// The names of the cameras that a pattern means; `None` for all.
pub fn cameras(dataset: &Dataset, scenes: &[String], pattern: Option<&str>) -> Result<Option<Vec<String>>, Problem> {
    let Some(pattern) = pattern else { return Ok(None) };
    Ok(Some(enfilade_pipeline::select("camera", &dataset.camera_names(scenes)?, Some(pattern))?))
}

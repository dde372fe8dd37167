//! The finished frames that something is made of.

use crate::{Dataset, DatasetError};
use enfilade_scene::Cx;
use std::ops::Range;

/// Frames of a dataset, by scene, camera and number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChosenFrames {
    /// Names of scenes of the dataset.
    pub scenes: Vec<String>,
    /// Names of cameras; `None`: all.
    pub cameras: Option<Vec<String>>,
    /// Frame numbers, the upper bound excluded; `None`: all.
    pub frames: Option<Range<u32>>,
}

impl ChosenFrames {
    /// The chosen frames of a scene that are whole, by camera, without cameras that have none. `cx` is warned of those that are not whole.
    ///
    /// # Errors
    /// When the scene's cameras or the records of frames cannot be read.
    pub fn of_scene(&self, dataset: &Dataset, scene: &str, cx: &dyn Cx) -> Result<Vec<(String, Vec<u32>)>, DatasetError> {
        let is_chosen = |name: &String| self.cameras.as_ref().is_none_or(|cameras| cameras.contains(name));
        let mut found = Vec::new();
        for camera in dataset.cameras(scene)?.into_iter().filter(is_chosen) {
            let mut frames = dataset.whole_frames([scene, &camera], self.frames.as_ref(), cx)?;
            frames.retain(|frame| self.frames.as_ref().is_none_or(|range| range.contains(frame)));
            if !frames.is_empty() {
                found.push((camera, frames));
            }
        }
        Ok(found)
    }
}

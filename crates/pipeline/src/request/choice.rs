//! Which frames of a scene a request is about.

use enfilade_dataset::number_runs;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Frames of a scene, by camera and number.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameChoice {
    /// Names of cameras; `None`: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cameras: Option<Vec<String>>,
    /// Frame numbers, the upper bound excluded; `None`: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frames: Option<Range<u32>>,
}

impl FrameChoice {
    /// True when every frame of `other` is one of these.
    pub(crate) fn covers(&self, other: &Self) -> bool {
        let has_cameras = match (&self.cameras, &other.cameras) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(these), Some(those)) => those.iter().all(|name| these.contains(name)),
        };
        let has_frames = match (&self.frames, &other.frames) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(these), Some(those)) => these.start <= those.start && those.end <= these.end,
        };
        has_cameras && has_frames
    }

    /// Frames of a camera as runs of numbers.
    pub(crate) fn runs(camera: &str, numbers: &[u32]) -> impl Iterator<Item = Self> {
        let runs = number_runs(numbers.iter().copied());
        runs.into_iter().map(move |run| Self { cameras: Some(vec![camera.into()]), frames: Some(*run.start()..run.end() + 1) })
    }

    /// True when a frame is one of these.
    pub(crate) fn has(&self, camera: &str, frame: u32) -> bool {
        self.cameras.as_ref().is_none_or(|names| names.iter().any(|name| name == camera))
            && self.frames.as_ref().is_none_or(|range| range.contains(&frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_covers_what_lies_within_it() {
        let choice = |cameras: Option<&[&str]>, frames| FrameChoice {
            cameras: cameras.map(|names| names.iter().map(ToString::to_string).collect()),
            frames,
        };
        let all = FrameChoice::default();
        let one = choice(Some(&["a"]), Some(2..4));
        assert!(all.covers(&one) && !one.covers(&all) && one.covers(&one));
        assert!(choice(None, Some(0..4)).covers(&one) && !choice(Some(&["b"]), None).covers(&one));
        assert!(one.has("a", 3) && !one.has("a", 4) && !one.has("b", 3) && all.has("b", 9));
    }
}

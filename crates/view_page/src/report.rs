//! The results of the last verification: the report, and the index of each frame in it.

use super::cache::Weight;
use super::place::FramePlace;
use enfilade_verify::{FrameValues, VerifyReport};
use std::collections::HashMap;
use std::sync::Arc;

/// A report with an index of its frames.
pub struct Report {
    /// The report as it was written.
    pub report: VerifyReport,
    by_place: HashMap<FramePlace, usize>,
    bytes: usize,
}

/// The report in a file: nothing if another version wrote it.
pub struct ReportFile(pub Option<Arc<Report>>);

impl Weight for ReportFile {
    fn weight(&self) -> usize {
        self.0.as_ref().map_or(0, |report| report.bytes)
    }
}

impl Report {
    /// From the text of its file; `None` where another version wrote it.
    pub fn of(text: &[u8]) -> Option<Self> {
        let report: VerifyReport = serde_json::from_slice(text).ok()?;
        let place = |v: &FrameValues| FramePlace { scene: v.scene.clone(), camera: v.camera.clone(), frame: v.frame };
        let by_place = report.frame_values.iter().enumerate().map(|(i, values)| (place(values), i)).collect();
        Some(Self { report, by_place, bytes: text.len() })
    }

    /// The values measured in a frame.
    pub fn frame(&self, place: &FramePlace) -> Option<&FrameValues> {
        self.by_place.get(place).map(|&at| &self.report.frame_values[at])
    }
}

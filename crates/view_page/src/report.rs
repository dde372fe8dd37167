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

/// The report in a file, or why that is none: another version wrote it, or it is damaged.
pub struct ReportFile(pub Result<Arc<Report>, String>);

impl Weight for ReportFile {
    fn weight(&self) -> usize {
        self.0.as_ref().map_or(0, |report| report.bytes)
    }
}

impl Report {
    /// From the text of its file.
    ///
    /// # Errors
    /// Why the text is no report.
    pub fn of(text: &[u8]) -> Result<Self, String> {
        let report: VerifyReport = serde_json::from_slice(text).map_err(|error| error.to_string())?;
        let place = |v: &FrameValues| FramePlace { scene: v.scene.clone(), camera: v.camera.clone(), frame: v.frame };
        let by_place = report.frame_values.iter().enumerate().map(|(i, values)| (place(values), i)).collect();
        Ok(Self { report, by_place, bytes: text.len() })
    }

    /// The values measured in a frame.
    pub fn frame(&self, place: &FramePlace) -> Option<&FrameValues> {
        self.by_place.get(place).map(|&at| &self.report.frame_values[at])
    }
}

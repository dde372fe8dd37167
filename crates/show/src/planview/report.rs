//! The plan's own report of a trajectory, where planning has left one: its values are shown instead of measuring again.

use super::measure::FrameMeasures;
use serde::Deserialize;
use std::path::Path;

/// The part of `plan_report.json` that pictures show. Fields that a report lacks are empty.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Report {
    /// Requested kind of trajectory.
    pub mode: String,
    per_frame: Values,
}

/// One entry per frame each.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
struct Values {
    frame: Vec<u32>,
    score: Vec<f64>,
    void_share: Vec<f64>,
    overlap: Vec<Option<f64>>,
    clearance_m: Vec<Option<f64>>,
    height_m: Vec<Option<f64>>,
}

impl Report {
    /// The report at `path`; `None` when there is none that can be read.
    pub fn read(path: &Path) -> Option<Self> {
        serde_json::from_slice(&std::fs::read(path).ok()?).ok()
    }

    /// Replaces the measures by those of the report. Returns false and changes nothing if it is about other frames.
    pub(super) fn put_into(&self, measures: &mut [FrameMeasures]) -> bool {
        let values = &self.per_frame;
        if !measures.iter().map(|m| m.frame).eq(values.frame.iter().copied()) {
            return false;
        }
        for (i, m) in measures.iter_mut().enumerate() {
            let plain = |from: &[f64]| from.get(i).copied();
            let maybe = |from: &[Option<f64>]| from.get(i).copied().flatten();
            m.score = plain(&values.score).unwrap_or(m.score);
            m.void_share = plain(&values.void_share).unwrap_or(m.void_share);
            m.overlap = maybe(&values.overlap).or(m.overlap);
            m.clearance_m = maybe(&values.clearance_m).unwrap_or(m.clearance_m);
            m.height_m = maybe(&values.height_m).unwrap_or(m.height_m);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_replaces_what_was_measured_of_the_same_frames() {
        let text =
            r#"{"mode": "walk", "new": 1, "per_frame": {"frame": [0, 1], "score": [7.5, 8.5], "overlap": [null, 0.25], "turn_deg": []}}"#;
        let report: Report = serde_json::from_str(text).unwrap();
        let measured = |frame| FrameMeasures { frame, score: 1.0, height_m: 1.5, overlap: Some(0.5), ..FrameMeasures::default() };
        let mut measures = [measured(0), measured(1)];
        assert!(report.put_into(&mut measures));
        assert_eq!(measures[1], FrameMeasures { score: 8.5, overlap: Some(0.25), ..measured(1) });
        let mut others = [measured(0), measured(2)];
        assert!(!report.put_into(&mut others));
        assert_eq!(others[0], measured(0));
        assert_eq!(Report::read(Path::new("no such file")), None);
    }
}

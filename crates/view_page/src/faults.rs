//! Faults of a frame: the gates of planning and of verification that it does not pass. Counts of rejected frames are made from these.

use super::place::{FramePlace, problem, stamp};
use super::report::{Report, ReportFile};
use super::viewer::Viewer;
use enfilade_dataset::{DatasetError, JudgedView, ViewVerdict};
use enfilade_serve::ApiProblem;
use enfilade_verify::FrameValues;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A gate that a frame does not pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// `planning` or `verification`.
    by: &'static str,
    /// The gate's name.
    gate: String,
    /// The measure; empty if the name states it.
    measure: &'static str,
    /// The value measured; `None` if it is not a number.
    value: Option<f64>,
    /// The last good value.
    limit: f64,
    /// `at least` or `at most`; empty if the dataset does not state it.
    side: &'static str,
    /// Unit of value and limit; empty for pure numbers.
    unit: &'static str,
    /// False where the gate only reports.
    pub rejects: bool,
}

impl Fault {
    fn of_plan(view: &JudgedView) -> Option<Self> {
        let rejects = match view.verdict {
            ViewVerdict::Passed => return None,
            ViewVerdict::Rejected => true,
            ViewVerdict::Reported => false,
        };
        let (gate, value, limit) = view.fault.as_ref().map_or((String::new(), None, 0.0), |f| (f.gate.clone(), Some(f.value), f.limit));
        Some(Self { by: "planning", gate, measure: "", value, limit, side: "", unit: "", rejects })
    }

    fn of_verification(values: &FrameValues) -> impl Iterator<Item = Self> {
        values.rejected_by().map(|gate| {
            let spec = gate.spec();
            let value = values.gates.get(&gate).copied().flatten();
            let (gate, side) = (spec.name.to_string(), spec.limit.words());
            Self { by: "verification", gate, measure: spec.measure, value, limit: spec.bound, side, unit: spec.unit, rejects: true }
        })
    }
}

impl Viewer {
    /// The report of the last verification; `None` without one that can be read.
    ///
    /// # Errors
    /// 403 if it is outside of the dataset, 500 if the file cannot be read.
    pub(super) fn report(&self) -> Result<Option<Arc<Report>>, ApiProblem> {
        Ok(self.report_file()?.and_then(Result::ok))
    }

    /// The report of the last verification, or why its file is none; `None` without a file.
    ///
    /// # Errors
    /// As [`Viewer::report`].
    pub(super) fn report_file(&self) -> Result<Option<Result<Arc<Report>, String>>, ApiProblem> {
        let path = self.layout().verify_report();
        self.allow(&path)?;
        if !path.is_file() {
            return Ok(None);
        }
        let file = self.reports.get(&(), stamp(&path), || {
            let text = std::fs::read(&path).map_err(|source| problem(DatasetError::Io { action: "read", path: path.clone(), source }))?;
            Ok::<_, ApiProblem>(ReportFile(Report::of(&text).map(Arc::new)))
        })?;
        Ok(Some(file.0.clone()))
    }

    /// The faults of a camera's frames, by frame.
    ///
    /// # Errors
    /// When the table of planning's verdicts cannot be read.
    pub(super) fn faults(&self, scene: &str, camera: &str, report: Option<&Report>) -> Result<BTreeMap<u32, Vec<Fault>>, ApiProblem> {
        let mut faults: BTreeMap<u32, Vec<Fault>> = BTreeMap::new();
        let mine = |v: &&FrameValues| v.scene == scene && v.camera == camera;
        for values in report.iter().flat_map(|report| &report.report.frame_values).filter(mine) {
            faults.entry(values.frame).or_default().extend(Fault::of_verification(values));
        }
        for view in self.dataset.read_view_gates(scene, camera).map_err(problem)?.unwrap_or_default() {
            faults.entry(view.frame).or_default().extend(Fault::of_plan(&view));
        }
        faults.retain(|_, faults| !faults.is_empty());
        Ok(faults)
    }

    /// The picture of a view that planning rejected, by its path in the dataset.
    pub(super) fn rejected_picture(&self, place: &FramePlace) -> Option<String> {
        let path = self.layout().rejected_view(&place.scene, &place.camera, place.frame);
        path.is_file().then(|| self.in_dataset(&path))
    }
}

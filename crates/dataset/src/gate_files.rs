//! `metadata_view_gates.csv`: which views of a camera were found worth rendering, and why the others were not. It is beside the trajectory;
//! the rejected views keep their places in the trajectory, and have no images.

use crate::tables::Table;
use crate::{Dataset, DatasetError, check_name};
use std::collections::BTreeMap;

const HEADER: [&str; 5] = ["frame_id", "verdict", "gate", "value", "limit"];

/// The verdict on a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "plain words")]
pub enum ViewVerdict {
    Passed,
    Rejected,
    /// Has a fault, but is rendered all the same.
    Reported,
}

impl ViewVerdict {
    const ALL: [(Self, &'static str); 3] = [(Self::Passed, "passed"), (Self::Rejected, "rejected"), (Self::Reported, "reported")];

    const fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }
}

/// The fault of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewFault {
    /// Name of the gate.
    pub gate: String,
    /// The measured value.
    pub value: f64,
    /// The limit of the gate.
    pub limit: f64,
}

impl std::fmt::Display for ViewFault {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}: {:.3}, limit {}", self.gate, self.value, self.limit)
    }
}

/// A view as it was judged.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedView {
    /// Frame number.
    pub frame: u32,
    /// The verdict on the view.
    pub verdict: ViewVerdict,
    /// Worst fault of the view, unless it passed.
    pub fault: Option<ViewFault>,
}

impl Dataset {
    /// Writes the verdicts over a camera's views, and for each view one value for each of the columns `measures`.
    ///
    /// # Errors
    /// When a name cannot be part of a path, or the file cannot be written.
    pub fn write_view_gates(
        &self,
        scene: &str,
        camera: &str,
        measures: &[&str],
        views: &[(JudgedView, Vec<f64>)],
    ) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        check_name("camera name", camera)?;
        let header: Vec<&str> = HEADER.iter().chain(measures).copied().collect();
        let mut table = Table::new(&self.layout().view_gates(scene, camera), &header);
        for (view, values) in views {
            let number = |v: f64| format!("{v:.6}");
            let fault = view.fault.as_ref().map_or([String::new(), String::new(), String::new()], |fault| {
                [fault.gate.clone(), number(fault.value), fault.limit.to_string()]
            });
            let first = [view.frame.to_string(), view.verdict.name().to_string()];
            table.rows.push(first.into_iter().chain(fault).chain(values.iter().map(|v| number(*v))).collect());
        }
        table.write()
    }

    /// The verdicts over a camera's views; `None` where none were judged.
    ///
    /// # Errors
    /// When the file cannot be read or understood.
    pub fn read_view_gates(&self, scene: &str, camera: &str) -> Result<Option<Vec<JudgedView>>, DatasetError> {
        let path = self.layout().view_gates(scene, camera);
        let table = match Table::read(&path) {
            Err(error) if error.is_not_found() => return Ok(None),
            table => table?,
        };
        let at = table.columns(HEADER)?;
        let view = |row: usize| {
            let name = &table.rows[row][at[1]];
            let known = ViewVerdict::ALL.iter().find(|(_, known)| known == name);
            let problem = || format!("line {}: the verdict is {name:?}; expected passed, rejected or reported", row + 2);
            let verdict = known.ok_or_else(|| DatasetError::text(&path, problem()))?.0;
            let fault = match verdict {
                ViewVerdict::Passed => None,
                _ => Some(ViewFault {
                    gate: table.rows[row][at[2]].clone(),
                    value: table.parse(row, at[3])?,
                    limit: table.parse(row, at[4])?,
                }),
            };
            Ok(JudgedView { frame: table.parse(row, at[0])?, verdict, fault })
        };
        (0..table.rows.len()).map(view).collect::<Result<_, _>>().map(Some)
    }

    /// The views of a camera that are not rendered because a gate rejects them, by frame number.
    ///
    /// # Errors
    /// As [`Dataset::read_view_gates`].
    pub fn rejected_views(&self, scene: &str, camera: &str) -> Result<BTreeMap<u32, ViewFault>, DatasetError> {
        let views = self.read_view_gates(scene, camera)?.unwrap_or_default();
        let rejected = views.into_iter().filter(|view| view.verdict == ViewVerdict::Rejected);
        Ok(rejected.filter_map(|view| Some((view.frame, view.fault?))).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts_come_back_and_only_rejected_views_are_left_out() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        assert_eq!(dataset.read_view_gates("room", "cam_00").unwrap(), None);
        assert!(dataset.rejected_views("room", "cam_00").unwrap().is_empty());
        let fault = || Some(ViewFault { gate: "blocked".into(), value: 0.75, limit: 0.5 });
        let view = |frame, verdict, fault| (JudgedView { frame, verdict, fault }, vec![0.25, 1.0]);
        let views = [view(0, ViewVerdict::Passed, None), view(1, ViewVerdict::Rejected, fault()), view(2, ViewVerdict::Reported, fault())];
        dataset.write_view_gates("room", "cam_00", &["void_share", "depth_range_m"], &views).unwrap();
        let text = std::fs::read_to_string(dataset.layout().view_gates("room", "cam_00")).unwrap();
        assert!(text.starts_with("frame_id,verdict,gate,value,limit,void_share,depth_range_m\n0,passed,,,,0.250000,1.000000\n"), "{text}");
        let back = dataset.read_view_gates("room", "cam_00").unwrap().unwrap();
        assert_eq!(back, views.map(|(view, _)| view));
        let rejected = dataset.rejected_views("room", "cam_00").unwrap();
        assert_eq!(rejected.into_iter().collect::<Vec<_>>(), [(1, fault().unwrap())]);
    }
}

//! The report card: what verification found, law by law, gate by gate, and of every frame and pair of frames.

use super::card::{Card, Finding};
use super::frame_values::FrameValues;
use super::law::{LAWS, Law};
use super::release::{Excuse, Excused, worst_of};
use super::two_views::PairValues;
use crate::frame_gates::{GATES, Gate, Limit};
use enfilade_dataset::counted;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// The results of verification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VerifyReport {
    /// True if every checked law is satisfied, and a frame was checked.
    pub passed: bool,
    /// True when moreover no gate rejects a frame.
    pub accepted: bool,
    /// Number of scenes checked.
    pub scenes: usize,
    /// Number of frames checked.
    pub frames: usize,
    /// One entry per law that was checked, in the order of [`LAWS`].
    pub laws: Vec<LawResult>,
    /// Laws that do not apply to Hypersim's release, and its known defects; empty for our datasets.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub excused: Vec<Excused>,
    /// Notes for users of the data that are not faults; each once, for any number of scenes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// One entry per gate that was measured, in the order of [`GATES`].
    pub gates: Vec<GateResult>,
    /// One entry per frame, by scene, camera and number.
    pub frame_values: Vec<FrameValues>,
    /// One entry per pair of frames that were compared.
    pub pairs: Vec<PairValues>,
}

/// The results for one law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawResult {
    /// Which one.
    pub law: Law,
    /// The statement.
    pub statement: String,
    /// True when the worst value is within the bound.
    pub holds: bool,
    /// The worst value; `None` when it is infinite or not a number.
    pub worst: Option<f64>,
    /// The largest value that satisfies the law.
    pub bound: f64,
    /// Unit of value and bound.
    pub unit: String,
    /// Scene, camera, frame and pixel of the worst value, and what was found there.
    pub place: String,
    /// Possible causes of a violation, and what to do.
    pub meaning: String,
    /// How often it was checked.
    pub checks: u64,
}

/// The results of one gate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GateResult {
    /// Which one.
    pub gate: Gate,
    /// The measure.
    pub measure: String,
    /// Which side of the bound is good.
    pub limit: Limit,
    /// The last good value.
    pub bound: f64,
    /// Unit of value and bound.
    pub unit: String,
    /// Frames measured.
    pub measured: usize,
    /// Frames rejected.
    pub rejected: usize,
    /// The worst value; `None` when it is no number.
    pub worst: Option<f64>,
    /// Scene, camera and frame of the worst value.
    pub place: String,
}

impl VerifyReport {
    /// The report of a card over this number of scenes, with the values of all frames and pairs.
    pub(super) fn new(card: &Card, scenes: usize, frame_values: Vec<FrameValues>, pairs: Vec<PairValues>, excused: Vec<Excused>) -> Self {
        let laws: Vec<LawResult> = LAWS.iter().filter_map(|spec| Some(LawResult::new(spec.law, card.finding(spec.law)?))).collect();
        let gates: Vec<GateResult> = GATES.iter().filter_map(|spec| GateResult::new(spec.gate, &frame_values)).collect();
        let passed = !frame_values.is_empty() && laws.iter().all(|law| law.holds);
        let accepted = passed && gates.iter().all(|gate| gate.rejected == 0);
        let excused = worst_of(excused);
        Self { passed, accepted, scenes, frames: frame_values.len(), laws, excused, notes: Vec::new(), gates, frame_values, pairs }
    }

    /// The report of several, and of what a card has about the dataset as a whole.
    pub(super) fn join(reports: Vec<Self>, mut card: Card) -> Self {
        let scenes = reports.iter().map(|report| report.scenes).sum();
        let (mut frame_values, mut pairs, mut excused) = (Vec::new(), Vec::new(), Vec::new());
        let mut notes = Vec::new();
        for report in reports {
            for law in report.laws {
                card.enter(law.law, Finding { value: law.worst.unwrap_or(f64::INFINITY), place: law.place, checks: law.checks });
            }
            frame_values.extend(report.frame_values);
            pairs.extend(report.pairs);
            excused.extend(report.excused);
            notes.extend(report.notes);
        }
        Self::new(&card, scenes, frame_values, pairs, excused).with_notes(notes)
    }

    /// With what users should know, each once.
    pub(super) fn with_notes(mut self, mut notes: Vec<String>) -> Self {
        notes.sort();
        notes.dedup();
        self.notes = notes;
        self
    }

    /// The laws that are not satisfied.
    pub fn failures(&self) -> impl Iterator<Item = &LawResult> {
        self.laws.iter().filter(|law| !law.holds)
    }

    /// The frames that some gate rejects.
    pub fn rejected(&self) -> impl Iterator<Item = &FrameValues> {
        self.frame_values.iter().filter(|frame| frame.rejected_by().next().is_some())
    }

    /// One line: whether all laws are satisfied, and for what data.
    pub fn verdict(&self) -> String {
        let over = format!("over {} of {}", counted(self.frames, "frame"), counted(self.scenes, "scene"));
        match (self.frames, self.failures().count()) {
            (0, _) => format!("nothing was verified: no complete frame was found {over}"),
            (_, 0) => format!("all {} laws hold {over}", self.laws.len()),
            (_, n) => format!("{n} of {} laws fail {over}", self.laws.len()),
        }
    }

    /// One line: what does not count of Hypersim's release; `None` for datasets of ours.
    pub fn excuses(&self) -> Option<String> {
        let count = |excuse: Excuse| self.excused.iter().filter(|e| e.excuse == excuse).count();
        let (not_applicable, known) = (count(Excuse::NotApplicable), count(Excuse::KnownDefect));
        let line = format!("Hypersim's release: {not_applicable} laws do not apply to it, {known} known defects of it are named above");
        (!self.excused.is_empty()).then_some(line)
    }

    /// One line: how many frames the gates reject.
    pub fn gate_verdict(&self) -> String {
        match self.rejected().count() {
            _ if self.gates.is_empty() => "no gate was measured".into(),
            0 => "no gate rejects a frame".into(),
            n => format!("{n} of {} rejected by the gates of those who use such data", counted(self.frames, "frame")),
        }
    }

    /// The report as text for a terminal: failures first with their place and what they may mean, then one line per law and gate.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        let (mut failed, mut held): (Vec<_>, Vec<_>) = self.laws.iter().partition(|law| !law.holds);
        failed.sort_by_key(|law| law.law);
        held.sort_by_key(|law| law.law);
        for law in &failed {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{}\n        at  {}\n        may mean: {}", law.line("FAIL"), law.place, law.meaning);
        }
        for law in &held {
            let _ = writeln!(text, "{}", law.line("ok"));
        }
        for excused in &self.excused {
            let _ = writeln!(text, "{}", excused.line());
        }
        for gate in &self.gates {
            let _ = writeln!(text, "{}", gate.line());
        }
        for note in &self.notes {
            let _ = writeln!(text, "note    {note}");
        }
        let excuses = self.excuses().map_or(String::new(), |line| line + "\n");
        text + &self.verdict() + "\n" + &excuses + &self.gate_verdict() + "\n"
    }
}

impl LawResult {
    fn new(law: Law, finding: &Finding) -> Self {
        let spec = law.spec();
        Self {
            law,
            statement: spec.statement.into(),
            holds: finding.value <= spec.bound,
            worst: Some(finding.value).filter(|v| v.is_finite()),
            bound: spec.bound,
            unit: spec.unit.into(),
            place: finding.place.clone(),
            meaning: spec.meaning.into(),
            checks: finding.checks,
        }
    }

    /// Verdict, worst value, bound, unit, statement; no numbers where a law that allows none was never broken.
    fn line(&self, verdict: &str) -> String {
        let numbers = format!("{:>10}  of {:<7} {:<9}", number(self.worst), number(Some(self.bound)), self.unit);
        let numbers = if self.holds && self.bound == 0.0 { " ".repeat(numbers.len()) } else { numbers };
        format!("{verdict:<6}{numbers} {}", self.statement)
    }
}

impl Excused {
    fn line(&self) -> String {
        let verdict = match self.excuse {
            Excuse::NotApplicable => "n/a",
            Excuse::KnownDefect => "known",
        };
        let at = if self.excuse == Excuse::KnownDefect { format!("\n        at  {}", self.place) } else { String::new() };
        let worst = if self.place.is_empty() { String::new() } else { format!("{:>10}", number(self.worst)) };
        format!("{verdict:<6}{worst:>10}  {:<17} {}{at}\n        because {}", "", self.statement, self.reason)
    }
}

impl GateResult {
    /// `None` when no frame was measured.
    fn new(gate: Gate, frames: &[FrameValues]) -> Option<Self> {
        let spec = gate.spec();
        let measured: Vec<(&FrameValues, f64)> =
            frames.iter().filter_map(|frame| Some((frame, frame.gates.get(&gate)?.unwrap_or(f64::NAN)))).collect();
        // Of equal ones the first.
        let (first, value) = measured.iter().rev().max_by(|a, b| gate.excess(a.1).total_cmp(&gate.excess(b.1)))?;
        Some(Self {
            gate,
            measure: spec.measure.into(),
            limit: spec.limit,
            bound: spec.bound,
            unit: spec.unit.into(),
            measured: measured.len(),
            rejected: measured.iter().filter(|(_, value)| !gate.passes(*value)).count(),
            worst: Some(*value).filter(|v| v.is_finite()),
            place: first.place(),
        })
    }

    fn line(&self) -> String {
        let (verdict, limit) = (if self.rejected > 0 { "gate" } else { "ok" }, self.limit.words());
        let rejected = if self.rejected > 0 {
            format!("; rejects {} of {}, worst {}", self.rejected, self.measured, self.place)
        } else {
            String::new()
        };
        let name = self.gate.spec().name;
        format!("{verdict:<6}{:>10}  {limit} {} {}: {name}{rejected}", number(self.worst), number(Some(self.bound)), self.unit)
    }
}

/// A number in at most seven characters or so.
pub fn number(v: Option<f64>) -> String {
    let Some(v) = v else { return "not finite".into() };
    match v.abs() {
        0.0 => "0".into(),
        a if (1e-2..1e6).contains(&a) => {
            let text = format!("{v:.3}");
            text.trim_end_matches('0').trim_end_matches('.').to_string()
        }
        _ => format!("{v:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(values: &[(Law, f64, &str)]) -> Card {
        let mut card = Card::default();
        values.iter().for_each(|&(law, value, place)| card.observe(law, value, || place.into()));
        card
    }

    fn report(card: &Card, frames: usize) -> VerifyReport {
        VerifyReport::new(card, 1, vec![FrameValues::default(); frames], vec![], vec![])
    }

    #[test]
    fn worst_value_counts_and_the_first_of_equals() {
        let mut a = card(&[(Law::Albedo, 0.5, "a"), (Law::Albedo, 1.0, "b"), (Law::Albedo, 1.0, "c")]);
        a.merge(card(&[(Law::Albedo, 0.25, "d"), (Law::Distance, f64::NAN, "e")]));
        let report = report(&a, 2);
        let found: Vec<_> = report.laws.iter().map(|l| (l.law, l.worst, l.place.as_str(), l.checks, l.holds)).collect();
        assert_eq!(found, [(Law::Albedo, Some(1.0), "b", 4, true), (Law::Distance, None, "e", 1, false)]);
        assert_eq!(a.failures(), [Law::Distance]);
        assert!(!report.passed);
    }

    #[test]
    fn text_puts_failures_first_and_lines_up() {
        let card = card(&[(Law::Readable, 0.0, "x"), (Law::Roll, 2.25, "room/cam_00/frame.0003"), (Law::Projection, 1.5e-5, "y")]);
        let expected = "\
FAIL        2.25  of 1.0e-6  degrees   roll is within the limit of the plan, if it has one (degrees beyond it)
        at  room/cam_00/frame.0003
        may mean: poses were edited after planning: plan again
ok                                     every file can be read, and has the shape and type that its name implies
ok        1.5e-5  of 0.02    px        position projects to the centre of its own pixel
1 of 3 laws fail over 4 frames of 1 scene
no gate was measured
";
        assert_eq!(report(&card, 4).to_text(), expected);
    }

    #[test]
    fn a_gate_that_rejects_a_frame_breaks_no_law() {
        let frame = |number, depth_range| {
            let gates = [(Gate::DepthRange, Some(depth_range)), (Gate::Shading, None)];
            FrameValues { scene: "room".into(), camera: "cam_00".into(), frame: number, gates: gates.into(), ..FrameValues::default() }
        };
        let frames = vec![frame(0, 2.0), frame(1, 0.25), frame(2, 0.4)];
        let report = VerifyReport::new(&card(&[(Law::Albedo, 1.0, "x")]), 1, frames, vec![], vec![]);
        assert!(report.passed && !report.accepted);
        let found: Vec<_> = report.gates.iter().map(|g| (g.gate, g.worst, g.place.as_str(), g.rejected, g.measured)).collect();
        assert_eq!(
            found,
            [(Gate::DepthRange, Some(0.25), "room/cam_00/frame.0001", 2, 3), (Gate::Shading, None, "room/cam_00/frame.0000", 3, 3)]
        );
        let text = report.to_text();
        assert!(text.contains("gate        0.25  at least 0.5 m: depth range; rejects 2 of 3, worst room/cam_00/frame.0001\n"), "{text}");
        assert!(text.ends_with("3 of 3 frames rejected by the gates of those who use such data\n"), "{text}");
    }

    #[test]
    fn joined_reports_are_those_of_all_scenes_together() {
        let [a, b] = [card(&[(Law::Roll, 2.0, "a"), (Law::Distance, 1.0, "a")]), card(&[(Law::Roll, 3.0, "b")])];
        let mut both = a.clone();
        both.merge(b.clone());
        both.merge(card(&[(Law::PartitionWhole, 0.0, "c")]));
        let joined = VerifyReport::join(vec![report(&a, 1), report(&b, 2)], card(&[(Law::PartitionWhole, 0.0, "c")]));
        assert_eq!(joined, VerifyReport::new(&both, 2, vec![FrameValues::default(); 3], vec![], vec![]));
    }

    #[test]
    fn nothing_checked_is_not_a_pass_and_reports_survive_json() {
        let report = report(&card(&[(Law::Distance, f64::INFINITY, "x")]), 0);
        assert!(!report.passed && report.to_text().contains("no complete frame was found over 0 frames of 1 scene\n"));
        let json = serde_json::to_string(&report).unwrap();
        assert_eq!(serde_json::from_str::<VerifyReport>(&json).unwrap(), report);
    }
}

//! The card: for every law the worst value found, where, and whether that is within its bound.

use super::law::{LAWS, Law};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Collects the worst value per law.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    findings: BTreeMap<Law, Finding>,
}

/// The worst that was seen of one law.
#[derive(Clone, Debug, PartialEq)]
struct Finding {
    value: f64,
    place: String,
    checks: u64,
}

impl Card {
    /// Records one check. `place` is asked only when the value is the worst so far; of equal ones the first counts.
    pub fn observe(&mut self, law: Law, value: f64, place: impl FnOnce() -> String) {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        match self.findings.get_mut(&law) {
            None => {
                self.findings.insert(law, Finding { value, place: place(), checks: 1 });
            }
            Some(finding) => {
                finding.checks += 1;
                if value > finding.value {
                    (finding.value, finding.place) = (value, place());
                }
            }
        }
    }

    /// Records what another card found.
    pub fn merge(&mut self, other: Self) {
        for (law, found) in other.findings {
            let place = found.place;
            self.observe(law, found.value, || place);
            if let Some(finding) = self.findings.get_mut(&law) {
                finding.checks += found.checks - 1;
            }
        }
    }

    /// The laws that do not hold.
    pub fn failures(&self) -> Vec<Law> {
        self.findings.iter().filter(|(law, finding)| finding.value > law.spec().bound).map(|(&law, _)| law).collect()
    }
}

/// What verification found, law by law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VerifyReport {
    /// True when every law that was checked holds, and a frame was checked.
    pub passed: bool,
    /// Number of scenes checked.
    pub scenes: usize,
    /// Number of frames checked.
    pub frames: usize,
    /// One entry per law that was checked, in the order of [`LAWS`].
    pub laws: Vec<LawResult>,
}

/// What verification found about one law.
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
    /// What a violation may mean, and what to do.
    pub meaning: String,
    /// How often it was checked.
    pub checks: u64,
}

impl VerifyReport {
    /// The report of a card over so many scenes and frames.
    pub fn new(card: &Card, scenes: usize, frames: usize) -> Self {
        let laws: Vec<LawResult> = LAWS
            .iter()
            .filter_map(|spec| {
                let finding = card.findings.get(&spec.law)?;
                Some(LawResult {
                    law: spec.law,
                    statement: spec.statement.into(),
                    holds: finding.value <= spec.bound,
                    worst: Some(finding.value).filter(|v| v.is_finite()),
                    bound: spec.bound,
                    unit: spec.unit.into(),
                    place: finding.place.clone(),
                    meaning: spec.meaning.into(),
                    checks: finding.checks,
                })
            })
            .collect();
        Self { passed: frames > 0 && laws.iter().all(|law| law.holds), scenes, frames, laws }
    }

    /// The laws that do not hold.
    pub fn failures(&self) -> impl Iterator<Item = &LawResult> {
        self.laws.iter().filter(|law| !law.holds)
    }

    /// The report as text for a terminal: failures first with their place and what they may mean, then one line per law.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        let (mut failed, mut held): (Vec<_>, Vec<_>) = self.laws.iter().partition(|law| !law.holds);
        failed.sort_by_key(|law| law.law);
        held.sort_by_key(|law| law.law);
        for law in &failed {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{}\n        at  {}\n        may mean: {}", line(law, "FAIL"), law.place, law.meaning);
        }
        for law in &held {
            let _ = writeln!(text, "{}", line(law, "ok"));
        }
        let over = format!("over {} of {}", count(self.frames, "frame"), count(self.scenes, "scene"));
        let verdict = match (self.frames, failed.len()) {
            (0, _) => format!("nothing was verified: no complete frame was found {over}"),
            (_, 0) => format!("all {} laws hold {over}", held.len()),
            (_, n) => format!("{n} of {} laws fail {over}", self.laws.len()),
        };
        text + &verdict + "\n"
    }
}

/// Verdict, worst value, bound, unit, statement; no numbers where a law that allows none was never broken.
fn line(law: &LawResult, verdict: &str) -> String {
    let worst = law.worst.map_or("not finite".to_string(), number);
    let numbers = format!("{worst:>10}  of {:<7} {:<9}", number(law.bound), law.unit);
    let numbers = if law.holds && law.bound == 0.0 { " ".repeat(numbers.len()) } else { numbers };
    format!("{verdict:<6}{numbers} {}", law.statement)
}

/// A number in at most seven characters or so.
fn number(v: f64) -> String {
    match v.abs() {
        0.0 => "0".into(),
        a if (1e-2..1e6).contains(&a) => {
            let text = format!("{v:.3}");
            text.trim_end_matches('0').trim_end_matches('.').to_string()
        }
        _ => format!("{v:.1e}"),
    }
}

fn count(n: usize, thing: &str) -> String {
    if n == 1 { format!("1 {thing}") } else { format!("{n} {thing}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(values: &[(Law, f64, &str)]) -> Card {
        let mut card = Card::default();
        values.iter().for_each(|&(law, value, place)| card.observe(law, value, || place.into()));
        card
    }

    #[test]
    fn worst_value_counts_and_the_first_of_equals() {
        let mut a = card(&[(Law::Roll, 2.0, "a"), (Law::Roll, 4.0, "b"), (Law::Roll, 4.0, "c")]);
        a.merge(card(&[(Law::Roll, 1.0, "d"), (Law::Distance, f64::NAN, "e")]));
        let report = VerifyReport::new(&a, 1, 2);
        let found: Vec<_> = report.laws.iter().map(|l| (l.law, l.worst, l.place.as_str(), l.checks, l.holds)).collect();
        assert_eq!(found, [(Law::Roll, Some(4.0), "b", 4, true), (Law::Distance, None, "e", 1, false)]);
        assert_eq!(a.failures(), [Law::Distance]);
        assert!(!report.passed);
    }

    #[test]
    fn text_puts_failures_first_and_lines_up() {
        let card = card(&[(Law::Readable, 0.0, "x"), (Law::Roll, 7.25, "room/cam_00/frame.0003"), (Law::Projection, 1.5e-5, "y")]);
        let expected = "\
FAIL        7.25  of 5       degrees   roll stays within 5 degrees
        at  room/cam_00/frame.0003
        may mean: the camera was tilted beyond the limit: plan again
ok                                     every file can be read and has the shape and type its name promises
ok        1.5e-5  of 0.02    px        position projects to the centre of its own pixel
1 of 3 laws fail over 4 frames of 1 scene
";
        assert_eq!(VerifyReport::new(&card, 1, 4).to_text(), expected);
    }

    #[test]
    fn nothing_checked_is_not_a_pass_and_reports_survive_json() {
        let report = VerifyReport::new(&card(&[(Law::Distance, f64::INFINITY, "x")]), 1, 0);
        assert!(!report.passed && report.to_text().ends_with("no complete frame was found over 0 frames of 1 scene\n"));
        let json = serde_json::to_string(&report).unwrap();
        assert_eq!(serde_json::from_str::<VerifyReport>(&json).unwrap(), report);
    }
}

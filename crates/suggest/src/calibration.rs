//! From a score to a confidence: how often names of such a score were right in scenes that the model had not seen.
//!
//! Isotonic regression (pool adjacent violators; Zadrozny and Elkan 2002), drawn through with straight lines.

use crate::chain::best;
use crate::table::{TableError, number, read};
use crate::weights::CLASSES;

const COLUMNS: [&str; 2] = ["score", "confidence"];

/// A curve that never falls.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Scores and confidences, both rising.
    points: Vec<(f32, f32)>,
}

/// A judged name: the model's score, whether its class was right, and how much it counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// The largest probability.
    pub score: f32,
    /// Share of the weight that was right, from 0 to 1.
    pub right: f32,
    /// Weight, above 0.
    pub weight: f32,
}

impl Calibration {
    /// The identity curve.
    pub fn identity() -> Self {
        Self { points: vec![(0.0, 0.0), (1.0, 1.0)] }
    }

    /// The curve of names judged in held-out scenes, from bins of at least `bin` of the weight.
    ///
    /// # Panics
    /// When nothing was judged.
    pub fn fit(judged: &[Judged], bin: f32) -> Self {
        assert!(!judged.is_empty(), "a calibration needs names that were judged");
        let mut sorted = judged.to_vec();
        sorted.sort_by(|a, b| a.score.total_cmp(&b.score));
        // Blocks of (weight, weight · score, weight · right).
        let mut blocks: Vec<[f64; 3]> = Vec::new();
        let mean = |block: &[f64; 3], of: usize| block[of] / block[0];
        let mut open = [0.0; 3];
        for (i, one) in sorted.iter().enumerate() {
            let weight = f64::from(one.weight);
            let add = [weight, weight * f64::from(one.score), weight * f64::from(one.right)];
            open = std::array::from_fn(|k| open[k] + add[k]);
            let ends = sorted.get(i + 1).is_none_or(|next| next.score > one.score);
            if ends && (open[0] >= f64::from(bin) || i + 1 == sorted.len()) {
                blocks.push(std::mem::take(&mut open));
            }
            while let [.., before, last] = blocks.as_slice()
                && mean(before, 2) >= mean(last, 2)
            {
                let merged = std::array::from_fn(|k| before[k] + last[k]);
                blocks.truncate(blocks.len() - 2);
                blocks.push(merged);
            }
        }
        let round = |x: f64| ((x * 1000.0).round() / 1000.0) as f32;
        let mut points: Vec<(f32, f32)> = blocks.iter().map(|block| (round(mean(block, 1)), round(mean(block, 2)))).collect();
        points.dedup_by_key(|point| point.0);
        Self { points }
    }

    /// Reads `score,confidence`. `file` is what errors call it.
    ///
    /// # Errors
    /// The first row that is no pair of numbers from 0 to 1, or falls.
    pub fn parse(text: &str, file: &str) -> Result<Self, TableError> {
        let mut points: Vec<(f32, f32)> = Vec::new();
        for (line, row) in read(text, file, COLUMNS)? {
            let error = |problem: String| TableError { file: file.into(), line, problem };
            let point = (number(&row[0], "score").map_err(error)?, number(&row[1], "confidence").map_err(error)?);
            if !(0.0..=1.0).contains(&point.0) || !(0.0..=1.0).contains(&point.1) {
                return Err(error(format!("{},{} is out of range; expected numbers from 0 to 1", row[0], row[1])));
            }
            if points.last().is_some_and(|last| point.0 <= last.0 || point.1 < last.1) {
                return Err(error("scores must rise and confidences must not fall".into()));
            }
            points.push(point);
        }
        if points.is_empty() {
            return Err(TableError {
                file: file.into(),
                line: 1,
                problem: "the curve has no points; take the file as it was released".into(),
            });
        }
        Ok(Self { points })
    }

    /// The curve as text.
    pub fn to_csv(&self) -> String {
        let rows = self.points.iter().map(|(score, confidence)| format!("{score},{confidence}\n"));
        std::iter::once(format!("{}\n", COLUMNS.join(","))).chain(rows).collect()
    }

    /// Probabilities whose largest is a confidence; the others share what is left as before.
    pub(crate) fn apply(&self, probabilities: &[f32; CLASSES]) -> [f32; CLASSES] {
        let (class, score) = best(probabilities);
        let confidence = self.confidence(score);
        let factor = (1.0 - confidence) / (1.0 - score).max(f32::EPSILON);
        let mut applied = probabilities.map(|p| (p * factor).min(confidence));
        applied[class as usize - 1] = confidence;
        applied
    }

    /// The confidence of a score, both from 0 to 1. Never falls with the score; outside of the curve it is the confidence at the nearest
    /// end.
    pub fn confidence(&self, score: f32) -> f32 {
        let after = self.points.partition_point(|&(s, _)| s < score);
        match (after.checked_sub(1).map(|i| self.points[i]), self.points.get(after)) {
            (Some((s0, c0)), Some(&(s1, c1))) => c0 + (c1 - c0) * ((score - s0) / (s1 - s0)).clamp(0.0, 1.0),
            (Some((_, c)), None) | (None, Some(&(_, c))) => c,
            (None, None) => 0.0,
        }
    }
}

/// The minimum confidence from which on names are right often enough, for several shares of right ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Thresholds {
    /// Share that is right, minimum confidence, and share of the names that have it; the first rising.
    rows: Vec<(f32, f32, f32)>,
}

const THRESHOLD_COLUMNS: [&str; 3] = ["precision", "min_confidence", "coverage"];
/// Names that a threshold must rest on.
const MIN_JUDGED: usize = 100;

impl Thresholds {
    /// The thresholds for `precisions` of names judged in held-out scenes, whose scores are confidences. A precision that is not
    /// reached has none.
    pub fn find(judged: &[Judged], precisions: &[f32]) -> Self {
        let mut sorted = judged.to_vec();
        sorted.sort_by(|a, b| b.score.total_cmp(&a.score));
        let (mut right, mut weight) = (0.0, 0.0);
        let total: f64 = judged.iter().map(|one| f64::from(one.weight)).sum();
        let mut reached: Vec<(f64, f32, f64)> = Vec::new();
        for (i, one) in sorted.iter().enumerate() {
            right += f64::from(one.right * one.weight);
            weight += f64::from(one.weight);
            if i + 1 >= MIN_JUDGED && sorted.get(i + 1).is_none_or(|next| next.score < one.score) {
                reached.push((right / weight, one.score, weight / total));
            }
        }
        // Confidences are given in thousandths, rounded upwards.
        let row = |&precision: &f32| {
            let min = reached.iter().rfind(|(share, ..)| *share >= f64::from(precision))?;
            Some((precision, (min.1 * 1000.0).ceil() / 1000.0, (min.2 as f32 * 1000.0).round() / 1000.0))
        };
        Self { rows: precisions.iter().filter_map(row).collect() }
    }

    /// Reads `precision,min_confidence,coverage`. `file` is what errors call it.
    ///
    /// # Errors
    /// The first row that is not three numbers from 0 to 1, or whose precision does not rise.
    pub fn parse(text: &str, file: &str) -> Result<Self, TableError> {
        let mut rows: Vec<(f32, f32, f32)> = Vec::new();
        for (line, row) in read(text, file, THRESHOLD_COLUMNS)? {
            let error = |problem: String| TableError { file: file.into(), line, problem };
            let value = |i: usize| number(&row[i], THRESHOLD_COLUMNS[i]).map_err(error);
            let found = (value(0)?, value(1)?, value(2)?);
            if [found.0, found.1, found.2].iter().any(|x| !(0.0..=1.0).contains(x)) {
                return Err(error(format!("{} is out of range; expected numbers from 0 to 1", row.join(","))));
            }
            if rows.last().is_some_and(|last| found.0 <= last.0) {
                return Err(error("precisions must rise".into()));
            }
            rows.push(found);
        }
        Ok(Self { rows })
    }

    /// The thresholds as text.
    pub fn to_csv(&self) -> String {
        let rows = self.rows.iter().map(|(precision, confidence, coverage)| format!("{precision},{confidence},{coverage}\n"));
        std::iter::once(format!("{}\n", THRESHOLD_COLUMNS.join(","))).chain(rows).collect()
    }

    /// The minimum confidence for `precision`, by the first listed precision that is not below it; `None` where there is none.
    pub fn min_confidence(&self, precision: f32) -> Option<f32> {
        self.rows.iter().find(|row| row.0 >= precision).map(|row| row.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(score: f32, right: bool) -> Judged {
        Judged { score, right: f32::from(u8::from(right)), weight: 1.0 }
    }

    #[test]
    fn the_curve_is_the_share_that_was_right_and_never_falls() {
        let judged: Vec<Judged> = (0..1000).map(|i| one(i as f32 / 1000.0, i % 10 < i / 100)).collect();
        let curve = Calibration::fit(&judged, 50.0);
        for score in [0.15, 0.45, 0.75] {
            assert!((curve.confidence(score) - score).abs() < 0.07, "{score}: {}", curve.confidence(score));
        }
        let values: Vec<f32> = (0..=100).map(|i| curve.confidence(i as f32 / 100.0)).collect();
        assert!(values.is_sorted());
        let fell = Calibration::fit(&[one(0.2, true), one(0.8, false)], 1.0);
        assert_eq!([fell.confidence(0.0), fell.confidence(1.0)], [0.5, 0.5]);
    }

    #[test]
    fn thresholds_are_where_enough_is_right() {
        let judged: Vec<Judged> = (0..1000).map(|i| one(i as f32 / 1000.0, i >= 500)).collect();
        let thresholds = Thresholds::find(&judged, &[0.5, 0.8, 1.0]);
        let near = |precision: f32, expected: f32| (thresholds.min_confidence(precision).unwrap() - expected).abs() < 0.002;
        assert!(near(0.5, 0.0) && near(0.8, 0.375) && near(0.7, 0.375) && near(1.0, 0.5), "{thresholds:?}");
        assert_eq!(Thresholds::parse(&thresholds.to_csv(), "t"), Ok(thresholds));
        assert_eq!(Thresholds::find(&judged[..500], &[0.9]).min_confidence(0.9), None);
        let message = |text: &str| Thresholds::parse(text, "t.csv").unwrap_err().to_string();
        assert!(message("precision,min_confidence,coverage\n0.9,0.5,0.1\n0.9,0.6,0.1\n").contains("t.csv:3: precisions must rise"));
    }

    #[test]
    fn what_is_written_is_read_and_damage_is_told() {
        let curve = Calibration::parse("score,confidence\n0.1,0.2\n0.9,0.8\n", "c.csv").unwrap();
        assert_eq!(Calibration::parse(&curve.to_csv(), "c.csv"), Ok(curve.clone()));
        assert!((curve.confidence(0.5) - 0.5).abs() < 1e-6);
        let message = |text: &str| Calibration::parse(text, "c.csv").unwrap_err().to_string();
        assert_eq!(message("score,confidence\n0.5,0.5\n0.6,0.4\n"), "c.csv:3: scores must rise and confidences must not fall");
        assert_eq!(message("score,confidence\n0.5,x\n"), "c.csv:2: confidence \"x\" is no finite number");
        assert!(message("score,confidence\n").contains("no points"));
        assert!(message("score,confidence\n0.5,1.5\n").contains("c.csv:2: 0.5,1.5 is out of range"));
    }
}

//! The numbers of an operation over time, between samples as USD has them: linear, quaternions along the shortest way.
//!
//! USD takes the numbers of matrices one by one, which squeezes what turns between two samples. Where both have the same scale and shear,
//! the rotation is taken along the shortest way instead.

use super::operation::{Kind, quaternion};
use super::stage::OverTime;
use super::value::Value;
use crate::motion::{MOST_STATES, between_placements, turns};
use enfilade_math::{DAffine3, DMat3};

/// Numbers over time; `None` where a sample says that there is no value.
pub(super) struct Curve {
    /// Time codes of the stage, ascending; empty where nothing changes.
    codes: Vec<f64>,
    values: Vec<Option<Vec<f64>>>,
}

impl Curve {
    /// The values of an operation; `None` where they are not of its kind, or not finite.
    pub(super) fn read(values: &OverTime, kind: Kind) -> Option<Self> {
        let numbers = |value: &Value| match value {
            Value::Block => Some(None),
            value => {
                value.as_numbers(kind.width())?.get(..kind.width()).filter(|n| n.iter().all(|v| v.is_finite())).map(|n| Some(n.to_vec()))
            }
        };
        let (samples, retiming) = match values {
            OverTime::Constant(value) => return Some(Self { codes: Vec::new(), values: vec![numbers(value)?] }),
            OverTime::Sampled(samples, retiming) => (samples, *retiming),
        };
        let all: Vec<Option<Vec<f64>>> = samples.values.iter().map(numbers).collect::<Option<_>>()?;
        if !samples.vary() || all.len() < samples.codes.len() {
            return Some(Self { codes: Vec::new(), values: all.into_iter().take(1).collect() });
        }
        let mut codes: Vec<f64> = samples.codes.iter().map(|code| retiming.of(*code)).collect();
        let mut values = all;
        // Time may run backwards.
        if retiming.scale < 0.0 {
            codes.reverse();
            values.reverse();
        }
        Some(Self { codes, values })
    }

    /// The transform at a time code of the stage; of rest, the first sample, without one.
    pub(super) fn at(&self, code: Option<f64>, kind: Kind) -> DAffine3 {
        let matrix = |i: usize| self.values[i].as_ref().map_or(DAffine3::IDENTITY, |numbers| kind.matrix(numbers));
        let Some(code) = code else { return matrix(0) };
        let after = self.codes.partition_point(|&known| known <= code);
        if after == 0 || after >= self.codes.len() {
            return matrix(after.saturating_sub(1).min(self.values.len() - 1));
        }
        let (from, to) = (self.codes[after - 1], self.codes[after]);
        let share = (code - from) / (to - from);
        match (&self.values[after - 1], &self.values[after]) {
            (Some(a), Some(b)) if share > 0.0 => between(a, b, share, kind),
            _ => matrix(after - 1),
        }
    }

    /// The time codes of the samples, and such that no turn between two is longer than a sixth.
    pub(super) fn codes(&self, kind: Kind) -> Vec<f64> {
        let mut codes = self.codes.clone();
        for (at, values) in self.codes.windows(2).zip(self.values.windows(2)) {
            let [Some(a), Some(b)] = values else { continue };
            // More than that are refused anyway.
            if codes.len() > MOST_STATES {
                break;
            }
            codes.extend(turns(at[0], at[1], turn_deg(a, b, kind)));
        }
        codes
    }
}

/// By how much an operation turns between two samples, at most.
fn turn_deg(a: &[f64], b: &[f64], kind: Kind) -> f64 {
    match kind {
        Kind::RotateAbout(_) | Kind::Rotate(_) => a.iter().zip(b).map(|(a, b)| (b - a).abs()).sum(),
        _ => 0.0,
    }
}

fn between(a: &[f64], b: &[f64], share: f64, kind: Kind) -> DAffine3 {
    match kind {
        Kind::Orient => {
            let [a, b] = [a, b].map(|q| quaternion([q[0], q[1], q[2], q[3]]));
            DAffine3::from_mat3(DMat3::from_quat(a.slerp(b, share)))
        }
        Kind::Matrix => between_placements(&kind.matrix(a), &kind.matrix(b), share),
        _ => kind.matrix(&a.iter().zip(b).map(|(a, b)| a + (b - a) * share).collect::<Vec<f64>>()),
    }
}

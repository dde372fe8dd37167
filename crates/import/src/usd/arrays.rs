//! Arrays of numbers over time, such as the points of a mesh.

use super::operation::quaternion;
use super::stage::{OverTime, Prim};
use super::value::Value;
use std::borrow::Cow;
use std::rc::Rc;

/// Arrays at time codes of the stage, of as many numbers each. Between two, numbers change evenly, as in USD.
pub(super) struct Arrays {
    /// Ascending; one where nothing changes.
    codes: Vec<f64>,
    values: Vec<Rc<Vec<f64>>>,
}

impl Arrays {
    /// The arrays of an attribute whose elements have `width` numbers; `None` where it has none, or a first one of another kind. Where later
    /// ones are of another kind or length, or were too large to be kept, the first holds at all times; besides, whether that is so.
    pub(super) fn read(prim: &Prim, attribute: &str, width: usize) -> Option<(Self, bool)> {
        let numbers = |value: &Value| match value {
            Value::Numbers(numbers) if numbers.width == width && numbers.data.iter().all(|v| v.is_finite()) => Some(numbers.data.clone()),
            _ => None,
        };
        let (samples, retiming) = match prim.over_time(attribute)? {
            OverTime::Constant(value) => return Some((Self { codes: vec![0.0], values: vec![numbers(value)?] }, false)),
            OverTime::Sampled(samples, retiming) => (samples, retiming),
        };
        let first = numbers(samples.values.first()?)?;
        let all: Option<Vec<_>> = samples.values.iter().map(|value| numbers(value).filter(|v| v.len() == first.len())).collect();
        let Some(mut values) = all.filter(|all| all.len() == samples.codes.len()) else {
            return Some((Self { codes: vec![0.0], values: vec![first] }, true));
        };
        let mut codes: Vec<f64> = samples.codes.iter().map(|code| retiming.of(*code)).collect();
        // Time may run backwards.
        if retiming.scale < 0.0 {
            codes.reverse();
            values.reverse();
        }
        Some((Self { codes, values }, false))
    }

    /// The time codes at which it changes its pace; none where nothing changes.
    pub(super) fn codes(&self) -> &[f64] {
        if self.values.windows(2).all(|pair| pair[0] == pair[1]) { &[] } else { &self.codes }
    }

    /// The first array.
    pub(super) fn first(&self) -> &[f64] {
        &self.values[0]
    }

    /// The array at a time code; the first one without.
    pub(super) fn at(&self, code: Option<f64>) -> Cow<'_, [f64]> {
        match self.around(code) {
            (before, _, 0.0) => Cow::Borrowed(before),
            (before, after, share) => Cow::Owned(before.iter().zip(after).map(|(a, b)| a + (b - a) * share).collect()),
        }
    }

    /// The array of quaternions, real parts first, at a time code: each turns the shortest way, and is of unit length.
    pub(super) fn quaternions_at(&self, code: Option<f64>) -> Vec<[f64; 4]> {
        let (before, after, share) = self.around(code);
        let pairs = before.as_chunks::<4>().0.iter().zip(after.as_chunks::<4>().0);
        let turned = pairs.map(|(a, b)| quaternion(*a).slerp(quaternion(*b), share));
        turned.map(|q| [q.w, q.x, q.y, q.z]).collect()
    }

    /// The arrays before and after a time code, and the share of the way from one to the other.
    fn around(&self, code: Option<f64>) -> (&[f64], &[f64], f64) {
        let last = self.codes.len() - 1;
        let after = code.map_or(0, |code| self.codes.partition_point(|&known| known <= code));
        let before = after.saturating_sub(1);
        let share = match code {
            Some(code) if (1..=last).contains(&after) => (code - self.codes[before]) / (self.codes[after] - self.codes[before]),
            _ => 0.0,
        };
        (&self.values[before], &self.values[after.min(last)], share)
    }
}

//! The share of each class in a frame.

use super::cache::Weight;
use serde::Serialize;
use std::collections::BTreeMap;

/// Share of the pixels of each class that is seen; -1 is what has none.
#[derive(Debug, Default, Serialize)]
#[serde(transparent)]
pub(super) struct Shares(BTreeMap<i16, f64>);

impl Shares {
    /// The shares of the classes of a frame's pixels.
    pub fn of(classes: &[i16]) -> Self {
        let mut pixels = vec![0u32; 1 << 16];
        classes.iter().for_each(|&class| pixels[usize::from(class.cast_unsigned())] += 1);
        let share = |class: u16| f64::from(pixels[usize::from(class)]) / classes.len() as f64;
        let seen = (0..=u16::MAX).filter(|&class| pixels[usize::from(class)] > 0);
        Self(seen.map(|class| (class.cast_signed(), share(class))).collect())
    }

    /// The classes that are seen.
    pub fn classes(&self) -> impl Iterator<Item = i16> + '_ {
        self.0.keys().copied()
    }
}

impl Weight for Shares {
    fn weight(&self) -> usize {
        self.0.len() * size_of::<(i16, f64)>()
    }
}

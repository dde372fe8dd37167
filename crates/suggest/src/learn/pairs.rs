//! The weight of names around a part, learned from Hypersim's names of two: `sofa leg` corresponds to a *leg* in a *sofa* in a hierarchy,
//! and people have labelled it.
//!
//! Hypersim's scenes have no hierarchy, but a tenth of its names have a thing first and then a detail: its piece, a separate thing
//! (`ceiling lamp`), a form or a material. Both halves are classified separately; the share of each [`Inner`] is the one under which the
//! labels are likeliest (expectation maximisation of a mixture of two).

use super::groups::NameGroup;
use crate::chain::{Inner, Level, Shares, best, mix};
use crate::roles::Role;
use crate::weights::CLASSES;

/// Steps of expectation maximisation.
const STEPS: usize = 100;
/// Pairs of each kind that are taken as half shared before any is seen.
const PRIOR: f32 = 1.0;

/// A name of two halves, as classified by models that have not seen it.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Index of its group.
    pub group: usize,
    /// Probabilities by the part's own half of the name, whose largest is a confidence.
    inner: Level,
    /// Probabilities by what is around the part.
    outer: Level,
}

impl Pair {
    pub(crate) fn new(group: usize, inner: (Role, [f32; CLASSES]), outer: (Role, [f32; CLASSES])) -> Self {
        let level = |(role, probabilities)| Level { role, probabilities };
        Self { group, inner: level(inner), outer: level(outer) }
    }

    /// Kind of the inner half; `None` for a thing.
    pub fn kind(&self) -> Option<Inner> {
        Inner::of(&self.inner.role, self.inner.best().1, self.outer.best().0)
    }

    /// The likeliest class by the own half alone, and its confidence.
    pub fn by_inner(&self) -> (i16, f32) {
        self.inner.best()
    }

    /// The likeliest class by both, and its confidence.
    pub fn by_both(&self, shares: &Shares) -> (i16, f32) {
        best(&mix(&[self.inner.clone(), self.outer.clone()], shares).0)
    }
}

/// The shares under which the labels of these pairs' groups are likeliest.
pub fn learn_shares<'a>(pairs: impl Iterator<Item = &'a Pair>, groups: &[NameGroup]) -> Shares {
    let mut seen: [Vec<(f32, f32, f32)>; Inner::ALL.len()] = Default::default();
    for pair in pairs {
        let (group, Some(kind)) = (&groups[pair.group], pair.kind()) else { continue };
        for (&class, &n) in group.classes.range(1..) {
            let at = class as usize - 1;
            let weight = n as f32 / group.labelled() as f32;
            seen[kind as usize].push((pair.inner.probabilities[at], pair.outer.probabilities[at], weight));
        }
    }
    Shares::new(seen.map(|likelihoods| {
        let mut share = 0.5;
        for _ in 0..STEPS {
            let of_outer = |&(inner, outer, weight): &(f32, f32, f32)| {
                weight * share * outer / ((1.0 - share) * inner + share * outer).max(f32::MIN_POSITIVE)
            };
            let total: f32 = likelihoods.iter().map(|one| one.2).sum();
            share = (likelihoods.iter().map(of_outer).sum::<f32>() + 0.5 * PRIOR) / (total + PRIOR);
        }
        share
    }))
}

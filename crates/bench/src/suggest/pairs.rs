//! Pairs of names, of a thing and a part in it: accuracy by the inner name alone, by both joined, and by the inner one within the other.

use enfilade_suggest::chain::Inner;
use enfilade_suggest::learn::{HeldOut, NameGroup};

/// The measurements of pairs of a kind.
pub struct OfKind {
    /// Kind of the inner name; none for a thing.
    pub kind: Option<Inner>,
    /// Pairs.
    pub pairs: usize,
    /// Share whose class is right by the inner name alone.
    pub inner: f64,
    /// Share whose class is right by both joined to one name.
    pub joined: f64,
    /// Share whose class is right by the inner name among the other.
    pub both: f64,
    /// Mean confidence of the last.
    pub confidence: f64,
    /// Pairs whose confidence is enough for a precision of 90 %, and the share of them that is right.
    pub sure: (usize, f64),
}

/// Every kind that occurs.
pub fn measure(held_out: &HeldOut, groups: &[NameGroup], threshold: f32) -> Vec<OfKind> {
    std::iter::once(None).chain(Inner::ALL.map(Some)).filter_map(|kind| of_kind(kind, held_out, groups, threshold)).collect()
}

fn of_kind(kind: Option<Inner>, held_out: &HeldOut, groups: &[NameGroup], threshold: f32) -> Option<OfKind> {
    let pairs: Vec<_> = held_out.pairs.iter().zip(&held_out.by_both).filter(|(pair, _)| pair.kind() == kind).collect();
    let right = |group: usize, class: i16| groups[group].of_class(class) as f64 / groups[group].labelled() as f64;
    let n = pairs.len();
    let mean = |of: &dyn Fn(usize) -> f64| (0..n).map(of).sum::<f64>() / n as f64;
    let joined = |group: usize| held_out.suggestions[group].as_ref().map_or(0.0, |s| right(group, s.class));
    let sure: Vec<f64> = pairs.iter().filter(|(_, both)| both.1 >= threshold).map(|(pair, both)| right(pair.group, both.0)).collect();
    (n > 0).then(|| OfKind {
        kind,
        pairs: n,
        inner: mean(&|i| right(pairs[i].0.group, pairs[i].0.by_inner().0)),
        joined: mean(&|i| joined(pairs[i].0.group)),
        both: mean(&|i| right(pairs[i].0.group, pairs[i].1.0)),
        confidence: mean(&|i| f64::from(pairs[i].1.1)),
        sure: (sure.len(), sure.iter().sum::<f64>() / sure.len().max(1) as f64),
    })
}

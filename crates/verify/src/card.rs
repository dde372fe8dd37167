//! The card: for every law the worst value found, and where.

use super::law::Law;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Collects the worst value per law.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    findings: BTreeMap<Law, Finding>,
}

/// The worst that was seen of one law, where, and how often it was checked.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Finding {
    pub value: f64,
    pub place: String,
    pub checks: u64,
}

impl Card {
    /// Records one check. `place` is asked only when the value is the worst so far; of equal ones the first counts.
    pub fn observe(&mut self, law: Law, value: f64, place: impl FnOnce() -> String) {
        if let Some(worst) = self.count(law, if value.is_nan() { f64::INFINITY } else { value }) {
            worst.place = place();
        }
    }

    /// The finding with one more check in it, if this value is the worst so far.
    fn count(&mut self, law: Law, value: f64) -> Option<&mut Finding> {
        match self.findings.entry(law) {
            Entry::Vacant(none) => Some(none.insert(Finding { value, place: String::new(), checks: 1 })),
            Entry::Occupied(known) => {
                let finding = known.into_mut();
                finding.checks += 1;
                (value > finding.value).then(|| {
                    finding.value = value;
                    finding
                })
            }
        }
    }

    /// Records what another card found.
    pub fn merge(&mut self, other: Self) {
        other.findings.into_iter().for_each(|(law, found)| self.enter(law, found));
    }

    /// Puts a finding on the card as if it were made here.
    pub(super) fn enter(&mut self, law: Law, found: Finding) {
        self.observe(law, found.value, || found.place);
        if let Some(finding) = self.findings.get_mut(&law) {
            finding.checks += found.checks - 1;
        }
    }

    /// Takes a finding off the card.
    pub(super) fn take(&mut self, law: Law) -> Option<Finding> {
        self.findings.remove(&law)
    }

    /// Takes a finding off the card if the law is not satisfied.
    pub(super) fn take_failure(&mut self, law: Law) -> Option<Finding> {
        let fails = self.findings.get(&law).is_some_and(|finding| finding.value > law.spec().bound);
        fails.then(|| self.take(law)).flatten()
    }

    /// The finding for a law, if it was checked.
    pub(super) fn finding(&self, law: Law) -> Option<&Finding> {
        self.findings.get(&law)
    }

    /// The laws that are not satisfied.
    pub fn failures(&self) -> Vec<Law> {
        self.findings.iter().filter(|(law, finding)| finding.value > law.spec().bound).map(|(&law, _)| law).collect()
    }
}

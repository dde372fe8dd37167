//! On which machines of a price table a job's attempts could have run, and what they would have cost there.
//!
//! An attempt fits a machine by the memory that it was measured to take and by its threads, so that it would have taken the same time
//! there; the whole machine is paid for that time. The memory that an attempt took counts, also if it was asked to end. An attempt that was
//! killed has not recorded its memory, and is left out.

use crate::AttemptRecord;
use enfilade_dataset::{Price, smallest_feasible};
use serde::Serialize;
use std::collections::BTreeMap;

/// A job on the smallest machines.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Feasible {
    /// Maximum threads and peak memory, bytes, of an attempt.
    pub threads: u32,
    /// See `threads`.
    pub peak_memory_bytes: u64,
    /// The smallest machine that has both; `None` when the table has none as large.
    pub for_all: Option<String>,
    /// Dollars of all attempts there.
    pub for_all_dollars: f64,
    /// Number of attempts by the smallest machine of each.
    pub machines: BTreeMap<String, u32>,
    /// Dollars of the attempts on the smallest machine of each.
    pub dollars: f64,
    /// Attempts that no machine of the table has room for.
    pub too_large: u32,
    /// Attempts of unknown memory.
    pub unknown: u32,
}

/// The smallest machine that could have run an attempt; `None` when the attempt has not recorded its memory, or no machine has enough.
pub(crate) fn machine_of<'a>(record: &AttemptRecord, prices: &'a [Price]) -> Option<&'a Price> {
    smallest_feasible(prices, record.threads, record.peak_memory_bytes?)
}

/// The feasible machines for the attempts of a job, from a price table with sizes.
pub(crate) fn feasible<'a>(records: impl Iterator<Item = &'a AttemptRecord> + Clone, prices: &[Price]) -> Feasible {
    let told = records.clone().filter_map(|record| Some((record, record.peak_memory_bytes?)));
    let mut found = Feasible { unknown: records.filter(|record| record.peak_memory_bytes.is_none()).count() as u32, ..Feasible::default() };
    let paid = |price: &Price, record: &AttemptRecord| price.whole_machine_dollars(record.wall_s).unwrap_or(0.0);
    for (record, peak_bytes) in told.clone() {
        found.threads = found.threads.max(record.threads);
        found.peak_memory_bytes = found.peak_memory_bytes.max(peak_bytes);
        match machine_of(record, prices) {
            Some(price) => {
                *found.machines.entry(price.name.clone()).or_default() += 1;
                found.dollars += paid(price, record);
            }
            None => found.too_large += 1,
        }
    }
    if let Some(price) = smallest_feasible(prices, found.threads, found.peak_memory_bytes) {
        found.for_all = Some(price.name.clone());
        found.for_all_dollars = told.map(|(record, _)| paid(price, record)).sum();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attempt, Ended};
    use enfilade_dataset::Machine;

    const GIB: u64 = 1 << 30;

    fn record(threads: u32, wall_s: f64, peak_memory_bytes: Option<u64>) -> AttemptRecord {
        AttemptRecord {
            attempt: Attempt { id: "a".into(), host: "n1".into(), engine: BTreeMap::new() },
            task: 0,
            wall_s,
            cpu_s: 0.0,
            threads,
            peak_memory_bytes,
            committed: 1,
            lost: 0,
            different: 0,
            broken: std::collections::BTreeMap::new(),
            ended: peak_memory_bytes.map(|_| Ended::Done),
            error: None,
        }
    }

    fn offer(name: &str, dollars_per_vcpu_hour: f64, vcpus: u32, memory_gib: f64) -> Price {
        Price { machine: Some(Machine { vcpus, memory_gib }), ..Price::new(name, dollars_per_vcpu_hour) }
    }

    #[test]
    fn every_attempt_has_its_smallest_machine_and_the_whole_machine_is_paid() {
        let prices = [offer("small", 0.1, 2, 4.0), offer("large", 0.2, 8, 32.0)];
        let records = [record(2, 3600.0, Some(GIB)), record(1, 1800.0, Some(5 * GIB)), record(2, 0.0, None)];
        let found = feasible(records.iter(), &prices);
        assert_eq!(found.machines, BTreeMap::from([("small".to_string(), 1), ("large".to_string(), 1)]));
        // An hour of two vCPUs, and half an hour of eight.
        assert!((found.dollars - (0.2 + 0.8)).abs() < 1e-12);
        assert_eq!((found.for_all.as_deref(), found.threads, found.peak_memory_bytes), (Some("large"), 2, 5 * GIB));
        assert!((found.for_all_dollars - (1.6 + 0.8)).abs() < 1e-12);
        assert_eq!((found.too_large, found.unknown), (0, 1));
    }

    #[test]
    fn what_no_machine_has_room_for_is_told() {
        let prices = [offer("small", 0.1, 2, 4.0)];
        let records = [record(2, 3600.0, Some(4 * GIB)), record(4, 3600.0, Some(GIB)), record(1, 3600.0, Some(GIB))];
        let found = feasible(records.iter(), &prices);
        assert_eq!((found.too_large, found.for_all, found.machines.len()), (2, None, 1), "the system needs memory too");
        assert_eq!(machine_of(&records[0], &prices), None);
    }
}

//! The smallest machine of a price table that could have done some work, like Hypersim's `min_feasible_instance_type`.
//!
//! A machine could have done it in the same time when it has a vCPU for every thread, and memory for what the process had at most and
//! for the system beside it. The smallest has the fewest vCPUs, then the least memory, then the lowest price.

use crate::price::{Machine, Price};

/// Bytes of a gibibyte.
const GIB: f64 = 1_073_741_824.0;
/// Memory that a machine's system keeps for itself, GiB; `farm submit` asks engines for as much beside the program's own.
const SYSTEM_GIB: f64 = 0.5;

/// The smallest machine with room for `threads` and for a process of `peak_bytes`; `None` when none is as large, or no size is given.
pub fn smallest_feasible(prices: &[Price], threads: u32, peak_bytes: u64) -> Option<&Price> {
    let fits = |machine: &Machine| machine.vcpus >= threads && machine.memory_gib >= memory_gib(peak_bytes);
    let sized = prices.iter().filter_map(|price| Some((price.machine.filter(fits)?, price)));
    let order = |(machine, price): &(Machine, &Price)| (machine.vcpus, machine.memory_gib, price.all_per_vcpu_hour());
    sized.min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(std::cmp::Ordering::Equal)).map(|(_, price)| price)
}

/// Memory that a machine needs for a process of `peak_bytes`, GiB.
pub fn memory_gib(peak_bytes: u64) -> f64 {
    peak_bytes as f64 / GIB + SYSTEM_GIB
}

/// True when the table includes the size of any machine.
pub fn tells_sizes(prices: &[Price]) -> bool {
    prices.iter().any(|price| price.machine.is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(name: &str, dollars_per_vcpu_hour: f64, vcpus: u32, memory_gib: f64) -> Price {
        Price { machine: Some(Machine { vcpus, memory_gib }), ..Price::new(name, dollars_per_vcpu_hour) }
    }

    #[test]
    fn the_smallest_machine_has_the_threads_the_memory_and_the_lowest_price() {
        let table = [
            offer("large", 0.05, 8, 64.0),
            offer("small", 0.05, 2, 4.0),
            offer("small spot", 0.02, 2, 4.0),
            offer("lean", 0.04, 4, 8.0),
            offer("rich", 0.06, 4, 32.0),
            Price::new("of no size", 0.001),
        ];
        let gib = |gib: f64| (gib * GIB) as u64;
        let smallest = |threads, peak| smallest_feasible(&table, threads, peak).map(|price| price.name.as_str());
        assert_eq!(smallest(1, gib(1.0)), Some("small spot"));
        assert_eq!(smallest(2, gib(3.5)), Some("small spot"), "memory and the system's part fill it");
        assert_eq!(smallest(2, gib(3.6)), Some("lean"));
        assert_eq!(smallest(4, gib(8.0)), Some("rich"));
        assert_eq!(smallest(5, gib(1.0)), Some("large"));
        assert_eq!((smallest(9, 0), smallest(1, gib(64.0))), (None, None));
        assert_eq!(smallest_feasible(&table[5..], 1, 0), None);
        assert!(tells_sizes(&table) && !tells_sizes(&table[5..]));
    }
}

//! Sets of task numbers as engines and people write them: `0-3`, `1,5,9-12`, or `1-9:2` for every other one.

use crate::FarmError;
use enfilade_dataset::{parse_number_ranges, print_number_ranges};
use std::collections::BTreeSet;

/// A set of task numbers.
pub type Ranges = BTreeSet<u32>;

/// Reads numbers and ranges, both ends included, the latter also in steps.
///
/// # Errors
/// When the text is something else.
pub fn parse_ranges(text: &str) -> Result<Ranges, FarmError> {
    parse_number_ranges(text).map_err(|part| {
        FarmError::Request(format!("{part:?} is no range of task numbers; expected something like 7, 0-3, 0-8:2 or 1,5,9-12"))
    })
}

/// The shortest text that [`parse_ranges`] reads as `numbers`; empty for none.
pub fn print_ranges(numbers: &Ranges) -> String {
    print_number_ranges(numbers.iter().copied(), ",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_come_back() {
        for text in ["", "7", "0-3", "1,5,9-12"] {
            assert_eq!(print_ranges(&parse_ranges(text).unwrap()), text);
        }
        assert_eq!(print_ranges(&parse_ranges(" 3, 1-2 ,2,").unwrap()), "1-3");
        assert_eq!(print_ranges(&parse_ranges("1-7:3,9, 20-23 : 2").unwrap()), "1,4,7,9,20,22");
        for wrong in ["x", "3-1", "-1", "1-4000000000", "1..3", "1-5:0", "1-5:x", "1-5:2:2"] {
            assert!(parse_ranges(wrong).unwrap_err().to_string().contains("no range"), "{wrong}");
        }
    }
}

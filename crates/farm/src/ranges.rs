//! Sets of numbers as engines and people write them: `0-3`, `1,5,9-12`, or `1-9:2` for every other one.

use crate::FarmError;
use std::collections::BTreeSet;

/// A set of task numbers.
pub type Ranges = BTreeSet<u32>;

/// Most numbers that one text may stand for.
const MOST: u32 = 10_000_000;

/// Reads numbers and ranges, both ends included, the latter also in steps.
///
/// # Errors
/// When the text is something else.
pub fn parse_ranges(text: &str) -> Result<Ranges, FarmError> {
    let mut all = Ranges::new();
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let (range, step) = part.split_once(':').unwrap_or((part, "1"));
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        match (first.trim().parse::<u32>(), last.trim().parse::<u32>(), step.trim().parse::<usize>()) {
            (Ok(first), Ok(last), Ok(step)) if first <= last && last < MOST && step > 0 => all.extend((first..=last).step_by(step)),
            _ => {
                return Err(FarmError::Request(format!(
                    "{part:?} is no range of task numbers; expected something like 7, 0-3, 0-8:2 or 1,5,9-12"
                )));
            }
        }
    }
    Ok(all)
}

/// The shortest text that [`parse_ranges`] reads as `numbers`; empty for none.
pub fn print_ranges(numbers: &Ranges) -> String {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => runs.push((number, number)),
        }
    }
    let text = |(first, last): &(u32, u32)| if first == last { first.to_string() } else { format!("{first}-{last}") };
    runs.iter().map(text).collect::<Vec<_>>().join(",")
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

//! Sets of numbers as people and programs write them: `0-3`, `1,5,9-12`, or `1-9:2` for every other one.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// Upper limit of all numbers of a text, so that a few characters cannot ask for gigabytes.
const END: u32 = 10_000_000;

/// Ascending numbers, cut into runs without gaps.
///
/// ```
/// assert_eq!(enfilade_dataset::number_runs([0, 1, 2, 5, 7, 8]), [0..=2, 5..=5, 7..=8]);
/// ```
pub fn number_runs(numbers: impl IntoIterator<Item = u32>) -> Vec<RangeInclusive<u32>> {
    let mut runs: Vec<RangeInclusive<u32>> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some(run) if run.end().checked_add(1) == Some(number) => *run = *run.start()..=number,
            _ => runs.push(number..=number),
        }
    }
    runs
}

/// Ascending numbers in the shortest form, such as `1,5,9-12` where the separator is a comma; empty for none.
pub fn print_number_ranges(numbers: impl IntoIterator<Item = u32>, separator: &str) -> String {
    let text = |run: &RangeInclusive<u32>| match (run.start(), run.end()) {
        (first, last) if first == last => first.to_string(),
        (first, last) => format!("{first}-{last}"),
    };
    number_runs(numbers).iter().map(text).collect::<Vec<_>>().join(separator)
}

/// Reads numbers and ranges between commas. Both ends of a range are included; `:2` behind it takes every other number.
///
/// # Errors
/// The first part of the text that is neither, that goes backward, or that goes beyond ten million.
///
/// ```
/// use enfilade_dataset::parse_number_ranges;
/// assert_eq!(parse_number_ranges("7, 1-5:2").unwrap().into_iter().collect::<Vec<_>>(), [1, 3, 5, 7]);
/// assert_eq!(parse_number_ranges("1,3-1").unwrap_err(), "3-1");
/// ```
pub fn parse_number_ranges(text: &str) -> Result<BTreeSet<u32>, String> {
    let mut all = BTreeSet::new();
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let (range, step) = part.split_once(':').unwrap_or((part, "1"));
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        match (first.trim().parse::<u32>(), last.trim().parse::<u32>(), step.trim().parse::<usize>()) {
            (Ok(first), Ok(last), Ok(step)) if first <= last && last < END && step > 0 => all.extend((first..=last).step_by(step)),
            _ => return Err(part.to_string()),
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_come_back() {
        let printed = |text: &str| print_number_ranges(parse_number_ranges(text).unwrap(), ",");
        for text in ["", "7", "0-3", "1,5,9-12"] {
            assert_eq!(printed(text), text);
        }
        assert_eq!(printed(" 3, 1-2 ,2,"), "1-3");
        assert_eq!(printed("1-7:3,9, 20-23 : 2"), "1,4,7,9,20,22");
        for wrong in ["x", "3-1", "-1", "1-4000000000", "1..3", "1-5:0", "1-5:x", "1-5:2:2"] {
            assert_eq!(parse_number_ranges(wrong).unwrap_err(), wrong);
        }
    }

    #[test]
    fn the_last_number_of_all_ends_a_run() {
        assert_eq!(number_runs([u32::MAX - 1, u32::MAX]), [u32::MAX - 1..=u32::MAX]);
    }
}

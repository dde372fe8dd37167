//! Ranges of options that are whole numbers.

use crate::error::Error;

/// Surfaces per pixel unless that is said, and at most.
pub(crate) const SURFACES: u32 = 8;
pub(crate) const MOST_SURFACES: u32 = 64;

/// The number of an option, from 1 to `most`.
pub(crate) fn checked(name: &str, number: u32, most: u32) -> Result<u32, Error> {
    if (1..=most).contains(&number) {
        return Ok(number);
    }
    let expected = if most == u32::MAX { "at least 1".to_string() } else { format!("1 to {most}") };
    Err(Error::usage(format!("{name} is {number}, expected {expected}"), "leave it out for the usual number"))
}

//! Numbers within bounds, which every value of the type keeps: options of such a type need no checks.

use crate::form::{Form, Given, is_interval};
use crate::value::Value;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// A whole number from `LEAST` to `MOST`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whole<const LEAST: u32, const MOST: u32 = { u32::MAX }>(u32);

/// Two numbers from 0 to `MOST`, the smaller one first. The largest of `u32` is no bound: the second number may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<const MOST: u32 = { u32::MAX }>([f64; 2]);

impl<const LEAST: u32, const MOST: u32> Whole<LEAST, MOST> {
    /// A number that is known to be within the bounds.
    ///
    /// # Panics
    /// When it is not.
    pub const fn new(number: u32) -> Self {
        assert!(LEAST <= number && number <= MOST, "a number outside of its bounds");
        Self(number)
    }

    /// The number, if it is within the bounds.
    pub fn of(number: u32) -> Option<Self> {
        (LEAST..=MOST).contains(&number).then_some(Self(number))
    }

    /// The number.
    pub const fn get(self) -> u32 {
        self.0
    }
}

impl<const LEAST: u32, const MOST: u32> Value for Whole<LEAST, MOST> {
    const FORM: Form = Form::Whole { least: LEAST as u64, most: MOST as u64 };

    fn read(given: &Given) -> Option<Self> {
        Self::of(u32::read(given)?)
    }
}

impl<'de, const LEAST: u32, const MOST: u32> Deserialize<'de> for Whole<LEAST, MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let number = u32::deserialize(deserializer)?;
        Self::of(number).ok_or_else(|| D::Error::custom(format_args!("{}, found {number}", Self::FORM.expected())))
    }
}

impl<const MOST: u32> Interval<MOST> {
    /// The interval between two numbers, if it is one within the bounds.
    pub fn of(ends: [f64; 2]) -> Option<Self> {
        is_interval(ends, MOST).then_some(Self(ends))
    }

    /// The two ends, the smaller one first.
    pub const fn ends(self) -> [f64; 2] {
        self.0
    }
}

impl<const MOST: u32> Value for Interval<MOST> {
    const FORM: Form = Form::Interval { most: MOST };

    fn read(given: &Given) -> Option<Self> {
        Self::of(<[f64; 2]>::read(given)?)
    }
}

impl<'de, const MOST: u32> Deserialize<'de> for Interval<MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ends = <[f64; 2]>::deserialize(deserializer)?;
        Self::of(ends).ok_or_else(|| D::Error::custom(format_args!("{}, found {ends:?}", Self::FORM.expected())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_outside_of_their_bounds_are_refused_wherever_they_come_from() {
        assert_eq!(Whole::<1, 64>::read(&Given::Whole(64)), Some(Whole::new(64)));
        assert_eq!(Whole::<1, 64>::read(&Given::Whole(65)), None);
        let whole = |text| serde_json::from_str::<Whole<1, 64>>(text).map(Whole::get).map_err(|error| error.to_string());
        assert_eq!(whole("8"), Ok(8));
        assert!(whole("0").unwrap_err().starts_with("expected a whole number from 1 to 64, found 0"));
        let interval = |text| serde_json::from_str::<Interval<1>>(text).map(Interval::ends).map_err(|error| error.to_string());
        assert_eq!(interval("[0.2, 1]"), Ok([0.2, 1.0]));
        assert!(interval("[0.5, 0.2]").unwrap_err().contains("the smaller one first, found [0.5, 0.2]"));
        assert!(Interval::<1>::of([0.0, 2.0]).is_none() && Interval::<9>::of([f64::NAN, 1.0]).is_none());
        assert_eq!(<Interval>::of([1.0, f64::INFINITY]).map(Interval::ends), Some([1.0, f64::INFINITY]));
    }
}

//! Numbers of sensors, which may differ from frame to frame.

use enfilade_math::Rng;
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A number, or the range from which one is drawn for every frame, evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amount {
    low: f64,
    high: f64,
}

impl Amount {
    /// Always 0.
    pub(crate) const fn nothing() -> Self {
        Self::of(0.0)
    }

    /// Always this.
    pub const fn of(value: f64) -> Self {
        Self { low: value, high: value }
    }

    /// The least and the largest.
    pub const fn bounds(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// A number of the amount. Every call takes one number of the stream, so that a range in the place of a number leaves the others as
    /// they are.
    pub fn draw(&self, rng: &mut Rng) -> f64 {
        let share = rng.next_f64();
        if self.low == self.high { self.low } else { self.low + (self.high - self.low) * share }
    }
}

impl Serialize for Amount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.low == self.high { self.low.serialize(serializer) } else { self.bounds().serialize(serializer) }
    }
}

impl<'de> Deserialize<'de> for Amount {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AmountVisitor)
    }
}

struct AmountVisitor;

impl<'de> Visitor<'de> for AmountVisitor {
    type Value = Amount;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a range such as [0.5, 2.0]")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Amount, E> {
        if value.is_finite() { Ok(Amount::of(value)) } else { Err(E::custom(format!("found {value}, expected a finite number"))) }
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Amount, E> {
        Ok(Amount::of(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Amount, E> {
        Ok(Amount::of(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Amount, A::Error> {
        let mut found: Vec<f64> = Vec::new();
        while let Some(value) = values.next_element()? {
            found.push(value);
        }
        match found[..] {
            [low, high] if low.is_finite() && high.is_finite() && low <= high => Ok(Amount { low, high }),
            [_, _] => Err(de::Error::custom(format!("found {found:?}, expected the smaller number first, both finite"))),
            _ => Err(de::Error::invalid_length(found.len(), &"two numbers, the smaller one first")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Amount, String> {
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    #[test]
    fn numbers_and_ranges_are_read_and_drawn() {
        assert_eq!(read("2"), Ok(Amount::of(2.0)));
        let range = read("[0.5, 2]").unwrap();
        assert_eq!((range.bounds(), serde_json::to_string(&range).unwrap()), ([0.5, 2.0], "[0.5,2.0]".into()));
        let mut rng = Rng::new(1);
        let drawn: Vec<f64> = (0..1000).map(|_| range.draw(&mut rng)).collect();
        assert!(drawn.iter().all(|v| (0.5..2.0).contains(v)));
        assert!((drawn.iter().sum::<f64>() / 1000.0 - 1.25).abs() < 0.05);
        assert_eq!(Amount::of(0.3).draw(&mut rng), 0.3);
    }

    #[test]
    fn what_is_neither_is_refused() {
        for (text, part) in [("[2, 1]", "the smaller number first"), ("[1]", "two numbers"), ("\"2\"", "a range such as")] {
            let message = read(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}

//! Keys of a table that several structs share.
//!
//! Serde's `flatten` reads through a buffer that has no places in the text: values could not be [`Spanned`](crate::Spanned), and unknown keys
//! would be reported without their place and without the keys that there are. Here every key is read where it is, into the struct that has it.

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Keys that had another name in 0.1.0, whose datasets have their files beside them: the old name, and today's.
const FORMER: [(&str, &str); 1] = [("splits", "light_parts")];

/// A struct whose fields are keys of a table, all of which may be left out.
pub trait Keys: Default {
    /// Adds the name of every key.
    fn names(into: &mut Vec<&'static str>);

    /// Reads the value of the key `name` from `map`; false, and nothing is read, where it is none of these.
    ///
    /// # Errors
    /// When the value cannot be read.
    fn take<'de, M: MapAccess<'de>>(&mut self, name: &str, map: &mut M) -> Result<bool, M::Error>;
}

/// Reads a table; unknown keys are errors as serde's `deny_unknown_fields` words them.
///
/// # Errors
/// When `deserializer` or a value fails.
pub fn read_keys<'de, D: Deserializer<'de>, K: Keys>(deserializer: D) -> Result<K, D::Error> {
    let mut known = Vec::new();
    K::names(&mut known);
    read_keys_of(deserializer, &known)
}

/// Reads a table that may have the keys `known` alone, which are some of those that there are.
///
/// # Errors
/// As [`read_keys`].
pub fn read_keys_of<'de, D: Deserializer<'de>, K: Keys>(deserializer: D, known: &[&'static str]) -> Result<K, D::Error> {
    deserializer.deserialize_map(Table(known, PhantomData))
}

struct Table<'k, K>(&'k [&'static str], PhantomData<K>);

impl<'de, K: Keys> Visitor<'de> for Table<'_, K> {
    type Value = K;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<K, M::Error> {
        let mut keys = K::default();
        while let Some(name) = map.next_key_seed(Name(self.0))? {
            keys.take(name, &mut map)?;
        }
        Ok(keys)
    }
}

/// The name of a key, which must be one of these.
struct Name<'k>(&'k [&'static str]);

impl<'de> DeserializeSeed<'de> for Name<'_> {
    type Value = &'static str;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Name<'_> {
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("the name of a key")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        let expected = || match self.0 {
            [] => "there are none".to_string(),
            known => format!("expected one of {}", known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")),
        };
        let today = FORMER.iter().find(|(former, _)| *former == name).map_or(name, |(_, today)| *today);
        self.0
            .iter()
            .find(|known| **known == today)
            .copied()
            .ok_or_else(|| E::custom(format_args!("unknown field `{name}`, {}", expected())))
    }
}

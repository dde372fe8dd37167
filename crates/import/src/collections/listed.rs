//! Lists of a collection's things, of which an odd one is left out and counted rather than being the end of the import.

use super::json::in_words;
use super::lenient::Lenient;
use crate::assembly::Assembly;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use serde_json::value::RawValue;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

/// Length up to which an odd entry is quoted.
const SHOWN: usize = 60;

/// The valid entries of a list.
#[derive(Clone, Debug)]
pub(crate) struct Listed<T> {
    items: Vec<T>,
    /// Number of other entries, and the fault of the first.
    odd: usize,
    first: String,
    is_null: bool,
}

impl<T> Default for Listed<T> {
    fn default() -> Self {
        Self { items: Vec::new(), odd: 0, first: String::new(), is_null: false }
    }
}

impl<T> Deref for Listed<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<'l, T> IntoIterator for &'l Listed<T> {
    type Item = &'l T;
    type IntoIter = std::slice::Iter<'l, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.iter()
    }
}

impl<T> Listed<T> {
    /// Reports how many entries of the list called `place` were left out, and `null` in its place.
    pub(super) fn report(&self, place: &str, a: &mut Assembly) {
        if self.is_null {
            a.warn(place, "found null, expected a list; nothing was imported of it");
        }
        if self.odd > 0 {
            let all = self.items.len() + self.odd;
            a.warn(
                place,
                format!("{} of {all} entries are not what they should be and were left out, the first: {}", self.odd, self.first),
            );
        }
    }

    /// The entries.
    pub(super) fn into_vec(self) -> Vec<T> {
        self.items
    }

    fn push(&mut self, text: &str, read: Result<T, serde_json::Error>) {
        match read {
            Ok(item) => self.items.push(item),
            Err(error) => {
                if self.odd == 0 {
                    let shown: String = text.chars().take(SHOWN).collect();
                    self.first = format!("{} in {shown}…", in_words(&error));
                }
                self.odd += 1;
            }
        }
    }
}

impl<'de, T: for<'t> Deserialize<'t>> Deserialize<'de> for Listed<T> {
    /// A list, or `null` for an empty one.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: for<'t> Deserialize<'t>> Visitor<'de> for Entries<T> {
            type Value = Listed<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a list")
            }

            fn visit_unit<E: Error>(self) -> Result<Listed<T>, E> {
                Ok(Listed { is_null: true, ..Listed::default() })
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<Listed<T>, A::Error> {
                let mut listed = Listed::default();
                while let Some(entry) = entries.next_element::<Box<RawValue>>()? {
                    let strict = serde_json::from_str::<T>(entry.get());
                    let lenient = |_| T::deserialize(Lenient(serde_json::from_str::<Value>(entry.get())?));
                    listed.push(entry.get(), strict.or_else(lenient));
                }
                Ok(listed)
            }
        }
        deserializer.deserialize_any(Entries(PhantomData))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_entries_are_counted_and_others_stay() {
        let listed: Listed<Vec<f64>> = serde_json::from_str(r#"[[1, 2], ["3", "4.5"], {"a": 1}, null, [5]]"#).unwrap();
        assert_eq!((&*listed, listed.odd), (&[vec![1.0, 2.0], vec![3.0, 4.5], vec![5.0]][..], 2));
        assert!(listed.first.contains("in {\"a\": 1}…"), "{}", listed.first);
        let within: Listed<Vec<f64>> = Deserialize::deserialize(Lenient(serde_json::json!([[1], "2"]))).unwrap();
        assert_eq!((&*within, within.odd), (&[vec![1.0], vec![2.0]][..], 0));
        assert_eq!(serde_json::from_str::<Listed<f64>>("null").unwrap().len(), 0);
        assert!(serde_json::from_str::<Listed<f64>>("3").is_err());
    }
}

//! JSON as collections write it rather than as they should: numbers as text, vectors as one text, whole numbers with a point.
//!
//! 3D-FRONT writes the coordinates of some meshes as `"1.00000"`. [`Lenient`] gives a type what it asks for wherever the value can only
//! mean that. Python's library writes `NaN` and `Infinity`, which JSON has not: [`nan_as_null`].

use crate::vectors::numbers;
use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{Deserializer, IntoDeserializer, Visitor};
use serde_json::{Error, Value};

/// The numbers that Python's library writes and JSON has not.
const NOT_FINITE: [&str; 3] = ["NaN", "-Infinity", "Infinity"];

/// The text with `null` for what is no number; `None` where it has nothing of that kind.
pub(super) fn nan_as_null(text: &str) -> Option<String> {
    let mut out = String::with_capacity(text.len());
    let (mut rest, mut is_in_text, mut found) = (text, false, false);
    while let Some(c) = rest.chars().next() {
        let word = NOT_FINITE.into_iter().find(|word| !is_in_text && rest.starts_with(word));
        let len = match (word, c) {
            (Some(word), _) => word.len(),
            (None, '\\') if is_in_text => 1 + rest[1..].chars().next().map_or(0, char::len_utf8),
            (None, c) => c.len_utf8(),
        };
        is_in_text ^= c == '"';
        found |= word.is_some();
        out.push_str(if word.is_some() { "null" } else { &rest[..len] });
        rest = &rest[len..];
    }
    found.then_some(out)
}

/// A value that is read as the type wants it.
pub(super) struct Lenient(pub Value);

impl<'de> IntoDeserializer<'de, Error> for Lenient {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl Lenient {
    /// The number that the value is, or that its text is.
    fn number(self) -> Value {
        let Value::String(text) = &self.0 else { return self.0 };
        match numbers(text).as_deref() {
            Some(&[number]) => serde_json::Number::from_f64(number).map_or(self.0, Value::Number),
            _ => self.0,
        }
    }

    /// Value as a whole number, where it is one.
    fn whole(self) -> Value {
        let number = self.number();
        match number.as_f64().filter(|v| number.is_f64() && v.fract() == 0.0 && v.abs() < 9e15) {
            Some(whole) => (whole as i64).into(),
            None => number,
        }
    }

    /// A list: its own values, or the numbers of a text such as `"1, 0, 0"`.
    fn list(self) -> Result<Vec<Value>, Value> {
        match self.0 {
            Value::Array(list) => Ok(list),
            Value::String(text) => match numbers(&text) {
                Some(found) => Ok(found.into_iter().map(Value::from).collect()),
                None => Err(Value::String(text)),
            },
            other => Err(other),
        }
    }

    fn sequence<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.list() {
            Ok(list) => SeqDeserializer::new(list.into_iter().map(Lenient)).deserialize_any(visitor),
            Err(other) => other.deserialize_any(visitor),
        }
    }

    fn table<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Object(table) => MapDeserializer::new(table.into_iter().map(|(key, value)| (key, Self(value)))).deserialize_any(visitor),
            other => other.deserialize_any(visitor),
        }
    }
}

/// Hands a value that was made by `$read` to the visitor.
macro_rules! read_as {
    ($read:ident: $($method:ident)*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            self.$read().$method(visitor)
        }
    )*};
}

impl<'de> Deserializer<'de> for Lenient {
    type Error = Error;

    read_as!(number: deserialize_f32 deserialize_f64);
    read_as!(whole: deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64 deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64);

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Array(_) => self.sequence(visitor),
            Value::Object(_) => self.table(visitor),
            other => other.deserialize_any(visitor),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = match self.0.as_str().map(str::to_lowercase).as_deref() {
            Some("true") => Value::Bool(true),
            Some("false") => Value::Bool(false),
            _ => match Self(self.0).whole() {
                Value::Number(n) if matches!(n.as_i64(), Some(0 | 1)) => Value::Bool(n.as_i64() == Some(1)),
                other => other,
            },
        };
        value.deserialize_bool(visitor)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_string(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Number(number) => visitor.visit_string(number.to_string()),
            other => other.deserialize_string(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if self.0.is_null() { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Error> {
        // serde_json's own types, such as the raw text of a value, have names that it alone understands.
        if name.starts_with('$') { self.0.deserialize_newtype_struct(name, visitor) } else { visitor.visit_newtype_struct(self) }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.sequence(visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.sequence(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(self, _: &'static str, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.sequence(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.table(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(self, _: &'static str, _: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Object(_) => self.table(visitor),
            _ => self.sequence(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(self, name: &'static str, all: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.0.deserialize_enum(name, all, visitor)
    }

    serde::forward_to_deserialize_any! { i128 u128 char bytes byte_buf unit unit_struct identifier ignored_any }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DVec3;
    use serde::Deserialize;
    use serde_json::json;

    #[derive(Debug, Default, PartialEq, Deserialize)]
    #[serde(default)]
    struct Thing {
        name: String,
        number: f32,
        whole: i64,
        flag: bool,
        place: DVec3,
        turn: [f64; 4],
        list: Vec<u32>,
        inner: Option<Box<Self>>,
        anything: Value,
    }

    fn read(value: Value) -> Result<Thing, Error> {
        Thing::deserialize(Lenient(value))
    }

    #[test]
    fn what_is_as_it_should_be_stays_and_text_becomes_numbers() {
        let right = json!({"name": "a", "number": 1.5, "whole": 3, "flag": true, "place": [1.0, 2.0, 3.0], "turn": [0, 0, 0, 1],
            "list": [1, 2], "inner": {"name": "b"}, "anything": {"a": ["1"]}});
        let expected: Thing = serde_json::from_value(right.clone()).unwrap();
        assert_eq!(read(right).unwrap(), expected);
        let odd = json!({"name": "a", "number": " 1.50", "whole": "3.0", "flag": "True", "place": "1, 2 ,3", "turn": ["0", 0, "0.0", 1.0],
            "list": ["1", 2.0], "inner": {"name": "b"}, "anything": {"a": ["1"]}});
        assert_eq!(read(odd).unwrap(), expected);
        assert_eq!(read(json!({"name": 7, "flag": 1})).unwrap(), Thing { name: "7".into(), flag: true, ..Thing::default() });
    }

    #[test]
    fn numbers_that_json_has_not_are_null_outside_of_texts() {
        let python = r#"{"a": [NaN, 1, -Infinity], "NaN \" NaN": "Infinity", "b":Infinity}"#;
        assert_eq!(nan_as_null(python).unwrap(), r#"{"a": [null, 1, null], "NaN \" NaN": "Infinity", "b":null}"#);
        assert_eq!(nan_as_null(r#"{"NaN": "-Infinity\\"}"#), None);
    }

    #[test]
    fn what_means_nothing_is_an_error() {
        for odd in
            [json!({"number": "one"}), json!({"whole": 2.5}), json!({"place": "1 2"}), json!({"list": ["a"]}), json!({"flag": 2}), json!(3)]
        {
            assert!(read(odd.clone()).is_err(), "{odd}");
        }
    }
}

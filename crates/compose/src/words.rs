//! Types of keys that may be written in more than one way.

use enfilade_options::{Form, Given, Value, closest};
use enfilade_scene::NYU40;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// One text or several.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Many(pub Vec<String>);

impl Many {
    /// True for none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<'de> Deserialize<'de> for Many {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum OneOrMany {
            One(String),
            Many(Vec<String>),
        }
        match OneOrMany::deserialize(deserializer) {
            Ok(OneOrMany::One(text)) => Ok(Self(vec![text])),
            Ok(OneOrMany::Many(texts)) => Ok(Self(texts)),
            Err(_) => Err(D::Error::custom("expected a text, or a list of texts")),
        }
    }
}

impl Value for Many {
    const FORM: Form = Form::List(&Form::Text);

    fn read(given: &Given) -> Option<Self> {
        String::read(given).map(|text| Self(vec![text])).or_else(|| Vec::read(given).map(Self))
    }
}

/// A whole number, or the least and the most of one that is drawn, each equally often.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Number(pub [u32; 2]);

/// A number, or the least and the most of one that is drawn uniformly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Extent(pub [f64; 2]);

#[derive(Deserialize)]
#[serde(untagged)]
enum OneOrTwo<T> {
    One(T),
    Two([T; 2]),
}

impl<T: Copy> OneOrTwo<T> {
    fn both(self) -> [T; 2] {
        match self {
            Self::One(value) => [value; 2],
            Self::Two(both) => both,
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read =
            OneOrTwo::deserialize(deserializer).map_err(|_| D::Error::custom("expected a whole number such as 10, or [least, most]"));
        read.map(|value| Self(value.both()))
    }
}

impl<'de> Deserialize<'de> for Extent {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let read = OneOrTwo::deserialize(deserializer).map_err(|_| D::Error::custom("expected a number such as 0.1, or [least, most]"));
        read.map(|value| Self(value.both()))
    }
}

impl Value for Number {
    const FORM: Form = <u32 as Value>::FORM;

    fn read(given: &Given) -> Option<Self> {
        u32::read(given).map(|number| Self([number; 2]))
    }
}

impl Value for Extent {
    const FORM: Form = Form::Number;

    fn read(given: &Given) -> Option<Self> {
        f64::read(given).map(|number| Self([number; 2]))
    }
}

/// A class of NYU40, by name or number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct ClassWord(pub i16);

impl ClassWord {
    /// The class of this name or number.
    ///
    /// # Errors
    /// What is expected, with the nearest name.
    pub fn of(word: &str) -> Result<Self, String> {
        let class = NYU40.iter().find(|class| class.name.eq_ignore_ascii_case(word.trim()) || word.trim().parse() == Ok(class.id));
        class.map(|class| Self(class.id)).ok_or_else(|| {
            let names = NYU40.map(|class| class.name);
            let nearest = closest(word, &names).map(|name| format!("; did you mean {name:?}?")).unwrap_or_default();
            format!("NYU40 has no class {word:?}, expected one of its names, such as \"box\", or a number from 1 to 40{nearest}")
        })
    }
}

impl<'de> Deserialize<'de> for ClassWord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Word {
            Number(i64),
            Name(String),
        }
        let word = match Word::deserialize(deserializer) {
            Ok(Word::Number(number)) => number.to_string(),
            Ok(Word::Name(name)) => name,
            Err(_) => return Err(D::Error::custom("expected the name of an NYU40 class, or its number")),
        };
        Self::of(&word).map_err(D::Error::custom)
    }
}

impl Value for ClassWord {
    const FORM: Form = Form::Text;

    fn read(given: &Given) -> Option<Self> {
        Self::of(given.text()?).ok()
    }
}

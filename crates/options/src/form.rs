//! Forms of values, and values as somebody gives them: a text of the command line, or what Python hands over.

use crate::proposal;
use crate::text::{Unit, parse_share, parse_size, parse_time};

/// The values that an option takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// True or false; as a flag it is there or not.
    Switch,
    /// A whole number from 0 to `most`.
    Whole {
        /// The largest number.
        most: u64,
    },
    /// Any number.
    Number,
    /// Any text.
    Text,
    /// A file or a folder.
    Path,
    /// A word of this list.
    Word(&'static [Word]),
    /// Width and height in pixels.
    Size,
    /// Several values; commas separate them on the command line.
    List(&'static Form),
    /// A table, which only files have.
    Table,
}

/// A word that a value may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word as it is written.
    pub name: &'static str,
    /// Doc comment of the variant.
    pub doc: &'static str,
}

/// A value as it is given.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// True or false.
    Switch(bool),
    /// A whole number.
    Whole(u64),
    /// Another number.
    Number(f64),
    /// A text, a word or a path.
    Text(String),
    /// Several values.
    List(Vec<Given>),
}

impl Form {
    /// The value that a text of the command line gives.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(&self, text: &str, unit: Unit) -> Result<Given, String> {
        match (self, unit) {
            (Self::Number, Unit::Share) => parse_share(text).map(Given::Number),
            (Self::Number, Unit::Time) => parse_time(text).map(Given::Number),
            (Self::Number, Unit::None) => text.trim().parse().map(Given::Number).map_err(|_| self.expected()),
            (Self::Whole { most }, _) => {
                let number = text.trim().parse().ok().filter(|number| number <= most);
                number.map(Given::Whole).ok_or_else(|| self.expected())
            }
            (Self::Switch, _) => text.parse().map(Given::Switch).map_err(|_| self.expected()),
            (Self::Word(words), _) => word(text, words),
            (Self::Size, _) => parse_size(text).map(|size| Given::List(size.map(|side| Given::Whole(side.into())).to_vec())),
            (Self::Text | Self::Path, _) => Ok(Given::Text(text.into())),
            (Self::Table, _) => Err(self.expected()),
            (Self::List(element), _) => text.split(',').map(|part| element.parse(part, unit)).collect::<Result<_, _>>().map(Given::List),
        }
    }

    /// What a value must be, as "expected a number".
    pub fn expected(&self) -> String {
        match self {
            Self::Switch => "expected true or false".into(),
            Self::Whole { most: u64::MAX } => "expected a whole number of at least 0".into(),
            Self::Whole { most } => format!("expected a whole number from 0 to {most}"),
            Self::Number => "expected a number".into(),
            Self::Text => "expected a text".into(),
            Self::Path => "expected a path".into(),
            Self::Word(words) => format!("expected one of {}", words.iter().map(|word| word.name).collect::<Vec<_>>().join(", ")),
            Self::Size => "expected two whole numbers".into(),
            Self::List(element) => format!("{}, or a list of such", element.expected()),
            Self::Table => "expected a table in dataset.toml".into(),
        }
    }

    /// What a value that is not of the form should have been, with the nearest word.
    pub fn refusal(&self, given: &Given) -> String {
        match (self, given) {
            (Self::Word(words), Given::Text(text)) => proposal(text, &words.iter().map(|word| word.name).collect::<Vec<_>>()),
            (Self::List(Self::Word(words)), Given::List(values)) => {
                let is_known = |value: &&Given| value.text().is_some_and(|text| words.iter().any(|word| word.name == text));
                values.iter().find(|value| !is_known(value)).map_or_else(|| self.expected(), |wrong| Self::Word(words).refusal(wrong))
            }
            _ => self.expected(),
        }
    }

    /// Name of the value in help.
    pub const fn value_name(&self) -> &'static str {
        match self {
            Self::Switch => "true|false",
            Self::Whole { .. } => "N",
            Self::Number => "X",
            Self::Text => "TEXT",
            Self::Path => "FILE",
            Self::Word(_) => "WORD",
            Self::Size => "WxH",
            Self::List(_) => "A,B",
            Self::Table => "TABLE",
        }
    }

    /// True where a value may begin with a minus sign.
    pub fn may_begin_with_minus(&self) -> bool {
        match self {
            Self::Word(words) => words.iter().any(|word| word.name.starts_with('-')),
            _ => false,
        }
    }
}

impl Word {
    /// The doc comment on one line, without the period at its end.
    pub fn about(&self) -> String {
        let text = self.doc.lines().map(str::trim).collect::<Vec<_>>().join(" ");
        text.trim().trim_end_matches('.').to_string()
    }
}

impl Given {
    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }
}

fn word(text: &str, words: &[Word]) -> Result<Given, String> {
    let known: Vec<&str> = words.iter().map(|word| word.name).collect();
    let text = text.trim();
    if known.contains(&text) { Ok(Given::Text(text.into())) } else { Err(proposal(text, &known)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: Form = Form::Word(&[Word { name: "y", doc: " Up." }, Word { name: "-y", doc: " Down." }]);

    #[test]
    fn texts_become_values_of_the_form() {
        let plain = |form: Form, text: &str| form.parse(text, Unit::None);
        assert_eq!(plain(Form::Whole { most: 9 }, "9"), Ok(Given::Whole(9)));
        assert!(plain(Form::Whole { most: 9 }, "10").unwrap_err().contains("from 0 to 9"));
        assert!(plain(Form::Whole { most: u64::MAX }, "-1").unwrap_err().contains("at least 0"));
        assert_eq!(plain(Form::Number, "-2.5"), Ok(Given::Number(-2.5)));
        assert_eq!(Form::Number.parse("2%", Unit::Share), Ok(Given::Number(0.02)));
        assert_eq!(plain(Form::Size, "64x48"), Ok(Given::List(vec![Given::Whole(64), Given::Whole(48)])));
        assert_eq!(plain(Form::List(&AXES), "y,-y"), Ok(Given::List(vec![Given::Text("y".into()), Given::Text("-y".into())])));
        assert!(plain(AXES, "u").unwrap_err().contains("expected one of y, -y"));
        let list = Given::List(vec![Given::Text("y".into()), Given::Text("-z".into())]);
        assert_eq!(Form::List(&AXES).refusal(&list), "expected one of y, -y");
        assert!(AXES.may_begin_with_minus() && !Form::Number.may_begin_with_minus());
    }
}

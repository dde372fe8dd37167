//! Forms of values, and values as somebody gives them: a text of the command line, or what Python hands over.

use crate::proposal;
use crate::text::{FRAME, Unit, parse_frame, parse_interval, parse_share, parse_size, parse_time};
use std::path::PathBuf;

/// The values that an option takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// True or false; as a flag it is there or not.
    Switch,
    /// A whole number from `least` to `most`.
    Whole {
        /// The smallest number.
        least: u64,
        /// The largest number.
        most: u64,
    },
    /// A whole number, which may be negative.
    Integer,
    /// Any number.
    Number,
    /// Two numbers from 0 to `most`, the smaller one first; on the command line with `..` between them, and each may be left out.
    Interval {
        /// The largest number; the largest of `u32` is no bound.
        most: u32,
    },
    /// Any text.
    Text,
    /// A file or a folder.
    Path,
    /// A word of this list.
    Word(&'static [Word]),
    /// Width and height in pixels.
    Size,
    /// A camera and the number of one of its frames.
    Frame,
    /// Two values; a space separates them on the command line.
    Two(&'static Form),
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
    /// Name of the variant in Rust.
    pub variant: &'static str,
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
    /// A whole number that may be negative.
    Integer(i64),
    /// Another number.
    Number(f64),
    /// A text or a word.
    Text(String),
    /// A file or a folder.
    Path(PathBuf),
    /// Several values.
    List(Vec<Given>),
}

impl Form {
    /// Parses a value from the command line.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(&self, text: &str, unit: Unit) -> Result<Given, String> {
        match (self, unit) {
            (Self::Number, Unit::Share) => parse_share(text).map(Given::Number),
            (Self::Number, Unit::Time) => parse_time(text).map(Given::Number),
            (Self::Number, _) => text.trim().parse().map(Given::Number).map_err(|_| self.expected()),
            (Self::Whole { least, most }, _) => {
                let number = text.trim().parse().ok().filter(|number| (*least..=*most).contains(number));
                number.map(Given::Whole).ok_or_else(|| self.expected())
            }
            (Self::Integer, _) => text.trim().parse().map(Given::Integer).map_err(|_| self.expected()),
            (&Self::Interval { most }, unit) => {
                interval(text, most, unit).ok_or_else(|| format!("{}, as in {}", self.expected(), unit.intervals()))
            }
            (Self::Switch, _) => text.parse().map(Given::Switch).map_err(|_| self.expected()),
            (Self::Word(words), _) => word(text, words),
            (Self::Size, _) => parse_size(text).map(|size| Given::List(size.map(|side| Given::Whole(side.into())).to_vec())),
            (Self::Text, _) => Ok(Given::Text(text.into())),
            (Self::Path, _) => Ok(Given::Path(text.into())),
            (Self::Frame, _) => parse_frame(text).map(|(camera, frame)| Given::frame(camera, frame.into())),
            (Self::Two(element), _) => text.split(' ').map(|part| element.parse(part, unit)).collect::<Result<_, _>>().map(Given::List),
            (Self::Table, _) => Err(self.expected()),
            (Self::List(element), _) => text.split(',').map(|part| element.parse(part, unit)).collect::<Result<_, _>>().map(Given::List),
        }
    }

    /// The message for a value of another form, such as "expected a number".
    pub fn expected(&self) -> String {
        match self {
            Self::Switch => "expected true or false".into(),
            Self::Whole { least, most: u64::MAX } => format!("expected a whole number of at least {least}"),
            Self::Whole { least, most } => format!("expected a whole number from {least} to {most}"),
            Self::Integer => "expected a whole number".into(),
            Self::Number => "expected a number".into(),
            Self::Interval { most: u32::MAX } => "expected two numbers from 0, the smaller one first".into(),
            Self::Interval { most } => format!("expected two numbers from 0 to {most}, the smaller one first"),
            Self::Text => "expected a text".into(),
            Self::Path => "expected a path".into(),
            Self::Word(words) => format!("expected one of {}", words.iter().map(|word| word.name).collect::<Vec<_>>().join(", ")),
            Self::Size => "expected two whole numbers".into(),
            Self::Frame => FRAME.into(),
            Self::Two(element) => format!("{}, and another", element.expected()),
            Self::List(element) => format!("{}, or a list of such", element.expected()),
            Self::Table => "expected a table in dataset.toml".into(),
        }
    }

    /// The message for a refused value: what was expected, with the nearest word.
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
            Self::Whole { .. } | Self::Integer => "N",
            Self::Number => "X",
            Self::Interval { .. } => "RANGE",
            Self::Text => "TEXT",
            Self::Path => "FILE",
            Self::Word(_) => "WORD",
            Self::Size => "WxH",
            Self::Frame => "CAMERA/FRAME",
            Self::Two(element) => element.value_name(),
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
    /// A camera and the number of one of its frames.
    pub fn frame(camera: String, number: u64) -> Self {
        Self::List(vec![Self::Text(camera), Self::Whole(number)])
    }

    /// The text, if it is one; also that of a path.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            Self::Path(path) => path.to_str(),
            _ => None,
        }
    }
}

/// Numbers from..to; an end that is left out is 0, or `most` where that is a bound.
fn interval(text: &str, most: u32, unit: Unit) -> Option<Given> {
    let number = |text: &str| if unit == Unit::Share { parse_share(text).ok() } else { text.trim().parse().ok() };
    let [least, greatest] = parse_interval(text, number)?;
    let bound = if most == u32::MAX { f64::INFINITY } else { f64::from(most) };
    let ends = [least.unwrap_or(0.0), greatest.unwrap_or(bound)];
    is_interval(ends, most).then(|| Given::List(ends.map(Given::Number).to_vec()))
}

/// True for two numbers from 0 to `most`, the smaller one first; the largest of `u32` is no bound.
pub(crate) fn is_interval([least, greatest]: [f64; 2], most: u32) -> bool {
    0.0 <= least && least <= greatest && (most == u32::MAX || greatest <= f64::from(most))
}

fn word(text: &str, words: &[Word]) -> Result<Given, String> {
    let known: Vec<&str> = words.iter().map(|word| word.name).collect();
    let text = text.trim();
    if known.contains(&text) { Ok(Given::Text(text.into())) } else { Err(proposal(text, &known)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: Form = Form::Word(&[Word { name: "y", variant: "Y", doc: " Up." }, Word { name: "-y", variant: "MinusY", doc: " Down." }]);

    #[test]
    fn texts_become_values_of_the_form() {
        let plain = |form: Form, text: &str| form.parse(text, Unit::None);
        assert_eq!(plain(Form::Whole { least: 0, most: 9 }, "9"), Ok(Given::Whole(9)));
        assert!(plain(Form::Whole { least: 1, most: 9 }, "10").unwrap_err().contains("from 1 to 9"));
        assert!(plain(Form::Whole { least: 1, most: 9 }, "0").unwrap_err().contains("from 1 to 9"));
        assert!(plain(Form::Whole { least: 0, most: u64::MAX }, "-1").unwrap_err().contains("at least 0"));
        assert_eq!(plain(Form::Integer, "-1"), Ok(Given::Integer(-1)));
        assert_eq!(plain(Form::Number, "-2.5"), Ok(Given::Number(-2.5)));
        assert_eq!(Form::Number.parse("2%", Unit::Share), Ok(Given::Number(0.02)));
        assert_eq!(plain(Form::Size, "64x48"), Ok(Given::List(vec![Given::Whole(64), Given::Whole(48)])));
        assert_eq!(plain(Form::List(&AXES), "y,-y"), Ok(Given::List(vec![Given::Text("y".into()), Given::Text("-y".into())])));
        assert!(plain(AXES, "u").unwrap_err().contains("expected one of y, -y"));
        let list = Given::List(vec![Given::Text("y".into()), Given::Text("-z".into())]);
        assert_eq!(Form::List(&AXES).refusal(&list), "expected one of y, -y");
        assert!(AXES.may_begin_with_minus() && !Form::Number.may_begin_with_minus());
        let frames = Given::List(vec![Given::frame("cam_00".into(), 3), Given::frame("cam_01".into(), 7)]);
        assert_eq!(plain(Form::Two(&Form::Frame), "cam_00/3 cam_01/7"), Ok(frames));
        assert!(plain(Form::Frame, "3").unwrap_err().contains("as in cam_00/3"));
    }

    #[test]
    fn intervals_may_lack_an_end_and_are_in_order() {
        let ends = |least, most| Ok(Given::List(vec![Given::Number(least), Given::Number(most)]));
        let lengths = |text| Form::Interval { most: u32::MAX }.parse(text, Unit::Meters);
        assert_eq!((lengths("0.3..2"), lengths("10.."), lengths("..90")), (ends(0.3, 2.0), ends(10.0, f64::INFINITY), ends(0.0, 90.0)));
        assert!(["3", "2..1", "-1..2", "a..b", "nan.."].iter().all(|text| lengths(text).is_err()));
        let shares = |text| Form::Interval { most: 1 }.parse(text, Unit::Share);
        assert_eq!((shares("0.2..0.7"), shares("20%.."), shares("..0.5")), (ends(0.2, 0.7), ends(0.2, 1.0), ends(0.0, 0.5)));
        assert!(["0.2", "0.7..0.2", "0..2", "a..b"].iter().all(|text| shares(text).is_err()));
        assert_eq!(shares("0..2").unwrap_err(), "expected two numbers from 0 to 1, the smaller one first, as in 0.2..0.7, 30%.. or ..0.5");
    }
}

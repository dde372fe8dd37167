//! The table of a struct's options.

use crate::form::{Form, Given};
use crate::proposal;
use crate::text::Unit;

/// A struct that [`options!`](crate::options) declares.
pub trait Options: Default {
    /// Every option, in the order of its declaration.
    const OPTIONS: &'static [Spec];

    /// Sets the option `name`.
    ///
    /// # Errors
    /// What was expected, when there is no option of this name or the value is not of its form.
    fn set(&mut self, name: &str, given: &Given) -> Result<(), String>;
}

/// One option, as it is declared.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Name of the field, of the key in files and of the keyword in Python.
    pub name: &'static str,
    /// Doc comment, line by line.
    pub doc: &'static str,
    /// Default, as it is written in Rust.
    pub default: &'static str,
    /// Values that it takes.
    pub form: Form,
    /// How the command line shows the value; `None` shows it by its form.
    pub shown: Option<Shown>,
}

/// How the command line shows a value.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// Name of the value in help, such as `SEED`.
    pub value: &'static str,
    /// Units that a number may be written with.
    pub unit: Unit,
}

/// A value with a name of its own.
pub const fn named(value: &'static str) -> Shown {
    Shown { value, unit: Unit::None }
}

/// A share, which may be written in per cent.
pub const SHARE: Shown = Shown { value: "SHARE", unit: Unit::Share };

/// A time in seconds, which may be written in minutes and hours.
pub const TIME: Shown = Shown { value: "TIME", unit: Unit::Time };

/// An interval of shares.
pub const SHARES: Shown = Shown { value: "RANGE", unit: Unit::Share };

/// An interval of lengths.
pub const METERS: Shown = Shown { value: "RANGE", unit: Unit::Meters };

/// An interval of angles.
pub const DEGREES: Shown = Shown { value: "RANGE", unit: Unit::Degrees };

/// An amount of memory.
pub const MEBIBYTES: Shown = Shown { value: "MIB", unit: Unit::Mebibytes };

impl Spec {
    /// Name of the flag, without hyphens before it.
    pub fn flag(&self) -> String {
        self.name.strip_suffix(self.unit().suffix()).unwrap_or(self.name).replace('_', "-")
    }

    /// Units of its numbers on the command line.
    pub fn unit(&self) -> Unit {
        self.shown.map_or(Unit::None, |shown| shown.unit)
    }

    /// Name of its value in help.
    pub fn value_name(&self) -> &'static str {
        self.shown.map_or_else(|| self.form.value_name(), |shown| shown.value)
    }

    /// The first paragraph of the doc comment on one line, with links to code as code, and without the period at the end.
    pub fn about(&self) -> String {
        let lines: Vec<&str> = self.doc.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
        let text = lines.join(" ").replace("[`", "`").replace("`]", "`");
        text.strip_suffix('.').map_or(text.clone(), String::from)
    }

    /// The default as written in files, if it is a number, a word, true or false; otherwise as written in Rust.
    pub fn literal(&self) -> &'static str {
        self.word()
            .unwrap_or_else(|| self.default.strip_prefix("Whole::new(").and_then(|rest| rest.strip_suffix(')')).unwrap_or(self.default))
    }

    /// The default, where it is a word.
    pub fn word(&self) -> Option<&'static str> {
        let Form::Word(words) = self.form else { return None };
        let (_, variant) = self.default.rsplit_once("::")?;
        words.iter().find(|word| word.variant == variant).map(|word| word.name)
    }

    /// The default as shown in help: a number, a word, or "any" if an interval may be left out.
    pub fn told_default(&self) -> Option<&'static str> {
        let literal = self.literal();
        let number = || literal.strip_suffix(".0").or(Some(literal)).filter(|plain| plain.parse::<f64>().is_ok());
        let any = || matches!(self.form, Form::Interval { .. }).then_some("any");
        self.word().or_else(number).or_else(any)
    }

    /// Examples of a value on the command line, if its form needs an explanation.
    pub fn examples(&self) -> Option<&'static str> {
        matches!(self.form, Form::Interval { .. }).then(|| self.unit().intervals())
    }

    /// Parses a value from the command line.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(&self, text: &str) -> Result<Given, String> {
        self.form.parse(text, self.unit())
    }
}

/// The message about a name that is no option of these.
pub fn unknown(name: &str, options: &[Spec]) -> String {
    let known: Vec<&str> = options.iter().map(|spec| spec.name).collect();
    format!("there is no option `{name}`; {}", proposal(name, &known))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Word;

    const LIMIT: Spec = Spec {
        name: "time_limit_s",
        doc: " Seconds that a frame may take,\n see [`Spec`].\n\n More.\n",
        default: "2.0",
        form: Form::Number,
        shown: Some(TIME),
    };

    #[test]
    fn a_spec_shows_itself_as_flag_and_sentence() {
        assert_eq!((LIMIT.flag().as_str(), LIMIT.value_name(), LIMIT.told_default()), ("time-limit", "TIME", Some("2")));
        assert_eq!(LIMIT.about(), "Seconds that a frame may take, see `Spec`");
        assert_eq!(LIMIT.parse("1.5m"), Ok(Given::Number(90.0)));
        assert!(LIMIT.parse("soon").unwrap_err().contains("90s"));
    }

    #[test]
    fn defaults_are_told_as_people_write_them() {
        let points = Spec { default: "Whole::new(256)", form: Form::Whole { least: 1, most: 999 }, shown: None, ..LIMIT };
        assert_eq!((points.literal(), points.told_default()), ("256", Some("256")));
        let words = Form::Word(&[Word { name: "as-is", variant: "AsIs", doc: "" }]);
        let word = Spec { default: "Form::AsIs", form: words, shown: None, ..LIMIT };
        assert_eq!((word.literal(), word.told_default()), ("as-is", Some("as-is")));
        let any = Spec { name: "baseline_m", default: "None", form: Form::Interval { most: u32::MAX }, shown: Some(METERS), ..LIMIT };
        assert_eq!((any.flag().as_str(), any.told_default(), any.examples()), ("baseline", Some("any"), Some("0.3..2, 0.3.. or ..2")));
    }

    #[test]
    fn an_unknown_name_gets_the_nearest() {
        assert!(unknown("time_limit", &[LIMIT]).contains("did you mean `time_limit_s`?"));
    }
}

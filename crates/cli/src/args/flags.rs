//! Flags of options that are declared once, made from their declaration.

use crate::outcome::Problem;
use clap::builder::{PathBufValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, ValueHint};
use enfilade_options::{Form, Given, Options, Spec, Unit, Value, Word};
use std::marker::PhantomData;

/// The options of `T` that the command line gives.
pub struct Flags<T> {
    given: Vec<(&'static Spec, Given)>,
    of: PhantomData<T>,
}

impl<T: Options> Flags<T> {
    /// The first flag that is given, with its hyphens.
    pub fn first(&self) -> Option<String> {
        self.given.first().map(|(spec, _)| format!("--{}", spec.flag()))
    }

    /// Lays what is given over `target`.
    pub fn apply(&self, target: &mut T) -> Result<(), Problem> {
        self.given.iter().try_for_each(|(spec, given)| {
            let wrong = |message: String| Problem::new(format!("--{}: {message}", spec.flag()), "--help of this verb has every flag");
            target.set(spec.name, given).map_err(wrong)
        })
    }

    /// The options, those that are not given by their defaults.
    pub fn options(&self) -> Result<T, Problem> {
        let mut options = T::default();
        self.apply(&mut options)?;
        Ok(options)
    }
}

impl<T: Options> FromArgMatches for Flags<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = T::OPTIONS.iter().filter_map(|spec| Some((spec, given(spec, matches)?))).collect();
        Ok(Self { given, of: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl<T: Options> Args for Flags<T> {
    fn augment_args(command: Command) -> Command {
        command.args(T::OPTIONS.iter().map(flag))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

fn given(spec: &Spec, matches: &ArgMatches) -> Option<Given> {
    if matches.value_source(spec.name) != Some(ValueSource::CommandLine) {
        return None;
    }
    match spec.form {
        Form::Switch => Some(Given::Switch(true)),
        Form::List(_) | Form::Two(_) => Some(Given::List(matches.get_many::<Given>(spec.name)?.cloned().collect())),
        _ => matches.get_one::<Given>(spec.name).cloned(),
    }
}

fn flag(spec: &'static Spec) -> Arg {
    let examples = spec.examples().map(|examples| format!(": {examples}"));
    let default = spec.told_default().map(|default| format!(" [default: {default}]"));
    let about = [Some(spec.about()), examples, default];
    let arg = Arg::new(spec.name).long(spec.flag()).help(about.into_iter().flatten().collect::<String>());
    let arg = match spec.form {
        Form::Switch => return arg.action(ArgAction::SetTrue),
        Form::List(element) => valued(arg.action(ArgAction::Append).value_delimiter(','), spec, element),
        Form::Two(element) => return valued(arg, spec, element).num_args(2).value_names([spec.value_name(); 2]),
        Form::Path => valued(arg.value_hint(ValueHint::AnyPath), spec, &spec.form),
        _ => valued(arg, spec, &spec.form),
    };
    arg.value_name(spec.value_name())
}

/// The flag with what reads a value of `form`.
fn valued(arg: Arg, spec: &'static Spec, form: &'static Form) -> Arg {
    let unit = spec.unit();
    let is_number = matches!(form, Form::Number | Form::Integer | Form::Whole { .. });
    // A number with its unit is no plain negative number, and one that is below zero has an error that says so.
    let begins_with_minus = form.may_begin_with_minus() || unit != Unit::None;
    let arg = arg.allow_negative_numbers(is_number).allow_hyphen_values(begins_with_minus);
    match form {
        Form::Word(words) => arg.value_parser(words_parser(words).map(Given::Text)),
        // Names of files need not be UTF-8.
        Form::Path => arg.value_parser(PathBufValueParser::new().map(Given::Path)),
        form => arg.value_parser(move |text: &str| form.parse(text, unit)),
    }
}

/// Reads one of the words of `T`, for a flag that is no option of a struct.
pub fn word<T: Value + Clone + Send + Sync + 'static>() -> impl TypedValueParser<Value = T> {
    let words = if let Form::Word(words) = T::FORM { words } else { &[] };
    words_parser(words).try_map(|text| T::read(&Given::Text(text)).ok_or("expected a word of these"))
}

fn words_parser(words: &'static [Word]) -> PossibleValuesParser {
    let value = |word: &Word| {
        let about = word.about();
        let value = PossibleValue::new(word.name);
        if about.is_empty() { value } else { value.help(about) }
    };
    PossibleValuesParser::new(words.iter().map(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_pipeline::{FileSource, HomeConfig, Moment, RoomKind, UpAxis};

    fn read<T: Options>(words: &[&str]) -> Result<Flags<T>, clap::Error> {
        let matches = Flags::<T>::augment_args(Command::new("test").no_binary_name(true)).try_get_matches_from(words)?;
        Flags::from_arg_matches(&matches)
    }

    #[test]
    fn every_option_is_a_flag_and_only_what_is_given_counts() {
        let flags: Flags<FileSource> = read(&["--up-axis", "-x", "--panes", "glass*,window pane", "--allow-missing-meshes"]).unwrap();
        let source = flags.options().unwrap();
        let expected = FileSource { up_axis: Some(UpAxis::MinusX), allow_missing_meshes: true, ..FileSource::default() };
        assert_eq!(source, FileSource { panes: vec!["glass*".into(), "window pane".into()], ..expected });
        assert_eq!(flags.first().as_deref(), Some("--up-axis"));
        assert_eq!(read::<FileSource>(&[]).unwrap().first(), None);
    }

    #[test]
    fn values_are_read_by_their_types() {
        let words =
            ["--seed", "18446744073709551615", "--rooms", "living,hall", "--rooms", "hall", "--moment", "night", "--clutter", "0.1"];
        let home: HomeConfig = read(&words).unwrap().options().unwrap();
        assert_eq!((home.seed, home.moment, home.clutter, home.realism), (u64::MAX, Some(Moment::Night), 0.1, 1.0));
        assert_eq!(home.rooms, [RoomKind::Living, RoomKind::Hall, RoomKind::Hall]);
    }

    #[test]
    fn values_that_cannot_be_are_refused_with_what_was_expected() {
        for (words, expected) in [
            (["--seed", "-1"], "expected a whole number of at least 0"),
            (["--clutter", "much"], "expected a number"),
            (["--moment", "noon"], "[possible values: day, evening, night]"),
            (["--rooms", "attic"], "[possible values: living"),
            (["--assets-shar", "1"], "--assets-share"),
        ] {
            let Err(error) = read::<HomeConfig>(&words) else { panic!("{words:?}") };
            assert!(error.to_string().contains(expected), "{error}");
        }
    }

    #[test]
    fn help_has_the_sentence_of_the_declaration_and_the_default() {
        let mut command = Flags::<HomeConfig>::augment_args(Command::new("test"));
        let help = command.render_long_help().to_string();
        for part in
            ["--clutter <X>", "[default: 1]", "--realism <SHARE>", "Seed of the floor plan alone", "- evening:", "--rooms <KIND,KIND>"]
        {
            assert!(help.contains(part), "{part}: {help}");
        }
    }
}

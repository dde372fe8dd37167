//! `cargo xtask signatures`: options in the signatures of the Python module's stubs, from their declarations.
//!
//! They are the lines from `# options: STRUCT` to `# end of options`; the rest of the stubs is written by hand.

use super::fields::{Declared, argument, last_name};
use super::sources::Sources;
use crate::house::House;
use syn::Type;

const STUBS: [&str; 2] = ["crates/python/enfilade/__init__.pyi", "crates/python/enfilade/farm.pyi"];
const BEGINS: &str = "# options: ";
const ENDS: &str = "# end of options";

/// Writes the lines anew.
///
/// # Errors
/// When the stub cannot be read or written, or an option has a type without a word in Python.
pub fn write(house: &House) -> Result<(), String> {
    let sources = Sources::read(house)?;
    STUBS.iter().try_for_each(|stub| {
        let text = renewed(&house.read(stub)?, &sources).map_err(|error| format!("{stub}: {error}"))?;
        std::fs::write(house.root.join(stub), text).map_err(|error| format!("cannot write {stub}: {error}"))
    })
}

/// Compares the lines with the declarations.
///
/// # Errors
/// With the first line that differs.
pub fn check(house: &House) -> Result<String, String> {
    let sources = Sources::read(house)?;
    let counts = STUBS.iter().map(|stub| check_stub(stub, &house.read(stub)?, &sources)).collect::<Result<Vec<_>, _>>()?;
    Ok(format!("{} signatures", counts.iter().sum::<usize>()))
}

/// The number of signatures with options in a stub whose lines are as they should be.
fn check_stub(stub: &str, text: &str, sources: &Sources) -> Result<usize, String> {
    let expected = renewed(text, sources).map_err(|error| format!("{stub}: {error}"))?;
    let differs = text.lines().zip(expected.lines()).position(|(found, expected)| found != expected);
    match differs {
        Some(line) => {
            let [found, expected] = [text, &expected].map(|text| text.lines().nth(line).unwrap_or_default().trim());
            Err(format!("{stub}:{}: found `{found}`, expected `{expected}`", line + 1))
        }
        None if text != expected => Err(format!("{stub} ends otherwise than it should")),
        None => Ok(text.matches(BEGINS).count()),
    }
}

/// The structs whose options the function or method `name` of a stub takes; a class takes those of `__new__`.
pub fn options_of<'s>(stub: &'s str, name: &str) -> Vec<&'s str> {
    let begins = [format!("def {name}("), "def __new__(".into()];
    let from = begins.iter().find_map(|begin| stub.find(begin.as_str()));
    let own = from.and_then(|from| stub[from + 1..].split("def ").next()).unwrap_or_default();
    own.lines().filter_map(|line| line.trim_start().strip_prefix(BEGINS)).collect()
}

/// The stub without the lines that mark options.
pub fn without_marks(stub: &str) -> String {
    let is_mark = |line: &&str| line.trim_start().starts_with(BEGINS) || line.trim() == ENDS;
    stub.lines().filter(|line| !is_mark(line)).collect::<Vec<_>>().join("\n")
}

fn renewed(text: &str, sources: &Sources) -> Result<String, String> {
    let (mut renewed, mut inside) = (String::new(), false);
    for line in text.lines() {
        if line.trim() == ENDS {
            inside = false;
        }
        if !inside {
            renewed += &format!("{line}\n");
        }
        if let Some(name) = line.trim_start().strip_prefix(BEGINS) {
            inside = true;
            let indent = &line[..line.len() - line.trim_start().len()];
            for option in sources.fields(name)? {
                renewed += &format!("{indent}{}\n", keyword(option, sources)?);
            }
        }
    }
    if inside { Err(format!("a line `{ENDS}` is missing")) } else { Ok(renewed) }
}

/// `name: type = default,`.
fn keyword(option: &Declared, sources: &Sources) -> Result<String, String> {
    let of = python_type(option, sources)?;
    let word = option.default.as_deref().and_then(|variant| sources.word(&option.of, variant));
    let (of, default) = match word.as_deref().or(option.default.as_deref()) {
        Some("true") => (of, "True"),
        Some("false") => (of, "False"),
        Some(value) if value.starts_with(|c: char| c == '"' || c.is_ascii_digit()) => (of, value),
        _ => (format!("{of} | None"), "None"),
    };
    Ok(format!("{}: {of} = {default},", option.name))
}

fn python_type(option: &Declared, sources: &Sources) -> Result<String, String> {
    // In Python one word is for all that can be opened.
    let word = syn::parse_quote!(StateWord);
    let of = if last_name(argument(&option.of).unwrap_or(&option.of)).as_deref() == Some("States") { &word } else { &option.of };
    if let Some(values) = sources.values(of) {
        return Ok(format!("Literal[{}]", values.join(", ")));
    }
    if let Type::Array(array) = &option.of {
        let of = match &*array.elem {
            Type::Tuple(_) => "Sequence[tuple[str, int] | str]",
            number if last_name(number).as_deref() == Some("f64") => "Sequence[float]",
            _ => "Sequence[int]",
        };
        return Ok(of.into());
    }
    let of = match last_name(&option.of).as_deref() {
        Some("bool") => "bool",
        Some("u32" | "u64" | "i64" | "Whole") => "int",
        Some("f32" | "f64") => "float",
        Some("String") => "str",
        Some("EnvironmentOverride" | "PathBuf") => "Path",
        Some("Interval") => "Sequence[float]",
        Some("Vec") => match argument(&option.of) {
            Some(Type::Array(_)) => "Sequence[Sequence[float]]",
            Some(of) if last_name(of).as_deref() == Some("u32") => "Sequence[int]",
            Some(of) if last_name(of).as_deref() == Some("f64") => "Sequence[float]",
            _ => "Names",
        },
        Some("Many") => "Names",
        other => {
            return Err(format!(
                "the option `{}` is a {other:?}, which has no word in Python yet: xtask/src/docs/signatures.rs",
                option.name
            ));
        }
    };
    Ok(of.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stub_has_the_options_that_are_declared() {
        check(&House::find().unwrap()).unwrap();
    }

    #[test]
    fn lines_between_the_marks_are_renewed_and_others_stay() {
        let sources = Sources::read(&House::find().unwrap()).unwrap();
        let old = "def home(\n    *,\n    # options: HomeConfig\n    gone: int = 3,\n    # end of options\n    progress: bool = True,\n) -> None: ...\n";
        let new = renewed(old, &sources).unwrap();
        assert!(
            !new.contains("gone") && new.contains("\n    clutter: float = 1.0,\n") && new.contains("    progress: bool = True,\n"),
            "{new}"
        );
        assert!(new.contains("moment: Literal[\"day\", \"evening\", \"night\"] | None = None,"), "{new}");
        assert_eq!(renewed(&new, &sources).unwrap(), new);
        assert_eq!(options_of(&new, "home"), ["HomeConfig"]);
        assert!(!without_marks(&new).contains('#'));
        assert!(renewed("    # options: HomeConfig\n", &sources).unwrap_err().contains("is missing"));
    }
}

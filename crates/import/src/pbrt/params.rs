//! The parameters of a directive: a list of `"type name" [values]`.

use super::tokens::{Kind, Tokens};
use crate::ImportError;
use enfilade_math::DVec3;
use std::cell::Cell;
use std::path::PathBuf;
use std::rc::Rc;

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Numbers(Vec<f64>),
    Strings(Vec<String>),
    Bools(Vec<bool>),
}

/// A parameter.
#[derive(Clone, Debug)]
pub(super) struct Param {
    /// `float`, `rgb`, `texture` …, as the file spells it.
    pub kind: String,
    pub name: String,
    pub values: Values,
    /// For textures: the indices that the name meant at this place of the file, among textures of colours and of numbers.
    pub bound: Cell<[Option<usize>; 2]>,
    used: Cell<bool>,
}

/// The place of a directive in the file, and its name.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub file: Rc<PathBuf>,
    pub line: u32,
    pub column: u32,
    /// The directive and its first word, such as `Shape "sphere"`.
    pub what: String,
}

impl Place {
    /// For messages: file, line, column and directive.
    pub(super) fn text(&self) -> String {
        let file = self.file.file_name().map_or_else(String::new, |f| f.to_string_lossy().into_owned());
        format!("{file} line {}:{} {}", self.line, self.column, self.what)
    }

    /// An error about the directive.
    pub(super) fn error(&self, problem: impl Into<String>) -> ImportError {
        ImportError::malformed(&self.file, format!("line {}:{} {}", self.line, self.column, self.what), problem)
    }
}

/// The parameters of one directive.
#[derive(Clone, Debug)]
pub(super) struct Params {
    pub place: Place,
    list: Vec<Param>,
}

impl Params {
    /// Reads parameters as long as there are any.
    ///
    /// # Errors
    /// When a type is unknown, a value is missing or is of another type.
    pub(super) fn read(tokens: &mut Tokens, place: Place) -> Result<Self, ImportError> {
        let mut list = Vec::new();
        while let Some(token) = tokens.peek()?
            && let Kind::Quoted(declaration) = token.kind
        {
            tokens.next()?;
            let words: Vec<&str> = declaration.split_whitespace().collect();
            let [kind, name] = words[..] else {
                return Err(tokens.error(format!("found {declaration:?}, expected a parameter's type and name, as in \"float radius\"")));
            };
            let values = values(tokens, kind, name)?;
            list.push(Param { kind: kind.to_string(), name: name.to_string(), values, bound: Cell::default(), used: Cell::new(false) });
        }
        Ok(Self { place, list })
    }

    /// No parameters at all.
    pub(super) fn none(what: &str) -> Self {
        let place = Place { file: Rc::new(PathBuf::new()), line: 0, column: 0, what: what.to_string() };
        Self { place, list: Vec::new() }
    }

    /// Adds the parameters that `Attribute` gave for all directives of a kind; the directive's own come first.
    pub(super) fn with_defaults<'d>(mut self, defaults: impl Iterator<Item = &'d Self>) -> Self {
        let others: Vec<Param> = defaults.flat_map(|d| d.list.clone()).collect();
        // A default that no directive asks for is no mistake.
        others.iter().for_each(|p| p.used.set(true));
        self.list.extend(others);
        self
    }

    /// A parameter by its name.
    pub(super) fn get(&self, name: &str) -> Option<&Param> {
        let found = self.list.iter().find(|p| p.name == name)?;
        found.used.set(true);
        Some(found)
    }

    /// True when there is a parameter of this name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Marks parameters as used that have no meaning here.
    pub(super) fn ignore(&self, names: &[&str]) {
        self.list.iter().filter(|p| names.contains(&p.name.as_str())).for_each(|p| p.used.set(true));
    }

    /// Marks all parameters as used, if a warning reports that the whole directive was dropped.
    pub(super) fn ignore_all(&self) {
        self.list.iter().for_each(|p| p.used.set(true));
    }

    /// The parameters that nothing asked for.
    pub(super) fn unused(&self) -> impl Iterator<Item = &Param> {
        self.list.iter().filter(|p| !p.used.get())
    }

    /// All parameters, without marking them as used.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Param> {
        self.list.iter()
    }

    /// All numbers of a parameter; none when it is absent.
    pub(super) fn numbers(&self, name: &str) -> Result<&[f64], ImportError> {
        match self.get(name) {
            None => Ok(&[]),
            Some(Param { values: Values::Numbers(n), .. }) => Ok(n),
            Some(p) => Err(self.wrong(p, "numbers")),
        }
    }

    /// Single number of a parameter.
    pub(super) fn float(&self, name: &str) -> Result<Option<f64>, ImportError> {
        let Some(param) = self.get(name) else { return Ok(None) };
        match &param.values {
            Values::Numbers(n) if n.len() == 1 => Ok(Some(n[0])),
            _ => Err(self.wrong(param, "one number")),
        }
    }

    /// Single number of a parameter, or a default.
    pub(super) fn float_or(&self, name: &str, default: f64) -> Result<f64, ImportError> {
        Ok(self.float(name)?.unwrap_or(default))
    }

    /// Three numbers, or a default.
    pub(super) fn point_or(&self, name: &str, default: DVec3) -> Result<DVec3, ImportError> {
        let Some(param) = self.get(name) else { return Ok(default) };
        match &param.values {
            Values::Numbers(n) if n.len() == 3 => Ok(DVec3::new(n[0], n[1], n[2])),
            _ => Err(self.wrong(param, "three numbers")),
        }
    }

    /// A string.
    pub(super) fn string(&self, name: &str) -> Result<Option<&str>, ImportError> {
        let Some(param) = self.get(name) else { return Ok(None) };
        match &param.values {
            Values::Strings(s) if s.len() == 1 => Ok(Some(&s[0])),
            _ => Err(self.wrong(param, "one string in quotation marks")),
        }
    }

    /// A truth value, or a default.
    pub(super) fn flag(&self, name: &str, default: bool) -> Result<bool, ImportError> {
        let Some(param) = self.get(name) else { return Ok(default) };
        match &param.values {
            Values::Bools(b) if b.len() == 1 => Ok(b[0]),
            _ => Err(self.wrong(param, "true or false")),
        }
    }

    /// Vertex indices below `vertices`.
    pub(super) fn indices(&self, name: &str, vertices: usize) -> Result<Vec<u32>, ImportError> {
        let numbers = self.numbers(name)?.iter();
        numbers
            .map(|&n| {
                let fits = n >= 0.0 && n < vertices as f64 && n.fract() == 0.0;
                let problem = || format!("{name} refers to vertex {n}, but there are {vertices}, counted from 0");
                if fits { Ok(n as u32) } else { Err(self.place.error(problem())) }
            })
            .collect()
    }

    /// An error about a parameter's value.
    pub(super) fn wrong(&self, param: &Param, expected: &str) -> ImportError {
        let found = match &param.values {
            Values::Numbers(n) => format!("{} numbers", n.len()),
            Values::Strings(s) => format!("{} strings", s.len()),
            Values::Bools(b) => format!("{} truth values", b.len()),
        };
        self.place.error(format!("\"{} {}\" has {found}, expected {expected}", param.kind, param.name))
    }
}

/// The values behind a declaration, with or without brackets.
fn values(tokens: &mut Tokens, kind: &str, name: &str) -> Result<Values, ImportError> {
    const NUMBERS: [&str; 14] = [
        "float",
        "integer",
        "point",
        "point2",
        "point3",
        "vector",
        "vector2",
        "vector3",
        "normal",
        "normal3",
        "rgb",
        "color",
        "xyz",
        "blackbody",
    ];
    let mut values = match kind {
        "bool" => Values::Bools(Vec::new()),
        "string" | "texture" => Values::Strings(Vec::new()),
        // Wavelengths and values, or the name of a file or of a spectrum that pbrt knows.
        "spectrum" => match tokens.peek()? {
            Some(t) if matches!(t.kind, Kind::Quoted(_)) => Values::Strings(Vec::new()),
            _ => Values::Numbers(Vec::new()),
        },
        kind if NUMBERS.contains(&kind) => Values::Numbers(Vec::new()),
        other => {
            let known = NUMBERS.join(", ");
            return Err(tokens.error(format!("{other:?} is not a type of parameters; expected bool, string, texture, spectrum, {known}")));
        }
    };
    let Some(first) = tokens.next()? else {
        return Err(tokens.error(format!("the value of {name:?} is missing; the file is cut short")));
    };
    if first.kind != Kind::Open {
        push(&mut values, first.kind).map_err(|problem| tokens.error(format!("{problem} for \"{kind} {name}\"")))?;
        return Ok(values);
    }
    loop {
        let Some(token) = tokens.next()? else {
            return Err(tokens.error(format!("the list of {name:?} does not end; close it by ]")));
        };
        match token.kind {
            Kind::Close => return Ok(values),
            Kind::Quoted(_) if kind == "spectrum" && values == Values::Numbers(Vec::new()) => {
                values = Values::Strings(Vec::new());
                push(&mut values, token.kind).map_err(|problem| tokens.error(problem))?;
            }
            kind_of_value => {
                push(&mut values, kind_of_value).map_err(|problem| tokens.error(format!("{problem} for \"{kind} {name}\"")))?;
            }
        }
    }
}

fn push(values: &mut Values, word: Kind) -> Result<(), String> {
    match (values, word) {
        (Values::Numbers(list), Kind::Bare(word)) => {
            let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
            list.push(number.ok_or_else(|| format!("found {word:?}, expected a finite number"))?);
        }
        (Values::Strings(list), Kind::Quoted(word)) => list.push(word.to_string()),
        // Version 3 has truth values in quotation marks.
        (Values::Bools(list), Kind::Bare(word) | Kind::Quoted(word)) => match word {
            "true" => list.push(true),
            "false" => list.push(false),
            other => return Err(format!("found {other:?}, expected true or false")),
        },
        (_, Kind::Open | Kind::Close) => return Err("found a bracket, expected a value".to_string()),
        (Values::Numbers(_), Kind::Quoted(word)) => return Err(format!("found the string {word:?}, expected a number")),
        (Values::Strings(_), Kind::Bare(word)) => return Err(format!("found {word}, expected a string in quotation marks")),
    }
    Ok(())
}

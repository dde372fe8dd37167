//! `mixes.csv`: which lamps are on, how bright, and in which colour.

use crate::error::Error;
use crate::pattern::matches;
use enfilade_dataset::{Fixture, check_name};
use enfilade_math::Rgb;
use enfilade_render::FixtureKind;
use enfilade_scene::decoded_text;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The columns of the table.
const COLUMNS: [&str; 5] = ["mix", "fixture", "r", "g", "b"];
const HINT: &str = "a table of mixes has the columns mix, fixture, r, g and b, as in docs/relight.md";

/// A mix: what each fixture's light is multiplied by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Mix {
    /// Name of the mix, and of its folder.
    pub name: String,
    rules: Vec<Rule>,
}

/// A row of the table.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Rule {
    #[serde(skip)]
    line: u64,
    /// Number of a fixture, or a pattern of names.
    fixture: String,
    factor: Rgb,
}

impl Mix {
    /// Factor for the light of a fixture: from the last row that selects it, 1 if none does.
    pub fn factor(&self, fixture: &Fixture) -> Rgb {
        self.rules.iter().rev().find(|rule| rule.means(fixture)).map_or(Rgb::WHITE, |rule| rule.factor)
    }
}

/// The line that it was read from does not count.
impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.fixture == other.fixture && self.factor == other.factor
    }
}

impl Rule {
    fn means(&self, fixture: &Fixture) -> bool {
        match self.fixture.parse::<u32>() {
            Ok(id) => id == fixture.id,
            // Most of the sky's light comes through windows.
            Err(_) if self.fixture == FixtureKind::Sky.name() && fixture.kind == FixtureKind::Window.name() => true,
            Err(_) => self.fixture == fixture.kind || matches(&self.fixture, &fixture.name),
        }
    }
}

/// The mixes of the table `file`; where the fixtures of scenes are given, rows that mean none of them are refused.
pub(crate) fn mixes_of(file: &Path, fixtures: Option<&[Fixture]>) -> Result<Vec<Mix>, Error> {
    let mixes = read(file)?;
    if let Some(fixtures) = fixtures {
        check(file, &mixes, &fixtures.iter().collect::<Vec<_>>())?;
    }
    Ok(mixes)
}

/// Reads and checks the table `file`.
fn read(file: &Path) -> Result<Vec<Mix>, Error> {
    let unreadable = |error: std::io::Error| Error::usage(format!("cannot read {}: {error}", file.display()), HINT);
    parse(file, &std::fs::read(file).map_err(unreadable)?)
}

fn parse(file: &Path, text: &[u8]) -> Result<Vec<Mix>, Error> {
    let wrong = |line: u64, what: String| Error::usage(format!("{}:{line}: {what}", file.display()), HINT);
    let text = decoded_text(text);
    let first = text.lines().next().unwrap_or_default();
    let separator = [b',', b';', b'\t'].into_iter().find(|byte| first.as_bytes().contains(byte)).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).delimiter(separator).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
    let mut at = [0; COLUMNS.len()];
    for (at, name) in at.iter_mut().zip(COLUMNS) {
        let found = header.iter().position(|column| column.eq_ignore_ascii_case(name));
        *at = found.ok_or_else(|| wrong(1, format!("no column {name:?}, only {}", header.iter().collect::<Vec<_>>().join(", "))))?;
    }
    let mut mixes: Vec<Mix> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| wrong(error.position().map_or(0, csv::Position::line), error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        if record.iter().all(str::is_empty) {
            continue;
        }
        let [name, fixture, factors @ ..] = at.map(|column| record.get(column).unwrap_or(""));
        check_name("mix", name).map_err(|error| wrong(line, error.to_string()))?;
        if fixture.is_empty() {
            return Err(wrong(
                line,
                "no fixture; expected a number, a kind or a name of metadata_fixtures.csv, or a pattern such as *".into(),
            ));
        }
        let mut factor = [0.0; 3];
        for ((channel, text), column) in factor.iter_mut().zip(factors).zip(&COLUMNS[2..]) {
            // Between semicolons the comma is the decimal point.
            let number = text.replace(',', ".").parse().ok().filter(|v: &f32| v.is_finite() && *v >= 0.0);
            *channel = number.ok_or_else(|| wrong(line, format!("{column}: expected a number from 0, found {text:?}")))?;
        }
        let rule = Rule { line, fixture: fixture.into(), factor: Rgb::from(factor) };
        match mixes.iter_mut().find(|mix| mix.name == name) {
            Some(mix) => mix.rules.push(rule),
            None => mixes.push(Mix { name: name.into(), rules: vec![rule] }),
        }
    }
    if mixes.is_empty() {
        return Err(wrong(2, "no mix".into()));
    }
    Ok(mixes)
}

/// Refuses rows that mean no fixture of any scene by its number or name; kinds may be named that a scene lacks.
fn check(file: &Path, mixes: &[Mix], fixtures: &[&Fixture]) -> Result<(), Error> {
    let is_kind = |rule: &Rule| FixtureKind::ALL.iter().any(|kind| kind.name() == rule.fixture);
    let idle = |rule: &&Rule| !is_kind(rule) && !fixtures.iter().any(|fixture| rule.means(fixture));
    let Some(rule) = mixes.iter().flat_map(|mix| &mix.rules).find(idle) else { return Ok(()) };
    let names: Vec<&str> = fixtures.iter().map(|fixture| fixture.name.as_str()).take(12).collect();
    let more = if fixtures.len() > names.len() { ", …" } else { "" };
    Err(Error::usage(
        format!("{}:{}: no fixture is {:?}", file.display(), rule.line, rule.fixture),
        format!("the fixtures are: {}{more}; _detail/metadata_fixtures.csv of each scene lists them", names.join(", ")),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixture(id: u32, kind: &str, name: &str) -> Fixture {
        let (kind, name) = (kind.into(), name.into());
        Fixture { id, kind, name, intensity: None, position: None, node_ids: Vec::new(), lights: Vec::new() }
    }

    fn parsed(text: &str) -> Result<Vec<Mix>, String> {
        parse(Path::new("mixes.csv"), text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_last_row_that_means_a_fixture_counts() {
        let mixes = parsed(
            "mix,fixture,r,g,b\nnight,sky,0,0,0\nnight,*bulb*,2,1,0.5\nnight,3,0,0,0\nday,lamp,0,0,0\nday,sky,2,2,2\nday,window,3,3,3\n",
        )
        .unwrap();
        assert_eq!(mixes.iter().map(|mix| mix.name.as_str()).collect::<Vec<_>>(), ["night", "day"]);
        let fixtures =
            [fixture(1, "sky", "sky"), fixture(2, "lamp", "desk bulb"), fixture(3, "lamp", "bulb"), fixture(4, "window", "pane")];
        let factors = |mix: &Mix| fixtures.each_ref().map(|fixture| mix.factor(fixture));
        assert_eq!(factors(&mixes[0]), [Rgb::BLACK, Rgb::new(2.0, 1.0, 0.5), Rgb::BLACK, Rgb::BLACK]);
        assert_eq!(factors(&mixes[1]), [Rgb::splat(2.0), Rgb::BLACK, Rgb::BLACK, Rgb::splat(3.0)]);
        check(Path::new("mixes.csv"), &mixes, &fixtures.each_ref()).unwrap();
        let message = check(Path::new("mixes.csv"), &mixes, &[&fixtures[0]]).unwrap_err().to_string();
        assert_eq!(message, "mixes.csv:3: no fixture is \"*bulb*\"");
        check(Path::new("mixes.csv"), &mixes[1..], &[&fixtures[0]]).unwrap();
    }

    #[test]
    fn tables_that_are_wrong_are_refused_with_their_line() {
        for (text, expected) in [
            ("", "mixes.csv:1: no column \"mix\", only "),
            ("mix,fixture,r,g\n", "mixes.csv:1: no column \"b\", only mix, fixture, r, g"),
            ("mix,fixture,r,g,b\n", "mixes.csv:2: no mix"),
            ("mix,fixture,r,g,b\na,sky,1,1,-1\n", "mixes.csv:2: b: expected a number from 0, found \"-1\""),
            ("mix,fixture,r,g,b\na,sky,1,1,1\na,,1,1,1\n", "mixes.csv:3: no fixture; "),
            ("mix,fixture,r,g,b\n../a,sky,1,1,1\n", "mixes.csv:2: mix \"../a\""),
            ("mix,fixture,r,g,b\na,sky,1,1\n", "mixes.csv:2: "),
        ] {
            let message = parsed(text).unwrap_err();
            assert!(message.starts_with(expected), "{text:?}: {message}");
        }
    }
}

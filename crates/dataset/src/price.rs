//! Prices of processor time: of the machine, and of everything licensed beside it.
//!
//! A price is one way to pay, such as spot machines; a table of prices has several, and every sum is given for each. A price has one rate
//! or more: the machine's, and those of licences. Hypersim paid 0.0161 to 0.0484 dollars per vCPU-hour for machines, half of them 0.0165 or
//! less, and 0.009 for V-Ray on each, which is 0.00015 per core-minute.

use serde::{Deserialize, Serialize};
use std::path::Path;

/// Advice if a price cannot be read.
const HELP: &str = "give dollars per vCPU-hour, as in --price 0.04; with what is paid beside the machine --price 0.0165,licence=0.00015/core-minute; \
                    or a table of lines like: on demand,0.048. With sizes of machines its first line is \
                    name,dollars_per_vcpu_hour,vcpus,memory_gib, and further columns may be such as licence_dollars_per_core_minute";
/// Names of the first columns of a table that has more than two, and of the columns of sizes.
const FIRST: [&str; 2] = ["name", "dollars_per_vcpu_hour"];
const SIZES: [&str; 2] = ["vcpus", "memory_gib"];
/// Name of the machine's rate if there are others.
const MACHINE: &str = "machine";

/// The size of a machine that can be had at a price.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Threads; 1 or more.
    pub vcpus: u32,
    /// Above 0.
    pub memory_gib: f64,
}

/// The unit of a rate. A core is a vCPU, a thread of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Per {
    /// An hour of one thread of a machine, busy or idle.
    VcpuHour,
    /// A minute of one.
    CoreMinute,
}

impl Per {
    /// Words of each: as it is written with a rate, in names of columns, and in sentences.
    const WORDS: [(Self, &'static str, &'static str, &'static str); 2] = [
        (Self::VcpuHour, "vcpu-hour", "_dollars_per_vcpu_hour", "per vCPU-hour"),
        (Self::CoreMinute, "core-minute", "_dollars_per_core_minute", "per core-minute"),
    ];

    fn in_a_vcpu_hour(self) -> f64 {
        match self {
            Self::VcpuHour => 1.0,
            Self::CoreMinute => 60.0,
        }
    }
}

/// Something that is paid beside the machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// Name of the rate, such as "licence".
    pub name: String,
    /// 0 or more.
    pub dollars: f64,
    /// Unit of the rate.
    pub per: Per,
}

impl Rate {
    /// Dollars for an hour of one thread.
    pub fn dollars_per_vcpu_hour(&self) -> f64 {
        self.dollars * self.per.in_a_vcpu_hour()
    }
}

/// One way to pay, with its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Price {
    /// Name of the price, such as "spot".
    pub name: String,
    /// Rate of the machine; 0 or more.
    pub dollars_per_vcpu_hour: f64,
    /// The machine that is paid, where its size is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<Machine>,
    /// Rates that are paid in addition.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub licences: Vec<Rate>,
}

impl Default for Price {
    /// The median of Hypersim's machine prices.
    fn default() -> Self {
        Self::new("Hypersim's median", 0.0165)
    }
}

impl Price {
    /// A machine of unknown size, and nothing beside it.
    pub fn new(name: &str, dollars_per_vcpu_hour: f64) -> Self {
        Self { name: name.into(), dollars_per_vcpu_hour, machine: None, licences: Vec::new() }
    }

    /// Dollars of all rates together.
    pub fn dollars(&self, vcpu_hours: f64) -> f64 {
        vcpu_hours * self.all_per_vcpu_hour()
    }

    /// Dollars of the machine alone.
    pub fn machine_dollars(&self, vcpu_hours: f64) -> f64 {
        vcpu_hours * self.dollars_per_vcpu_hour
    }

    /// Dollars of everything besides the machine.
    pub fn licence_dollars(&self, vcpu_hours: f64) -> f64 {
        vcpu_hours * self.licences.iter().map(Rate::dollars_per_vcpu_hour).sum::<f64>()
    }

    /// Dollars of the whole machine for some seconds, licences for all of it included; `None` if its size is not given.
    pub fn whole_machine_dollars(&self, wall_s: f64) -> Option<f64> {
        Some(self.dollars(wall_s / 3600.0 * f64::from(self.machine?.vcpus)))
    }

    /// Dollars by rate, the machine's first; empty where that is the only one.
    pub fn parts(&self, vcpu_hours: f64) -> Vec<(&str, f64)> {
        if self.licences.is_empty() {
            return Vec::new();
        }
        let licences = self.licences.iter().map(|rate| (rate.name.as_str(), vcpu_hours * rate.dollars_per_vcpu_hour()));
        std::iter::once((MACHINE, self.machine_dollars(vcpu_hours))).chain(licences).collect()
    }

    /// All rates in words: "0.0165 per vCPU-hour and 0.00015 per core-minute for licence".
    pub fn rates(&self) -> String {
        let licence = |rate: &Rate| {
            let per = Per::WORDS.iter().find(|(per, ..)| *per == rate.per).map_or("", |(.., words)| words);
            format!(" and {} {per} for {}", rate.dollars, rate.name)
        };
        format!("{} per vCPU-hour", self.dollars_per_vcpu_hour) + &self.licences.iter().map(licence).collect::<String>()
    }

    /// Sum of all rates.
    pub(crate) fn all_per_vcpu_hour(&self) -> f64 {
        self.dollars_per_vcpu_hour + self.licences.iter().map(Rate::dollars_per_vcpu_hour).sum::<f64>()
    }
}

/// A text that is not a price.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct PriceError {
    message: String,
}

impl PriceError {
    fn new(message: impl Into<String>) -> Self {
        Self { message: message.into() }
    }

    /// Advice on valid prices.
    pub fn help(&self) -> &'static str {
        HELP
    }
}

/// Prices from a number, from rates, or from the file of a table.
///
/// `0.0165` is the machine's rate per vCPU-hour; `0.0165,licence=0.00015/core-minute` adds others, each with a name, and `/vcpu-hour` or no
/// unit for those per vCPU-hour. A line of a table is `name,dollars_per_vcpu_hour`, with or without a header line. With a header line of
/// more columns, these may be followed by `vcpus,memory_gib`, the numbers of threads and gibibytes of each machine, and by columns such as
/// `licence_dollars_per_core_minute` or `licence_dollars_per_vcpu_hour`; a cell of these may be empty.
///
/// # Errors
/// When it is neither, with the line of a table.
pub fn read_prices(given: &str) -> Result<Vec<Price>, PriceError> {
    let (first, further) = given.split_once(',').map_or((given, None), |(first, further)| (first, Some(further)));
    if let Ok(dollars) = first.trim().parse::<f64>() {
        let price = Price { licences: further.map_or(Ok(Vec::new()), rates)?, ..Price::new("given", dollars) };
        return Ok(vec![checked(price)?]);
    }
    let bytes = std::fs::read(Path::new(given));
    let bytes = bytes.map_err(|error| PriceError::new(format!("the price {given:?} is no number, and no table: {error}")))?;
    table(given, &enfilade_scene::decoded_text(&bytes))
}

/// Rates as the command line has them: `licence=0.00015/core-minute,storage=0.001`.
fn rates(text: &str) -> Result<Vec<Rate>, PriceError> {
    let wrong = |part: &str| PriceError::new(format!("{part:?} is no rate; expected something like licence=0.00015/core-minute"));
    let rate = |part: &str| {
        let (name, value) = part.split_once('=').filter(|(name, _)| !name.trim().is_empty()).ok_or_else(|| wrong(part))?;
        let (dollars, per) = value.split_once('/').unwrap_or((value, Per::WORDS[0].1));
        let per = Per::WORDS.iter().find(|(_, word, ..)| *word == per.trim()).map(|&(per, ..)| per).ok_or_else(|| wrong(part))?;
        Ok(Rate { name: name.trim().into(), dollars: dollars.trim().parse().map_err(|_| wrong(part))?, per })
    };
    text.split(',').map(rate).collect()
}

/// The prices of a table; `place` is its file.
fn table(place: &str, text: &str) -> Result<Vec<Price>, PriceError> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).peekable();
    let header = lines.next_if(|(_, line)| line.starts_with("name,")).map(|(_, line)| line);
    let columns = header.filter(|line| line.split(',').count() > 2).map(|line| Columns::read(place, line)).transpose()?;
    let price = |(i, line): (usize, &str)| {
        let (read, what) = match &columns {
            Some(columns) => (columns.price(line), "is no machine with its rates and, where there are columns for them, vCPUs and memory"),
            None => (plain(line), "is no price"),
        };
        let price = read.ok_or_else(|| PriceError::new(format!("{place}, line {}: {line:?} {what}", i + 1)))?;
        checked(price).map_err(|error| PriceError::new(format!("{place}, line {}: {error}", i + 1)))
    };
    let prices: Vec<Price> = lines.map(price).collect::<Result<_, _>>()?;
    if prices.is_empty() { Err(PriceError::new(format!("{place} has no prices"))) } else { Ok(prices) }
}

/// A line of a table without columns: a name, which may have commas, and a rate.
fn plain(line: &str) -> Option<Price> {
    let (name, dollars) = line.rsplit_once(',')?;
    Some(Price::new(name.trim(), dollars.trim().parse().ok()?))
}

/// The meanings of a table's columns after the first two.
struct Columns {
    has_sizes: bool,
    /// Names and units of rates.
    licences: Vec<(String, Per)>,
}

impl Columns {
    fn read(place: &str, header: &str) -> Result<Self, PriceError> {
        let names: Vec<&str> = header.split(',').map(str::trim).collect();
        let further = names.strip_prefix(&FIRST);
        let has_sizes = further.is_some_and(|names| names.starts_with(&SIZES));
        let further = further.map(|names| names.strip_prefix(&SIZES).unwrap_or(names));
        let licence = |name: &&str| {
            let found = Per::WORDS.iter().find_map(|&(per, _, end, _)| Some((name.strip_suffix(end)?, per)));
            found.filter(|(name, _)| !name.is_empty()).map(|(name, per)| (name.to_string(), per))
        };
        let licences: Option<Vec<_>> = further.and_then(|names| names.iter().map(licence).collect());
        let licences = licences.ok_or_else(|| {
            let expected = [FIRST, SIZES].concat().join(",");
            PriceError::new(format!(
                "{place}, line 1: the columns are {}; expected {expected}, the last two or none of them, and then any such as \
                 licence_dollars_per_core_minute or licence_dollars_per_vcpu_hour",
                names.join(",")
            ))
        })?;
        Ok(Self { has_sizes, licences })
    }

    fn price(&self, line: &str) -> Option<Price> {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let (&[name, dollars], cells) = cells.split_first_chunk()?;
        let (machine, cells) = if self.has_sizes {
            let (&[vcpus, memory_gib], cells) = cells.split_first_chunk()?;
            let machine = Machine { vcpus: vcpus.parse().ok()?, memory_gib: memory_gib.parse().ok()? };
            let is_possible = machine.vcpus >= 1 && machine.memory_gib > 0.0 && machine.memory_gib.is_finite();
            (Some(is_possible.then_some(machine)?), cells)
        } else {
            (None, cells)
        };
        if cells.len() != self.licences.len() {
            return None;
        }
        let paid = self.licences.iter().zip(cells).filter(|(_, cell)| !cell.is_empty());
        let rate = |((name, per), cell): (&(String, Per), &&str)| Some(Rate { name: name.clone(), dollars: cell.parse().ok()?, per: *per });
        Some(Price { machine, licences: paid.map(rate).collect::<Option<_>>()?, ..Price::new(name, dollars.parse().ok()?) })
    }
}

fn checked(price: Price) -> Result<Price, PriceError> {
    let rates =
        std::iter::once(("price", price.dollars_per_vcpu_hour)).chain(price.licences.iter().map(|rate| (rate.name.as_str(), rate.dollars)));
    for (name, dollars) in rates {
        if !(dollars >= 0.0 && dollars.is_finite()) {
            return Err(PriceError::new(format!("the {name} is {dollars}; expected 0 or more dollars")));
        }
    }
    let is_twice = |(i, rate): (usize, &Rate)| rate.name == MACHINE || price.licences[..i].iter().any(|other| other.name == rate.name);
    match price.licences.iter().enumerate().find(|&each| is_twice(each)) {
        Some((_, rate)) => Err(PriceError::new(format!("there are two rates for {:?}; give each a name of its own", rate.name))),
        None => Ok(price),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn licence(dollars: f64, per: Per) -> Rate {
        Rate { name: "licence".into(), dollars, per }
    }

    #[test]
    fn prices_are_numbers_rates_or_tables_and_mistakes_are_told() {
        assert_eq!(read_prices("0.04").unwrap(), [Price::new("given", 0.04)]);
        let found = read_prices("0.0165, licence=0.00015/core-minute,disk=0.001").unwrap();
        assert_eq!(found[0].licences[0], licence(0.000_15, Per::CoreMinute));
        assert_eq!((found[0].licences[1].name.as_str(), found[0].licences[1].per), ("disk", Per::VcpuHour));
        for (wrong, said) in [
            ("-1", "the price is -1"),
            ("nan", "the price is NaN"),
            ("no such file", "is no number, and no table"),
            ("0.1,licence", "\"licence\" is no rate"),
            ("0.1,licence=1/hour", "expected something like licence=0.00015/core-minute"),
            ("0.1,=1", "is no rate"),
            ("0.1,licence=-1", "the licence is -1"),
            ("0.1,a=1,a=2", "two rates for \"a\""),
            ("0.1,machine=1", "two rates for \"machine\""),
        ] {
            let error = read_prices(wrong).unwrap_err();
            assert!(error.to_string().contains(said) && error.help().contains("--price 0.04"), "{error}");
        }
    }

    #[test]
    fn all_rates_are_paid_for_the_same_time() {
        // Hypersim's: 0.009 per vCPU-hour for V-Ray, by the minute.
        let price = Price { licences: vec![licence(0.000_15, Per::CoreMinute)], ..Price::new("9xlarge", 0.0165) };
        assert!((price.licence_dollars(100.0) - 0.9).abs() < 1e-12 && (price.machine_dollars(100.0) - 1.65).abs() < 1e-12);
        assert!((price.dollars(100.0) - 2.55).abs() < 1e-12);
        assert_eq!(price.parts(0.0), [("machine", 0.0), ("licence", 0.0)]);
        assert_eq!(price.rates(), "0.0165 per vCPU-hour and 0.00015 per core-minute for licence");
        assert!(Price::default().parts(1.0).is_empty() && Price::default().rates() == "0.0165 per vCPU-hour");
        let whole = Price { machine: Some(Machine { vcpus: 4, memory_gib: 8.0 }), ..price };
        assert!((whole.whole_machine_dollars(1800.0).unwrap() - 2.0 * (0.0165 + 0.009)).abs() < 1e-12, "half an hour of four vCPUs");
        assert_eq!(Price::default().whole_machine_dollars(1800.0), None);
    }

    #[test]
    fn a_table_may_tell_the_sizes_of_machines_and_further_rates() {
        let read = |text: &str| table("prices.csv", text);
        let found: Vec<_> = read("name,dollars_per_vcpu_hour\nspot,0.0165\non demand, 0.048\n").unwrap();
        assert_eq!(found, [Price::new("spot", 0.0165), Price::new("on demand", 0.048)]);
        let found = read("name,dollars_per_vcpu_hour,vcpus,memory_gib\n\nsmall, 0.05, 2, 7.5\n").unwrap();
        let machine = Some(Machine { vcpus: 2, memory_gib: 7.5 });
        assert_eq!(found, [Price { machine, ..Price::new("small", 0.05) }]);
        let found = read(
            "name,dollars_per_vcpu_hour,vcpus,memory_gib,licence_dollars_per_core_minute\nsmall,0.05,2,7.5,0.00015\nfree,0.05,2,7.5,\n",
        );
        let licences = vec![licence(0.000_15, Per::CoreMinute)];
        assert_eq!(
            found.unwrap(),
            [Price { machine, licences, ..Price::new("small", 0.05) }, Price { machine, ..Price::new("free", 0.05) }]
        );
        let found = read("name,dollars_per_vcpu_hour,licence_dollars_per_vcpu_hour\na,0.05,0.009\n").unwrap();
        assert_eq!(found, [Price { licences: vec![licence(0.009, Per::VcpuHour)], ..Price::new("a", 0.05) }]);
        // Under any other header, and without one, a line is a name, which may have commas, and a rate.
        assert_eq!(read("name,price\nm7, spot,0.05\n").unwrap()[0].name, "m7, spot");
    }

    #[test]
    fn mistakes_in_tables_are_told_with_their_lines() {
        let said = |text: &str| table("prices.csv", text).unwrap_err().to_string();
        assert!(said("spot;0.0165\n").starts_with("prices.csv, line 1: \"spot;0.0165\" is no price"));
        for wrong in
            ["small,0.05,2", "small,0.05,0,8", "small,0.05,2,nan", "small,0.05,2,-8", "small,-1,2,8", "a,b,0.05,2,8", "small,0.05,2,8,1"]
        {
            let found = said(&format!("name,dollars_per_vcpu_hour,vcpus,memory_gib\n{wrong}\n"));
            assert!(found.starts_with("prices.csv, line 2: "), "{found}");
        }
        for header in [
            "name,dollars_per_vcpu_hour,memory_gib",
            "name,price,licence_dollars_per_core_minute",
            "name,dollars_per_vcpu_hour,_dollars_per_vcpu_hour",
        ] {
            let found = said(&format!("{header}\nsmall,0.05,8\n"));
            assert!(found.starts_with(&format!("prices.csv, line 1: the columns are {header}; expected")), "{found}");
        }
        assert!(said("name,price\n").ends_with("has no prices"));
    }
}

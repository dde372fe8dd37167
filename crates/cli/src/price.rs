//! Prices of processor time and of machines, and sums of money.

use crate::outcome::Problem;
use enfilade_show::stats::{Machine, Price};
use std::path::Path;

/// The first line of a table that also tells the sizes of machines.
const SIZED: [&str; 4] = ["name", "dollars_per_vcpu_hour", "vcpus", "memory_gib"];
const HELP: &str = "give dollars per vCPU-hour, as in --price 0.04, or a table of lines like: on demand,0.048; with sizes of machines its first \
                    line is name,dollars_per_vcpu_hour,vcpus,memory_gib";

/// Prices from a number, or from a table of them.
///
/// A line of the table is `name,dollars_per_vcpu_hour`, with or without a first line that says so. Under the first line
/// `name,dollars_per_vcpu_hour,vcpus,memory_gib` each line is a machine: how many threads and gibibytes it has.
pub fn prices(given: Option<&str>) -> Result<Vec<Price>, Problem> {
    let Some(given) = given else { return Ok(vec![Price::default()]) };
    if let Ok(dollars_per_vcpu_hour) = given.trim().parse::<f64>() {
        return Ok(vec![checked(Price { name: "given".into(), dollars_per_vcpu_hour, machine: None })?]);
    }
    let text = std::fs::read_to_string(Path::new(given))
        .map_err(|e| Problem::new(format!("the price {given:?} is no number, and no table: {e}"), HELP))?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).peekable();
    let header = lines.next_if(|(_, line)| line.starts_with("name,"));
    let header: Vec<&str> = header.map_or(Vec::new(), |(_, line)| line.split(',').map(str::trim).collect());
    if header.len() > 2 && header != SIZED {
        let problem = format!("{given}, line 1: the columns are {}; expected {}", header.join(","), SIZED.join(","));
        return Err(Problem::new(problem, HELP));
    }
    let price = |(i, line): (usize, &str)| {
        let parsed = if header.len() > 2 { sized(line) } else { plain(line) };
        let wrong = if header.len() > 2 { "is no machine with its price, vCPUs and memory" } else { "is no price" };
        checked(parsed.ok_or_else(|| Problem::new(format!("{given}, line {}: {line:?} {wrong}", i + 1), HELP))?)
    };
    let prices: Vec<Price> = lines.map(price).collect::<Result<_, _>>()?;
    if prices.is_empty() { Err(Problem::new(format!("{given} has no prices"), HELP)) } else { Ok(prices) }
}

fn plain(line: &str) -> Option<Price> {
    let (name, dollars) = line.rsplit_once(',')?;
    Some(Price { name: name.trim().into(), dollars_per_vcpu_hour: dollars.trim().parse().ok()?, machine: None })
}

fn sized(line: &str) -> Option<Price> {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    let [name, dollars, vcpus, memory_gib] = cells[..] else { return None };
    let machine = Machine { vcpus: vcpus.parse().ok()?, memory_gib: memory_gib.parse().ok()? };
    let possible = machine.vcpus >= 1 && machine.memory_gib > 0.0 && machine.memory_gib.is_finite();
    possible.then_some(Price { name: name.into(), dollars_per_vcpu_hour: dollars.parse().ok()?, machine: Some(machine) })
}

fn checked(price: Price) -> Result<Price, Problem> {
    let dollars = price.dollars_per_vcpu_hour;
    let wrong = || Problem::new(format!("the price is {dollars}; expected 0 or more dollars per vCPU-hour"), "as in --price 0.04");
    if dollars >= 0.0 && dollars.is_finite() { Ok(price) } else { Err(wrong()) }
}

/// Dollars, small sums to two digits that say something.
pub fn dollars(sum: f64) -> String {
    match sum {
        d if d >= 0.1 || d <= 0.0 => format!("{d:.2}"),
        d => format!("{d:.*}", (1.0 - d.log10().floor()) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prices_are_numbers_or_tables_and_mistakes_are_told() {
        assert_eq!(prices(None).unwrap(), [Price::default()]);
        assert_eq!(prices(Some("0.04")).unwrap()[0].dollars_per_vcpu_hour, 0.04);
        assert!(prices(Some("-1")).is_err() && prices(Some("nan")).is_err() && prices(Some("no such file")).is_err());
        let folder = tempfile::tempdir().unwrap();
        let table = folder.path().join("prices.csv");
        std::fs::write(&table, "name,dollars_per_vcpu_hour\nspot,0.0165\non demand, 0.048\n").unwrap();
        let found: Vec<(String, f64)> = prices(table.to_str()).unwrap().into_iter().map(|p| (p.name, p.dollars_per_vcpu_hour)).collect();
        assert_eq!(found, [("spot".into(), 0.0165), ("on demand".into(), 0.048)]);
        std::fs::write(&table, "spot;0.0165\n").unwrap();
        assert!(prices(table.to_str()).is_err());
    }

    #[test]
    fn a_table_may_tell_the_sizes_of_machines() {
        let folder = tempfile::tempdir().unwrap();
        let table = folder.path().join("machines.csv");
        let read = |text: &str| {
            std::fs::write(&table, text).unwrap();
            prices(table.to_str())
        };
        let found = read("name,dollars_per_vcpu_hour,vcpus,memory_gib\n\nsmall, 0.05, 2, 7.5\n").unwrap();
        let machine = Some(Machine { vcpus: 2, memory_gib: 7.5 });
        assert_eq!(found, [Price { name: "small".into(), dollars_per_vcpu_hour: 0.05, machine }]);
        // Under any other header, and without one, a line is a name, which may have commas, and a price.
        assert_eq!(read("name,price\nm7, spot,0.05\n").unwrap()[0].name, "m7, spot");
        for wrong in ["small,0.05,2", "small,0.05,0,8", "small,0.05,2,nan", "small,0.05,2,-8", "small,-1,2,8", "a,b,0.05,2,8"] {
            assert!(read(&format!("{}\n{wrong}\n", SIZED.join(","))).is_err(), "{wrong}");
        }
        assert!(read("name,dollars_per_vcpu_hour,memory_gib\nsmall,0.05,8\n").is_err());
    }

    #[test]
    fn small_sums_have_two_digits() {
        assert_eq!((dollars(12.345).as_str(), dollars(0.000_46).as_str(), dollars(0.0).as_str()), ("12.35", "0.00046", "0.00"));
    }
}

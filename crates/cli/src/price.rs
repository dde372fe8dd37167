//! Prices of processor time, and sums of money.

use crate::outcome::Problem;
use enfilade_post::stats::Price;
use std::path::Path;

/// Prices from a number, or from a table of them.
pub fn prices(given: Option<&str>) -> Result<Vec<Price>, Problem> {
    let Some(given) = given else { return Ok(vec![Price::default()]) };
    if let Ok(dollars_per_vcpu_hour) = given.trim().parse::<f64>() {
        return Ok(vec![checked(Price { name: "given".into(), dollars_per_vcpu_hour })?]);
    }
    let help = "give dollars per vCPU-hour, as in --price 0.04, or a table of lines like: on demand,0.048";
    let text = std::fs::read_to_string(Path::new(given))
        .map_err(|e| Problem::new(format!("the price {given:?} is no number, and no table: {e}"), help))?;
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with("name,"));
    let price = |(i, line): (usize, &str)| {
        let parsed = line.rsplit_once(',').and_then(|(name, dollars)| Some((name.trim(), dollars.trim().parse().ok()?)));
        let (name, dollars_per_vcpu_hour) =
            parsed.ok_or_else(|| Problem::new(format!("{given}, line {}: {line:?} is no price", i + 1), help))?;
        checked(Price { name: name.into(), dollars_per_vcpu_hour })
    };
    let prices: Vec<Price> = lines.map(price).collect::<Result<_, _>>()?;
    if prices.is_empty() { Err(Problem::new(format!("{given} has no prices"), help)) } else { Ok(prices) }
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
    fn small_sums_have_two_digits() {
        assert_eq!((dollars(12.345).as_str(), dollars(0.000_46).as_str(), dollars(0.0).as_str()), ("12.35", "0.00046", "0.00"));
    }
}

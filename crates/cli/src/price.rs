//! Prices of processor time as they are given, and sums of money in words.

use crate::outcome::Problem;
use enfilade_dataset::{Price, read_prices};

/// Prices from a number, rates, or a table of them; Hypersim's unless any are given.
pub fn prices(given: Option<&str>) -> Result<Vec<Price>, Problem> {
    let read = |given| read_prices(given).map_err(|error| Problem::new(error.to_string(), error.help()));
    given.map_or_else(|| Ok(vec![Price::default()]), read)
}

/// The cost of processor time at a price, in words.
pub fn paid(price: &Price, vcpu_hours: f64) -> String {
    told_price(price, &dollars(price.dollars(vcpu_hours)), vcpu_hours)
}

/// A `sum` of dollars with its price, and the share of each rate if there are several.
pub fn told_price(price: &Price, sum: &str, vcpu_hours: f64) -> String {
    let parts: Vec<String> = price.parts(vcpu_hours).iter().map(|(rate, part)| format!("{} for {rate}", dollars(*part))).collect();
    let parts = if parts.is_empty() { String::new() } else { format!(": {}", parts.join(", ")) };
    format!("{sum} dollars at {} ({}){parts}", price.rates(), price.name)
}

/// Dollars, small sums to two significant digits.
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
    fn prices_are_hypersims_unless_given() {
        assert_eq!(prices(None).unwrap(), [Price::default()]);
        assert_eq!(prices(Some("0.04")).unwrap(), [Price::new("given", 0.04)]);
        assert!(prices(Some("-1")).is_err());
    }

    #[test]
    fn sums_are_told_with_their_rates() {
        assert_eq!(paid(&Price::new("spot", 0.5), 3.0), "1.50 dollars at 0.5 per vCPU-hour (spot)");
        let price = &prices(Some("0.5,licence=0.025/core-minute")).unwrap()[0];
        let expected =
            "6.00 dollars at 0.5 per vCPU-hour and 0.025 per core-minute for licence (given): 1.50 for machine, 4.50 for licence";
        assert_eq!(paid(price, 3.0), expected);
    }

    #[test]
    fn small_sums_have_two_digits() {
        assert_eq!((dollars(12.345).as_str(), dollars(0.000_46).as_str(), dollars(0.0).as_str()), ("12.35", "0.00046", "0.00"));
    }
}

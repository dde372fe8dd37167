//! `stats`: from arguments to a call of `post`'s statistics, and what came of it.

use crate::args::StatsArgs;
use crate::estimate::dollars;
use crate::outcome::{Problem, Verdict, say};
use crate::progress::Progress;
use enfilade_dataset::Dataset;
use enfilade_post::stats::{Price, StatsConfig, write_statistics};
use std::path::Path;

/// `stats`: what the images show and what they cost.
pub fn stats(args: &StatsArgs, quiet: bool) -> Result<Verdict, Problem> {
    let dataset = Dataset::open(&args.dataset)?;
    let config = StatsConfig {
        scenes: enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?,
        folder: args.output.clone(),
        compare: args.compare.clone(),
        prices: prices(args.price.as_deref())?,
    };
    let written = {
        let progress = Progress::new(quiet);
        let cx = progress.begin(&args.dataset.display().to_string(), "stats");
        write_statistics(&dataset, &config, &cx)?
    };
    say(&format!("{} images, {} outliers", written.images, written.outliers));
    if let Some(cost) = written.cost {
        let prices = config
            .prices
            .iter()
            .map(|price| format!("{} dollars at {} ({})", dollars(cost.dollars(price)), price.dollars_per_vcpu_hour, price.name));
        say(&format!("{:.3} vCPU-hours: {}", cost.vcpu_hours, prices.collect::<Vec<_>>().join(", ")));
    }
    say(&format!("see  {}", written.page.display()));
    Ok(Verdict::Done)
}

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
}

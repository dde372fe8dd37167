//! `run --estimate`: what a run would take, as a table.

use crate::outcome::{Verdict, say};
use crate::price::{dollars, prices, told_price};
use crate::{outcome::Problem, progress::Progress, summary};
use enfilade_dataset::Price;
use enfilade_pipeline::{Config, Expected, Forecast};
use std::path::Path;

/// Forecasts the run and prints the forecast.
pub fn estimate(config: &Config, out: &Path, pattern: Option<&str>, price: Option<&str>, quiet: bool) -> Result<Verdict, Problem> {
    let prices = prices(price)?;
    let (result, scenes) = {
        let progress = Progress::new(quiet);
        enfilade_pipeline::estimate(config, out, pattern, &progress)?
    };
    match result.ok() {
        true => summary::print_warnings(&result),
        false => summary::print_table(&result),
    }
    let all = Forecast::sum(scenes.iter().map(|(_, forecast)| *forecast));
    let mut rows = scenes;
    if rows.len() != 1 {
        rows.push(("all".into(), all));
    }
    say("What is still to be done, each with the interval that holds the truth in 95 of 100 cases:\n");
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0).max(5);
    say(&format!("{:width$}  frames  {:>27}  {:>27}  {:>23}  {:>23}", "scene", "processor time", "time on this machine", "disk", "memory"));
    for (name, forecast) in &rows {
        say(&row(name, width, forecast));
    }
    say("");
    if all.busy {
        say("Other programs keep this machine busy: times are those under this load, and less sure.");
    }
    prices.iter().for_each(|price| say(&paid(&all, price)));
    Ok(Verdict::of(result.ok()))
}

fn row(name: &str, width: usize, forecast: &Forecast) -> String {
    let (cpu, wall) = (told(&forecast.cpu_s, time), told(&forecast.wall_s, time));
    let (disk, memory) = (told(&forecast.disk_bytes, size), told(&forecast.memory_bytes, size));
    format!("{name:width$}  {:6}  {cpu:>27}  {wall:>27}  {disk:>23}  {memory:>23}", forecast.frames)
}

fn paid(forecast: &Forecast, price: &Price) -> String {
    let hours = &forecast.vcpu_hours;
    let sum = told(hours, |hours| dollars(price.dollars(hours)));
    let vcpu_hours = told(hours, |hours| format!("{hours:.3}"));
    format!("{vcpu_hours} vCPU-hours, {}", told_price(price, &sum, hours.mean))
}

/// The expected value and its interval, in words.
pub fn told(expected: &Expected, words: impl Fn(f64) -> String) -> String {
    let [low, high] = expected.interval();
    format!("{} ({} to {})", words(expected.mean), words(low), words(high))
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

fn size(bytes: f64) -> String {
    match bytes {
        b if b < 1e9 => format!("{:.0} MB", b / 1e6),
        b if b < 1e12 => format!("{:.1} GB", b / 1e9),
        b => format!("{:.2} TB", b / 1e12),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_sizes_have_the_unit_that_fits() {
        assert_eq!((time(3.25).as_str(), time(600.0).as_str(), time(36_000.0).as_str()), ("3.2 s", "10.0 min", "10.0 h"));
        assert_eq!((size(2.5e8).as_str(), size(2.5e9).as_str(), size(1.9e12).as_str()), ("250 MB", "2.5 GB", "1.90 TB"));
        let expected = Expected { mean: 100.0, deviation: 10.0 };
        assert_eq!(told(&expected, |v| format!("{v:.0}")), "100 (80 to 120)");
    }
}

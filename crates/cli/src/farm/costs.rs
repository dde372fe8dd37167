//! What a job has cost, for `farm status` and `farm collect`.

use crate::outcome::{Problem, say};
use crate::price::dollars;
use enfilade_farm::{Costs, Job, costs};
use enfilade_post::stats::Price;
use std::path::Path;

/// Says what was paid at every price, and for what; writes a row per attempt to `table` at the first price.
pub fn say_costs(job: &Job, prices: &[Price], table: Option<&Path>) -> Result<(), Problem> {
    let costs = costs(job)?;
    lines(&costs).iter().for_each(|line| say(line));
    for price in prices {
        say(&format!(
            "  {} dollars at {} per vCPU-hour ({})",
            dollars(costs.dollars(price.dollars_per_vcpu_hour)),
            price.dollars_per_vcpu_hour,
            price.name
        ));
    }
    let Some(path) = table else { return Ok(()) };
    let dollars_per_vcpu_hour = prices.first().map_or(0.0, |price| price.dollars_per_vcpu_hour);
    std::fs::write(path, costs.table(job, dollars_per_vcpu_hour))
        .map_err(|error| Problem::new(format!("cannot write {}: {error}", path.display()), "name another file with --attempts"))?;
    say(&format!("{:.4} vCPU-hours by attempt: {}", costs.vcpu_hours(), path.display()));
    Ok(())
}

fn lines(costs: &Costs) -> Vec<String> {
    let share = |part: f64| if costs.vcpu_s > 0.0 { 100.0 * part / costs.vcpu_s } else { 0.0 };
    let mut lines = vec![format!(
        "{:.4} vCPU-hours paid, of which {:.1} % were used; {:.1} % went into frames that count, {:.1} % into attempts that failed or came second",
        costs.vcpu_hours(),
        100.0 * costs.utilization(),
        share(costs.in_frames_vcpu_s),
        share(costs.wasted_vcpu_s)
    )];
    let memory =
        costs.peak_memory_bytes.map_or(String::new(), |bytes| format!(", at most {:.2} GiB of memory", bytes as f64 / f64::from(1 << 30)));
    lines.push(format!("{} attempts, {} of them retries{memory}", costs.attempts.len(), costs.retries));
    if costs.expected_cpu_s > 0.0 {
        let ratio = costs.frames_cpu_s / costs.expected_cpu_s;
        lines.push(format!("frames took {:.1} s of processor time, {ratio:.2} times what the plan expected", costs.frames_cpu_s));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_of_what_was_paid() {
        let costs = Costs { vcpu_s: 7200.0, cpu_s: 5400.0, in_frames_vcpu_s: 6480.0, wasted_vcpu_s: 360.0, ..Costs::default() };
        assert_eq!(
            lines(&costs)[0],
            "2.0000 vCPU-hours paid, of which 75.0 % were used; 90.0 % went into frames that count, 5.0 % into attempts that failed or came second"
        );
        assert_eq!(lines(&Costs::default()).len(), 2);
    }
}

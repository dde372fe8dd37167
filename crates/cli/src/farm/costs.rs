//! The costs of a job, for `farm status` and `farm collect`.

use crate::outcome::{Problem, say};
use crate::price::{dollars, paid};
use enfilade_dataset::{Price, memory_gib, tells_sizes};
use enfilade_farm::{Costs, Feasible, Job, costs};
use std::path::Path;

/// Prints the cost of the job at every price, what it was spent on, and on which machines the job could have run. Writes a row per attempt
/// to `table` at the first price. Returns the costs.
pub fn say_costs(job: &Job, prices: &[Price], table: Option<&Path>) -> Result<Costs, Problem> {
    let costs = costs(job)?;
    lines(&costs).iter().for_each(|line| say(line));
    for price in prices {
        say(&format!("  {}", paid(price, costs.vcpu_hours())));
    }
    if tells_sizes(prices) {
        machines(&costs.feasible(prices), costs.attempts.len()).iter().for_each(|line| say(line));
    } else {
        say(
            "The smallest machine is unknown: the prices have no sizes (--price with a table of name,dollars_per_vcpu_hour,vcpus,memory_gib)",
        );
    }
    let Some(path) = table else { return Ok(costs) };
    std::fs::write(path, costs.table(job, prices))
        .map_err(|error| Problem::new(format!("cannot write {}: {error}", path.display()), "name another file with --attempts"))?;
    say(&format!("{:.4} vCPU-hours by attempt: {}", costs.vcpu_hours(), path.display()));
    Ok(costs)
}

fn lines(costs: &Costs) -> Vec<String> {
    let share = |part: f64| if costs.vcpu_s > 0.0 { 100.0 * part / costs.vcpu_s } else { 0.0 };
    let after_frame = match costs.after_frame_vcpu_s {
        spent if spent > 0.0 => format!(" {:.1} % into the program that is run after them,", share(spent)),
        _ => String::new(),
    };
    let mut lines = vec![format!(
        "{:.4} vCPU-hours paid, of which {:.1} % were used; {:.1} % went into frames that count,{after_frame} {:.1} % into attempts that failed or came second",
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

/// The machines on which `attempts` could have run.
fn machines(found: &Feasible, attempts: usize) -> Vec<String> {
    let told = attempts - found.unknown as usize;
    if told == 0 {
        return vec!["The smallest machine is unknown: no attempt recorded its memory".into()];
    }
    let need = format!("{} threads and {:.2} GiB", found.threads, memory_gib(found.peak_memory_bytes));
    let mut lines = vec![match &found.for_all {
        Some(name) => format!(
            "Smallest machine for every attempt ({need} with the system's): {name}; all of them there, whole machines: {} dollars",
            dollars(found.for_all_dollars)
        ),
        None => format!("No machine of the table has room for every attempt ({need} with the system's)"),
    }];
    let by_machine: Vec<String> = found.machines.iter().map(|(name, count)| format!("{count} on {name}")).collect();
    if !by_machine.is_empty() {
        lines.push(format!("  each on the smallest for it: {}: {} dollars", by_machine.join(", "), dollars(found.dollars)));
    }
    if found.too_large > 0 {
        lines.push(format!("  {} attempts fit none", found.too_large));
    }
    if found.unknown > 0 {
        lines.push(format!(
            "  {} attempts did not record their memory, for example because they were killed, and are left out",
            found.unknown
        ));
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
        let costs = Costs { after_frame_vcpu_s: 720.0, ..costs };
        assert!(lines(&costs)[0].contains("frames that count, 10.0 % into the program that is run after them, 5.0 % into attempts"));
        assert_eq!(lines(&Costs::default()).len(), 2);
    }

    #[test]
    fn machines_are_told_with_what_fits_none_and_what_is_not_known() {
        let mut found = Feasible { threads: 8, peak_memory_bytes: 3 << 29, for_all: Some("m8".into()), ..Feasible::default() };
        (found.for_all_dollars, found.dollars, found.machines) = (1.5, 0.75, [("m8".to_string(), 2)].into());
        assert_eq!(
            machines(&found, 2),
            [
                "Smallest machine for every attempt (8 threads and 2.00 GiB with the system's): m8; all of them there, whole machines: 1.50 dollars",
                "  each on the smallest for it: 2 on m8: 0.75 dollars"
            ]
        );
        let found = Feasible { for_all: None, too_large: 1, unknown: 1, ..found };
        let text = machines(&found, 4).join("\n");
        assert!(
            text.contains("No machine of the table") && text.contains("1 attempts fit none") && text.contains("1 attempts did not record")
        );
        assert!(machines(&found, 1)[0].contains("unknown"));
    }
}

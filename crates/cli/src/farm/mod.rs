//! `farm`: one dataset on many machines.

mod costs;

use crate::args::{FarmArgs, FarmCollectArgs, FarmPlanArgs, FarmStatusArgs, FarmSubmitArgs, FarmVerb, FarmWorkArgs};
use crate::estimate::told;
use crate::outcome::{Problem, Verdict, say, warn};
use crate::price::{dollars, paid, prices, told_price};
use crate::progress::Progress;
use crate::run::configuration;
use crate::summary;
use enfilade_dataset::{Price, quoted};
use enfilade_farm::{
    Assignment, Attempt, Ended, Engine, EngineName, FarmError, Job, Plan, PricedPlan, Store, Submitted, Work, default_scratch,
    how_to_submit, parse_ranges, print_ranges, stop_on_signals,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Runs a verb of the farm; `program` is the file that jobs of Slurm start.
pub fn farm(args: &FarmArgs, program: Option<&Path>, quiet: bool) -> Result<Verdict, Problem> {
    match &args.verb {
        FarmVerb::Plan(args) => plan(args, quiet),
        FarmVerb::Work(args) => work(args, quiet),
        FarmVerb::Status(args) => status(args),
        FarmVerb::Collect(args) => collect(args, quiet),
        FarmVerb::Submit(args) => submit(args, program),
    }
}

impl From<FarmError> for Problem {
    fn from(error: FarmError) -> Self {
        match error {
            FarmError::Pipeline(error) => error.into(),
            error => Self::of_farm(&error),
        }
    }
}

fn open(job: &str) -> Result<Job, FarmError> {
    Job::open(Store::open(job, enfilade_farm::environment())?)
}

fn plan(args: &FarmPlanArgs, quiet: bool) -> Result<Verdict, Problem> {
    let prices = prices(args.price.as_deref())?;
    let config = configuration(args.config.as_deref(), &args.settings)?;
    let options = args.options.options()?;
    options.check()?;
    let store = Store::begin(&args.output, enfilade_farm::environment())?;
    let (result, job) = {
        let progress = Progress::new(quiet);
        enfilade_farm::plan(&config, store, &options, &progress)?
    };
    let Some(job) = job else {
        summary::print_table(&result);
        return Ok(Verdict::Failed);
    };
    summary::print_warnings(&result);
    say_plan(&job.plan, &prices);
    let place = job.store.url();
    say(&format!("The job is in {place}. Start workers: enfilade farm submit {} --engine slurm", quoted(place)));
    Ok(Verdict::Done)
}

/// Prints how the work was divided, how long it will take and what it will cost.
fn say_plan(plan: &Plan, prices: &[Price]) {
    let told_plan = plan.statement(prices);
    let (tasks, hours) = (told_plan.tasks, told_plan.vcpu_hours.mean);
    say(&format!("{tasks} tasks of {} frames in {} scenes: {hours:.2} vCPU-hours expected", told_plan.frames, told_plan.scenes));
    for nodes in [1, 10, 100] {
        let tasks_at_once = nodes.min(tasks.max(1)) as f64;
        let wall_minutes = 60.0 * hours / (f64::from(plan.cpus) * tasks_at_once);
        say(&format!("  on {nodes:3} workers of {} threads about {wall_minutes:.1} minutes", plan.cpus));
    }
    for PricedPlan { price, dollars: sum } in &told_plan.prices {
        say(&format!("  {}", told_price(price, &told(sum, dollars), hours)));
    }
    if let Some(program) = plan.farm.after_frame.first() {
        say(&format!("  and what {program:?} takes after every frame, which is not known"));
    }
}

fn work(args: &FarmWorkArgs, quiet: bool) -> Result<Verdict, Problem> {
    let stop = stop_on_signals();
    let assignment = match (&args.task, &args.shard) {
        (Some(text), _) if args.nth => Assignment::nth(&parse_ranges(text)?, |name| std::env::var(name).ok())?,
        (Some(text), _) => Assignment::Tasks(parse_ranges(text)?),
        (None, Some(text)) => parse_shard(text)?,
        (None, None) => return Err(Problem::new("no tasks are named", "give --task 0-3 or --shard 0/4")),
    };
    let (attempt, scratch) = (Attempt::here(), args.scratch.clone().unwrap_or_else(default_scratch));
    let done = open(&args.job).and_then(|job| {
        let progress = Progress::new(quiet);
        let records = enfilade_farm::work(&job, &assignment, &Work { scratch: &scratch, attempt: &attempt, stop: &stop }, &progress)?;
        Ok((records, assignment.tasks(job.plan.tasks.len()).len()))
    });
    let (records, asked) = match done {
        Ok(done) => done,
        Err(error) => {
            let verdict = if error.is_transient() { Verdict::Transient } else { Verdict::Permanent };
            Problem::from(error).print();
            return Ok(verdict);
        }
    };
    for record in &records {
        let ended = record.ended.map_or("open", Ended::word);
        let why = record.error.as_ref().map_or(String::new(), |error| format!(": {error}"));
        say(&format!("task {}: {ended}, {} frames committed, {} already there{why}", record.task, record.committed, record.lost));
        say_faults(record.different, &record.broken);
    }
    Ok(match records.iter().filter_map(|record| record.ended).max() {
        Some(Ended::Permanent) => Verdict::Permanent,
        Some(Ended::Transient) => Verdict::Transient,
        _ if records.len() < asked => Verdict::Transient,
        _ => Verdict::Done,
    })
}

fn parse_shard(text: &str) -> Result<Assignment, Problem> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse::<u32>().ok()?, n.trim().parse::<u32>().ok()?)));
    match numbers {
        Some((i, n)) if i < n => Ok(Assignment::Shard(i, n)),
        _ => Err(Problem::new(format!("--shard is {text:?}; expected I/N with I below N"), "the first of four shares is --shard 0/4")),
    }
}

fn status(args: &FarmStatusArgs) -> Result<Verdict, Problem> {
    let job = open(&args.job)?;
    let status = enfilade_farm::status(&job)?;
    if args.json {
        say(&serde_json::to_string_pretty(&status).map_err(|error| Problem::new(error.to_string(), "leave --json away"))?);
    } else if args.missing {
        say(&print_ranges(&status.missing));
    } else {
        say(&format!(
            "{} of {} frames are committed; {} of {} tasks are missing",
            status.frames_done,
            status.frames,
            status.missing.len(),
            status.tasks
        ));
        if !status.is_complete() {
            say(&format!("missing: {}", print_ranges(&status.missing)));
            say(&format!("about {:.2} vCPU-hours are left", status.left_cpu_s / 3600.0));
        }
        let attempts: Vec<String> = status.attempts.iter().map(|(word, n)| format!("{n} {word}")).collect();
        if !attempts.is_empty() {
            say(&format!("attempts: {}", attempts.join(", ")));
        }
        status.errors.iter().for_each(|(task, error)| say(&format!("task {task}: {error}")));
        say_faults(status.different, &status.broken);
    }
    warn_of(&status.unreadable);
    if args.price.is_some() || args.attempts.is_some() {
        let prices = prices(args.price.as_deref())?;
        costs::say_costs(&job, &prices, args.attempts.as_deref())?;
        let left = prices.iter().filter(|_| !status.is_complete());
        left.for_each(|price| say(&format!("About {}, for what is left", paid(price, status.left_cpu_s / 3600.0))));
    }
    Ok(Verdict::of(status.is_complete()))
}

/// Records that were left out, on standard error, since `--json` and `--missing` are for programs.
fn warn_of(unreadable: &[String]) {
    unreadable.iter().for_each(|warning| warn(warning));
}

/// Prints faults: machines that make different bytes of a frame, and frames that break laws.
fn say_faults(different: u32, broken: &BTreeMap<String, u32>) {
    if different > 0 {
        say(&format!("{different} frames came out differently when they were made twice: nodes differ in program, library or settings"));
    }
    broken.iter().for_each(|(law, frames)| say(&format!("{frames} frames break the law {law}")));
}

fn collect(args: &FarmCollectArgs, quiet: bool) -> Result<Verdict, Problem> {
    let prices = prices(args.price.as_deref())?;
    let job = open(&args.job)?;
    let out: &PathBuf = &args.output;
    let result = {
        let progress = Progress::new(quiet);
        enfilade_farm::collect(&job, out, &progress)?
    };
    summary::print_table(&result);
    summary::print_where_to_look(out, &result)?;
    let costs = costs::say_costs(&job, &prices, None)?;
    warn_of(&costs.unreadable);
    say_faults(costs.different(), &BTreeMap::new());
    Ok(Verdict::of(result.ok()))
}

/// `farm submit`: files for engines.
fn submit(args: &FarmSubmitArgs, program: Option<&Path>) -> Result<Verdict, Problem> {
    let mut options = args.options.options()?;
    let engine = Engine::of(args.engine, &options)?;
    // Nodes of Slurm see the same folders.
    let here = || program.filter(|_| args.engine == EngineName::Slurm).map(|path| path.display().to_string());
    options.program = options.program.or_else(here);
    let mut tell = |done: Submitted| match done {
        Submitted::File(path) => say(&path.display().to_string()),
        Submitted::Job(number) => say(&format!("submitted as job {number}")),
    };
    if !enfilade_farm::submit(&open(&args.job)?, &engine, &options, &args.output, &mut tell)? {
        say(&format!("nothing is missing; collect the dataset: enfilade farm collect {} -o OUT", quoted(&args.job)));
    } else if let Some(advice) = how_to_submit(&engine) {
        say(advice);
    }
    Ok(Verdict::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_read_and_mistakes_are_told() {
        assert_eq!(parse_shard("3/16").unwrap(), Assignment::Shard(3, 16));
        for wrong in ["4/4", "x/2", "1", "1/0", "-1/2"] {
            assert!(parse_shard(wrong).is_err(), "{wrong}");
        }
    }
}

//! The command line `enfilade`: `run` makes datasets, `make` more of their frames, and the other verbs read them. It is a library since the Python package has it as well;
//! `main.rs` is the program.
//!
//! Results go to standard output, progress and errors to standard error. Exit codes: 0 done, 1 something failed or a law is violated, 2 the
//! command or the configuration is wrong; `farm work` also has 65 and 75, see there.

mod animate;
mod annotate;
mod args;
mod estimate;
mod export;
mod farm;
mod ingest;
mod make;
mod outcome;
mod pictures;
mod price;
mod progress;
mod released;
mod run;
mod scene_files;
mod shell;
mod signposts;
mod stats;
mod suggest;
mod summary;
mod verbs;
mod view;
mod vray;

use args::{Cli, Verb};
use outcome::{Problem, Verdict};
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

/// Runs a command line, whose first word is the program's name, and returns the exit code. `program` is the executable that jobs of Slurm
/// start; with `None` it is `enfilade` from the PATH of the nodes.
pub fn main(words: impl IntoIterator<Item = OsString>, program: Option<PathBuf>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    words.iter().take(1).for_each(|word| summary::called(word));
    let code = match Cli::of(&words) {
        Ok(cli) => code_of(start(&Cli { program, ..cli })),
        // `--help` and `--version` come here too.
        Err(answer) => {
            match signposts::of(&answer) {
                Some(problem) => problem.print(),
                None => outcome::note(answer.print()),
            }
            answer.exit_code() as u8
        }
    };
    // A program in Rust would do this at its end, an interpreter does not.
    outcome::note(std::io::stdout().flush());
    let unsaid = outcome::unsaid();
    unsaid.iter().for_each(Problem::print);
    // Whatever else went wrong has an exit code of its own.
    if unsaid.is_some() { code.max(1) } else { code }
}

fn code_of(result: Result<Verdict, Problem>) -> u8 {
    match result {
        Ok(Verdict::Done) => 0,
        Ok(Verdict::Failed) => 1,
        Ok(Verdict::Permanent) => 65,
        Ok(Verdict::Transient) => 75,
        Err(problem) => {
            problem.print();
            if problem.usage { 2 } else { 1 }
        }
    }
}

fn start(cli: &Cli) -> Result<Verdict, Problem> {
    start_threads(cli.threads.map(usize::from))?;
    match &cli.verb {
        Verb::Run(args) => run::run(args, cli.quiet),
        Verb::Look(args) => scene_files::look(args, cli.quiet),
        Verb::Import(args) => scene_files::import(args, cli.quiet),
        Verb::Home(args) => scene_files::home(args, cli.quiet),
        Verb::Make(args) => make::make(args, cli.quiet),
        Verb::Label(args) => run::label(args, cli.quiet),
        Verb::Suggest(args) => suggest::suggest(args, cli.quiet),
        Verb::Annotate(args) => annotate::annotate(args, cli.quiet),
        Verb::Verify(args) => verbs::verify(args, cli.quiet),
        Verb::View(args) => view::view(args),
        Verb::Inspect(args) => verbs::inspect(args),
        Verb::Export(args) => export::export(args, cli.quiet),
        Verb::Animate(args) => animate::animate(args, cli.quiet),
        Verb::Stats(args) => stats::stats(args, cli.quiet),
        Verb::Partition(args) => verbs::partition(args),
        Verb::Replay(args) => verbs::replay(args, cli.quiet),
        Verb::Farm(args) => farm::farm(args, cli.program.as_deref(), cli.quiet),
        Verb::Vray(args) => vray::vray(args, cli.quiet),
        Verb::Completions(args) => shell::completions(args),
    }
}

/// Starts the threads that share the work, by default one per processor. Later, a failure to start them would be a panic.
fn start_threads(count: Option<usize>) -> Result<(), Problem> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(count.unwrap_or(0)).build_global();
    built.map_err(|error| {
        let hint = "raise the limit of processes (ulimit -u), or ask for fewer threads with --threads 1";
        Problem::new(format!("cannot start threads: {error}"), hint)
    })
}

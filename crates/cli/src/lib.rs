//! The command line `enfilade`: one verb per stage, and `run` for all of them. It is a library since the Python package has it as well;
//! `main.rs` is the program.
//!
//! Results go to standard output, progress and errors to standard error. Exit codes: 0 done, 1 something failed or a law does
//! not hold, 2 the command or the configuration is wrong; of `farm work` also 65 and 75, see there.

mod animate;
mod annotate;
mod args;
mod describe;
mod estimate;
mod export;
mod farm;
mod flow;
mod ingest;
mod layout;
mod outcome;
mod pairs;
mod pictures;
mod price;
mod progress;
mod released;
mod relight;
mod scene_files;
mod sense;
mod shell;
mod stats;
mod suggest;
mod summary;
mod surfaces;
mod tracks;
mod verbs;
mod view;
mod vray;

use args::{Cli, Verb};
use clap::Parser;
use outcome::{Problem, Verdict};
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

/// Does what the words of a command line say, of which the first is the program's name, and gives the exit code. `program` is the file to start
/// again as this program, for jobs of Slurm; `None` takes `enfilade` from the PATH of the nodes.
pub fn main(words: impl IntoIterator<Item = OsString>, program: Option<PathBuf>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    words.iter().take(1).for_each(|word| summary::called(word));
    let code = match Cli::try_parse_from(words) {
        Ok(cli) => code_of(start(&Cli { program, ..cli })),
        // `--help` and `--version` come here too.
        Err(answer) => {
            outcome::note(answer.print());
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
        Verb::Run(args) => verbs::run(args, cli.quiet),
        Verb::Look(args) => scene_files::look(args, cli.quiet),
        Verb::Import(args) => scene_files::import(args, cli.quiet),
        Verb::Home(args) => scene_files::home(args, cli.quiet),
        Verb::Carve(args) => verbs::stage(args, enfilade_pipeline::Stage::Carve, cli.quiet),
        Verb::Plan(args) => verbs::plan(args, cli.quiet),
        Verb::Gate(args) => verbs::stage(args, enfilade_pipeline::Stage::Gate, cli.quiet),
        Verb::Render(args) => verbs::render(args, cli.quiet),
        Verb::Denoise(args) => verbs::denoise(args, cli.quiet),
        Verb::Label(args) => verbs::label(args, cli.quiet),
        Verb::Boxes(args) => verbs::stage(args, enfilade_pipeline::Stage::Boxes, cli.quiet),
        Verb::Preview(args) => pictures::preview(args, cli.quiet),
        Verb::Verify(args) => verbs::verify(args, cli.quiet),
        Verb::Split(args) => verbs::split(args),
        Verb::Pairs(args) => pairs::pairs(args, cli.quiet),
        Verb::Flow(args) => flow::flow(args, cli.quiet),
        Verb::Tracks(args) => tracks::tracks(args, cli.quiet),
        Verb::Layout(args) => layout::layout(args, cli.quiet),
        Verb::Describe(args) => describe::describe(args, cli.quiet),
        Verb::Surfaces(args) => surfaces::surfaces(args, cli.quiet),
        Verb::Sense(args) => sense::sense(args, cli.quiet),
        Verb::Relight(args) => relight::relight(args, cli.quiet),
        Verb::Inspect(args) => verbs::inspect(args),
        Verb::Animate(args) => animate::animate(args, cli.quiet),
        Verb::Replay(args) => verbs::replay(args, cli.quiet),
        Verb::Export(args) => export::export(args, cli.quiet),
        Verb::Ingest(args) => ingest::ingest(args),
        Verb::Stats(args) => stats::stats(args, cli.quiet),
        Verb::Vray(args) => vray::vray(args, cli.quiet),
        Verb::Farm(args) => farm::farm(args, cli.program.as_deref(), cli.quiet),
        Verb::Annotate(args) => annotate::annotate(args, cli.quiet),
        Verb::Suggest(args) => suggest::suggest(args, cli.quiet),
        Verb::View(args) => view::view(args),
        Verb::Completions(args) => Ok(shell::completions(args)),
        Verb::Man(args) => shell::man(args),
    }
}

/// Starts the threads that work is shared among, one per processor unless told otherwise. Begun later, their failure would be a panic.
fn start_threads(count: Option<usize>) -> Result<(), Problem> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(count.unwrap_or(0)).build_global();
    built.map_err(|error| {
        let hint = "raise the limit of processes (ulimit -u), or ask for fewer threads with --threads 1";
        Problem::new(format!("cannot start threads: {error}"), hint)
    })
}

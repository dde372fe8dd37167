//! The `enfilade` binary: one verb per stage, and `run` for all of them.
//!
//! Results go to standard output, progress and errors to standard error. Exit codes: 0 done, 1 something failed or a law does
//! not hold, 2 the command or the configuration is wrong; of `farm work` also 65 and 75, see there.

mod animate;
mod annotate;
mod args;
mod estimate;
mod export;
mod farm;
mod ingest;
mod outcome;
mod pictures;
mod price;
mod progress;
mod scene_files;
mod stats;
mod suggest;
mod summary;
mod verbs;
mod view;
mod vray;

use args::{Cli, Verb};
use clap::Parser;
use outcome::{Problem, Verdict};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    match start(&cli) {
        Ok(Verdict::Done) => ExitCode::SUCCESS,
        Ok(Verdict::Failed) => ExitCode::from(1),
        Ok(Verdict::Permanent) => ExitCode::from(65),
        Ok(Verdict::Transient) => ExitCode::from(75),
        Err(problem) => {
            problem.print();
            ExitCode::from(if problem.usage { 2 } else { 1 })
        }
    }
}

fn start(cli: &Cli) -> Result<Verdict, Problem> {
    if let Some(threads) = cli.threads {
        let built = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
        built.map_err(|e| Problem::new(format!("cannot start {threads} threads: {e}"), "ask for fewer with --threads"))?;
    }
    match &cli.verb {
        Verb::Run(args) => verbs::run(args, cli.quiet),
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
        Verb::Inspect(args) => verbs::inspect(args),
        Verb::Animate(args) => animate::animate(args, cli.quiet),
        Verb::Replay(args) => verbs::replay(args, cli.quiet),
        Verb::Export(args) => export::export(args, cli.quiet),
        Verb::Ingest(args) => ingest::ingest(args),
        Verb::Stats(args) => stats::stats(args, cli.quiet),
        Verb::Vray(args) => vray::vray(args, cli.quiet),
        Verb::Farm(args) => farm::farm(args, cli.quiet),
        Verb::Annotate(args) => annotate::annotate(args, cli.quiet),
        Verb::Suggest(args) => suggest::suggest(args, cli.quiet),
        Verb::View(args) => view::view(args),
    }
}

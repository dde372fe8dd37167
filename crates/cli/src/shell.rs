//! `completions`: what clap makes of the definition of the command line, for shells and as manual pages.

use crate::args::{Cli, CompletionsArgs};
use crate::outcome::{Problem, Verdict, note, say};
use clap::CommandFactory;
use std::io::Write;
use std::path::Path;

/// `completions`: those of a shell to standard output, or the manual pages into a folder.
pub fn completions(args: &CompletionsArgs) -> Result<Verdict, Problem> {
    if let Some(folder) = &args.man {
        return manual(folder);
    }
    if let Some(shell) = args.shell {
        let mut text = Vec::new();
        clap_complete::generate(shell, &mut Cli::command(), "enfilade", &mut text);
        note(std::io::stdout().write_all(&text));
    }
    Ok(Verdict::Done)
}

/// Writes a page for the program and one for each of its verbs, and prints their folder.
fn manual(folder: &Path) -> Result<Verdict, Problem> {
    let written = std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written
        .map_err(|error| Problem::of_data(format!("cannot write {}: {error}", folder.display()), "name a folder that can be written to"))?;
    say(&folder.join("enfilade.1").display().to_string());
    Ok(Verdict::Done)
}

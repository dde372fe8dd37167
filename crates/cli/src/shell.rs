//! `enfilade completions` and `enfilade man`: what clap makes of the definition of the command line.

use crate::args::{Cli, CompletionsArgs, ManArgs};
use crate::outcome::{Problem, Verdict, note, say};
use clap::CommandFactory;
use std::io::Write;

/// Writes the shell's completions to standard output.
pub fn completions(args: &CompletionsArgs) -> Verdict {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "enfilade", &mut text);
    note(std::io::stdout().write_all(&text));
    Verdict::Done
}

/// Writes a page for the program and one for each of its verbs, and says where.
pub fn man(args: &ManArgs) -> Result<Verdict, Problem> {
    let folder = &args.folder;
    let written = std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written
        .map_err(|error| Problem::of_data(format!("cannot write {}: {error}", folder.display()), "name a folder that can be written to"))?;
    say(&folder.join("enfilade.1").display().to_string());
    Ok(Verdict::Done)
}

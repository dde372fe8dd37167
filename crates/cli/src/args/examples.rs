//! Every command of the pages and of the help is one that the command line takes.

use super::Cli;
use clap::{Command, CommandFactory};
use std::ffi::OsString;
use std::path::Path;

/// The words of a command as a shell splits it, up to a comment or a redirection. `None` where it goes on in the next line, or is a
/// pattern with options in brackets.
fn words(line: &str) -> Option<Vec<OsString>> {
    if line.contains('[') || line.ends_with('\\') {
        return None;
    }
    let (mut words, mut word, mut quoted) = (Vec::new(), String::new(), false);
    for character in line.chars().chain([' ']) {
        match character {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.extend((!word.is_empty()).then(|| std::mem::take(&mut word))),
            other => word.push(other),
        }
    }
    Some(words.into_iter().take_while(|word| !word.starts_with(['#', '>', '|'])).map(Into::into).collect())
}

/// The commands in the code of a page.
fn commands_of_page(text: &str) -> Vec<&str> {
    let mut in_fence = false;
    let mut commands = Vec::new();
    for line in text.lines() {
        in_fence ^= line.starts_with("```");
        let is_code = in_fence || line.starts_with("    ");
        commands.extend(Some(line.trim()).filter(|line| is_code && line.starts_with("enfilade ")));
    }
    commands
}

/// The commands in the help of a verb and of those below it.
fn commands_of_help(command: &Command) -> Vec<String> {
    let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let own = help.lines().filter(|line| line.starts_with("  enfilade ")).map(|line| line.trim().to_string());
    own.chain(command.get_subcommands().flat_map(commands_of_help)).collect()
}

fn problem(line: &str) -> Option<String> {
    let error = Cli::of(&words(line)?).err()?;
    Some(format!("{line}: {error}"))
}

#[test]
fn commands_of_the_help_are_taken() {
    let commands = commands_of_help(&Cli::command());
    assert!(commands.len() > 40, "{}", commands.len());
    let problems: Vec<String> = commands.iter().filter_map(|line| problem(line)).collect();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn commands_of_the_pages_are_taken() {
    let house = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let docs = std::fs::read_dir(house.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let pages = docs.chain([house.join("README.md")]).filter(|path| path.extension().is_some_and(|kind| kind == "md"));
    let (mut count, mut problems) = (0, Vec::new());
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap();
        for line in commands_of_page(&text) {
            count += 1;
            problems.extend(problem(line).map(|problem| format!("{}: {problem}", page.display())));
        }
    }
    assert!(count > 60 && problems.is_empty(), "{count} commands\n{}", problems.join("\n"));
}

//! The output of `enfilade VERB --help`, for all verbs.

use crate::house::House;
use std::path::Path;

/// The page's headings, each with the help of a verb.
///
/// # Errors
/// When the program does not explain itself.
pub fn help(house: &House) -> Result<String, String> {
    let program = house.tested("enfilade")?;
    let mut page = String::new();
    describe(house, &program, &[], &mut page)?;
    Ok(page)
}

/// Adds the help of a verb, and of those below it.
fn describe(house: &House, program: &Path, verb: &[&str], page: &mut String) -> Result<(), String> {
    let words = [verb, &["--help"]].concat();
    let output = house.command(program, &words).env("COLUMNS", "100").output();
    let output = output.map_err(|error| format!("cannot run {}: {error}", program.display()))?;
    let help = String::from_utf8_lossy(&output.stdout).trim_end().to_string();
    if !output.status.success() || help.is_empty() {
        return Err(format!("`enfilade {}` ended with {}", words.join(" "), output.status));
    }
    let name = ["enfilade"].iter().chain(verb).copied().collect::<Vec<_>>().join(" ");
    *page += &format!("{} {name}\n\n```text\n{help}\n```\n\n", "#".repeat(verb.len() + 2));
    for below in verbs(&help) {
        describe(house, program, &[verb, &[below]].concat(), page)?;
    }
    Ok(())
}

/// The verbs below `Commands:`.
fn verbs(help: &str) -> Vec<&str> {
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let named = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    named.filter_map(|line| line.split_whitespace().next()).filter(|verb| *verb != "help").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verbs_are_found_and_nothing_else() {
        let help = "Makes.\n\nUsage: enfilade <COMMAND>\n\nCommands:\n  look    One picture\n          of a file\n  farm    Many\n  help    Print\n\nOptions:\n  -h  x";
        assert_eq!(verbs(help), ["look", "farm"]);
        assert!(verbs("Options:\n  --all  x").is_empty());
    }
}

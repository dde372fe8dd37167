//! A step: a task that is announced before it runs and timed.

use crate::house::House;
use std::process::Command;
use std::time::Instant;

/// One thing to do.
pub struct Step {
    /// Name on the command line.
    pub name: &'static str,
    /// What it ensures.
    pub about: &'static str,
    /// What to do if it fails.
    pub remedy: &'static str,
    /// Runs the step. Returns a remark, or an empty text; an error is the problem found.
    pub run: fn(&House) -> Result<String, String>,
}

impl Step {
    /// Runs the step and prints its progress.
    ///
    /// # Errors
    /// With the step's name, the problem found and what to do.
    pub fn take(&self, house: &House) -> Result<(), String> {
        println!("\n== {}: {}", self.name, self.about);
        let start = Instant::now();
        let outcome = (self.run)(house);
        let seconds = start.elapsed().as_secs_f64();
        match outcome {
            Ok(remark) if remark.is_empty() => println!("== {}: ok, {seconds:.1} s", self.name),
            Ok(remark) => println!("== {}: ok, {seconds:.1} s; {remark}", self.name),
            Err(found) => {
                println!("== {}: failed, {seconds:.1} s", self.name);
                return Err(format!("{}: {found}\n  {}", self.name, self.remedy));
            }
        }
        Ok(())
    }
}

/// The steps with these names in the order of `steps`, or all.
///
/// # Errors
/// When a name is unknown.
pub fn choose<'a>(steps: &'a [Step], names: &[&str]) -> Result<Vec<&'a Step>, String> {
    if let Some(unknown) = names.iter().find(|name| !steps.iter().any(|step| step.name == **name)) {
        let known: Vec<&str> = steps.iter().map(|step| step.name).collect();
        return Err(format!("unknown step `{unknown}`; expected some of {}", known.join(", ")));
    }
    Ok(steps.iter().filter(|step| names.is_empty() || names.contains(&step.name)).collect())
}

/// Runs a program to its end, its output going where ours goes. Returns an empty remark.
///
/// # Errors
/// When it cannot be started or does not end well.
pub fn finish(mut command: Command) -> Result<String, String> {
    let line = line(&command);
    println!("   {line}");
    match command.status() {
        Ok(status) if status.success() => Ok(String::new()),
        Ok(status) => Err(format!("`{line}` ended with {status}")),
        Err(error) => Err(format!("cannot run `{line}`: {error}")),
    }
}

/// The command as one would type it.
fn line(command: &Command) -> String {
    let program = std::path::Path::new(command.get_program());
    let name = program.file_stem().unwrap_or(program.as_os_str()).to_string_lossy();
    command.get_args().fold(name.into_owned(), |line, argument| line + " " + &argument.to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Stdio;

    #[test]
    fn a_failure_names_the_step_what_was_found_and_what_to_do() {
        let step = Step { name: "roof", about: "the roof is tight", remedy: "fix it", run: |_| Err("a hole".into()) };
        assert_eq!(step.take(&House::find().unwrap()).unwrap_err(), "roof: a hole\n  fix it");
    }

    #[test]
    fn steps_are_chosen_by_name_in_their_own_order() {
        let steps = ["a", "b", "c"].map(|name| Step { name, about: "", remedy: "", run: |_| Ok(String::new()) });
        let names = |words: &[&str]| choose(&steps, words).map(|steps| steps.iter().map(|step| step.name).collect::<Vec<_>>());
        assert_eq!(names(&[]).unwrap(), ["a", "b", "c"]);
        assert_eq!(names(&["c", "a"]).unwrap(), ["a", "c"]);
        assert_eq!(names(&["roof"]).unwrap_err(), "unknown step `roof`; expected some of a, b, c");
    }

    #[test]
    fn a_program_that_fails_or_is_not_there_is_an_error_with_its_line() {
        let house = House::find().unwrap();
        let quiet = |arguments: &[&str]| {
            let mut command = house.cargo(arguments);
            command.stdout(Stdio::null()).stderr(Stdio::null());
            finish(command)
        };
        assert!(quiet(&["--version"]).is_ok());
        assert!(quiet(&["no-such-command"]).unwrap_err().starts_with("`cargo no-such-command` ended with"));
        assert!(finish(house.command("no-such-program", &["a"])).unwrap_err().starts_with("cannot run `no-such-program a`"));
    }
}

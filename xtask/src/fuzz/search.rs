//! One search: libFuzzer with a target's seeds and bounds, and its final output.

use super::report::{Found, Row};
use serde_json::Value;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

/// Memory of the process, MB. The program itself refuses more than 1.5 GB of allocations, so the rest is for C libraries.
const MOST_MEMORY_MB: u32 = 2560;
/// An input that takes longer is a hang, seconds: the program is slowed by coverage, and the machine may be busy.
const PATIENCE_S: u32 = 20;
/// An input that was found is made smaller for this long, seconds.
const MINIMISE_S: u32 = 20;

/// A target as the program's table has it.
pub struct Target {
    pub name: String,
    pub about: String,
    longest: u64,
    /// Everything of it.
    folder: PathBuf,
}

/// Has the program write its table and the seeds to `folder`, and reads the table.
///
/// # Errors
/// When it does not run or its table cannot be read.
pub fn targets(program: &Path, folder: &Path) -> Result<Vec<Target>, String> {
    let status = Command::new(program).env("ENFILADE_FUZZ_WRITE", folder).status();
    match status {
        Ok(status) if status.success() => {}
        Ok(status) => return Err(format!("{} ended with {status}", program.display())),
        Err(error) => return Err(format!("cannot run {}: {error}", program.display())),
    }
    let file = folder.join("targets.json");
    let wrong = |problem: String| format!("{}: {problem}", file.display());
    let text = std::fs::read(&file).map_err(|error| wrong(error.to_string()))?;
    let table: Vec<Value> = serde_json::from_slice(&text).map_err(|error| wrong(error.to_string()))?;
    let target = |row: &Value| {
        let name = row["name"].as_str()?.to_string();
        Some(Target { folder: folder.join(&name), name, about: row["about"].as_str()?.into(), longest: row["longest"].as_u64()? })
    };
    table.iter().map(|row| target(row).ok_or_else(|| wrong(format!("{row} is no target")))).collect()
}

/// Searches a target for this number of seconds, with this random seed if one is given.
///
/// # Errors
/// When the program cannot be run, or ends without having searched.
pub fn search(program: &Path, target: &Target, seconds: u64, seed: Option<u32>) -> Result<Row, String> {
    let scratch = Scratch::new(target)?;
    let work = |name: &str| target.folder.join(name);
    for name in ["corpus", "found"] {
        std::fs::create_dir_all(work(name)).map_err(|error| format!("cannot make {}: {error}", work(name).display()))?;
    }
    let log = work("log");
    let mut command = scratch.command(program, target, &log)?;
    command.args([work("corpus"), work("seeds")]);
    command.arg(format!("-max_total_time={seconds}")).arg(format!("-max_len={}", target.longest)).arg("-print_final_stats=1");
    command.arg(format!("-artifact_prefix={}/", work("found").display())).arg("-reload=0").arg("-report_slow_units=60");
    if let Some(seed) = seed {
        command.arg(format!("-seed={seed}"));
    }
    if std::fs::metadata(work("words")).is_ok_and(|words| words.len() > 0) {
        command.arg(format!("-dict={}", work("words").display()));
    }
    let before = names(&work("found"));
    let status = command.status().map_err(|error| format!("cannot run {}: {error}", program.display()))?;
    let said = std::fs::read(&log).map_err(|error| format!("cannot read {}: {error}", log.display()))?;
    let said = String::from_utf8_lossy(&said);
    let found = if status.success() { None } else { Some(found(program, target, &scratch, &before, &said, status)?) };
    let mut row = Row::new(&target.name, &target.about, &said, found);
    row.slowest_ms = scratch.number("slowest") / 1000.0;
    row.peak_alloc_mb = scratch.number("memory") / 1e6;
    Ok(row)
}

/// The finding that ended a search before its time, with a reduced input.
fn found(program: &Path, target: &Target, scratch: &Scratch, before: &[String], said: &str, status: ExitStatus) -> Result<Found, String> {
    let folder = target.folder.join("found");
    let new = names(&folder).into_iter().find(|name| !before.contains(name));
    // A stack that overflows leaves no time to keep the input.
    let input = match new {
        Some(name) => folder.join(name),
        None => scratch
            .last_input(&folder.join("killed"))
            .ok_or_else(|| format!("{}: the program ended with {status}; see {}", target.name, target.folder.join("log").display()))?,
    };
    let problem = problem(said).unwrap_or_else(|| format!("the program ended with {status}"));
    let small = folder.join(format!("small-{}", input.file_name().unwrap_or_default().to_string_lossy()));
    let mut command = scratch.command(program, target, &target.folder.join("minimise.log"))?;
    command.arg(&input).arg("-minimize_crash=1").arg(format!("-max_total_time={MINIMISE_S}"));
    command.arg(format!("-exact_artifact_path={}", small.display()));
    drop(command.status());
    Ok(Found { problem, input: if small.is_file() { small } else { input } })
}

/// The problem in the program's output.
fn problem(said: &str) -> Option<String> {
    let telling = |line: &&str| {
        line.starts_with("panicked at")
            || line.contains("memory allocation of")
            || line.contains("ERROR: libFuzzer")
            || line.contains("overflow")
    };
    let lines: Vec<&str> = said.lines().collect();
    let at = lines.iter().position(telling)?;
    let more = lines.get(at + 1).filter(|_| lines[at].starts_with("panicked at")).copied().unwrap_or_default();
    Some(format!("{} {more}", lines[at]).trim_end().to_string())
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}

/// Folder for small files that change with every input: in memory if the system has such a folder.
struct Scratch(PathBuf);

impl Scratch {
    fn new(target: &Target) -> Result<Self, String> {
        let memory = Path::new("/dev/shm");
        let parent = if memory.is_dir() { memory.to_path_buf() } else { std::env::temp_dir() };
        let folder = parent.join(format!("enfilade-fuzz-{}-{}", std::process::id(), target.name));
        std::fs::create_dir_all(&folder).map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
        Ok(Self(folder))
    }

    /// The program at a target, its output going to `log`.
    fn command(&self, program: &Path, target: &Target, log: &Path) -> Result<Command, String> {
        let output = File::create(log).map_err(|error| format!("cannot write {}: {error}", log.display()))?;
        let both = output.try_clone().map_err(|error| format!("cannot write {}: {error}", log.display()))?;
        let mut command = Command::new(program);
        command.env("ENFILADE_FUZZ_TARGET", &target.name).env("ENFILADE_FUZZ_FOLDER", &self.0).env("TMPDIR", &self.0);
        // One thread: the same input then leads to the same places.
        command.env("RAYON_NUM_THREADS", "1").env("RUST_BACKTRACE", "0").stdin(Stdio::null()).stdout(both).stderr(output);
        command.arg(format!("-rss_limit_mb={MOST_MEMORY_MB}")).arg(format!("-timeout={PATIENCE_S}"));
        Ok(command)
    }

    /// A number that the program has left there; 0 where it has not.
    fn number(&self, name: &str) -> f64 {
        std::fs::read_to_string(self.0.join(name)).ok().and_then(|text| text.trim().parse().ok()).unwrap_or(0.0)
    }

    /// Copies the input that was read last to `file`.
    fn last_input(&self, file: &Path) -> Option<PathBuf> {
        let kept = std::fs::read(self.0.join("input")).ok()?;
        let (length, rest) = kept.split_first_chunk::<8>()?;
        let input = rest.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
        std::fs::write(file, input).ok().map(|()| file.to_path_buf())
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // If it cannot be removed, it is only a temporary file.
        drop(std::fs::remove_dir_all(&self.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_problem_is_the_line_that_tells_it() {
        let panic = "#12 NEW cov: 3\npanicked at crates/a.rs:3:4:\nindex out of bounds\n==7== ERROR: libFuzzer: deadly signal\n";
        assert_eq!(problem(panic).unwrap(), "panicked at crates/a.rs:3:4: index out of bounds");
        let memory = "memory allocation of 8589934592 bytes failed\n==7== ERROR: libFuzzer: deadly signal\n";
        assert_eq!(problem(memory).unwrap(), "memory allocation of 8589934592 bytes failed");
        assert_eq!(problem("#12 NEW cov: 3\n"), None);
    }
}

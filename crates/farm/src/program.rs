//! A program of the user's as a process of its own: until it ends, takes too long, or the worker is asked to end.

use std::ffi::{OsStr, OsString};
use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Bytes of a program's last words on standard error that go into messages.
const TAIL_BYTES: usize = 2000;
/// Between two looks whether it has ended: the first, doubled up to the last.
const PAUSES: [Duration; 2] = [Duration::from_millis(2), Duration::from_millis(100)];
/// Time that the program has to tidy up when it is asked to end, and that its last messages have to arrive after it has ended.
const GRACE: Duration = Duration::from_secs(2);
/// The exit code by which a program asks for another try (EX_TEMPFAIL), as our workers do.
const TRY_AGAIN: i32 = 75;

/// The reason why a program failed.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    /// Description, with the program's last output.
    pub problem: String,
    /// True when another try may help.
    pub is_transient: bool,
}

impl Failure {
    fn new(problem: impl Into<String>, is_transient: bool) -> Self {
        Self { problem: problem.into(), is_transient }
    }
}

/// Runs `program` in `folder`, without a shell. Its output goes where this process's output goes.
///
/// # Errors
/// When it cannot be started, ends with another code than 0, is killed, takes longer than `limit`, or `stop` rises.
pub(crate) fn run(program: &str, arguments: &[OsString], folder: &Path, limit: Duration, stop: &AtomicBool) -> Result<(), Failure> {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).stderr(Stdio::piped());
    // A group of its own, so that what it has started can be ended with it.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut child = command.spawn().map_err(|error| not_started(&error))?;
    let of_the_system = |error: std::io::Error| Failure::new(format!("cannot be waited for: {error}"), true);
    let heard = child.stderr.take().map(listen).transpose().map_err(|error| {
        end(&mut child);
        of_the_system(error)
    })?;
    let ended = wait(&mut child, limit, stop).map_err(of_the_system)?;
    let Some((problem, is_transient)) = told(&ended, limit) else { return Ok(()) };
    Err(Failure::new(problem + &heard.map_or(String::new(), |heard| heard.last_words()), is_transient))
}

fn not_started(error: &std::io::Error) -> Failure {
    let is_lasting = matches!(error.kind(), ErrorKind::NotFound | ErrorKind::PermissionDenied | ErrorKind::InvalidInput);
    let advice = match error.kind() {
        ErrorKind::NotFound => "; install it on every node, or name it by an absolute path that every node has",
        ErrorKind::PermissionDenied => "; make it executable, or name what runs it first, as in [\"python3\", \"/shared/features.py\"]",
        _ => "",
    };
    Failure::new(format!("cannot be started: {error}{advice}"), !is_lasting)
}

/// The end of a process.
enum Ended {
    ByItself(ExitStatus),
    TooLate,
    Stopped,
}

fn wait(child: &mut Child, limit: Duration, stop: &AtomicBool) -> std::io::Result<Ended> {
    let (begun, [mut pause, longest]) = (Instant::now(), PAUSES);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Ended::ByItself(status));
        }
        let is_stopped = stop.load(Ordering::Relaxed);
        if is_stopped || begun.elapsed() > limit {
            end(child);
            return Ok(if is_stopped { Ended::Stopped } else { Ended::TooLate });
        }
        std::thread::sleep(pause);
        pause = (2 * pause).min(longest);
    }
}

/// The problem with how a process ended, and whether another attempt may help; `None` when it ended well.
fn told(ended: &Ended, limit: Duration) -> Option<(String, bool)> {
    let status = match ended {
        Ended::Stopped => return Some(("was ended, since the worker was asked to end".into(), true)),
        Ended::TooLate => return Some((format!("took longer than after_frame_timeout_s = {} and was ended", limit.as_secs_f64()), false)),
        Ended::ByItself(status) if status.success() => return None,
        Ended::ByItself(status) => status,
    };
    Some(match status.code() {
        Some(TRY_AGAIN) => (format!("ended with exit code {TRY_AGAIN}, by which it asks for another try"), true),
        Some(code) => (format!("ended with exit code {code}; expected 0"), false),
        // As when the system has no memory for it.
        None => (format!("was killed: {status}"), true),
    })
}

/// Ends a process that has not been waited for, with what it has started: by a request, and then by force.
fn end(child: &mut Child) {
    #[cfg(unix)]
    {
        use rustix::process::{Pid, Signal, kill_process_group};
        let group = Pid::from_child(child);
        // A failure means that it has already ended.
        let _ = kill_process_group(group, Signal::TERM);
        let asked = Instant::now();
        while asked.elapsed() < GRACE {
            if !matches!(child.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(PAUSES[1] / 5);
        }
        let _ = kill_process_group(group, Signal::KILL);
    }
    let _ = child.kill();
    let _ = child.wait();
}

/// The output of a process on standard error.
struct Heard {
    tail: Arc<Mutex<Vec<u8>>>,
    end: Receiver<()>,
}

/// Passes on the output of `from`, and keeps the end of it.
fn listen(mut from: impl Read + Send + 'static) -> std::io::Result<Heard> {
    let tail = Arc::new(Mutex::new(Vec::new()));
    let (kept, (at_work, end)) = (tail.clone(), channel());
    std::thread::Builder::new().spawn(move || {
        let _at_work: std::sync::mpsc::Sender<()> = at_work;
        let mut buffer = [0; 4096];
        loop {
            let read = match from.read(&mut buffer) {
                Ok(0) => return,
                Ok(read) => &buffer[..read],
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return,
            };
            let _ = std::io::stderr().write_all(read); // nowhere left to report it
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.extend_from_slice(read);
            let surplus = kept.len().saturating_sub(TAIL_BYTES);
            kept.drain(..surplus);
        }
    })?;
    Ok(Heard { tail, end })
}

impl Heard {
    /// The last output, on lines of its own; a note when there was none. Processes that it has left running may still hold the pipe, and
    /// are not waited for.
    fn last_words(&self) -> String {
        let _ = self.end.recv_timeout(GRACE);
        let tail = self.tail.lock().unwrap_or_else(PoisonError::into_inner);
        let text = String::from_utf8_lossy(&tail);
        let text = text.trim_matches(|c: char| c == char::REPLACEMENT_CHARACTER || c.is_whitespace());
        if text.is_empty() { "; it said nothing on standard error".into() } else { format!("; it said last:\n{text}") }
    }
}

/// Whether this machine has a program: a file of an absolute path, or one in a folder of `path`, the variable PATH.
pub(crate) fn is_here(program: &str, path: Option<&OsStr>) -> bool {
    let names = [program.to_string(), format!("{program}{}", std::env::consts::EXE_SUFFIX)];
    let is_in = |folder: &Path| names.iter().any(|name| folder.join(name).is_file());
    if Path::new(program).is_absolute() {
        is_in(Path::new(""))
    } else {
        path.is_some_and(|path| std::env::split_paths(path).any(|folder| is_in(&folder)))
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str, limit_s: f64, stop: bool) -> Result<(), Failure> {
        let folder = tempfile::tempdir().unwrap();
        run("sh", &["-c".into(), script.into()], folder.path(), Duration::from_secs_f64(limit_s), &AtomicBool::new(stop))
    }

    fn failure(script: &str) -> (String, bool) {
        let Failure { problem, is_transient } = shell(script, 60.0, false).unwrap_err();
        (problem, is_transient)
    }

    #[test]
    fn a_program_starts_in_its_folder_and_gets_its_arguments_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let arguments = ["-c", "printf '%s|' \"$@\" >told", "x", "a b", "$HOME", ""].map(OsString::from);
        run("sh", &arguments, folder.path(), Duration::MAX, &AtomicBool::new(false)).unwrap();
        assert_eq!(std::fs::read_to_string(folder.path().join("told")).unwrap(), "a b|$HOME||");
    }

    #[test]
    fn failures_are_told_with_the_last_words_and_whether_another_try_may_help() {
        assert_eq!(failure("echo no weights >&2; exit 3"), ("ended with exit code 3; expected 0; it said last:\nno weights".into(), false));
        assert_eq!(failure("exit 1"), ("ended with exit code 1; expected 0; it said nothing on standard error".into(), false));
        let (problem, is_transient) = failure("exit 75");
        assert!(problem.contains("asks for another try") && is_transient, "{problem}");
        let (problem, is_transient) = failure("kill -KILL $$");
        assert!(problem.starts_with("was killed: signal: 9") && is_transient, "{problem}");
        let (problem, _) = failure("i=0; while [ $i -lt 999 ]; do echo \"line $i is long enough\" >&2; i=$((i+1)); done; exit 1");
        assert!(problem.ends_with("line 998 is long enough") && problem.len() < TAIL_BYTES + 100, "{}", problem.len());
        let missing = run("no-such-program", &[], Path::new("/"), Duration::MAX, &AtomicBool::new(false)).unwrap_err();
        assert!(missing.problem.contains("cannot be started") && missing.problem.contains("on every node") && !missing.is_transient);
    }

    #[test]
    fn a_program_that_hangs_is_ended_with_what_it_has_started() {
        let begun = Instant::now();
        // The shell waits for a process that holds standard error too.
        let late = shell("sleep 50; true", 0.2, false).unwrap_err();
        assert!(late.problem.contains("longer than after_frame_timeout_s = 0.2") && !late.is_transient, "{late:?}");
        let stopped = shell("trap '' TERM; sleep 50; true", 60.0, true).unwrap_err();
        assert!(stopped.problem.contains("asked to end") && stopped.is_transient, "{stopped:?}");
        assert!(begun.elapsed() < Duration::from_secs(30));
    }

    #[test]
    fn programs_are_looked_for_as_the_system_does() {
        let path = std::env::var_os("PATH");
        assert!(is_here("sh", path.as_deref()) && is_here("/bin/sh", None));
        assert!(!is_here("sh", None) && !is_here("no-such-program", path.as_deref()) && !is_here("/no/such/program", path.as_deref()));
    }
}

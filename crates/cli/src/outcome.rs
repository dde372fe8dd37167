//! The outcomes of a verb, and its output and messages.

use enfilade_pipeline::{Failure, ProductOutcome};
use std::io::{ErrorKind, Write};
use std::sync::OnceLock;

/// Why standard output could not be written to, the first time that it could not.
static UNSAID: OnceLock<String> = OnceLock::new();

/// The outcome of a verb that could do its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All is well.
    Done,
    /// A scene failed, or a law is violated; the reason has been printed.
    Failed,
    /// A worker of a farm could not do its tasks, and no other could (EX_DATAERR).
    Permanent,
    /// A worker of a farm could not do its tasks now (EX_TEMPFAIL).
    Transient,
}

impl Verdict {
    /// Done when `ok`.
    pub fn of(ok: bool) -> Self {
        if ok { Self::Done } else { Self::Failed }
    }
}

/// Why a verb could not do its work.
#[derive(Debug)]
pub struct Problem {
    message: String,
    hint: Option<String>,
    /// True when the command or the configuration must change.
    pub usage: bool,
}

impl Problem {
    /// A problem that the command's author can solve.
    pub fn new(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { message: message.into(), hint: Some(hint.into()), usage: true }
    }

    /// A problem with what was found, and what to do.
    pub fn of_data(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self { usage: false, ..Self::new(message, hint) }
    }

    /// A problem with what was found; the message says what to do.
    pub fn found(error: &dyn std::error::Error) -> Self {
        Self { message: error.to_string(), hint: None, usage: false }
    }

    /// A problem with a farm's job.
    pub fn of_farm(error: &enfilade_farm::FarmError) -> Self {
        Self {
            message: error.to_string(),
            hint: error.hint().map(Into::into),
            usage: matches!(error, enfilade_farm::FarmError::Request(_) | enfilade_farm::FarmError::Place { .. }),
        }
    }

    /// Why a scene stopped.
    pub fn of_scene(scene: &str, failure: &Failure) -> Self {
        let message = format!("{scene}: `{}` failed: {}", failure.stage.name(), failure.message);
        Self { message, hint: failure.hint.clone(), usage: false }
    }

    /// Why a product could not be made; `None` where it was.
    pub fn of_product(outcome: &ProductOutcome) -> Option<Self> {
        let (message, hint) = outcome.failure.as_ref()?;
        let place = outcome.scene.as_deref().map_or(String::new(), |scene| format!("{scene}: "));
        let message = format!("{place}{} could not be made: {message}", outcome.product.name());
        Some(Self { message, hint: hint.clone(), usage: false })
    }

    /// Prints it on standard error.
    pub fn print(&self) {
        let mut text = format!("error: {}\n", self.message);
        if let Some(hint) = &self.hint {
            text.push_str(&format!("help: {hint}\n"));
        }
        let _ = std::io::stderr().write_all(text.as_bytes()); // nowhere left to report it
    }
}

impl From<enfilade_pipeline::Error> for Problem {
    fn from(error: enfilade_pipeline::Error) -> Self {
        Self { message: error.explain(), hint: error.hint(), usage: error.is_usage() }
    }
}

impl From<enfilade_dataset::DatasetError> for Problem {
    fn from(error: enfilade_dataset::DatasetError) -> Self {
        let usage = matches!(error, enfilade_dataset::DatasetError::NotADataset { .. }) || error.is_not_found();
        Self { message: error.to_string(), hint: None, usage }
    }
}

impl From<enfilade_vray::VrayError> for Problem {
    fn from(error: enfilade_vray::VrayError) -> Self {
        use enfilade_dataset::DatasetError::{Busy, Io};
        match error {
            enfilade_vray::VrayError::Usage { message, hint } => Self::new(message, hint),
            // The pipeline knows what to do about these.
            enfilade_vray::VrayError::Dataset(error @ (Busy { .. } | Io { .. })) => enfilade_pipeline::Error::from(error).into(),
            enfilade_vray::VrayError::Dataset(error) => error.into(),
        }
    }
}

impl From<enfilade_export::ExportError> for Problem {
    fn from(error: enfilade_export::ExportError) -> Self {
        match error {
            enfilade_export::ExportError::Dataset(error) => error.into(),
            error => Self { message: error.to_string(), hint: None, usage: error.is_usage() },
        }
    }
}

impl From<enfilade_serve::ServeError> for Problem {
    fn from(error: enfilade_serve::ServeError) -> Self {
        let usage = matches!(error, enfilade_serve::ServeError::Bind { .. });
        Self { message: error.to_string(), hint: None, usage }
    }
}

/// Writes lines to standard output; [`unsaid`] reports whether that was possible.
pub fn say(text: &str) {
    note(writeln!(std::io::stdout(), "{text}"));
}

/// Records that something could not be written to standard output. A reader that has gone away is no error.
pub fn note(written: std::io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = UNSAID.set(error.to_string()); // the first error is the cause
    }
}

/// The problem of a standard output that could not be written to, if it could not.
pub fn unsaid() -> Option<Problem> {
    let error = UNSAID.get()?;
    Some(Problem::of_data(format!("cannot write the output: {error}"), "free some space, or send standard output elsewhere"))
}

/// Prints a warning on standard error.
pub fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "warning: {text}"); // nowhere left to report it
}

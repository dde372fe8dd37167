//! The errors of a run, in words for the person who will fix them.

use enfilade_dataset::DatasetError;
use std::error::Error as StdError;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why a verb could not do its work.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The configuration file.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A request that cannot be carried out as given.
    #[error("{message}")]
    Usage {
        /// The request, and why it cannot be done.
        message: String,
        /// What to do.
        hint: String,
    },
    /// A file or folder of the output.
    #[error("cannot {action} {}", path.display())]
    Io {
        /// "read", "write", …
        action: &'static str,
        /// Which one.
        path: PathBuf,
        /// The system's answer.
        source: io::Error,
    },
    /// The scene cannot be processed in its current state.
    #[error("{message}")]
    Scene {
        /// The problem found, and what was expected.
        message: String,
        /// What to do.
        hint: String,
    },
    /// The work was to end, and was put aside within a frame.
    #[error("interrupted within frame {frame} of {camera}, which was kept as far as it has come")]
    Interrupted {
        /// Trajectory of the frame.
        camera: String,
        /// Number of the frame.
        frame: u32,
        /// The file with the unfinished frame.
        kept: PathBuf,
    },
    /// A stage's own error.
    #[error(transparent)]
    Stage(#[from] Box<dyn StdError + Send + Sync>),
}

impl Error {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Io { action, path, source }
    }

    pub(crate) fn usage(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Usage { message: message.into(), hint: hint.into() }
    }

    pub(crate) fn scene(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Scene { message: message.into(), hint: hint.into() }
    }

    /// Boxes the error of a stage's function.
    pub(crate) fn stage(error: impl StdError + Send + Sync + 'static) -> Self {
        Self::Stage(Box::new(error))
    }

    /// True when the command or the configuration must change, rather than a scene or the machine.
    pub fn is_usage(&self) -> bool {
        matches!(self, Self::Config(_) | Self::Usage { .. })
    }

    /// What to do about it, if known.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::Config(error) => error.help.clone(),
            Self::Usage { hint, .. } | Self::Scene { hint, .. } => Some(hint.clone()),
            Self::Io { source, .. } => hint_for(source.kind()).map(Into::into),
            Self::Interrupted { .. } | Self::Stage(_) => None, // the errors of the crates below say what to do themselves
        }
    }

    /// The message and its causes on one line, without causes that the message already contains.
    pub fn explain(&self) -> String {
        let mut text = self.to_string();
        let mut cause = self.source();
        while let Some(error) = cause {
            let part = error.to_string();
            if !text.contains(&part) {
                text = format!("{text}: {part}");
            }
            cause = error.source();
        }
        text
    }
}

impl From<DatasetError> for Error {
    fn from(error: DatasetError) -> Self {
        match error {
            DatasetError::Io { action, path, source } => Self::Io { action, path, source },
            DatasetError::Busy { root, holder } => Self::usage(
                format!("another process ({holder}) is working on {}", root.display()),
                "wait until it has finished, or choose another output folder",
            ),
            error => Self::stage(error),
        }
    }
}

/// What to do about an answer of the operating system.
fn hint_for(kind: io::ErrorKind) -> Option<&'static str> {
    match kind {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            Some("free some space and give the same command again: finished frames are kept, and no file is left half written")
        }
        io::ErrorKind::PermissionDenied => Some("check who owns the file and its folder, or choose another output folder with -o"),
        io::ErrorKind::ReadOnlyFilesystem => Some("the file system is mounted read-only; choose another output folder with -o"),
        io::ErrorKind::NotADirectory => Some("a part of the path is a file; choose another output folder with -o"),
        io::ErrorKind::NotFound => {
            Some("check the path for typing errors; if the files were moved, run again with the dataset.toml beside them")
        }
        _ => None,
    }
}

/// An error in a configuration file, and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Place of the error; `None` if the file as a whole is meant.
    pub place: Option<Box<Place>>,
    /// The problem found, and what was expected.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

/// A place in a file, for display.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// The line itself.
    pub text: String,
    /// Number of characters that the problem spans on its line.
    pub width: usize,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        let Some(place) = &self.place else { return write!(f, ": {}", self.message) };
        let (line, column) = (place.line, place.column);
        let (text, indent, width) = place.excerpt();
        let gutter = line.to_string().len();
        let marker = "^".repeat(width.max(1));
        write!(f, ":{line}:{column}: {}\n  {line} | {text}\n  {:gutter$} | {:indent$}{marker}", self.message, "", "")
    }
}

/// Greatest length of a line that is shown whole, characters; of a longer line this many are shown, ...
pub(crate) const LONGEST_LINE: usize = 160;
/// ... at most this many of them before the place.
const BEFORE_PLACE: usize = 60;

impl Place {
    /// The part of the line that is shown, and where in it and over how many characters it is marked.
    fn excerpt(&self) -> (String, usize, usize) {
        let (start, length) = (self.column - 1, self.text.chars().count());
        if length <= LONGEST_LINE {
            return (self.text.clone(), start, self.width);
        }
        let first = start.saturating_sub(BEFORE_PLACE);
        let end = first + LONGEST_LINE;
        let shown: String = self.text.chars().skip(first).take(LONGEST_LINE).collect();
        let [before, after] = [first > 0, end < length].map(|is_cut| if is_cut { "…" } else { "" });
        (format!("{before}{shown}{after}"), start - first + before.chars().count(), self.width.min(end - start))
    }
}

impl std::error::Error for ConfigError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_explained_once_with_what_to_do() {
        let error = Error::io("write", Path::new("a/b"))(io::Error::from(io::ErrorKind::StorageFull));
        assert_eq!(error.explain(), "cannot write a/b: no storage space");
        assert!(error.hint().unwrap().starts_with("free some space"), "{error:?}");
        assert!(!error.is_usage());
    }

    #[derive(Debug, thiserror::Error)]
    #[error("frame 3: {source}")]
    struct Inner {
        source: io::Error,
    }

    #[test]
    fn causes_that_a_message_tells_are_not_repeated() {
        let error = Error::stage(Inner { source: io::Error::other("no luck") });
        assert_eq!(error.explain(), "frame 3: no luck");
    }
}

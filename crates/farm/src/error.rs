//! Errors of a farm, and whether another attempt may help.

use enfilade_dataset::DatasetError;
use std::error::Error as StdError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Words of an error for want of threads.
pub(crate) const START_THREADS: &str = "start threads for";

/// Why something on a farm could not be done.
#[derive(Debug, thiserror::Error)]
pub enum FarmError {
    /// The place of a job.
    #[error("{place:?} is no place for a job: {problem}; expected a folder, or a URL such as s3://bucket/prefix, gs://… or az://…")]
    Place {
        /// Place as it was given.
        place: String,
        /// The fault of the place.
        problem: String,
    },
    /// The store did not do what it was asked.
    #[error("the store failed at {name}: {source}")]
    Store {
        /// The object, or the place.
        name: String,
        /// Answer of the store.
        source: object_store::Error,
    },
    /// The store does not keep what every commit rests on.
    #[error("{place} cannot hold a job: {problem}; use a store that honours conditional writes (If-None-Match)")]
    Unreliable {
        /// The store.
        place: String,
        /// The fault of the store.
        problem: String,
    },
    /// A file of this machine.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The attempted action.
        action: &'static str,
        /// Which one.
        path: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
    /// The program that the user has asked to run after every frame.
    #[error(
        "after_frame: {program:?} {problem}\n({place} is kept without it, and is not rendered again: do its task again when the program is mended)"
    )]
    Program {
        /// Name of the program.
        program: String,
        /// The frame.
        place: String,
        /// The failure, with the program's last output.
        problem: String,
        /// True when another try may help.
        is_transient: bool,
    },
    /// A request that cannot be carried out as asked.
    #[error("{0}")]
    Request(String),
    /// The job contains an invalid object.
    #[error("{place}: {problem}")]
    Damaged {
        /// The object.
        place: String,
        /// The fault that was found, and what to do.
        problem: String,
    },
    /// A file of a dataset.
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    /// A stage.
    #[error("{}", .0.explain())]
    Pipeline(#[from] enfilade_pipeline::Error),
}

impl FarmError {
    pub(crate) fn store(name: &str) -> impl FnOnce(object_store::Error) -> Self {
        let name = name.to_string();
        move |source| Self::Store { name, source }
    }

    pub(crate) fn io(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Self::Io { action, path: path.into(), source }
    }

    /// Advice on what to do, if the message has none.
    pub fn hint(&self) -> Option<&'static str> {
        if matches!(self, Self::Io { action: START_THREADS, .. }) {
            return Some(
                "the system gives no more threads: end other programs, or raise the limit of processes (ulimit -u) or of the node's group",
            );
        }
        match of_the_system(self)?.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                Some("free some space and give the same command again: what the job has already is not made again")
            }
            _ => None,
        }
    }

    /// True when another attempt, here or elsewhere, may succeed: the store, the network, a full disk, an interruption. False when the
    /// same would happen again.
    pub fn is_transient(&self) -> bool {
        match self {
            Self::Store { .. } | Self::Io { .. } | Self::Dataset(DatasetError::Io { .. }) => true,
            Self::Pipeline(enfilade_pipeline::Error::Stage(error)) => is_of_the_system(error.as_ref()),
            Self::Pipeline(error) => matches!(error, enfilade_pipeline::Error::Io { .. } | enfilade_pipeline::Error::Interrupted { .. }),
            Self::Program { is_transient, .. } => *is_transient,
            Self::Place { .. } | Self::Unreliable { .. } | Self::Request(_) | Self::Damaged { .. } | Self::Dataset(_) => false,
        }
    }
}

/// True when the system refused something, such as space on a disk, at the bottom of `error`.
fn is_of_the_system(error: &(dyn StdError + 'static)) -> bool {
    of_the_system(error).is_some()
}

/// The system's error at the bottom of `error`.
fn of_the_system<'e>(error: &'e (dyn StdError + 'static)) -> Option<&'e std::io::Error> {
    std::iter::successors(Some(error), |&error| error.source()).find_map(|error| error.downcast_ref())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_passes_wherever_it_was_met_and_a_wrong_file_does_not() {
        let full = || DatasetError::Io { action: "write", path: "frame.hdf5".into(), source: ErrorKind::StorageFull.into() };
        let wrong = || DatasetError::NotADataset { root: "out".into(), problem: "it is empty".into() };
        let of_stage = |error: DatasetError| FarmError::Pipeline(enfilade_pipeline::Error::Stage(Box::new(error)));
        assert!(FarmError::Dataset(full()).is_transient() && of_stage(full()).is_transient());
        assert!(!FarmError::Dataset(wrong()).is_transient() && !of_stage(wrong()).is_transient());
    }

    #[test]
    fn a_full_disk_under_a_store_is_told_with_what_to_do() {
        let failed = |kind: ErrorKind| {
            let source = object_store::Error::Generic { store: "LocalFileSystem", source: Box::new(std::io::Error::from(kind)) };
            FarmError::store("/shared/job/objects/ab/abc")(source)
        };
        let full = failed(ErrorKind::StorageFull);
        assert!(full.to_string().starts_with("the store failed at /shared/job/objects/ab/abc: "), "{full}");
        assert!(full.hint().is_some_and(|hint| hint.starts_with("free some space")));
        assert_eq!(failed(ErrorKind::TimedOut).hint(), None);
    }
}

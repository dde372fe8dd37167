//! The lock of a dataset's work folder: one process at a time changes a dataset.

use crate::{DatasetError, WORKDIR};
use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Read, Write};
use std::path::Path;

/// Name of the file in the work folder.
pub const LOCK: &str = "lock";

/// The lock of a dataset's work folder, held by this process while the value lives.
///
/// The system gives the lock back when the process ends in whatever way.
#[derive(Debug)]
pub struct WorkLock {
    _file: File,
}

impl WorkLock {
    /// Locks the work folder of the dataset in `root`, which must be there.
    ///
    /// # Errors
    /// When another process works on the dataset, or the file cannot be written.
    pub fn take(root: &Path) -> Result<Self, DatasetError> {
        let path = root.join(WORKDIR).join(LOCK);
        let mut options = File::options();
        let mut file = options.create(true).truncate(false).read(true).write(true).open(&path).map_err(DatasetError::at("write", &path))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let mut holder = String::new();
                let _ = file.read_to_string(&mut holder); // only for the message
                return Err(DatasetError::Busy { root: root.into(), holder: holder.trim().into() });
            }
            // Some network file systems know no locks; two runs at once would waste work there, but files still appear whole.
            Err(TryLockError::Error(e)) if e.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(DatasetError::io("lock", &path, e)),
        }
        file.set_len(0)
            .and_then(|()| file.write_all(format!("process {}\n", std::process::id()).as_bytes()))
            .map_err(DatasetError::at("write", &path))?;
        Ok(Self { _file: file })
    }
}

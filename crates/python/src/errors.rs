//! Which Python exception each error becomes. Messages name the file.

use enfilade_dataset::DatasetError;
use enfilade_export::ExportError;
use enfilade_farm::FarmError;
use enfilade_loader::LoaderError;
use pyo3::create_exception;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(enfilade, DamagedFileError, PyOSError, "A file of a dataset is damaged, or is not what its name says.");
create_exception!(enfilade, StageError, PyRuntimeError, "A scene could not be finished; `summary` says how far each came.");

/// Errors that become Python exceptions.
pub trait IntoPy {
    /// The exception.
    fn into_py(self) -> PyErr;
}

impl IntoPy for PyErr {
    fn into_py(self) -> PyErr {
        self
    }
}

impl IntoPy for DatasetError {
    fn into_py(self) -> PyErr {
        let message = self.to_string();
        match self {
            Self::NotADataset { .. } | Self::Name { .. } | Self::Unstorable { .. } => PyValueError::new_err(message),
            error if error.is_not_found() => PyFileNotFoundError::new_err(message),
            Self::Io { .. } => PyOSError::new_err(message),
            _ => DamagedFileError::new_err(message),
        }
    }
}

impl IntoPy for LoaderError {
    fn into_py(self) -> PyErr {
        match self {
            Self::Dataset(error) => error.into_py(),
            error @ Self::NoPartition { .. } => PyFileNotFoundError::new_err(error.to_string()),
            Self::Request(message) => PyValueError::new_err(message),
        }
    }
}

impl IntoPy for ExportError {
    fn into_py(self) -> PyErr {
        match self {
            Self::Dataset(error) => error.into_py(),
            Self::Io { .. } => PyOSError::new_err(self.to_string()),
            Self::Place { .. } | Self::Selection(_) | Self::Unsuitable { .. } => PyValueError::new_err(self.to_string()),
        }
    }
}

impl IntoPy for enfilade_pipeline::Error {
    fn into_py(self) -> PyErr {
        let hint = self.hint().map(|hint| format!("; {hint}")).unwrap_or_default();
        let message = format!("{}{hint}", self.explain());
        if self.is_usage() { PyValueError::new_err(message) } else { PyRuntimeError::new_err(message) }
    }
}

impl IntoPy for FarmError {
    fn into_py(self) -> PyErr {
        let hint = self.hint().map(|hint| format!("; {hint}")).unwrap_or_default();
        let message = format!("{self}{hint}");
        match self {
            Self::Dataset(error) => error.into_py(),
            Self::Pipeline(error) => error.into_py(),
            Self::Place { .. } | Self::Request(_) => PyValueError::new_err(message),
            Self::Store { .. } | Self::Unreliable { .. } | Self::Io { .. } => PyOSError::new_err(message),
            Self::Damaged { .. } => DamagedFileError::new_err(message),
            Self::Program { .. } => PyRuntimeError::new_err(message),
        }
    }
}

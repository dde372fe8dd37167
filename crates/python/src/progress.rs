//! Bars that show how far work has come, drawn by `enfilade/_progress.py`.

use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Last reported progress of the work: received on any thread, shown by Python's own.
#[derive(Default)]
pub struct Heard(Mutex<Option<State>>);

/// Messages of the work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Name of the work.
    what: String,
    /// Units that are finished.
    done: u64,
    /// All of them.
    total: u64,
}

impl Heard {
    /// Takes note of it, in place of what was heard before.
    pub fn hear(&self, what: &str, done: u64, total: u64) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let state = state.get_or_insert_default();
        if state.what != what {
            what.clone_into(&mut state.what);
        }
        (state.done, state.total) = (done, total);
    }

    fn take(&self) -> Option<State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// A bar, or none.
pub struct Bar<'py>(Option<Bound<'py, PyAny>>);

impl<'py> Bar<'py> {
    /// No progress bar in any case.
    pub fn none() -> Self {
        Self(None)
    }

    /// A bar if `progress` requests one; if it is `None`, in notebooks and terminals.
    pub fn new(py: Python<'py>, progress: Option<bool>, title: &str) -> PyResult<Self> {
        if progress == Some(false) {
            return Ok(Self(None));
        }
        let bar = py.import("enfilade._progress")?.call_method1("bar", (progress, title))?;
        Ok(Self(Some(bar).filter(|bar| !bar.is_none())))
    }

    /// Shows what was heard since.
    pub fn show(&self, heard: &Heard) -> PyResult<()> {
        let (Some(bar), Some(state)) = (&self.0, heard.take()) else { return Ok(()) };
        bar.call_method1("update", (state.what, state.done, state.total)).map(drop)
    }

    /// Ends it; `whole` means that the work is done.
    pub fn close(&self, whole: bool) -> PyResult<()> {
        self.0.as_ref().map_or(Ok(()), |bar| bar.call_method1("close", (whole,)).map(drop))
    }
}

//! How a stage reports to its caller. Nothing below the pipeline prints, so progress and warnings go through [`Cx`].

use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Something that was dropped, guessed or fixed: the work went on, and the stage's report shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// File, and place in it, or the part or frame concerned.
    pub place: String,
    /// The problem found, and how it was handled.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// Receives the reports of a stage, from any thread.
pub trait Cx: Sync {
    /// `done` of `total` units of `what` are finished. Cheap enough to call per tile.
    fn progress(&self, what: &str, done: u64, total: u64);

    /// Records a warning for the stage's report.
    fn warn(&self, warning: Warning);
}

/// Reports to a [`Cx`] how many units of parallel work are finished.
///
/// Progress is reported before and after each unit. A caller may end the work by unwinding from [`Cx::progress`], which ends one thread's
/// work; the other threads take over its remaining units, and end before they begin their next unit.
pub struct Counted<'a> {
    cx: &'a dyn Cx,
    what: &'a str,
    total: u64,
    done: AtomicU64,
}

impl<'a> Counted<'a> {
    /// None of `total` units of `what` is finished.
    pub fn new(cx: &'a dyn Cx, what: &'a str, total: usize) -> Self {
        Self { cx, what, total: total as u64, done: AtomicU64::new(0) }
    }

    /// Does one of the units.
    pub fn unit<T>(&self, work: impl FnOnce() -> T) -> T {
        self.cx.progress(self.what, self.done.load(Ordering::Relaxed), self.total);
        let result = work();
        self.cx.progress(self.what, self.done.fetch_add(1, Ordering::Relaxed) + 1, self.total);
        result
    }
}

/// A [`Cx`] that keeps the warnings, in the order in which they come, for tests.
#[derive(Debug, Default)]
pub struct Heard(Mutex<Vec<Warning>>);

impl Heard {
    /// The warnings so far, each in a line.
    pub fn lines(&self) -> Vec<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).iter().map(Warning::to_string).collect()
    }
}

impl Cx for Heard {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {}

    fn warn(&self, warning: Warning) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(warning);
    }
}

/// A [`Cx`] that hears nothing, for tests and one-off calls.
pub struct Quiet;

impl Cx for Quiet {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {}
    fn warn(&self, _warning: Warning) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

    /// Keeps what it hears, and ends the work when a number of units is finished.
    struct Ending(Mutex<Vec<(u64, u64)>>, u64);

    impl Cx for Ending {
        fn progress(&self, _what: &str, done: u64, total: u64) {
            self.0.lock().unwrap().push((done, total));
            if done == self.1 {
                resume_unwind(Box::new("ended"));
            }
        }

        fn warn(&self, _warning: Warning) {}
    }

    #[test]
    fn units_are_told_before_and_after_and_do_not_begin_once_the_work_has_ended() {
        let (cx, begun) = (Ending(Mutex::default(), 2), AtomicU64::new(0));
        let counted = Counted::new(&cx, "units", 5);
        let ended: Vec<bool> =
            (0..5).map(|_| catch_unwind(AssertUnwindSafe(|| counted.unit(|| begun.fetch_add(1, Ordering::Relaxed)))).is_err()).collect();
        assert_eq!((ended, begun.into_inner()), (vec![false, true, true, true, true], 2));
        assert_eq!(cx.0.into_inner().unwrap(), [(0, 5), (1, 5), (1, 5), (2, 5), (2, 5), (2, 5), (2, 5)]);
    }
}

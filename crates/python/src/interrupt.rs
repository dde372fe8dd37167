//! Ctrl-C during long work: the work runs on another thread, while Python's own thread looks for signals.

use crate::errors::IntoPy;
use enfilade_pipeline::{Event, Reporter, Stage};
use enfilade_scene::{Cx, Warning};
use pyo3::prelude::*;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time between two looks for signals.
const INTERVAL: Duration = Duration::from_millis(100);

/// Ends interrupted work when it next reports progress. What is finished by then stays, as when a run is killed.
#[derive(Default)]
pub struct Interrupt(AtomicBool);

impl Interrupt {
    /// Rises with the interruption: for work that is ended by a flag, in good order.
    pub fn flag(&self) -> &AtomicBool {
        &self.0
    }

    fn check(&self) {
        if self.0.load(Ordering::Relaxed) {
            resume_unwind(Box::new("interrupted"));
        }
    }
}

impl Reporter for Interrupt {
    fn on(&self, _scene: &str, _stage: Stage, _event: Event) {
        self.check();
    }
}

impl Cx for Interrupt {
    fn progress(&self, _what: &str, _done: u64, _total: u64) {
        self.check();
    }

    fn warn(&self, _warning: Warning) {}
}

/// Runs `work` on another thread, while Python checks for signals.
pub fn interruptible<T: Send, E: IntoPy + Send>(py: Python<'_>, work: impl FnOnce(&Interrupt) -> Result<T, E> + Send) -> PyResult<T> {
    let interrupt = Interrupt::default();
    std::thread::scope(|scope| {
        let (alive, ended) = channel::<()>();
        let reporter = &interrupt;
        let worker = scope.spawn(move || {
            let _alive = alive;
            work(reporter)
        });
        let ended = std::sync::Mutex::new(ended);
        let still_works = || ended.lock().is_ok_and(|ended| ended.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout));
        let mut signal = Ok(());
        while py.detach(still_works) {
            if let Err(raised) = py.check_signals() {
                interrupt.0.store(true, Ordering::Relaxed);
                signal = signal.and(Err(raised));
            }
        }
        match py.detach(|| worker.join()) {
            Ok(done) => signal.and(done.map_err(IntoPy::into_py)),
            Err(panic) => signal.and_then(|()| resume_unwind(panic)),
        }
    })
}

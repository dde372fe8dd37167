//! Ctrl-C during long work, and how far it has come: the work runs on another thread, while Python's own thread looks for signals.

use crate::errors::IntoPy;
use crate::progress::{Bar, Heard};
use enfilade_pipeline::{Event, Product, Reporter, Stage};
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
pub struct Interrupt {
    interrupted: AtomicBool,
    heard: Heard,
}

impl Interrupt {
    /// Rises with the interruption: for work that is ended by a flag, in good order.
    pub fn flag(&self) -> &AtomicBool {
        &self.interrupted
    }

    fn check(&self) {
        if self.interrupted.load(Ordering::Relaxed) {
            resume_unwind(Box::new("interrupted"));
        }
    }
}

impl Reporter for Interrupt {
    fn on(&self, scene: &str, stage: Stage, event: Event) {
        self.tell(scene, stage.name(), event);
    }

    fn on_product(&self, scene: &str, product: Product, event: Event) {
        self.tell(if scene.is_empty() { "dataset" } else { scene }, product.name(), event);
    }
}

impl Interrupt {
    /// Reports an event of a stage or a product of a scene.
    fn tell(&self, scene: &str, name: &str, event: Event) {
        self.check();
        match event {
            Event::Started => self.heard.hear(&format!("{scene}: {name}"), 0, 1),
            Event::Progress { what, done, total } => self.heard.hear(&format!("{scene}: {name}, {what}"), done, total),
            _ => {}
        }
    }
}

impl Cx for Interrupt {
    fn progress(&self, what: &str, done: u64, total: u64) {
        self.check();
        self.heard.hear(what, done, total);
    }

    fn warn(&self, _warning: Warning) {}
}

/// Runs `work` on another thread, while Python checks for signals.
pub fn interruptible<T: Send, E: IntoPy + Send>(py: Python<'_>, work: impl FnOnce(&Interrupt) -> Result<T, E> + Send) -> PyResult<T> {
    watched(py, &Bar::none(), work)
}

/// Runs work as [`interruptible`] does, and shows in `bar` how far it has come.
pub fn watched<T: Send, E: IntoPy + Send>(
    py: Python<'_>,
    bar: &Bar<'_>,
    work: impl FnOnce(&Interrupt) -> Result<T, E> + Send,
) -> PyResult<T> {
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
            // After a first error nothing more is shown: it may have come from the bar.
            let shown = if signal.is_ok() { bar.show(&interrupt.heard) } else { Ok(()) };
            if let Err(raised) = py.check_signals().and(shown) {
                interrupt.interrupted.store(true, Ordering::Relaxed);
                signal = signal.and(Err(raised));
            }
        }
        let done = match py.detach(|| worker.join()) {
            Ok(done) => signal.and(done.map_err(IntoPy::into_py)),
            Err(panic) => signal.and_then(|()| resume_unwind(panic)),
        };
        let closed = bar.close(done.is_ok());
        done.and_then(|done| closed.map(|()| done))
    })
}

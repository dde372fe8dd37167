//! Samples in a given order, decoded ahead by threads.

use crate::error::LoaderError;
use crate::sample::Sample;
use crate::samples::{FrameName, Samples};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// Gives samples in order while its threads decode those that follow.
///
/// The samples do not depend on the number of threads. Dropping it ends the threads.
pub struct Stream {
    work: Arc<Work>,
    threads: Vec<JoinHandle<()>>,
}

struct Work {
    samples: Arc<Samples>,
    order: Vec<usize>,
    epoch: u64,
    /// Largest number of samples that are decoded or being decoded, but not yet returned.
    ahead: usize,
    state: Mutex<State>,
    /// Something was decoded, given, or ended.
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Places of the order whose decoding has begun.
    begun: usize,
    /// Places that were given.
    given: usize,
    ready: BTreeMap<usize, Result<Sample, LoaderError>>,
    ended: bool,
}

impl Stream {
    /// Begins to decode the samples whose indices `order` lists, on the given number of threads; at most `ahead` samples are held in memory.
    pub fn new(samples: Arc<Samples>, order: Vec<usize>, epoch: u64, threads: usize, ahead: usize) -> Self {
        let (state, changed) = Default::default();
        let work = Arc::new(Work { samples, order, epoch, ahead: ahead.max(1), state, changed });
        let threads = (0..threads.max(1)).map(|_| {
            let work = work.clone();
            std::thread::spawn(move || work.decode())
        });
        Self { threads: threads.collect(), work }
    }
}

impl Work {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The loop of a thread: decodes the next place until none is left.
    fn decode(&self) {
        while let Some(place) = self.next_place() {
            let index = self.order[place];
            let FrameName { scene, camera, frame } = self.samples.place(index);
            let gave_up = |_| Err(LoaderError::Request(format!("sample {index}, {scene}/{camera} frame {frame}: the decoder gave up")));
            let sample = catch_unwind(AssertUnwindSafe(|| self.samples.sample(index, self.epoch))).unwrap_or_else(gave_up);
            self.lock().ready.insert(place, sample);
            self.changed.notify_all();
        }
    }

    fn next_place(&self) -> Option<usize> {
        let mut state = self.lock();
        loop {
            if state.ended || state.begun == self.order.len() {
                return None;
            }
            if state.begun < state.given + self.ahead {
                state.begun += 1;
                return Some(state.begun - 1);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Iterator for Stream {
    type Item = Result<Sample, LoaderError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut state = self.work.lock();
        let place = state.given;
        if place == self.work.order.len() {
            return None;
        }
        loop {
            if let Some(sample) = state.ready.remove(&place) {
                state.given += 1;
                self.work.changed.notify_all();
                return Some(sample);
            }
            state = self.work.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        self.work.lock().ended = true;
        self.work.changed.notify_all();
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}

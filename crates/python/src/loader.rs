//! `enfilade.Loader`: passes over a dataset whose samples or batches threads decode ahead.

use crate::arrays::{self, Batch};
use crate::errors::IntoPy;
use enfilade_loader::{Sample, Samples, Stream, shuffled};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Threads that can run at once.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Passes over a dataset, one for every `for`, whose samples threads decode ahead; made by `Dataset.loader`.
///
/// A pass is an epoch: it decides the order and where random crops lie. Samples and their order do not depend on the number of threads.
#[pyclass(module = "enfilade", frozen)]
pub struct Loader {
    samples: Arc<Samples>,
    epoch: AtomicU64,
    batch_size: Option<usize>,
    shuffle: bool,
    threads: usize,
    prefetch: usize,
    drop_last: bool,
}

impl Loader {
    /// A loader with the options that `Dataset.loader` describes.
    pub fn new(
        samples: Arc<Samples>,
        epoch: u64,
        batch_size: Option<usize>,
        shuffle: bool,
        threads: Option<usize>,
        prefetch: Option<usize>,
        drop_last: bool,
    ) -> PyResult<Self> {
        if batch_size == Some(0) || threads == Some(0) || prefetch == Some(0) {
            return Err(PyValueError::new_err("batch_size, threads and prefetch must be at least 1, or None"));
        }
        let threads = threads.unwrap_or_else(cores);
        let prefetch = prefetch.unwrap_or_else(|| (2 * threads).max(2 * batch_size.unwrap_or(1)));
        Ok(Self { samples, epoch: AtomicU64::new(epoch), batch_size, shuffle, threads, prefetch, drop_last })
    }
}

#[pymethods]
impl Loader {
    /// Batches of a pass, or samples where there are no batches.
    fn __len__(&self) -> usize {
        let count = self.samples.len();
        match self.batch_size {
            None => count,
            Some(size) if self.drop_last => count / size,
            Some(size) => count.div_ceil(size),
        }
    }

    /// The epoch of the next pass; each pass adds one.
    #[getter]
    fn epoch(&self) -> u64 {
        self.epoch.load(Ordering::Relaxed)
    }

    /// Says which epoch the next pass is, as after a restart.
    fn set_epoch(&self, epoch: u64) {
        self.epoch.store(epoch, Ordering::Relaxed);
    }

    fn __iter__(&self) -> LoaderIterator {
        let (count, epoch) = (self.samples.len(), self.epoch.fetch_add(1, Ordering::Relaxed));
        let mut order = if self.shuffle { shuffled(count, self.samples.options().seed, epoch) } else { (0..count).collect() };
        if let (Some(size), true) = (self.batch_size, self.drop_last) {
            order.truncate(count / size * size);
        }
        let stream = Stream::new(self.samples.clone(), order.clone(), epoch, self.threads, self.prefetch);
        LoaderIterator { pass: Mutex::new(Pass { stream, order: order.into_iter() }), batch_size: self.batch_size }
    }
}

/// One pass.
#[pyclass(module = "enfilade", frozen)]
pub struct LoaderIterator {
    pass: Mutex<Pass>,
    batch_size: Option<usize>,
}

struct Pass {
    stream: Stream,
    order: std::vec::IntoIter<usize>,
}

impl Pass {
    fn next(&mut self) -> PyResult<Option<(usize, Sample)>> {
        match self.stream.next().zip(self.order.next()) {
            None => Ok(None),
            Some((sample, index)) => Ok(Some((index, sample.map_err(IntoPy::into_py)?))),
        }
    }
}

#[pymethods]
impl LoaderIterator {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let lock = || self.pass.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(size) = self.batch_size else {
            let next = py.detach(|| lock().next())?;
            return next.map(|(index, sample)| arrays::sample(py, index, sample)).transpose();
        };
        let batch = py.detach(|| {
            let mut pass = lock();
            let samples = (0..size).map_while(|_| pass.next().transpose()).collect::<PyResult<Vec<_>>>()?;
            let stacked = (!samples.is_empty()).then(|| Batch::of(samples));
            stacked.transpose().map_err(PyValueError::new_err)
        })?;
        batch.map(|batch| batch.into_dict(py)).transpose()
    }
}

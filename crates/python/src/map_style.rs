//! Common parts of the datasets of this module: indexing by one number or by several, as Python and torch's DataLoader do it.

use crate::arguments::position;
use crate::arrays;
use crate::errors::IntoPy;
use crate::loader::cores;
use enfilade_frame::Layer;
use enfilade_loader::{LoaderError, Sample};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3::{PyClass, PyTypeInfo};

/// A dataset whose samples are found by index and decoded independently of each other.
pub trait MapStyle {
    /// Number of samples.
    fn count(&self) -> usize;

    /// A function that decodes samples by their index. One decoder serves one request, so that all its samples are of one epoch.
    fn decoder(&self) -> impl Fn(usize) -> Result<Sample, LoaderError> + Sync;

    /// The index that Python means: negative ones count from the end.
    fn index(&self, index: isize) -> PyResult<usize> {
        position(index, self.count())
    }
}

/// `dataset[index]`.
pub fn item<'py>(py: Python<'py>, dataset: &(impl MapStyle + Sync), index: isize) -> PyResult<Bound<'py, PyDict>> {
    let index = dataset.index(index)?;
    let decode = dataset.decoder();
    let sample = py.detach(|| decode(index)).map_err(IntoPy::into_py)?;
    arrays::sample(py, index, sample)
}

/// The samples of several indices, decoded on all cores. Those of a subclass with a `__getitem__` of its own come from there, one by one.
pub fn items<'py, T>(dataset: &Bound<'py, T>, indices: Vec<isize>) -> PyResult<Vec<Bound<'py, PyAny>>>
where
    T: MapStyle + PyClass<Frozen = pyo3::pyclass::boolean_struct::True> + Sync,
{
    if gives_own_samples(dataset)? {
        return indices.into_iter().map(|index| dataset.as_any().get_item(index)).collect();
    }
    let (py, ours) = (dataset.py(), dataset.get());
    let indices = indices.into_iter().map(|index| ours.index(index)).collect::<PyResult<Vec<_>>>()?;
    let decode = ours.decoder();
    let samples = py.detach(|| decode_all(&indices, &decode)).map_err(IntoPy::into_py)?;
    indices.into_iter().zip(samples).map(|(index, sample)| Ok(arrays::sample(py, index, sample)?.into_any())).collect()
}

/// The samples one after the other, as `dataset[0]`, `dataset[1]`, … return them, also for subclasses.
#[pyclass(module = "enfilade")]
pub struct SampleIterator {
    dataset: Py<PyAny>,
    next: usize,
}

impl SampleIterator {
    /// From the first on.
    pub fn over(dataset: Bound<'_, PyAny>) -> Self {
        Self { dataset: dataset.unbind(), next: 0 }
    }
}

#[pymethods]
impl SampleIterator {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let dataset = self.dataset.bind(py);
        if self.next >= dataset.len()? {
            return Ok(None);
        }
        self.next += 1;
        dataset.get_item(self.next - 1).map(Some)
    }
}

/// Names of layers.
pub fn layer_names(layers: impl IntoIterator<Item = Layer>) -> Vec<&'static str> {
    layers.into_iter().map(|layer| layer.spec().name).collect()
}

/// The samples of these indices, in their order, decoded by as many threads as there are cores.
fn decode_all(indices: &[usize], decode: impl Fn(usize) -> Result<Sample, LoaderError> + Sync) -> Result<Vec<Sample>, LoaderError> {
    let per_thread = indices.len().div_ceil(cores()).max(1);
    let decode = &|part: &[usize]| part.iter().map(|&index| decode(index)).collect::<Result<Vec<_>, _>>();
    std::thread::scope(|scope| {
        let threads: Vec<_> = indices.chunks(per_thread).map(|part| scope.spawn(move || decode(part))).collect();
        let parts = threads.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        parts.collect::<Result<Vec<_>, _>>().map(|parts| parts.into_iter().flatten().collect())
    })
}

/// True for a dataset of a subclass that overrides `__getitem__`.
fn gives_own_samples<T: PyTypeInfo>(dataset: &Bound<'_, T>) -> PyResult<bool> {
    let ours = dataset.py().get_type::<T>().getattr("__getitem__")?;
    Ok(!dataset.as_any().get_type().getattr("__getitem__")?.is(&ours))
}

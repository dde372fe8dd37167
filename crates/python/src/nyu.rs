//! `enfilade.NyuV2`, the labelled images of NYU-Depth V2 as published, and the tables of its classes.

use crate::arguments::{Names, layers};
use crate::errors::IntoPy;
use crate::map_style::{MapStyle, SampleIterator, item, items, layer_names};
use enfilade_loader::{LoaderError, NYU_LAYERS, NyuChoice, NyuClasses, NyuSide, NyuV2 as Images, Sample, nyu13_of_nyu40};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::path::PathBuf;

/// NYU-Depth V2's labelled images, from the published file nyu_depth_v2_labeled.mat: a map-style dataset.
///
/// The file is read as it is; nothing is unpacked. It can be pickled, and may be used in forked processes and from several threads, which
/// decode at the same time.
///
/// `ds[i]` has, as that of `enfilade.Dataset` does,
///
/// - `color`: uint8, height × width × 3.
/// - `depth_z_meters`: float32, height × width: planar depth in metres, with holes filled in by the dataset's authors (`depths`).
/// - `semantic`: int16, height × width: classes from 1; -1 is "unlabelled".
/// - `mask`: bool, height × width: true where depth, if asked for, is a number above zero.
/// - `scene` (the dataset's name, such as "kitchen_0004"), `camera` (empty), `frame` (the image's number in the file, from 1), `index`, and
///   `window`.
///
/// The split is the published one: 795 images to train with, 654 to test with.
///
/// Parameters
/// ----------
/// path: of nyu_depth_v2_labeled.mat.
/// split: "train" or "test"; all images unless given.
/// classes: 894, those of the file; 40 (Gupta et al. 2013); or 13 (Couprie et al. 2013).
/// layers: some of "color", "depth_z_meters" and "semantic"; all unless given.
/// partial: takes a file with other than the 1449 published images.
#[pyclass(module = "enfilade", subclass, frozen)]
pub struct NyuV2 {
    images: Images,
    arguments: Arguments,
}

/// The constructor's arguments, so that pickling can make it again in another process.
#[derive(Clone, IntoPyObject)]
struct Arguments {
    split: Option<String>,
    classes: usize,
    layers: Option<Names>,
    partial: bool,
}

impl Arguments {
    fn choice(&self) -> PyResult<NyuChoice> {
        let wrong = |problem: String| PyValueError::new_err(problem);
        let split = match self.split.as_deref() {
            None => None,
            Some("train") => Some(NyuSide::Train),
            Some("test") => Some(NyuSide::Test),
            Some(other) => return Err(wrong(format!("split: {other:?} is no side of NYUv2; expected \"train\" or \"test\""))),
        };
        let classes = NyuClasses::of(self.classes);
        let classes = classes.ok_or_else(|| wrong(format!("classes is {}; expected 894, 40 or 13", self.classes)))?;
        let layers = layers(self.layers.as_ref())?.unwrap_or_else(|| NYU_LAYERS.to_vec());
        Ok(NyuChoice { side: split, classes, layers, partial: self.partial })
    }
}

impl MapStyle for NyuV2 {
    fn count(&self) -> usize {
        self.images.len()
    }

    fn decoder(&self) -> impl Fn(usize) -> Result<Sample, LoaderError> + Sync {
        |index| self.images.sample(index)
    }
}

#[pymethods]
impl NyuV2 {
    #[new]
    #[pyo3(signature = (path, *, split=None, classes=40, layers=None, partial=false))]
    fn new(py: Python<'_>, path: PathBuf, split: Option<String>, classes: usize, layers: Option<Names>, partial: bool) -> PyResult<Self> {
        let arguments = Arguments { split, classes, layers, partial };
        let (choice, path) = (arguments.choice()?, std::path::absolute(path)?);
        let images = py.detach(|| Images::open(&path, &choice)).map_err(IntoPy::into_py)?;
        Ok(Self { images, arguments })
    }

    fn __len__(&self) -> usize {
        self.images.len()
    }

    fn __iter__(this: &Bound<'_, Self>) -> SampleIterator {
        SampleIterator::over(this.as_any().clone())
    }

    fn __getitem__<'py>(&self, py: Python<'py>, index: isize) -> PyResult<Bound<'py, PyDict>> {
        item(py, self, index)
    }

    /// The samples of several indices, decoded on all cores; torch's DataLoader asks for a batch so. Those of a subclass with a
    /// `__getitem__` of its own come from there, one by one.
    fn __getitems__<'py>(this: &Bound<'py, Self>, indices: Vec<isize>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        items(this, indices)
    }

    /// Number of a sample's image in the file, from 1, without decoding it.
    fn frame(&self, index: isize) -> PyResult<u32> {
        Ok(self.images.frame(self.index(index)?))
    }

    /// Names of the layers of each sample.
    #[getter]
    fn layers(&self) -> Vec<&'static str> {
        layer_names(self.images.layers())
    }

    /// Names of the classes; that of class 1 is the first.
    #[getter]
    fn class_names(&self) -> Vec<&'static str> {
        self.images.classes().names()
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        Ok((PyTuple::new(py, [self.images.path()])?, self.arguments.clone().into_pyobject(py)?))
    }

    fn __repr__(&self) -> String {
        let layers = self.layers().join(", ");
        format!("<enfilade.NyuV2 {:?}: {} samples of {layers}, {} classes>", self.images.path(), self.images.len(), self.arguments.classes)
    }
}

/// Adds `NYU40`, `NYU40_COLORS`, `NYU13` and `NYU13_OF_NYU40`.
pub fn add_tables(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("NYU40", PyTuple::new(py, NyuClasses::Forty.names())?)?;
    module.add("NYU13", PyTuple::new(py, NyuClasses::Thirteen.names())?)?;
    let colors: Vec<_> = enfilade_scene::NYU40.iter().map(|class| (class.color[0], class.color[1], class.color[2])).collect();
    module.add("NYU40_COLORS", PyTuple::new(py, colors)?)?;
    module.add("NYU13_OF_NYU40", PyTuple::new(py, (0..=40).map(nyu13_of_nyu40))?)
}

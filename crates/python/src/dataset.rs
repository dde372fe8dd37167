//! `enfilade.Dataset`: frames of a dataset of ours or of Hypersim's release, as dictionaries of numpy arrays.

use crate::arguments::CropPosition;
use crate::dataset_options::DatasetOptions;
use crate::errors::IntoPy;
use crate::keywords;
use crate::loader::Loader;
use crate::map_style::{MapStyle, SampleIterator, item, items, layer_names};
use enfilade_dataset::{Layout, read_pairs};
use enfilade_loader::{Choice, LoaderError, Sample, Samples};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Frames of a dataset as dictionaries of numpy arrays: a map-style dataset, as torch's DataLoader takes it.
///
/// It opens datasets of enfilade, and Hypersim's release as Apple publishes it (a folder of unpacked scenes, with
/// metadata_camera_parameters.csv beside them). It can be pickled, and may be used in forked processes and from several threads.
///
/// `ds[i]` has
///
/// - every layer by its name: height × width, or height × width × channels; `enfilade.LAYERS` tells units, spaces and sentinels.
///   Distances, planar depths (`depth_z_meters`, computed where it is not stored) and positions are float32 and in metres.
/// - `mask`: bool, height × width; true where every layer has a value: floating-point values are finite, and depths above zero.
/// - `K`: float64, 3 × 3, OpenCV's: x right, y down, (0, 0) the centre of the upper left pixel; that of the crop and size asked for, before
///   lens distortion. Missing for panoramas and grids of rays.
/// - `world_from_camera`: float64, 4 × 4, metres; camera axes are OpenCV's (x right, y down, z forward), the world's z is up.
///   A tilted image plane, as most of Apple's cameras have, is straightened by a turn of the camera, which is in `K` and pose. It is not in
///   `normal_cam`, `normal_bump_cam` and `scene_flow`, which have the camera's own axes (x right, y up, z backward): normals in the axes of
///   `K` are `normal_world @ world_from_camera[:3, :3]`.
/// - `scene`, `camera`, `frame`, `index`, and `window`: row, column, height and width of the part of the frame that is shown.
///
/// Parameters
/// ----------
/// path: folder of the dataset.
/// {options}
/// crop_place: "center", "random" (by seed, epoch and index), or row and column of the crop's first pixel.
/// epoch: of random crops.
/// camera_table: another metadata_camera_parameters.csv.
#[pyclass(module = "enfilade", subclass, frozen)]
pub struct Dataset {
    samples: Arc<Samples>,
    epoch: AtomicU64,
    /// Absolute, as its table of cameras is: the current folder may change.
    root: PathBuf,
    arguments: Arguments,
}

/// Arguments of a dataset, so that pickling can make it again in another process.
struct Arguments {
    path: PathBuf,
    crop_place: CropPosition,
    camera_table: Option<PathBuf>,
    /// The given options.
    options: Py<PyDict>,
}

impl Arguments {
    /// The samples that the arguments choose; `root` is the absolute path of the dataset.
    fn open(&self, py: Python<'_>, root: &Path) -> PyResult<Samples> {
        let chosen: DatasetOptions =
            keywords::options(Some(self.options.bind(py)), "Dataset", &["path", "crop_place", "epoch", "camera_table"])?;
        let (options, layers, side) = (chosen.of_samples(self.crop_place.crop_place()?), chosen.layers()?, chosen.side()?);
        py.detach(|| {
            let dataset = enfilade_dataset::Dataset::open(root).map_err(IntoPy::into_py)?;
            let dataset = match &self.camera_table {
                Some(table) => dataset.with_camera_table(table),
                None => dataset,
            };
            let select = |what, names: &[String], chosen: &[String]| {
                enfilade_pipeline::select(what, names, Some(&chosen.join(","))).map_err(IntoPy::into_py)
            };
            let scenes = dataset.scenes().map_err(IntoPy::into_py)?;
            let scenes = chosen.scenes.as_ref().map(|pattern| select("scene", &scenes, pattern)).transpose()?.unwrap_or(scenes);
            let cameras = match &chosen.cameras {
                None => None,
                Some(pattern) => Some(select("camera", &dataset.camera_names(&scenes).map_err(IntoPy::into_py)?, pattern)?),
            };
            Samples::open(dataset, &Choice { layers, scenes: Some(scenes), cameras, side }, options).map_err(IntoPy::into_py)
        })
    }
}

impl MapStyle for Dataset {
    fn count(&self) -> usize {
        self.samples.len()
    }

    fn decoder(&self) -> impl Fn(usize) -> Result<Sample, LoaderError> + Sync {
        let epoch = self.epoch.load(Ordering::Relaxed);
        move |index| self.samples.sample(index, epoch)
    }
}

#[pymethods]
impl Dataset {
    #[new]
    #[pyo3(signature = (path, *, crop_place=CropPosition::Named("center".into()), epoch=0, camera_table=None, **options))]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        crop_place: CropPosition,
        epoch: u64,
        camera_table: Option<PathBuf>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (root, camera_table) = (std::path::absolute(&path)?, camera_table.map(std::path::absolute).transpose()?);
        let options = options.map_or_else(|| Ok(PyDict::new(py)), |options| options.copy())?.unbind();
        let arguments = Arguments { path, crop_place, camera_table, options };
        Ok(Self { samples: Arc::new(arguments.open(py, &root)?), epoch: AtomicU64::new(epoch), root, arguments })
    }

    fn __len__(&self) -> usize {
        self.samples.len()
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

    /// Scene, camera and frame number of a sample, without decoding it.
    fn place(&self, index: isize) -> PyResult<(&str, &str, u32)> {
        let place = self.samples.place(self.index(index)?);
        Ok((place.scene, place.camera, place.frame))
    }

    /// Pairs of frames that see the same surfaces, as `enfilade make OUT pairs` lists them: indices of samples, each pair once, for models that learn
    /// from several views. Pairs of which this dataset lacks a frame, because of `split` or `scenes`, are left out.
    ///
    /// file: another list than pairs.csv in the dataset's folder.
    #[pyo3(signature = (file=None))]
    fn pairs(&self, file: Option<PathBuf>) -> PyResult<Vec<(usize, usize)>> {
        let file = file.unwrap_or_else(|| Layout::new(&self.root).pairs());
        let pairs = read_pairs(&file).map_err(IntoPy::into_py)?;
        let places = (0..self.samples.len()).map(|index| (self.samples.place(index), index));
        let index: HashMap<(&str, &str, u32), usize> = places.map(|(at, index)| ((at.scene, at.camera, at.frame), index)).collect();
        let find = |scene: &str, (camera, frame): &(String, u32)| index.get(&(scene, camera.as_str(), *frame)).copied();
        Ok(pairs.iter().filter_map(|pair| Some((find(&pair.scene, &pair.first)?, find(&pair.scene, &pair.second)?))).collect())
    }

    /// Names of the layers of each sample.
    #[getter]
    fn layers(&self) -> Vec<&'static str> {
        layer_names(self.samples.layers().iter().copied())
    }

    /// Decides where random crops lie; `set_epoch` changes it.
    #[getter]
    fn epoch(&self) -> u64 {
        self.epoch.load(Ordering::Relaxed)
    }

    /// Moves random crops: call it before each pass, in the process that holds the dataset.
    fn set_epoch(&self, epoch: u64) {
        self.epoch.store(epoch, Ordering::Relaxed);
    }

    /// Passes over the dataset in which threads decode ahead, without worker processes; see `Loader`.
    ///
    /// batch_size: samples per batch, whose arrays then have a first axis more; single samples unless given.
    /// shuffle: another order in each pass, by the dataset's seed.
    /// threads: that decode; as many as there are cores unless given.
    /// prefetch: samples held ready; two per thread, and at least two batches, unless given.
    /// drop_last: leaves out a last batch that is not full.
    #[pyo3(signature = (batch_size=None, *, shuffle=false, threads=None, prefetch=None, drop_last=false))]
    fn loader(
        &self,
        batch_size: Option<usize>,
        shuffle: bool,
        threads: Option<usize>,
        prefetch: Option<usize>,
        drop_last: bool,
    ) -> PyResult<Loader> {
        Loader::new(self.samples.clone(), self.epoch(), batch_size, shuffle, threads, prefetch, drop_last)
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let named = self.arguments.options.bind(py).copy()?;
        named.set_item("crop_place", self.arguments.crop_place.clone())?;
        named.set_item("camera_table", &self.arguments.camera_table)?;
        named.set_item("epoch", self.epoch())?;
        Ok((PyTuple::new(py, [&self.root])?, named))
    }

    fn _repr_html_<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        this.py().import("enfilade._display")?.call_method1("dataset_html", (this, &this.get().root))
    }

    fn __repr__(&self) -> String {
        let layers = self.layers().join(", ");
        format!("<enfilade.Dataset {:?}: {} samples of {layers}>", self.arguments.path, self.samples.len())
    }
}

//! `enfilade.Dataset`: frames of a dataset of ours or of Hypersim's release, as dictionaries of numpy arrays.

use crate::arguments::{CropPosition, Names, layers, split};
use crate::errors::IntoPy;
use crate::loader::Loader;
use crate::map_style::{MapStyle, SampleIterator, item, items, layer_names};
use enfilade_dataset::{Layout, read_pairs};
use enfilade_loader::{Choice, Crop, LoaderError, Options, Sample, Samples};
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
/// layers: names; all that the first frame has, unless given. Frames that lack one are left out.
/// scenes, cameras: names, in which `*` stands for any run of characters. A camera is a trajectory.
/// split: "train", "val" or "test", by the dataset's metadata_images_split_scene_v1.csv.
/// crop: height and width; only the chunks of the file that it touches are decoded.
/// crop_place: "center", "random" (by seed, epoch and index), or row and column of its first pixel.
/// resize: height and width; light and colours are averaged over areas, of other layers the nearest value is taken.
/// tone_map: makes `color` uint8 by Hypersim's tone map (the image's 90th percentile at 0.8, gamma 1/2.2).
/// mask, poses: whether to give `mask`, and `K` and `world_from_camera`.
/// stored: gives layers exactly as their files have them: type, unit and all.
/// seed, epoch: of random crops.
/// camera_table: another metadata_camera_parameters.csv.
#[pyclass(module = "enfilade", subclass, frozen)]
pub struct Dataset {
    samples: Arc<Samples>,
    epoch: AtomicU64,
    /// Absolute, as its table of cameras is: the current folder may change.
    root: PathBuf,
    arguments: Arguments,
}

/// What it was made with, so that pickling can make it again in another process.
#[derive(Clone, IntoPyObject)]
struct Arguments {
    layers: Option<Names>,
    scenes: Option<Names>,
    cameras: Option<Names>,
    split: Option<String>,
    crop: Option<(usize, usize)>,
    crop_place: CropPosition,
    resize: Option<(usize, usize)>,
    tone_map: bool,
    mask: bool,
    poses: bool,
    stored: bool,
    seed: u64,
    camera_table: Option<PathBuf>,
    path: PathBuf,
}

impl Arguments {
    fn options(&self) -> PyResult<Options> {
        let place = self.crop_place.crop_place()?;
        Ok(Options {
            crop: self.crop.map(|(height, width)| Crop { size: [height, width], place }),
            resize: self.resize.map(|(height, width)| [height, width]),
            tone_map: self.tone_map,
            mask: self.mask,
            cameras: self.poses,
            stored: self.stored,
            seed: self.seed,
        })
    }

    /// `root` is the absolute path of the dataset.
    fn open(&self, py: Python<'_>, root: &Path) -> PyResult<Samples> {
        let (options, layers, split) = (self.options()?, layers(self.layers.as_ref())?, split(self.split.as_deref())?);
        py.detach(|| {
            let dataset = enfilade_dataset::Dataset::open(root).map_err(IntoPy::into_py)?;
            let dataset = match &self.camera_table {
                Some(table) => dataset.with_camera_table(table),
                None => dataset,
            };
            let select = |what, names: &[String], pattern: Option<&Names>| {
                let chosen = pattern.map(|pattern| enfilade_pipeline::select(what, names, Some(&pattern.pattern())));
                chosen.transpose().map_err(IntoPy::into_py)
            };
            let scenes = dataset.scenes().map_err(IntoPy::into_py)?;
            let scenes = select("scene", &scenes, self.scenes.as_ref())?.unwrap_or(scenes);
            let cameras = match &self.cameras {
                None => None,
                pattern => select("camera", &dataset.camera_names(&scenes).map_err(IntoPy::into_py)?, pattern.as_ref())?,
            };
            Samples::open(dataset, &Choice { layers, scenes: Some(scenes), cameras, side: split }, options).map_err(IntoPy::into_py)
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
    #[pyo3(signature = (path, *, layers=None, scenes=None, cameras=None, split=None, crop=None, crop_place=CropPosition::Named("center".into()),
        resize=None, tone_map=false, mask=true, poses=true, stored=false, seed=0, epoch=0, camera_table=None))]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        layers: Option<Names>,
        scenes: Option<Names>,
        cameras: Option<Names>,
        split: Option<String>,
        crop: Option<(usize, usize)>,
        crop_place: CropPosition,
        resize: Option<(usize, usize)>,
        tone_map: bool,
        mask: bool,
        poses: bool,
        stored: bool,
        seed: u64,
        epoch: u64,
        camera_table: Option<PathBuf>,
    ) -> PyResult<Self> {
        let (root, camera_table) = (std::path::absolute(&path)?, camera_table.map(std::path::absolute).transpose()?);
        let arguments =
            Arguments { layers, scenes, cameras, split, crop, crop_place, resize, tone_map, mask, poses, stored, seed, camera_table, path };
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
        let named = self.arguments.clone().into_pyobject(py)?;
        named.del_item("path")?;
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

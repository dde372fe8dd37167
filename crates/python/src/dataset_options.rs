//! The options of `enfilade.Dataset`.

use crate::arguments::layer;
use enfilade_dataset::Side as DatasetSide;
use enfilade_frame::Layer;
use enfilade_loader::{Crop, CropPlace, Options};
use enfilade_options::{options, words};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

options! {
    /// Which frames and layers `enfilade.Dataset` has, and what is done to each sample.
    pub struct DatasetOptions {
        /// Names of layers; all that the first frame has, unless given. Frames that lack one are left out.
        pub layers: Option<Vec<String>> = None,
        /// Names of scenes, in which `*` stands for any run of characters.
        pub scenes: Option<Vec<String>> = None,
        /// Names of cameras, in which `*` stands for any run of characters. A camera is a trajectory.
        pub cameras: Option<Vec<String>> = None,
        /// "train", "val" or "test", by the dataset's metadata_images_split_scene_v1.csv.
        pub split: Option<Side> = None,
        /// Height and width of the part of the image that is given; only the chunks of the file that it touches are decoded.
        pub crop: Option<[u32; 2]> = None,
        /// Height and width of the result; light and colours are averaged over areas, of other layers the nearest value is taken.
        pub resize: Option<[u32; 2]> = None,
        /// Makes `color` uint8 by Hypersim's tone map (the image's 90th percentile at 0.8, gamma 1/2.2).
        pub tone_map: bool = false,
        /// Whether to give `mask`.
        pub mask: bool = true,
        /// Whether to give `K` and `world_from_camera`.
        pub poses: bool = true,
        /// Gives layers exactly as their files have them: type, unit and all.
        pub stored: bool = false,
        /// Seed of the places of random crops.
        pub seed: u64 = 0,
    }
}

words! {
    /// A side of the dataset's division.
    #[derive(Clone, Copy)]
    pub enum Side {
        /// Scenes that models learn from.
        Train = "train",
        /// Scenes that training is steered by.
        Val = "val",
        /// Scenes that models are judged by.
        Test = "test",
    }
}

impl DatasetOptions {
    /// Options of the loader, which define how each sample is processed; crops are at `place`.
    pub fn of_samples(&self, place: CropPlace) -> Options {
        let pixels = |size: [u32; 2]| size.map(|side| side as usize);
        Options {
            crop: self.crop.map(|size| Crop { size: pixels(size), place }),
            resize: self.resize.map(pixels),
            tone_map: self.tone_map,
            mask: self.mask,
            cameras: self.poses,
            stored: self.stored,
            seed: self.seed,
        }
    }

    /// The layers of these names.
    pub fn layers(&self) -> PyResult<Option<Vec<Layer>>> {
        self.layers.as_ref().map(|names| names.iter().map(|name| layer(name)).collect()).transpose()
    }

    /// The requested side.
    pub fn side(&self) -> PyResult<Option<DatasetSide>> {
        self.split.map(|side| side.name().parse().map_err(|problem| PyValueError::new_err(format!("split: {problem}")))).transpose()
    }
}

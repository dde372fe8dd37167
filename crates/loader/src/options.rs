//! The options of users: which frames and layers, and how each sample is processed.

use enfilade_dataset::Side;
use enfilade_frame::Layer;

/// Which frames and layers. `None` is all.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Layers of each sample; frames that lack one are left out. `None` takes the layers of the first frame.
    pub layers: Option<Vec<Layer>>,
    /// Names of scenes.
    pub scenes: Option<Vec<String>>,
    /// Names of cameras, which are the names of trajectories.
    pub cameras: Option<Vec<String>>,
    /// A side of the dataset's partition.
    pub side: Option<Side>,
}

/// How a sample is processed.
///
/// ```
/// use enfilade_loader::Options;
/// let options = Options { resize: Some([192, 256]), tone_map: true, ..Options::default() };
/// assert!(options.crop.is_none() && options.mask && options.cameras && !options.stored);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// A rectangle of the image instead of the whole.
    pub crop: Option<Crop>,
    /// Height and width of the result. Light, reflectance and colours are averaged over the area of a pixel; of all other layers the
    /// value nearest to its centre is taken.
    pub resize: Option<[usize; 2]>,
    /// Makes `color` 8-bit sRGB-like by Hypersim's tone map, with the exposure of the whole image.
    pub tone_map: bool,
    /// Gives a mask of the pixels where all layers have a value.
    pub mask: bool,
    /// Gives K and the pose.
    pub cameras: bool,
    /// Gives layers exactly as in their files, instead of in metres and single precision where the table of layers specifies it.
    pub stored: bool,
    /// Seed of the places of random crops.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { crop: None, resize: None, tone_map: false, mask: true, cameras: true, stored: false, seed: 0 }
    }
}

/// A rectangle of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Height and width, pixels.
    pub size: [usize; 2],
    /// Position in the image.
    pub place: CropPlace,
}

/// Position of a crop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CropPlace {
    /// In the middle.
    Center,
    /// Anywhere, by seed, epoch and index.
    Random,
    /// With this first row and column.
    At([usize; 2]),
}

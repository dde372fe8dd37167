//! The reference of a frame's checks: its camera, its labels, how its values were stored.

use crate::rounding::Rounding;
use enfilade_scene::{CameraView, Labels, PartLabel};

/// The reference of a frame's checks.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The frame's camera and pose.
    pub camera: CameraView<'a>,
    /// How its distances and positions, which are in metres, were rounded when they were stored.
    pub rounding: Rounding,
    /// True where the colour layers are denoised. The rendered versions, to which noise and the parts of light belong, have separate layers
    /// then.
    pub denoised: bool,
    /// True for frames of Hypersim's release, which has fewer layers.
    pub released: bool,
    /// Number of render entities.
    pub entities: usize,
    /// Labels by render entity (`parts[i]` is entity i + 1), where the scene has label tables.
    pub labels: Option<&'a Labels>,
    /// Labels of the other pieces of parts that people split, by render entity; empty where nothing was split.
    pub pieces: &'a [(u32, PartLabel)],
    /// The greatest class of the scene's list: 40 of NYU40.
    pub last_class: i16,
}

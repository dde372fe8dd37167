//! Many views of one scene: which frames see the same surfaces.
//!
//! Everything is a pure function of the frames that are stored and, where it is there, of the scene package that they were rendered from.
//! Frames of all cameras of a scene stand side by side, whatever their cameras are: points go from one to the other by
//! [`CameraView`](enfilade_scene::CameraView). The same input gives the same bytes on any number of threads.
//!
//! [`covisibility`] measures, and [`choose_pairs`] picks what is worth training on.

mod covisibility;
mod error;
mod filmed;
mod package;
mod pairs;
mod surroundings;

pub use covisibility::{CovisibilityConfig, covisibility};
pub use error::MultiviewError;
pub use filmed::Filmed;
pub use package::ScenePackage;
pub use pairs::{PairFilter, choose_pairs};

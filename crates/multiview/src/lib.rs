//! Many views of one scene: which frames see the same surfaces, and where the points of one are in the others.
//!
//! Everything is a pure function of the stored frames and, if it exists, of the scene package that they were rendered from. Frames of all
//! cameras of a scene are treated alike, regardless of the camera model: points are transferred between them by
//! [`CameraView`](enfilade_scene::CameraView). The same input gives the same bytes on any number of threads.
//!
//! [`covisibility`] measures, and [`choose_pairs`] picks what is worth training on; [`write_flow`] leads from any frame to any
//! other, and [`tracks`] follows points through all frames of a camera.

mod covisibility;
mod error;
mod filmed;
mod flow;
mod package;
mod pairs;
mod surfaces;
mod surroundings;
mod tracks;

pub use covisibility::{CovisibilityConfig, covisibility};
pub use error::MultiviewError;
pub use filmed::Filmed;
pub use flow::write_flow;
pub use package::ScenePackage;
pub use pairs::{PairFilter, choose_pairs};
pub use surfaces::write_surfaces;
pub use tracks::{TracksConfig, tracks};

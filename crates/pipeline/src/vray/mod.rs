//! V-Ray in place of our own renderer: scenes of a dataset's cameras for it, job files that render them, and its images as frames.
//!
//! The scene is edited by `enfilade-vrscene`; what needs a dataset, a picture or a look at several files is here. [`write_job`] makes
//! the scenes of the three passes and the commands that render them, [`collect`] reads what they made. What V-Ray writes is in its own
//! units ([`enfilade_vrscene::edit::meters_per_asset_unit`]); what a dataset gets is in the dataset's.

mod camera;
mod collect;
mod color;
mod entities;
mod exr_file;
mod files;
mod geometry;
mod header;
mod job;
mod job_file;
mod lens;
mod notes;
mod rays;
mod script;
mod steps;
#[cfg(test)]
mod testing;

pub use camera::{CameraWish, FilmedCamera, filmed_camera};
pub use collect::{CollectConfig, Collected, collect};
pub use exr_file::VrayImage;
pub use files::{Asset, inline_scene, read_scene, scene_assets};
pub use job::{JobConfig, write_job};
pub use job_file::{Job, JobCamera, JobStep, read_job};
pub use lens::LensPicture;

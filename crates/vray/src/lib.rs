//! V-Ray in place of the built-in renderer: edits of its scenes, jobs that render a dataset's cameras, and its images as frames.
//!
//! [`edit`] changes a scene in memory, as Hypersim's toolkit does; `enfilade-vrscene` reads and writes the format. [`write_job`] makes the
//! scenes of the three passes and the commands that render them, [`collect`] reads the resulting images. V-Ray's files are in its own units
//! ([`edit::meters_per_asset_unit`]); a dataset's files are in the dataset's. [`verbs`] is `enfilade vray`, which the command line
//! includes.

mod camera;
mod collect;
mod color;
pub mod edit;
mod entities;
mod error;
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
pub mod verbs;

pub use camera::{CameraWish, FilmedCamera, filmed_camera};
pub use collect::{CollectConfig, Collected, collect};
pub use error::VrayError;
pub use exr_file::VrayImage;
pub use files::{Asset, inline_scene, read_scene, scene_assets};
pub use job::{JobConfig, write_job};
pub use job_file::{Job, JobCamera, JobStep, read_job};
pub use lens::LensPicture;

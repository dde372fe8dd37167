//! V-Ray in place of our own renderer: edits of its scenes, jobs that render a dataset's cameras, and its images as frames.
//!
//! [`edit`] changes a scene in memory, as Hypersim's toolkit does; the format is that of `enfilade-vrscene`. [`write_job`] makes the scenes
//! of the three passes and the commands that render them, [`collect`] reads what they made. What V-Ray writes is in its own units
//! ([`edit::meters_per_asset_unit`]); what a dataset gets is in the dataset's. [`verbs`] is `enfilade vray`, which the command line
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

//! `job.json`: a job for V-Ray as programs read it, with every command that renders it.

use crate::error::VrayError;
use crate::files::Asset;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Name of the job's format.
pub(crate) const FORMAT: &str = "enfilade V-Ray job 1";

/// A job, as `job.json` has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Job {
    /// `enfilade V-Ray job 1`.
    pub format: String,
    /// Name of the scene in the dataset.
    pub scene: String,
    /// Metres per unit of V-Ray's scene.
    pub meters_per_unit: f64,
    /// Absolute path of the job's folder on the machine that renders.
    pub folder: String,
    /// Table of the scene's nodes in the folder.
    pub nodes: String,
    /// The cameras in order.
    pub cameras: Vec<JobCamera>,
    /// Files that the scenes need, by their paths on the machine that renders.
    pub assets: Vec<Asset>,
    /// Included scenes that were not there to be looked at; they may need more files.
    pub unseen_includes: Vec<String>,
}

/// A camera of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JobCamera {
    /// Name of the camera in the dataset.
    pub camera: String,
    /// Horizontal field of view in degrees that was requested in place of the dataset's camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fov_x_deg: Option<f64>,
    /// Width and height in pixels that were requested in place of the dataset's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[u32; 2]>,
    /// Grid of rays that was requested in place of the dataset's camera, by its path when the job was written.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rays: Option<PathBuf>,
    /// The frames that are rendered.
    pub frames: Vec<u32>,
    /// Folder of the images of the geometry pass, relative to the job's.
    pub geometry: String,
    /// Folder of the images of the final pass, relative to the job's.
    #[serde(rename = "final")]
    pub beauty: String,
    /// The steps, in this order. Steps of one name may be divided by frames over several machines; the next step needs all of them.
    pub steps: Vec<JobStep>,
}

/// A command.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JobStep {
    /// `geometry`, `pre`, `merge light cache`, `merge irradiance map`, `final` or `convert`.
    pub step: String,
    /// Folders that must exist.
    pub folders: Vec<String>,
    /// The program, `vray`, `imapviewer` or `vrimg2exr`, and its arguments.
    pub command: Vec<String>,
    /// The further argument that selects the frames; absent if the command is for all frames at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frames: Option<String>,
}

/// Reads a `job.json`.
///
/// # Errors
/// When it cannot be read, or is none of this version.
pub fn read_job(path: &Path) -> Result<Job, VrayError> {
    let hint = "name the job.json that `enfilade vray jobs` wrote";
    let text = std::fs::read(path).map_err(|e| VrayError::usage(format!("cannot read {}: {e}", path.display()), hint))?;
    let job: Job = serde_json::from_slice(&text).map_err(|e| VrayError::usage(format!("{}: it is no job: {e}", path.display()), hint))?;
    if job.format != FORMAT {
        let message = format!("{}: its format is {:?}, and this version reads {FORMAT:?}", path.display(), job.format);
        return Err(VrayError::usage(message, "write the job again with this version"));
    }
    Ok(job)
}

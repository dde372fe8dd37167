//! Jobs for V-Ray: the scenes of the three passes of every camera, and the commands that render them.
//!
//! ```text
//! FOLDER/job.json                                  everything below for programs: steps, frames, files that the scenes need
//! FOLDER/render.sh or render.bat                   the steps in order, for one machine
//! FOLDER/vrscenes/scene_CAMERA_{geometry,pre,final}.vrscene
//! FOLDER/shared/scene_CAMERA/                      lens distortion here; indirect light of every frame and of all, when rendered
//! FOLDER/images/scene_CAMERA_{geometry,pre,final}/ V-Ray's images, when rendered
//! FOLDER/metadata_nodes.csv                        what the numbers in the images are
//! ```
//!
//! The names are Hypersim's. Paths within the scenes and commands are those of the machine that renders, where the folder is copied to.

use super::camera::{CameraWish, check_described, filmed_camera};
use super::files::{damaged, scene_assets};
use super::job_file::{FORMAT, Job, JobCamera};
use super::script;
use super::steps::{Place, steps};
use crate::error::Error;
use enfilade_dataset::{Dataset, check_name, write_bytes, write_json};
use enfilade_scene::{Cx, Warning};
use enfilade_vrscene::Document;
use enfilade_vrscene::edit::{GiCaches, LensTexture, Pass, make_pass, meters_per_asset_unit, set_camera};
use std::path::{Path, PathBuf};

/// Names of a job's files.
const JOB: &str = "job.json";
const NODES: &str = "metadata_nodes.csv";

/// What is to be rendered, and where.
#[derive(Clone, Debug)]
pub struct JobConfig {
    /// Name of the scene in the dataset.
    pub scene: String,
    /// Cameras of the dataset; empty for all.
    pub cameras: Vec<String>,
    /// The camera that is rendered, where it is not the dataset's own.
    pub wish: CameraWish,
    /// The job's folder on the machine that renders.
    pub folder_when_rendering: String,
    /// Table of the scene's nodes, as `metadata_nodes.csv`.
    pub nodes: PathBuf,
}

/// Writes a job into `folder`, for the scene in the file `path`, which has render elements and numbered nodes.
///
/// # Errors
/// When the scene has no render elements, the dataset no such camera, or a file cannot be read or written.
pub fn write_job(scene: &Document, path: &Path, dataset: &Dataset, config: &JobConfig, folder: &Path, cx: &dyn Cx) -> Result<Job, Error> {
    check_layers(scene, path)?;
    let meters_per_unit = meters_per_asset_unit(scene).map_err(|error| damaged(path, &error))?.unwrap_or(1.0);
    let names = if config.cameras.is_empty() { dataset.cameras(&config.scene).map_err(Error::stage)? } else { config.cameras.clone() };
    if names.is_empty() {
        return Err(Error::usage(format!("the scene {} of the dataset has no camera", config.scene), "plan one: enfilade plan"));
    }
    names.iter().try_for_each(|name| check_name("camera name", name)).map_err(Error::stage)?;
    let there = Place::new(&config.folder_when_rendering)?;
    let nodes = std::fs::read(&config.nodes).map_err(|e| {
        let message = format!("cannot read the table of nodes {}: {e}", config.nodes.display());
        Error::usage(message, "write it with the scene: enfilade vray entities --nodes FILE")
    })?;
    let (assets, unseen_includes) = scene_assets(scene, path)?;
    for include in &unseen_includes {
        let message = format!("the included file {include:?} is not on this machine; what it needs is not listed, and no edit reached it");
        cx.warn(Warning { place: path.display().to_string(), message });
    }
    let mut job = Job {
        format: FORMAT.into(),
        scene: config.scene.clone(),
        meters_per_unit,
        folder: there.folder.clone(),
        nodes: NODES.into(),
        cameras: Vec::new(),
        assets,
        unseen_includes,
    };
    for (done, name) in names.iter().enumerate() {
        cx.progress("cameras", done as u64, names.len() as u64);
        job.cameras.push(write_camera(scene, dataset, config, name, meters_per_unit, &there, folder, cx)?);
    }
    put(folder, NODES, &nodes)?;
    put(folder, there.script(), script::write(&job, there.platform).as_bytes())?;
    write_json(&folder.join(JOB), &job)?;
    Ok(job)
}

/// The scene must have the elements that the frames are made of; else days of rendering are for nothing.
fn check_layers(scene: &Document, path: &Path) -> Result<(), Error> {
    let has = |kind: &str| scene.of_kind(kind).next().is_some();
    let missing: Vec<&str> =
        ["RenderChannelExtraTex", "RenderChannelNodeID", "RenderChannelColor"].into_iter().filter(|kind| !has(kind)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let hint = "add the render elements first: enfilade vray layers; of a scene with included files: enfilade vray inline before that";
    Err(Error::usage(format!("{}: the scene has no {}", path.display(), missing.join(", ")), hint))
}

fn write_camera(
    scene: &Document,
    dataset: &Dataset,
    config: &JobConfig,
    name: &str,
    meters_per_unit: f64,
    there: &Place,
    folder: &Path,
    cx: &dyn Cx,
) -> Result<JobCamera, Error> {
    check_described(dataset, &config.scene, name, &config.wish)?;
    let mut filmed = filmed_camera(dataset, &config.scene, name, meters_per_unit, &config.wish)?;
    for what in &filmed.left_out {
        cx.warn(Warning { place: name.into(), message: format!("left out: {what}") });
    }
    let shared = format!("shared/scene_{name}");
    if let Some(lens) = &filmed.lens {
        let file = format!("{shared}/_hypersim_camera_lens_distortion.exr");
        put(folder, &file, &lens.to_exr())?;
        filmed.path.lens = Some(LensTexture { file: there.path(&file), size: lens.size });
    }
    let mut of_camera = scene.clone();
    set_camera(&mut of_camera, &filmed.path);
    let caches = |between: &str| GiCaches {
        light_cache: there.path(&format!("{shared}/_hypersim_light_cache{between}.vrlmap")),
        irradiance_map: there.path(&format!("{shared}/_hypersim_irradiance_map{between}.vrmap")),
    };
    let passes = [(Pass::Geometry, "geometry", caches("")), (Pass::Pre, "pre", caches(".%04d")), (Pass::Final, "final", caches(""))];
    for (pass, called, caches) in passes {
        let mut of_pass = of_camera.clone();
        make_pass(&mut of_pass, pass, &caches);
        put(folder, &format!("vrscenes/scene_{name}_{called}.vrscene"), &of_pass.to_bytes())?;
    }
    let rejected = dataset.rejected_views(&config.scene, name).map_err(Error::stage)?;
    let frames = filmed.path.keyframes.iter().filter_map(|key| u32::try_from(key.frame).ok());
    let frames: Vec<u32> = frames.filter(|frame| !rejected.contains_key(frame)).collect();
    if frames.is_empty() {
        return Err(Error::usage(format!("no frame of {name} is worth rendering"), "see why: enfilade gate, or name other cameras"));
    }
    Ok(JobCamera {
        camera: name.into(),
        fov_x_deg: config.wish.fov_x_deg,
        size: config.wish.size,
        rays: config.wish.rays.clone(),
        geometry: format!("images/scene_{name}_geometry"),
        beauty: format!("images/scene_{name}_final"),
        steps: steps(name, &shared, &frames, there),
        frames,
    })
}

/// Writes a file of the job.
fn put(folder: &Path, inside: &str, bytes: &[u8]) -> Result<(), Error> {
    Ok(write_bytes(&folder.join(inside), bytes)?)
}

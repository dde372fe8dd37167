//! Jobs for V-Ray: the scenes of the three passes of every camera, and the commands that render them.
//!
//! ```text
//! FOLDER/job.json                                  everything below for programs: steps, frames, files that the scenes need
//! FOLDER/render.sh or render.bat                   the steps in order, for one machine
//! FOLDER/vrscenes/scene_CAMERA_{geometry,pre,final}.vrscene; no `pre` where indirect light is not kept in files
//! FOLDER/shared/scene_CAMERA/                      lens distortion here; indirect light of every frame and of all, when rendered
//! FOLDER/images/scene_CAMERA_{geometry,pre,final}/ V-Ray's images, when rendered
//! FOLDER/metadata_nodes.csv                        what the numbers in the images are
//! ```
//!
//! The names are Hypersim's, and so are sampling and indirect light, unless the scene's own are kept. Paths within the scenes and
//! commands are for the machine that renders, to which the folder is copied.

use crate::camera::{CameraWish, check_described, filmed_camera};
use crate::edit::{GiCaches, GiFiles, LensTexture, Pass, gi_files, hypersim_quality, make_pass, meters_per_asset_unit, set_camera};
use crate::error::VrayError;
use crate::files::{damaged, scene_assets};
use crate::job_file::{FORMAT, Job, JobCamera};
use crate::script;
use crate::steps::{Place, steps};
use enfilade_dataset::{Dataset, check_name, write_bytes, write_json};
use enfilade_scene::{Cx, Warning};
use enfilade_vrscene::{Document, SceneTextError};
use std::path::{Path, PathBuf};

/// Names of a job's files.
const JOB: &str = "job.json";
const NODES: &str = "metadata_nodes.csv";

/// The cameras to render, and where.
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
    /// Keeps the scene's own settings of sampling and indirect light; otherwise it gets Hypersim's ([`hypersim_quality`]), so that the
    /// pictures of all scenes have the same quality.
    pub keep_quality: bool,
}

/// Data that the cameras of a job share.
struct Common<'a> {
    scene: &'a Document,
    /// Files of indirect light that the scene makes.
    gi: GiFiles,
    meters_per_unit: f64,
    dataset: &'a Dataset,
    config: &'a JobConfig,
    there: &'a Place,
    folder: &'a Path,
}

/// Writes a job into `folder`, for the scene in the file `path`, which has render elements and numbered nodes.
///
/// # Errors
/// When the scene has no render elements, the dataset no such camera, or a file cannot be read or written.
pub fn write_job(
    scene: &Document,
    path: &Path,
    dataset: &Dataset,
    config: &JobConfig,
    folder: &Path,
    cx: &dyn Cx,
) -> Result<Job, VrayError> {
    check_layers(scene, path)?;
    let meters_per_unit = meters_per_asset_unit(scene).map_err(|error| damaged(path, &error))?.unwrap_or(1.0);
    let names = if config.cameras.is_empty() { dataset.cameras(&config.scene)? } else { config.cameras.clone() };
    if names.is_empty() {
        return Err(VrayError::usage(
            format!("the scene {} of the dataset has no camera", config.scene),
            "plan one: enfilade run OUT --only plan",
        ));
    }
    names.iter().try_for_each(|name| check_name("camera name", name))?;
    let there = Place::new(&config.folder_when_rendering)?;
    let nodes = std::fs::read(&config.nodes).map_err(|e| {
        let message = format!("cannot read the table of nodes {}: {e}", config.nodes.display());
        VrayError::usage(message, "write it with the scene: enfilade vray entities --nodes FILE")
    })?;
    let (assets, unseen_includes) = scene_assets(scene, path)?;
    warn_of_includes(scene, path, &unseen_includes, cx);
    let scene = with_quality(scene.clone(), config.keep_quality);
    let gi = gi_of(&scene).map_err(|error| damaged(path, &error))?;
    let common = Common { scene: &scene, gi, meters_per_unit, dataset, config, there: &there, folder };
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
        job.cameras.push(write_camera(&common, name, cx)?);
    }
    put(folder, NODES, &nodes)?;
    put(folder, there.script(), script::write(&job, there.platform).as_bytes())?;
    write_json(&folder.join(JOB), &job)?;
    Ok(job)
}

/// The scene must have the elements that the frames are made of; else days of rendering are for nothing.
fn check_layers(scene: &Document, path: &Path) -> Result<(), VrayError> {
    let has = |kind: &str| scene.of_kind(kind).next().is_some();
    let missing: Vec<&str> =
        ["RenderChannelExtraTex", "RenderChannelNodeID", "RenderChannelColor"].into_iter().filter(|kind| !has(kind)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let hint = "add the render elements first: enfilade vray layers; of a scene with included files: enfilade vray inline before that";
    Err(VrayError::usage(format!("{}: the scene has no {}", path.display(), missing.join(", ")), hint))
}

/// Included files stay as they are, which matters where they have settings.
fn warn_of_includes(scene: &Document, path: &Path, unseen: &[String], cx: &dyn Cx) {
    let warn = |message: String| cx.warn(Warning { place: path.display().to_string(), message });
    for include in unseen {
        warn(format!("the included file {include:?} is not on this machine; what it needs is not listed, and no edit reached it"));
    }
    let seen = scene.includes().filter(|include| unseen.iter().all(|path| path.as_bytes() != include.path())).count();
    if seen > 0 {
        warn(format!("{seen} included files stay as they are, and so do settings and cameras in them; to edit all: enfilade vray inline"));
    }
}

/// The scene with its own quality, or with Hypersim's.
fn with_quality(mut scene: Document, keep_quality: bool) -> Document {
    if !keep_quality {
        hypersim_quality(&mut scene);
    }
    scene
}

/// Files of indirect light that a scene makes; all if the setting may be in an included file.
fn gi_of(scene: &Document) -> Result<GiFiles, SceneTextError> {
    match (scene.of_kind("SettingsGI").next(), scene.includes().next()) {
        (None, Some(_)) => Ok(GiFiles { light_cache: true, irradiance_map: true }),
        _ => gi_files(scene),
    }
}

fn write_camera(common: &Common, name: &str, cx: &dyn Cx) -> Result<JobCamera, VrayError> {
    let &Common { scene, gi, meters_per_unit, dataset, config, there, folder } = common;
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
    let mut passes = vec![(Pass::Geometry, "geometry", caches("")), (Pass::Final, "final", caches(""))];
    if gi.light_cache || gi.irradiance_map {
        passes.push((Pass::Pre, "pre", caches(".%04d")));
    }
    for (pass, called, caches) in passes {
        let mut of_pass = of_camera.clone();
        make_pass(&mut of_pass, pass, &caches);
        put(folder, &format!("vrscenes/scene_{name}_{called}.vrscene"), &of_pass.to_bytes())?;
    }
    let rejected = dataset.rejected_views(&config.scene, name)?;
    let frames = filmed.path.keyframes.iter().filter_map(|key| u32::try_from(key.frame).ok());
    let frames: Vec<u32> = frames.filter(|frame| !rejected.contains_key(frame)).collect();
    if frames.is_empty() {
        return Err(VrayError::usage(
            format!("no frame of {name} is worth rendering"),
            "see why: enfilade run OUT --only gate, or name other cameras",
        ));
    }
    Ok(JobCamera {
        camera: name.into(),
        fov_x_deg: config.wish.fov_x_deg,
        size: config.wish.size,
        rays: config.wish.rays.clone(),
        geometry: format!("images/scene_{name}_geometry"),
        beauty: format!("images/scene_{name}_final"),
        steps: steps(name, &shared, &frames, gi, there),
        frames,
    })
}

/// Writes a file of the job.
fn put(folder: &Path, inside: &str, bytes: &[u8]) -> Result<(), VrayError> {
    Ok(write_bytes(&folder.join(inside), bytes)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{add_color_channels, add_geometry_channels};
    use crate::testing::dataset_of;
    use enfilade_scene::{Camera, Intrinsics, Quiet};

    /// Settings of a scene in use: brute force, a coarse sampler, a dark window, and blur of both kinds.
    const SETTINGS: &str = "SettingsImageSampler is { type=1; dmc_threshold=0.3; }\n\
        SettingsGI gi { on=1; primary_engine=2; secondary_engine=3; }\n\
        SettingsEnvironment env { gi_color=Color(0.5, 0.5, 0.5); }\n\
        SettingsMotionBlur mb { on=1; duration=0.5; }\nSettingsCameraDof dof { on=1; aperture=5; }\n";

    /// The scenes of the job's passes, by name, and its steps.
    fn job(settings: &str, keep_quality: bool) -> (impl Fn(&str) -> Option<String>, Vec<String>) {
        let folder = tempfile::tempdir().unwrap();
        let camera = Camera::from(Intrinsics::from_fov_x(64, 48, 1.0));
        let dataset = dataset_of(&folder.path().join("data"), &camera);
        std::fs::write(folder.path().join("nodes.csv"), "node_id,node_name,object_id,object_name\n").unwrap();
        let mut scene = Document::parse(settings.as_bytes()).unwrap();
        add_geometry_channels(&mut scene);
        add_color_channels(&mut scene);
        let config = JobConfig {
            scene: "room".into(),
            cameras: Vec::new(),
            wish: CameraWish::default(),
            folder_when_rendering: "/mnt/job".into(),
            nodes: folder.path().join("nodes.csv"),
            keep_quality,
        };
        let to = folder.path().join("job");
        let job = write_job(&scene, Path::new("room.vrscene"), &dataset, &config, &to, &Quiet).unwrap();
        let steps = job.cameras[0].steps.iter().map(|step| step.step.clone()).collect();
        let pass = move |pass: &str| {
            let _kept = &folder;
            std::fs::read_to_string(to.join(format!("vrscenes/scene_cam_00_{pass}.vrscene"))).ok()
        };
        (pass, steps)
    }

    #[test]
    fn scenes_have_hypersims_quality_and_their_own_light() {
        let (pass, steps) = job(SETTINGS, false);
        let last = pass("final").unwrap();
        for set in ["type=3; dmc_threshold=0.3;\n  min_shade_rate=6;", "on=1; primary_engine=0; secondary_engine=3;", "subdivs_mult=0;"] {
            assert!(last.contains(set), "no {set} in\n{last}");
        }
        assert!(last.contains("SettingsEnvironment env { gi_color=Color(0.5, 0.5, 0.5); }"), "{last}");
        assert_eq!(steps, ["geometry", "pre", "merge light cache", "merge irradiance map", "final", "convert", "convert"]);
        // One sample per pixel where a pass is not for the eye.
        assert!(pass("geometry").unwrap().contains("type=0;") && pass("pre").unwrap().contains("type=0;"));
    }

    #[test]
    fn a_kept_quality_is_the_scenes_and_merges_what_its_engines_make() {
        let (pass, steps) = job(SETTINGS, true);
        let last = pass("final").unwrap();
        let kept = &SETTINGS[..SETTINGS.find("SettingsMotionBlur").unwrap()];
        assert!(last.starts_with(kept), "{last}");
        assert!(!last.contains("progressive_") && !last.contains("SettingsDMCSampler"), "{last}");
        assert_eq!(steps, ["geometry", "pre", "merge light cache", "final", "convert", "convert"]);
        let (pass, steps) = job("SettingsGI gi { on=0; }\n", true);
        assert_eq!(steps, ["geometry", "final", "convert", "convert"]);
        assert!(pass("pre").is_none() && pass("final").is_some());
        // The engines of an included file are unknown.
        let (_, steps) = job("#include \"settings.vrscene\"\n", true);
        assert_eq!(steps.len(), 7);
    }

    #[test]
    fn no_pass_has_motion_blur_or_depth_of_field() {
        for keep_quality in [false, true] {
            let (pass, _) = job(SETTINGS, keep_quality);
            for name in ["geometry", "pre", "final"] {
                let scene = pass(name).unwrap();
                for off in ["SettingsMotionBlur mb { on=0; duration=0.5; }", "SettingsCameraDof dof { on=0; aperture=5; }"] {
                    assert!(scene.contains(off), "no {off} in {name}:\n{scene}");
                }
            }
        }
    }
}

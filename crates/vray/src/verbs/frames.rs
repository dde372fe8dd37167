//! The verbs that connect scenes and datasets: cameras, jobs, and images as frames.

use super::Console;
use super::args::{CollectArgs, JobArgs};
use crate::VrayError;
use crate::edit::{LensTexture, meters_per_asset_unit, set_camera};
use crate::{CameraWish, CollectConfig, FilmedCamera, Job, JobCamera, JobConfig, filmed_camera, read_job, read_scene, write_job};
use enfilade_dataset::{Dataset, quoted, write_bytes};
use enfilade_vrscene::Document;
use std::path::{Path, PathBuf};

/// Metres per unit of a scene, if it states them.
pub fn units(scene: &Document, file: &Path) -> Result<Option<f64>, VrayError> {
    meters_per_asset_unit(scene)
        .map_err(|error| VrayError::usage(format!("{}:{error}", file.display()), "export the scene again, or correct it at this place"))
}

/// Gives the scene a camera of a dataset. `lens` is the file of its picture, here and on the machine that renders.
pub fn set_dataset_camera(
    scene: &mut Document,
    file: &Path,
    dataset: &Path,
    [name, camera]: [&str; 2],
    wish: &CameraWish,
    lens: Option<(&Path, Option<&str>)>,
) -> Result<String, VrayError> {
    let metres = units(scene, file)?.unwrap_or(1.0);
    let FilmedCamera { mut path, lens: picture, left_out } = filmed_camera(&Dataset::open(dataset)?, name, camera, metres, wish)?;
    let mut done = format!("{} keyframes of {camera}", path.keyframes.len());
    if let Some(picture) = picture {
        let Some((file, there)) = lens else {
            return Err(VrayError::usage(
                format!("{camera} is no plain pinhole, so V-Ray needs a picture of its rays"),
                "say where it is written: --lens FILE, and --lens-when-rendering PATH; for a plain pinhole give --fov-deg",
            ));
        };
        write_bytes(file, picture.to_exr())?;
        let here = || std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf()).to_string_lossy().into_owned();
        path.lens = Some(LensTexture { file: there.map_or_else(here, str::to_string), size: picture.size });
        done.push_str(&format!(", and the rays of its lens in {}", file.display()));
    }
    set_camera(scene, &path);
    left_out.iter().for_each(|what| done.push_str(&format!("; left out: {what}")));
    Ok(done)
}

/// `vray jobs`
pub fn jobs(args: &JobArgs, console: &dyn Console) -> Result<(), VrayError> {
    let scene = read_scene(&args.input)?;
    let config = JobConfig {
        scene: args.scene.clone(),
        cameras: args.cameras.clone(),
        wish: args.wish.wish(),
        folder_when_rendering: args.folder.clone(),
        nodes: args.nodes.clone(),
        keep_quality: args.keep_quality,
    };
    let job = {
        let cx = console.begin(&args.scene, "vray jobs");
        write_job(&scene, &args.input, &Dataset::open(&args.dataset)?, &config, &args.output, &*cx)?
    };
    for camera in &job.cameras {
        console.say(&format!("{:8} {} frames in {} steps", camera.camera, camera.frames.len(), camera.steps.len()));
    }
    console.say(&format!(
        "quality  {}",
        if args.keep_quality { "the scene's own" } else { "Hypersim's; --keep-quality keeps the scene's own" }
    ));
    console.say(&format!("files    {} that the scenes need, listed in job.json", job.assets.len()));
    console.say(&format!("render   copy {} to {} and run the script there", args.output.display(), job.folder));
    let (dataset, file) = (quoted(args.dataset.display()), quoted(args.output.join("job.json").display()));
    console.say(&format!("then     enfilade vray collect {dataset} --job {file}"));
    Ok(())
}

/// `vray collect`
pub fn collect(args: &CollectArgs, console: &dyn Console) -> Result<(), VrayError> {
    for config in configs(args)? {
        let collected = {
            let cx = console.begin(&format!("{}/{}", config.scene, config.camera), "vray collect");
            crate::collect(&args.dataset, &config, &*cx)?
        };
        console.say(&format!("{}/{}: {}", config.scene, config.camera, collected.summary()));
    }
    console.say(&format!("then  enfilade label, boxes, preview and verify {}", quoted(args.dataset.display())));
    Ok(())
}

/// Settings for each camera.
fn configs(args: &CollectArgs) -> Result<Vec<CollectConfig>, VrayError> {
    let Some(file) = &args.job else {
        let missing = || VrayError::usage("without a job, scene, folders and units must be named", "see enfilade vray collect --help");
        return Ok(vec![CollectConfig {
            scene: args.scene.clone().ok_or_else(missing)?,
            camera: args.camera.clone().unwrap_or_else(|| "cam_00".into()),
            geometry: args.geometry.clone().ok_or_else(missing)?,
            beauty: args.beauty.clone().ok_or_else(missing)?,
            nodes: args.nodes.clone(),
            meters_per_unit: args.meters_per_unit.ok_or_else(missing)?,
            wish: args.wish.wish(),
            ignore_camera: args.ignore_camera,
            force: args.force,
        }]);
    };
    let job = read_job(file)?;
    let beside = file.parent().map(Path::to_path_buf).unwrap_or_default();
    let named = |camera: &&JobCamera| args.camera.as_ref().is_none_or(|name| *name == camera.camera);
    let configs: Vec<CollectConfig> = job.cameras.iter().filter(named).map(|camera| of_job(args, &job, camera, &beside)).collect();
    if configs.is_empty() {
        let names: Vec<&str> = job.cameras.iter().map(|camera| camera.camera.as_str()).collect();
        return Err(VrayError::usage(format!("{} has no such camera", file.display()), format!("it has {}", names.join(", "))));
    }
    Ok(configs)
}

fn of_job(args: &CollectArgs, job: &Job, camera: &JobCamera, beside: &Path) -> CollectConfig {
    let images = |folder: &str| -> PathBuf {
        match &args.images {
            Some(images) => images.join(folder.strip_prefix("images/").unwrap_or(folder)),
            None => beside.join(folder),
        }
    };
    CollectConfig {
        scene: job.scene.clone(),
        camera: camera.camera.clone(),
        geometry: images(&camera.geometry),
        beauty: images(&camera.beauty),
        nodes: Some(args.nodes.clone().unwrap_or_else(|| beside.join(&job.nodes))),
        meters_per_unit: job.meters_per_unit,
        wish: CameraWish { fov_x_deg: camera.fov_x_deg, size: camera.size, rays: camera.rays.clone() },
        ignore_camera: args.ignore_camera,
        force: args.force,
    }
}

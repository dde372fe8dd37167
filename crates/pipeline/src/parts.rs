//! A dataset made by several machines: the work done once before, by each machine, and once after.
//!
//! [`prepare`] does everything before rendering on one machine. A worker needs only the files that it names: with these in a separate
//! folder, [`render_part`] can make any frames. When all frames are in one folder, [`finish`] makes the rest of the dataset there, byte for
//! byte as one machine would have made it. The caller transfers the files.

use crate::config::Config;
use crate::error::Error;
use crate::estimate::forecast;
use crate::forecast::Forecast;
use crate::report::{Reporter, StageCx, Summary};
use crate::run::{Session, open, store_config};
use crate::stages::{FinishedFrame, Job, PARTIALS, Part, STAGES, Shift, Stage, StageSpec, frame_finisher, kept_part, render_frames};
use crate::workdir::{GATHERED, RUN, Workdir, read_json};
use enfilade_dataset::{Dataset, WORKDIR, write_json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

/// The name under which a scene's label table travels.
const TABLE: &str = "label_table.csv";

/// The files and scenes of a planned dataset that rendering needs.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// In the order of the configuration.
    pub scenes: Vec<PreparedScene>,
    /// Files that belong to no one scene, relative to the dataset's folder.
    pub files: Vec<PathBuf>,
}

/// The data of one scene that rendering needs.
#[derive(Clone, Debug)]
pub struct PreparedScene {
    /// Name of the scene in the dataset.
    pub name: String,
    /// Forecast of its rendering.
    pub forecast: Forecast,
    /// Trajectories with the numbers of the frames that are to be rendered.
    pub trajectories: Vec<(String, Vec<u32>)>,
    /// Files of the scene, relative to the dataset's folder.
    pub files: Vec<PathBuf>,
}

/// Does everything before rendering in the folder `out`, and forecasts the rest.
///
/// # Errors
/// As [`crate::estimate`]. Scenes that fail are left out, and the summary has the reasons.
pub fn prepare(config: &Config, out: &Path, pattern: Option<&str>, reporter: &dyn Reporter) -> Result<(Summary, Prepared), Error> {
    let chosen = config.select(pattern)?;
    let (summary, forecasts) = forecast(config, &chosen, &Workdir::create(out)?, &|job| job.frames_by_trajectory(), reporter)?;
    let (workdir, mut config) = open(out)?;
    carry_tables(&workdir, &mut config)?;
    store_config(&workdir, &config)?;
    let dataset = Dataset::create(out).map_err(Error::stage)?;
    let mut scenes = Vec::new();
    for (name, forecast) in forecasts {
        let Some(scene) = config.scenes.iter().find(|scene| scene.name == name) else { continue };
        let job = Job::new(&config, scene, &dataset, &workdir, false);
        let trajectories = job.frames_by_trajectory()?.into_iter().map(|(name, frames)| (name, frames.into_iter().collect())).collect();
        let folders = [out.join(WORKDIR).join(&name), dataset.layout().scene_dir(&name)];
        let mut files = Vec::new();
        folders.iter().try_for_each(|folder| files_below(folder, out, &mut files))?;
        // A table that several scenes share is stored with the last of them.
        if let Some(labels) = &scene.labels {
            files.push(relative(&config.path(&labels.table)?, out));
        }
        files.sort();
        files.dedup();
        scenes.push(PreparedScene { name, forecast, trajectories, files });
    }
    Ok((summary, Prepared { scenes, files: common_files(out)? }))
}

/// Renders and labels `part` of the dataset in `out`, whose files [`prepare`] has named. `finished` is called for every frame as soon as it
/// is done. `stop` ends the work within a frame; its saved state, see [`kept_frame`], lets another worker continue.
///
/// # Errors
/// [`Error::Interrupted`] when it was stopped, what `finished` answers, and as rendering.
pub fn render_part(
    out: &Path,
    part: &Part,
    stop: &AtomicBool,
    finished: &(dyn Fn(&FinishedFrame) -> Result<(), Error> + Sync),
    reporter: &dyn Reporter,
) -> Result<(), Error> {
    let (workdir, config) = open(out)?;
    let scenes = config.select(None)?;
    let scene = scenes.into_iter().find(|scene| scene.name == part.scene);
    let scene =
        scene.ok_or_else(|| Error::usage(format!("there is no scene {:?} in {}", part.scene, out.display()), "plan the job again"))?;
    let dataset = Dataset::create(out).map_err(Error::stage)?;
    let cx = StageCx::new(&part.scene, Stage::Render, reporter);
    let job = Job::new(&config, scene, &dataset, &workdir, false);
    let finisher = frame_finisher(&job, &cx)?;
    let told = Mutex::new(BTreeSet::new());
    let tell = |camera: &str, frame: u32| {
        told.lock().unwrap_or_else(std::sync::PoisonError::into_inner).insert(frame);
        finished(&finisher.finish(&job, camera, frame)?)
    };
    render_frames(&job.on_shift(&Shift { part, stop, rendered: &tell }), &cx)?;
    // Frames that an earlier attempt on this machine rendered but did not report.
    let told = told.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone();
    part.frames.difference(&told).try_for_each(|&frame| finished(&finisher.finish(&job, &part.camera, frame)?))
}

/// Path of an unfinished frame in the worker's folder `out`: put another worker's file there, and rendering continues from it.
///
/// # Errors
/// When the folder cannot be made.
pub fn kept_frame(out: &Path, scene: &str, camera: &str, frame: u32) -> Result<PathBuf, Error> {
    let folder = out.join(WORKDIR).join(scene).join(PARTIALS);
    std::fs::create_dir_all(&folder).map_err(Error::io("create", &folder))?;
    Ok(folder.join(kept_part(camera, frame)))
}

/// Reserves the folder `out` for the dataset that `job` names, to bring its files and frames there: a new folder, or one reserved for the
/// same job before. No other process works in it while the value lives.
///
/// # Errors
/// If it contains something else, or another process works there.
pub fn gather(out: &Path, job: &str) -> Result<Workdir, Error> {
    let workdir = Workdir::create(out)?;
    let note = workdir.file(GATHERED);
    match read_json::<String>(&note) {
        Some(there) if there == job => {}
        None if !workdir.file(RUN).is_file() => write_json(&note, &job)?,
        _ => {
            let message = format!("{} holds another dataset, or one of another job", out.display());
            return Err(Error::usage(message, "name an empty folder or one that does not exist yet"));
        }
    }
    Ok(workdir)
}

/// Makes the rest of the dataset in `out`, whose frames are all there: what [`crate::run`] does from rendering on.
///
/// # Errors
/// As [`crate::run`].
pub fn finish(out: &Path, reporter: &dyn Reporter) -> Result<Summary, Error> {
    let (workdir, config) = open(out)?;
    let scenes = config.select(None)?;
    let later: Vec<&StageSpec> = STAGES.iter().filter(|spec| spec.stage >= Stage::Render).collect();
    Session::with_products(&config, &workdir)?.run(&scenes, &later, false, reporter)
}

/// Copies the label tables, which are elsewhere, into the work folder.
fn carry_tables(workdir: &Workdir, config: &mut Config) -> Result<(), Error> {
    let mut carried = std::mem::take(&mut config.carried);
    for scene in &config.scenes {
        let Some(labels) = &scene.labels else { continue };
        let (from, to) = (config.path(&labels.table)?, workdir.scene_file(&scene.name, TABLE)?);
        std::fs::copy(&from, &to).map_err(Error::io("copy", &from))?;
        carried.insert(labels.table.clone(), to);
    }
    config.carried = carried;
    Ok(())
}

/// The files of the dataset as a whole, as far as rendering needs them.
fn common_files(out: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = std::fs::read_dir(out).map_err(Error::io("read", out))?;
    let is_table = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|extension| extension == "csv");
    let tables = entries.filter_map(Result::ok).map(|entry| entry.path()).filter(is_table);
    let mut files: Vec<PathBuf> = tables.chain([out.join(WORKDIR).join(RUN)]).map(|path| relative(&path, out)).collect();
    files.sort();
    Ok(files)
}

/// Every file below `folder` but frames in the making.
fn files_below(folder: &Path, out: &Path, files: &mut Vec<PathBuf>) -> Result<(), Error> {
    for entry in std::fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let path = entry.map_err(Error::io("read", folder))?.path();
        match path.is_dir() {
            true if path.file_name().is_some_and(|name| name == PARTIALS) => {}
            true => files_below(&path, out, files)?,
            false => files.push(relative(&path, out)),
        }
    }
    Ok(())
}

fn relative(path: &Path, out: &Path) -> PathBuf {
    path.strip_prefix(out).unwrap_or(path).into()
}

//! `denoise`: denoised companions of the colour layers of finished frames, where they are asked for. What was rendered stays.

use super::{Inputs, Job, Outcome, Record, Stage};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::{counted, remove_if_there};
use enfilade_denoise::{DenoiseError, Denoiser, INPUTS, denoise};
use enfilade_frame::{LAYERS, Pass};
use enfilade_scene::Cx;
use enfilade_show::preview::{PREVIEWS, PreviewSpec};
use std::path::PathBuf;

/// Names the library where the configuration does not.
const VARIABLE: &str = "ENFILADE_OIDN";

pub(super) fn settings(job: &Job) -> Hash {
    Hash::of(&job.scene.denoise)
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    job.frame_records().map(Some)
}

/// Whether every frame has its denoised layers, where they are asked for.
pub(super) fn frames_are_whole(job: &Job) -> bool {
    !job.scene.denoise || job.layers_are_whole(Pass::Denoised)
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let frames = job.frames()?;
    if !job.scene.denoise {
        frames.iter().try_for_each(|(camera, frame)| remove(job, camera, *frame))?;
        return Ok(Outcome { summary: "not asked for".into(), ..Outcome::default() });
    }
    let mut missing = Vec::new();
    for (camera, frame) in &frames {
        let hash = denoise_hash(job, camera, *frame)?;
        if job.force || !job.dataset.denoised_are_complete(&job.scene.name, camera, *frame, &hash) {
            missing.push((camera, *frame, hash));
        }
    }
    let mut summary = counted(missing.len(), "frame");
    if !missing.is_empty() {
        let denoiser = open(job)?;
        for (done, (camera, frame, hash)) in missing.iter().enumerate() {
            denoise_frame(job, camera, *frame, hash, &denoiser)?;
            cx.progress("frames", done as u64 + 1, missing.len() as u64);
        }
        summary = format!("{summary} by {}", denoiser.name());
    }
    if missing.len() < frames.len() {
        summary = format!("{summary}, {} kept", frames.len() - missing.len());
    }
    Ok(Outcome { summary, outputs: outputs(job, &frames), ..Outcome::default() })
}

/// Opens the library where the scene is to be denoised for the first time, and others have not done so.
///
/// # Errors
/// When it cannot be had.
pub(crate) fn check_denoiser(job: &Job) -> Result<(), Error> {
    if !job.scene.denoise || job.work_file(&Stage::Denoise.record())?.is_file() {
        return Ok(());
    }
    // Where the frames are not known yet, because the scene is not planned or the plan is damaged, the library will be needed.
    if all_are_denoised(job).unwrap_or(false) { Ok(()) } else { open(job).map(drop) }
}

fn all_are_denoised(job: &Job) -> Result<bool, Error> {
    for (camera, frame) in job.frames()? {
        let hash = denoise_hash(job, &camera, frame)?;
        if !job.dataset.denoised_are_complete(&job.scene.name, &camera, frame, &hash) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The library that the configuration names, else the environment, else the system's.
pub(super) fn open(job: &Job) -> Result<Denoiser, Error> {
    let written = job.scene.denoise_library.as_deref().map(|path| job.config.path(path)).transpose()?;
    let place = written.or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from));
    Denoiser::open(place.as_deref(), rayon::current_num_threads()).map_err(|error| match error {
        DenoiseError::NotFound { .. } | DenoiseError::Function { .. } | DenoiseError::Version { .. } => Error::scene(
            error.to_string(),
            format!(
                "install version 2 (`pip install pyoidn` brings it along, and openimagedenoise.org has packages) and name the file, or \
                 the folder that it lies in, by {VARIABLE} or by denoise_library in [render]; or render without denoising"
            ),
        ),
        other => Error::stage(other),
    })
}

/// Denoises one frame.
pub(super) fn denoise_frame(job: &Job, camera: &str, frame: u32, hash: &str, denoiser: &Denoiser) -> Result<(), Error> {
    let name = &job.scene.name;
    let rendered = job.dataset.read_frame(name, camera, frame, &INPUTS).map_err(Error::stage)?;
    let layers = denoise(&rendered, |noisy| denoiser.filter(noisy)).map_err(Error::stage)?;
    job.dataset.write_denoised_layers(name, camera, frame, &layers, &denoiser.name(), hash).map_err(Error::stage).map(drop)
}

/// Names what a frame's denoised layers are made from. The library's version stands in their record instead, so that a finished
/// dataset does not ask for a library.
pub(super) fn denoise_hash(job: &Job, camera: &str, frame: u32) -> Result<String, Error> {
    let record = job.dataset.frame_record(&job.scene.name, camera, frame).map_err(Error::stage)?;
    let version = (env!("CARGO_PKG_VERSION"), Stage::Denoise.version());
    Ok(Hash::of(&(version, record.map(|r| r.config_hash))).0)
}

/// Removes what an earlier configuration asked for.
fn remove(job: &Job, camera: &str, frame: u32) -> Result<(), Error> {
    let name = &job.scene.name;
    job.dataset.remove_denoised_layers(name, camera, frame).map_err(Error::stage)?;
    let mut previews = PREVIEWS.iter().filter(|spec| spec.pass == Pass::Denoised);
    let path = |spec: &PreviewSpec| job.dataset.layout().preview(name, camera, frame, spec.pass, spec.name);
    Ok(previews.try_for_each(|spec| remove_if_there(&path(spec)))?)
}

fn outputs(job: &Job, frames: &[(String, u32)]) -> Vec<PathBuf> {
    let (layout, name) = (job.dataset.layout(), &job.scene.name);
    let mut files = Vec::new();
    for (camera, frame) in frames {
        files.push(layout.denoise_record(name, camera, *frame));
        let denoised = LAYERS.iter().filter(|spec| spec.pass == Pass::Denoised);
        files.extend(denoised.map(|spec| layout.layer(name, camera, *frame, spec.layer)));
    }
    files
}

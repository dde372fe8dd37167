//! `denoise`: `color`, `diffuse_illumination` and `residual` of finished frames, made from what was rendered: denoised, or the same under a
//! second name. It makes one or the other of the same rendering; nothing is rendered for it.

use super::{HASHED_AS, Inputs, Job, Outcome, Record, Stage};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::{ColorKind, Denoised, FrameRecord, counted, remove_if_there};
use enfilade_denoise::{Denoiser, denoise, inputs_of};
use enfilade_frame::Pass;
use enfilade_scene::{Cx, Warning};
use enfilade_show::preview::{PREVIEWS, PreviewSpec};

/// Beginning of the names of denoisers in records of earlier versions, which could also denoise by an installed library. Their results are
/// still valid.
const LIBRARY: &str = "Open Image Denoise ";
/// The place of that library in hashes of settings.
const NO_LIBRARY: Option<&str> = None;

pub(super) fn settings(job: &Job) -> Hash {
    Hash::of(&(job.scene.color, job.scene.keep_rendered, NO_LIBRARY))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    job.rendered_records().map(Some)
}

/// Whether every frame has the requested kind of colour.
pub(super) fn frames_are_chosen(job: &Job) -> bool {
    let is_chosen = |(camera, frame): &(String, u32)| record(job, camera, *frame).is_ok_and(|record| is_chosen(job, &record));
    job.frames().is_ok_and(|frames| frames.iter().all(is_chosen))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let frames = job.frames()?;
    let mut left = Vec::new();
    for (camera, frame) in &frames {
        let record = record(job, camera, *frame)?;
        if !is_chosen(job, &record) || job.force && job.scene.color == ColorKind::Denoised && record.has_rendered() {
            left.push((camera, *frame, record));
        } else {
            settle(job, camera, *frame, &record)?;
        }
    }
    let denoiser = if left.iter().any(|(_, _, record)| is_denoised_now(job, record)) { Some(Denoiser::built_in()) } else { None };
    let mut denoised = 0;
    for (done, (camera, frame, record)) in left.iter().enumerate() {
        match &denoiser {
            Some(denoiser) if is_denoised_now(job, record) => {
                denoise_frame(job, camera, *frame, denoiser)?;
                denoised += 1;
            }
            _ => settle(job, camera, *frame, record)?,
        }
        remove_pictures_of_rendered(job, camera, *frame)?;
        cx.progress("frames", done as u64 + 1, left.len() as u64);
    }
    let mut summary = match (job.scene.color, &denoiser) {
        (ColorKind::Rendered, _) => format!("colour as rendered in {}", counted(frames.len(), "frame")),
        (ColorKind::Denoised, None) => format!("{} denoised before", counted(frames.len(), "frame")),
        (ColorKind::Denoised, Some(denoiser)) => format!("{} by {}", counted(denoised, "frame"), denoiser.name()),
    };
    if denoised > 0 && denoised < frames.len() {
        summary = format!("{summary}, {} kept", frames.len() - denoised);
    }
    Ok(Outcome { summary, ..Outcome::default() })
}

/// Warns of frames that have to be rendered again because their rendered layers are requested but were not kept.
pub(crate) fn warn_of_lost(job: &Job, cx: &dyn Cx) {
    if job.scene.color == ColorKind::Denoised {
        return;
    }
    let is_lost = |(camera, frame): &&(String, u32)| record(job, camera, *frame).is_ok_and(|record| !record.has_rendered());
    let lost = job.frames().map_or(0, |frames| frames.iter().filter(is_lost).count());
    if lost > 0 {
        let message =
            format!("{} denoised, and what was rendered was not kept (keep_rendered = false): rendered again", counted(lost, "frame"));
        cx.warn(Warning { place: job.scene.name.clone(), message });
    }
}

/// Makes the requested kind of colour of one rendered frame, unless it exists already.
pub(super) fn make_color(job: &Job, camera: &str, frame: u32) -> Result<(), Error> {
    match job.scene.color {
        ColorKind::Denoised if is_chosen(job, &record(job, camera, frame)?) => Ok(()),
        ColorKind::Denoised => denoise_frame(job, camera, frame, &Denoiser::built_in()),
        ColorKind::Rendered => job.dataset.link_rendered([&job.scene.name, camera], frame).map_err(Error::stage),
    }
}

/// Denoises one frame.
fn denoise_frame(job: &Job, camera: &str, frame: u32, denoiser: &Denoiser) -> Result<(), Error> {
    let name = &job.scene.name;
    let layers = inputs_of(|layer| job.dataset.has_layer(name, camera, frame, layer));
    let rendered = job.dataset.read_rendered([name, camera], frame, &layers).map_err(Error::stage)?;
    let layers = denoise(&rendered, |noisy| denoiser.filter(noisy)).map_err(Error::stage)?;
    let by = [&denoiser.name(), &denoise_hash()];
    job.dataset
        .write_denoised([name, camera], frame, &layers, by.map(String::as_str), job.scene.keep_rendered)
        .map_err(Error::stage)
        .map(drop)
}

/// Hash of the denoiser. The record also has the checksums of the denoised layers.
fn denoise_hash() -> String {
    Hash::of(&(HASHED_AS, Stage::Denoise.version(), NO_LIBRARY)).0
}

fn record(job: &Job, camera: &str, frame: u32) -> Result<FrameRecord, Error> {
    let name = &job.scene.name;
    let record = job.dataset.frame_record(name, camera, frame).map_err(Error::stage)?;
    record.ok_or_else(|| {
        Error::scene(format!("frame {frame} of {name}/{camera} is not there"), format!("run first: {}", job.command(Stage::Render)))
    })
}

/// Whether a frame has the requested kind of colour.
fn is_chosen(job: &Job, record: &FrameRecord) -> bool {
    let is_asked_for = match (&record.denoised, job.scene.color) {
        (None, color) => color == ColorKind::Rendered,
        (Some(_), ColorKind::Rendered) => false,
        (Some(denoised), ColorKind::Denoised) => !record.has_rendered() || is_current(denoised) && job.scene.keep_rendered,
    };
    is_asked_for && job.dataset.color_is_whole(&job.scene.name, record)
}

/// Whether a frame without the requested kind of colour has to be denoised.
fn is_denoised_now(job: &Job, record: &FrameRecord) -> bool {
    job.scene.color == ColorKind::Denoised
        && record.has_rendered()
        && (record.denoised.as_ref().is_none_or(|denoised| job.force || !is_current(denoised))
            || !job.dataset.color_is_whole(&job.scene.name, record))
}

/// Whether frames that were denoised so need not be denoised again.
fn is_current(denoised: &Denoised) -> bool {
    denoised.denoise_hash == denoise_hash() || denoised.denoiser.starts_with(LIBRARY)
}

/// Brings a frame that needs no denoising to the requested state: the rendered layers under both names, or removed if they are not to be
/// kept.
fn settle(job: &Job, camera: &str, frame: u32, record: &FrameRecord) -> Result<(), Error> {
    let of = [job.scene.name.as_str(), camera];
    let settled = match job.scene.color {
        ColorKind::Rendered => job.dataset.link_rendered(of, frame),
        ColorKind::Denoised if job.scene.keep_rendered && record.has_rendered() => Ok(()),
        ColorKind::Denoised => job.dataset.drop_rendered(of, frame),
    };
    settled.map_err(Error::stage)
}

/// Removes the pictures of layers that a frame may not have any more; the preview stage makes pictures of its current layers.
fn remove_pictures_of_rendered(job: &Job, camera: &str, frame: u32) -> Result<(), Error> {
    let name = &job.scene.name;
    let mut previews = PREVIEWS.iter().filter(|spec| matches!(spec.pass, Pass::Rendered | Pass::Guides));
    let path = |spec: &PreviewSpec| job.dataset.layout().preview(name, camera, frame, spec.pass, spec.name);
    Ok(previews.try_for_each(|spec| remove_if_there(&path(spec)))?)
}

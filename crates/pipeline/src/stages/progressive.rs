//! One frame, pass by pass: saved now and then, so that a killed run continues within the frame, and ended when its time is over.

use super::Job;
use crate::error::Error;
use crate::report::Stopwatch;
use enfilade_dataset::{FrameInfo, Sampling, StoppedBy, remove_if_there, write_bytes};
use enfilade_frame::Frame;
use enfilade_render::{FrameRender, PartialError};
use enfilade_scene::{Cx, Warning};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

/// Folder of frames in the making, within the work folder of a scene.
pub(crate) const FOLDER: &str = "partial";

/// Takes the samples of the frame that is `rendering`, after those that an earlier run has kept. The time limit is one of this run.
///
/// # Errors
/// When what is to be kept cannot be written.
pub(super) fn render(
    job: &Job,
    camera: &str,
    info: &FrameInfo,
    mut rendering: FrameRender<'_, '_>,
    cx: &dyn Cx,
) -> Result<(Frame, Sampling), Error> {
    // Go on from what an earlier run has kept of this very frame.
    let path = file(job, camera, info.pose.frame)?;
    let key = info.config_hash.as_bytes();
    if let Ok(bytes) = std::fs::read(&path) {
        match rendering.restore(&bytes, key) {
            Ok(()) | Err(PartialError::OtherFrame) => {}
            Err(problem) => {
                let message = format!("{problem}; the frame was started again");
                cx.warn(Warning { place: path.display().to_string(), message });
            }
        }
    }

    // Take samples pass by pass, until there are enough or the time is over.
    let time = Stopwatch::start();
    let (mut over, mut kept_s) = (false, 0.0);
    while !rendering.is_done() && !over {
        if job.scene.time_limit_s.is_some() {
            // The first pass may take many times as long as the frame should.
            rendering.short_pass(cx);
        } else {
            rendering.pass(cx);
        }
        let now_s = time.wall_s();
        over = job.scene.time_limit_s.is_some_and(|limit| now_s >= limit);

        // Keep the frame now and then, and when the work is to end.
        let ends = job.shift.is_some_and(|shift| shift.stop.load(Ordering::Relaxed));
        if !over && !rendering.is_done() && (ends || now_s - kept_s >= job.scene.save_every_s) {
            write_bytes(&path, rendering.save(key))?;
            kept_s = time.wall_s();
            if ends {
                return Err(Error::Interrupted { camera: camera.to_string(), frame: info.pose.frame, kept: path });
            }
        }
    }

    let stopped_by = match rendering.is_done() {
        false => StoppedBy::TimeLimit,
        true if rendering.met_noise_target() => StoppedBy::Noise,
        true => StoppedBy::Samples,
    };
    let noise_target = job.scene.render.noise;
    let sampling = Sampling { samples_taken: rendering.samples(), noise: rendering.noise(), noise_target, stopped_by };
    Ok((rendering.frame(), sampling))
}

/// Removes what was kept of a frame.
///
/// # Errors
/// When it cannot be removed.
pub(super) fn forget(job: &Job, camera: &str, frame: u32) -> Result<(), Error> {
    Ok(remove_if_there(&file(job, camera, frame)?)?)
}

/// Removes what was kept of frames that are not to be rendered any more.
///
/// # Errors
/// When a file cannot be removed.
pub(super) fn forget_all_but<'a>(job: &Job, frames: impl Iterator<Item = (&'a str, u32)>) -> Result<(), Error> {
    let keep = frames.map(|(camera, frame)| file(job, camera, frame)).collect::<Result<BTreeSet<_>, _>>()?;
    let Ok(entries) = std::fs::read_dir(job.work_file(FOLDER)?) else { return Ok(()) };
    let there = entries.filter_map(Result::ok).map(|entry| entry.path());
    Ok(there.filter(|path| !keep.contains(path)).try_for_each(|path| remove_if_there(&path))?)
}

fn file(job: &Job, camera: &str, frame: u32) -> Result<PathBuf, Error> {
    Ok(job.work_file(FOLDER)?.join(file_name(camera, frame)))
}

/// Name under which a frame in the making is kept in [`FOLDER`].
pub(crate) fn file_name(camera: &str, frame: u32) -> String {
    format!("{camera}.{frame:04}.partial")
}

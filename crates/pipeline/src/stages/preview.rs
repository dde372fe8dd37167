//! `preview`: pictures of every layer of finished frames, and a contact sheet per trajectory.

use super::{Input, Job, Outcome, Record};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::write_bytes;
use enfilade_frame::{Frame, LAYERS, Layer};
use enfilade_post::picture::jpeg;
use enfilade_post::preview::PREVIEWS;
use enfilade_post::sheet::{SheetConfig, SheetTitle, spread, trajectory_sheet};
use enfilade_post::tonemap::ToneMap;
use enfilade_scene::Cx;
use std::path::PathBuf;

pub(super) fn settings(_job: &Job) -> Hash {
    Hash::of(&SheetConfig::default())
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Result<Option<Vec<Input>>, Error> {
    let mut inputs = job.frame_records()?;
    inputs.extend(job.label_records()?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let (_, trajectories) = job.trajectories()?;
    let total: usize = trajectories.iter().map(|t| t.poses.len()).sum();
    let config = SheetConfig::default();
    let mut outputs = Vec::new();
    let mut done = 0;
    for trajectory in &trajectories {
        let shown = spread(trajectory.poses.len(), config.frames);
        let mut sheet = Vec::new();
        for (index, pose) in trajectory.poses.iter().enumerate() {
            let frame = read_all_layers(job, &trajectory.name, pose.frame)?;
            outputs.extend(write_previews(job, &trajectory.name, pose.frame, &frame)?);
            if shown.contains(&index) {
                sheet.push((pose.frame, frame));
            }
            done += 1;
            cx.progress("frames", done, total as u64);
        }
        let title = SheetTitle { scene: name, camera: &trajectory.name, frames: trajectory.poses.len() };
        let path = job.dataset.layout().contact_sheet(name, &trajectory.name);
        write_bytes(&path, jpeg(&trajectory_sheet(title, &sheet, &config))).map_err(Error::stage)?;
        outputs.push(path);
    }
    let sheets = if trajectories.len() == 1 { "1 contact sheet".into() } else { format!("{} contact sheets", trajectories.len()) };
    Ok(Outcome { summary: format!("{} pictures, {sheets}", outputs.len() - trajectories.len()), outputs, ..Outcome::default() })
}

fn read_all_layers(job: &Job, camera: &str, frame: u32) -> Result<Frame, Error> {
    let name = &job.scene.name;
    let there: Vec<Layer> = LAYERS.iter().map(|s| s.layer).filter(|&layer| job.dataset.has_layer(name, camera, frame, layer)).collect();
    job.dataset.read_frame(name, camera, frame, &there).map_err(Error::stage)
}

fn write_previews(job: &Job, camera: &str, number: u32, frame: &Frame) -> Result<Vec<PathBuf>, Error> {
    let tone = ToneMap::of_frame(frame).unwrap_or(ToneMap { scale: 1.0 });
    let mut written = Vec::new();
    for spec in &PREVIEWS {
        let Some(bytes) = spec.file(frame, tone) else { continue };
        let path = job.dataset.layout().preview(&job.scene.name, camera, number, spec.pass, spec.name);
        write_bytes(&path, bytes).map_err(Error::stage)?;
        written.push(path);
    }
    Ok(written)
}

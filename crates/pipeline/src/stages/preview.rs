//! `preview`: pictures of every layer of finished frames, boxes drawn over them, and a contact sheet per trajectory.

use super::{Inputs, Job, Outcome, Record, Stage, boxes, made, variation};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::{counted, remove_if_there};
use enfilade_scene::Trajectory;
use enfilade_show::drivers::{expose_camera, preview_boxes, preview_camera, write_contact_sheet};
use enfilade_show::sheet::SheetConfig;
use std::collections::BTreeSet;

pub(super) fn settings(job: &Job) -> Hash {
    let sheet = SheetConfig::default();
    match variation::exposure_stops(job) {
        0.0 => Hash::of(&sheet),
        stops => Hash::of(&(sheet, stops)),
    }
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = job.frame_records()?;
    inputs.extend(job.label_records()?);
    inputs.extend(boxes::tables(job)?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let filmed = job.filmed()?;
    filmed.iter().try_for_each(|(_, trajectory)| refuse_incomplete(job, trajectory))?;
    let name = &job.scene.name;
    let boxes = made::boxes(job)?;
    let mut outputs = Vec::new();
    let mut tables = Vec::new();
    let mut sheets = 0;
    for (_, trajectory) in filmed.iter() {
        let frames: Vec<u32> = job.frames_of(trajectory)?.into_iter().collect();
        let shot = [name.as_str(), trajectory.name.as_str()];
        let (exposures, table) = expose_camera(job.dataset, name, &trajectory.name, &frames).map_err(Error::stage)?;
        let mut made = BTreeSet::new();
        for &frame in &frames {
            let Some(pictures) = made::pictures(job, &trajectory.name, frame, &boxes)? else { continue };
            made.insert(frame);
            outputs.extend(pictures);
        }
        outputs.extend(preview_camera(job.dataset, shot, &frames, &exposures, &made, cx).map_err(Error::stage)?);
        let unmade: Vec<u32> = frames.iter().copied().filter(|frame| !made.contains(frame)).collect();
        outputs.extend(preview_boxes(job.dataset, name, &trajectory.name, &unmade, cx).map_err(Error::stage)?);
        let sheet = write_contact_sheet(job.dataset, shot, &frames, exposures.display, &SheetConfig::default()).map_err(Error::stage)?;
        tables.push(table);
        if sheet.is_none() {
            remove_if_there(&job.dataset.layout().contact_sheet(name, &trajectory.name))?;
        }
        sheets += usize::from(sheet.is_some());
        outputs.extend(sheet);
    }
    let summary = format!("{}, {}", counted(outputs.len() - sheets, "picture"), counted(sheets, "contact sheet"));
    outputs.extend(tables);
    Ok(Outcome { summary, outputs, ..Outcome::default() })
}

/// Refuses frames of which a file is missing or cut short: the exposure of the trajectory would be computed without them, and kept when
/// they are there again.
fn refuse_incomplete(job: &Job, trajectory: &Trajectory) -> Result<(), Error> {
    let (dataset, name, camera) = (job.dataset, job.scene.name.as_str(), trajectory.name.as_str());
    let wanted = job.frames_of(trajectory)?;
    let complete = dataset.frame_numbers(name, camera).map_err(Error::stage)?;
    let mut incomplete = dataset.incomplete_frames(name, camera, &complete).map_err(Error::stage)?;
    incomplete.retain(|frame, _| wanted.contains(frame));
    if let Some((_, problem)) = incomplete.pop_first() {
        return Err(Error::stage(problem));
    }
    for &frame in &wanted {
        let labels = dataset.label_record(name, camera, frame).map_err(Error::stage)?;
        if labels.is_some_and(|record| !dataset.labels_are_complete(name, camera, frame, &record.labels_hash)) {
            return Err(lacks_layers_of(Stage::Label, job, camera, frame));
        }
    }
    Ok(())
}

fn lacks_layers_of(stage: Stage, job: &Job, camera: &str, frame: u32) -> Error {
    let (verb, name) = (stage.name(), &job.scene.name);
    let message = format!("frame {frame} of {name}/{camera} has a record of `{verb}`, but not all layers of it in full length");
    Error::scene(message, format!("make them again: {}", job.command(stage)))
}

//! `preview`: pictures of every layer of finished frames, boxes drawn over them, and a contact sheet per trajectory.

use super::{Inputs, Job, Outcome, Record};
use crate::error::Error;
use crate::report::{StageCx, count};
use crate::workdir::{Hash, remove_if_there};
use enfilade_post::drivers::{preview_boxes, preview_camera, write_contact_sheet};
use enfilade_post::sheet::SheetConfig;

pub(super) fn settings(_job: &Job) -> Hash {
    Hash::of(&SheetConfig::default())
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = job.frame_records()?;
    inputs.extend(job.label_records()?);
    inputs.extend(job.denoise_records()?);
    inputs.extend(super::boxes::tables(job)?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    // The dataset's own sheet shows these frames: the run makes it again at its end.
    remove_if_there(&job.dataset.layout().overview())?;
    let name = &job.scene.name;
    let filmed = job.filmed()?;
    let mut outputs = Vec::new();
    let mut sheets = 0;
    for (_, trajectory) in &filmed {
        let frames: Vec<u32> = trajectory.poses.iter().map(|pose| pose.frame).collect();
        outputs.extend(preview_camera(job.dataset, name, &trajectory.name, &frames, cx).map_err(Error::stage)?);
        outputs.extend(preview_boxes(job.dataset, name, &trajectory.name, &frames, cx).map_err(Error::stage)?);
        let sheet = write_contact_sheet(job.dataset, name, &trajectory.name, &frames, &SheetConfig::default()).map_err(Error::stage)?;
        sheets += usize::from(sheet.is_some());
        outputs.extend(sheet);
    }
    let summary = format!("{}, {}", count(outputs.len() - sheets, "picture"), count(sheets, "contact sheet"));
    Ok(Outcome { summary, outputs, ..Outcome::default() })
}

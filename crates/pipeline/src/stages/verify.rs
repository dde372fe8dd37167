//! `verify`: the laws that tie a scene's files together, on a card.

use super::{Inputs, Job, Outcome, Record, boxes, camera_files};
use crate::error::Error;
use crate::report::StageCx;
use crate::workdir::Hash;
use enfilade_dataset::{counted, quoted, remove_if_there, write_json};
use enfilade_verify::frame_gates::GATES;
use enfilade_verify::{LAWS, verify_scene};

/// The scene's part of the report card, in its work folder; written also when a check does not pass.
pub(crate) const CARD: &str = "card.json";

/// Removes the card of the scene and that of the dataset, before the data that they judge change.
pub(super) fn forget(job: &Job) -> Result<(), Error> {
    let layout = job.dataset.layout();
    let cards = [job.work_file(CARD)?, layout.verify_report(), layout.verify_page()];
    Ok(cards.iter().try_for_each(|path| remove_if_there(path))?)
}

pub(super) fn settings(_job: &Job) -> Hash {
    let laws = LAWS.map(|law| (law.statement, law.bound.to_bits()));
    let gates = GATES.map(|gate| (gate.measure, gate.bound.to_bits()));
    Hash::of(&(laws.as_slice(), gates.as_slice()))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = camera_files::inputs(job)?;
    inputs.extend(job.frame_records()?);
    inputs.extend(job.label_records()?);
    inputs.extend(boxes::tables(job)?);
    Ok(Some(inputs))
}

pub(super) fn run(job: &Job, cx: &StageCx) -> Result<Outcome, Error> {
    let name = &job.scene.name;
    let report = verify_scene(job.dataset, name, cx).map_err(Error::stage)?;
    let card = job.work_file(CARD)?;
    write_json(&card, &report)?;
    if !report.passed {
        let broken: Vec<String> = report.failures().map(|law| format!("{} (at {})", law.statement, law.place)).collect();
        let message = format!("{} of {} laws do not hold: {}", broken.len(), report.laws.len(), broken.join("; "));
        return Err(Error::scene(
            message,
            format!("see the card: enfilade verify {} --scene {}", quoted(job.out().display()), quoted(name)),
        ));
    }
    let rejected = match report.rejected().count() {
        0 => String::new(),
        n => format!("; gates reject {n}"),
    };
    let summary = format!("all {} laws hold over {}{rejected}", report.laws.len(), counted(report.frames, "frame"));
    Ok(Outcome { summary, outputs: vec![card], ..Outcome::default() })
}

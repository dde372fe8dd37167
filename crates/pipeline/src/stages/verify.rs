//! `verify`: the laws that tie a scene's files together, on a card.

use super::{Inputs, Job, Outcome, Record};
use crate::error::Error;
use crate::report::{StageCx, count};
use crate::workdir::{Hash, remove_if_there, write_json};
use enfilade_dataset::quoted;
use enfilade_verify::frame_gates::GATES;
use enfilade_verify::{LAWS, verify_scene};

/// The scene's part of the report card, in its work folder; it is there also when laws do not hold.
pub(crate) const CARD: &str = "card.json";

/// Removes the card of the scene and that of the dataset, because what they are about changes.
pub(super) fn forget(job: &Job) -> Result<(), Error> {
    let layout = job.dataset.layout();
    let cards = [job.work_file(CARD)?, layout.verify_report(), layout.verify_page()];
    cards.iter().try_for_each(|path| remove_if_there(path))
}

pub(super) fn settings(_job: &Job) -> Hash {
    let laws = LAWS.map(|law| (law.statement, law.bound.to_bits()));
    let gates = GATES.map(|gate| (gate.measure, gate.bound.to_bits()));
    Hash::of(&(laws.as_slice(), gates.as_slice()))
}

pub(super) fn inputs(job: &Job, _previous: Option<&Record>) -> Inputs {
    let mut inputs = super::plan::outputs(job)?;
    inputs.extend(job.frame_records()?);
    inputs.extend(job.label_records()?);
    inputs.extend(job.denoise_records()?);
    inputs.extend(super::boxes::tables(job)?);
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
    let summary = format!("all {} laws hold over {}{rejected}", report.laws.len(), count(report.frames, "frame"));
    Ok(Outcome { summary, outputs: vec![card], ..Outcome::default() })
}

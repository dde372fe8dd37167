//! `verify`: the laws that tie a scene's files together, on a card.

use super::{Inputs, Job, Outcome, Record};
use crate::error::Error;
use crate::report::{StageCx, count};
use crate::workdir::Hash;
use enfilade_post::verify::{LAWS, verify_dataset};

pub(super) fn settings(_job: &Job) -> Hash {
    Hash::of(&LAWS.map(|law| (law.statement, law.bound.to_bits())).as_slice())
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
    let report = verify_dataset(job.dataset, std::slice::from_ref(name), cx).map_err(Error::stage)?;
    if !report.passed {
        let broken: Vec<String> = report.failures().map(|law| format!("{} (at {})", law.statement, law.place)).collect();
        let message = format!("{} of {} laws do not hold: {}", broken.len(), report.laws.len(), broken.join("; "));
        return Err(Error::scene(message, format!("see the card: enfilade verify {} --scene {name}", job.out().display())));
    }
    let summary = format!("all {} laws hold over {}", report.laws.len(), count(report.frames, "frame"));
    let report = serde_json::to_value(&report).unwrap_or_default();
    Ok(Outcome { summary, report, ..Outcome::default() })
}

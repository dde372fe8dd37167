//! Running a stage, and the rule for skipping it.
//!
//! A stage is up to date if its record states that it ran with the same configuration, the same content of the same inputs and the same
//! version of the code, and all its outputs exist as it wrote them. Further conditions of a stage are in its row of the table, [`STAGES`].

use super::{HASHED_AS, Input, Job, Output, Record, STAGES, Stage, StageSpec, verify};
use crate::error::Error;
use crate::report::{Event, StageCx, StageOutcome, Stopwatch};
use crate::workdir::{Hash, read_json};
use enfilade_dataset::{remove_if_there, write_json};
use std::path::{Path, PathBuf};

/// Runs a stage of a scene unless it is up to date and not forced. `ready` is called before it does, and not where there is nothing to do.
pub(crate) fn advance(spec: &StageSpec, job: &Job, ready: impl FnOnce() -> Result<(), Error>, cx: StageCx) -> Result<StageOutcome, Error> {
    // Skip the stage where nothing that it depends on has changed.
    let record_path = job.work_file(&spec.stage.record())?;
    let previous: Option<Record> = read_json(&record_path);
    let inputs = (spec.inputs)(job, previous.as_ref())?;
    let settings = (spec.settings)(job);
    if let (false, Some(record), Some(inputs)) = (job.force, &previous, &inputs)
        && vouches(record, spec, job, &settings, inputs)
    {
        cx.event(Event::UpToDate);
        let warnings = record.warnings.len();
        return Ok(StageOutcome {
            stage: spec.stage,
            up_to_date: true,
            summary: record.summary.clone(),
            warnings,
            wall_s: 0.0,
            key: record.key.clone(),
        });
    }

    // Check what would be in vain later, while the old outputs are still whole.
    if spec.replaces_frames() {
        refuse_damaged(spec.stage, job, inputs.as_deref().unwrap_or_default())?;
    }
    ready()?;

    // The old outputs are about to change: from here on neither the old record nor the report card may vouch for them.
    cx.event(Event::Started);
    let time = Stopwatch::start();
    remove_if_there(&record_path)?;
    if spec.is_verified() {
        verify::forget(job)?;
    }

    // Do the work.
    let outcome = (spec.run)(job, &cx)?;

    // Describe the outputs on disk.
    let inputs = outcome.inputs.or(inputs).unwrap_or_default();
    let outputs = outcome.outputs.iter().map(|path| Output::of(job.out(), path)).collect::<Result<_, _>>()?;
    let listed = spec.shared_row.as_ref().and_then(|row| (row.hash)(job));
    let (wall_s, cpu_s) = (time.wall_s(), time.cpu_s());
    cx.event(Event::Finished { summary: &outcome.summary, wall_s });

    // Write the record last: a stage that was killed before has none and runs again.
    let record = Record {
        key: key(spec, &settings, &inputs),
        summary: outcome.summary,
        warnings: cx.into_warnings(),
        report: outcome.report,
        wall_s,
        cpu_s,
        inputs,
        outputs,
        listed,
    };
    write_json(&record_path, &record)?;
    let warnings = record.warnings.len();
    Ok(StageOutcome { stage: spec.stage, up_to_date: false, summary: record.summary, warnings, wall_s, key: record.key })
}

/// True when [`advance`] would find nothing to do.
pub(crate) fn is_up_to_date(spec: &StageSpec, job: &Job) -> Result<bool, Error> {
    let record: Option<Record> = read_json(&job.work_file(&spec.stage.record())?);
    let Some(record) = record else { return Ok(false) };
    let inputs = (spec.inputs)(job, Some(&record))?;
    Ok(inputs.is_some_and(|inputs| vouches(&record, spec, job, &(spec.settings)(job), &inputs)))
}

/// Whether the stage ran with these settings and inputs, and what it wrote is there.
fn vouches(record: &Record, spec: &StageSpec, job: &Job, settings: &Hash, inputs: &[Input]) -> bool {
    let is_there = |output: &Output| output.is_committed() || output.is_there(job.out());
    record.key == key(spec, settings, inputs)
        && record.outputs.iter().all(is_there)
        && (spec.is_whole)(job)
        && has_its_row(record, spec, job)
}

/// Whether the scene's row in a table that scenes share is as the stage left it; true for stages that write no such row.
fn has_its_row(record: &Record, spec: &StageSpec, job: &Job) -> bool {
    let Some(row) = &spec.shared_row else { return true };
    (row.hash)(job).is_some_and(|now| record.listed.as_ref().is_none_or(|then| now == *then))
}

/// Refuses inputs of `stage` that are not as an earlier stage wrote them.
fn refuse_damaged(stage: Stage, job: &Job, inputs: &[Input]) -> Result<(), Error> {
    for earlier in &STAGES[..stage as usize] {
        let Some(record) = read_json::<Record>(&job.work_file(&earlier.stage.record())?) else { continue };
        let is_other = |path: &Path, content: &Hash| inputs.iter().any(|input| input.path == path && input.content != *content);
        let noted = record.outputs.iter().filter_map(|output| Some((job.out().join(&output.path), output.content.as_ref()?)));
        let mut damaged: Vec<PathBuf> = noted.filter(|(path, content)| is_other(path, content)).map(|(path, _)| path).collect();
        if let Some(row) = &earlier.shared_row
            && !has_its_row(&record, earlier, job)
        {
            damaged.push((row.table)(job));
        }
        if let Some(path) = damaged.first() {
            return Err(job.not_as_written(earlier.stage, path));
        }
    }
    Ok(())
}

/// Names the settings, the inputs and the version of the code that a stage ran with.
fn key(spec: &StageSpec, settings: &Hash, inputs: &[Input]) -> Hash {
    // A dataset may be moved: the contents of its files count, not their paths.
    let contents: Vec<&Hash> = inputs.iter().map(|i| &i.content).collect();
    Hash::of(&(HASHED_AS, spec.name, spec.stage.version(), settings, contents))
}

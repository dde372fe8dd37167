//! The progress of a job, by the contents of the store, whatever an engine reports.

use crate::object_names::ATTEMPTS;
use crate::work::{AttemptRecord, Ended, missing_by_task};
use crate::{FarmError, Job, Ranges};
use serde::Serialize;
use std::collections::BTreeMap;

/// The progress of a job.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// All frames.
    pub frames: u64,
    /// Frames that are committed.
    pub frames_done: u64,
    /// All tasks.
    pub tasks: u32,
    /// Tasks with frames that are not.
    pub missing: Ranges,
    /// Attempts by how they ended; those that are at work or were killed are "open".
    pub attempts: BTreeMap<&'static str, u32>,
    /// Processor seconds that are still to be spent, by the forecast.
    pub left_cpu_s: f64,
    /// Frames of which two attempts made different bytes: there should be none.
    pub different: u32,
    /// Committed frames that break a law of verification, by law: there should be none.
    pub broken: BTreeMap<String, u32>,
    /// The last error of each task that is not done and has failed.
    pub errors: BTreeMap<u32, String>,
    /// Records of attempts that cannot be read and are left out, each with what is wrong.
    pub unreadable: Vec<String>,
}

impl Status {
    /// True when nothing is missing.
    pub fn is_complete(&self) -> bool {
        self.missing.is_empty()
    }
}

/// Looks at every marker and every record of attempts.
///
/// # Errors
/// When the store does not answer.
pub fn status(job: &Job) -> Result<Status, FarmError> {
    let plan = &job.plan;
    let mut status = Status {
        frames: plan.tasks.iter().map(|task| task.part.frames.len() as u64).sum(),
        frames_done: 0,
        tasks: plan.tasks.len() as u32,
        missing: Ranges::new(),
        attempts: BTreeMap::new(),
        left_cpu_s: 0.0,
        different: 0,
        broken: BTreeMap::new(),
        errors: BTreeMap::new(),
        unreadable: Vec::new(),
    };
    let missing = missing_by_task(job)?;
    status.frames_done = status.frames - missing.values().map(|&count| count as u64).sum::<u64>();
    for (&number, &count) in &missing {
        let task = job.task(number)?;
        status.left_cpu_s += task.cpu_s * count as f64 / task.part.frames.len() as f64;
        status.missing.insert(number);
    }
    let (records, unreadable) = attempts(job)?;
    status.unreadable = unreadable;
    for record in records {
        *status.attempts.entry(record.ended.map_or("open", Ended::word)).or_default() += 1;
        status.different += record.different;
        record.broken.into_iter().for_each(|(law, frames)| *status.broken.entry(law).or_default() += frames);
        if let Some(error) = record.error.filter(|_| status.missing.contains(&record.task)) {
            status.errors.insert(record.task, error);
        }
    }
    Ok(status)
}

impl Ended {
    /// Word for the outcome in records.
    pub fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Transient => "transient",
            Self::Permanent => "permanent",
        }
    }
}

/// Every record of an attempt, and what is wrong with those that cannot be read: no frame depends on them.
pub(crate) fn attempts(job: &Job) -> Result<(Vec<AttemptRecord>, Vec<String>), FarmError> {
    let (mut records, mut unreadable) = (Vec::new(), Vec::new());
    for (name, _) in job.store.list(ATTEMPTS)? {
        let Some(bytes) = job.store.get(&name)? else { continue };
        match serde_json::from_slice(&bytes) {
            Ok(record) => records.push(record),
            Err(error) => {
                unreadable.push(format!("{}: {error}; it was left out, and no frame depends on it: remove it", job.store.full_name(&name)));
            }
        }
    }
    Ok((records, unreadable))
}

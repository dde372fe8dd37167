//! The worker: it takes its tasks one after the other, makes the frames that nobody has committed, and commits them.

use crate::commit::{Commit, is_whole};
use crate::hand_in::{Finished, hand_in};
use crate::object_names::{ATTEMPTS, DONE, FRAMES, object_name};
use crate::{Attempt, FarmError, FrameKey, Job, Ranges, Task};
use enfilade_dataset::write_bytes;
use enfilade_pipeline::{FinishedFrame, Part, Reporter, Stopwatch, kept_frame, render_part};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The tasks of one worker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Assignment {
    /// The tasks of these numbers.
    Tasks(Ranges),
    /// The i-th of n shares of all tasks, each of consecutive ones.
    Shard(u32, u32),
}

/// Environment variables in which engines give a worker its index in a job, counted from 0.
const INDEX_VARIABLES: [&str; 2] = ["JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX"];

impl Assignment {
    /// Assignment of the task at the place in `tasks` that Kubernetes or AWS Batch give in `environment`; of the first task where neither
    /// does, as for a job of AWS Batch with a single task.
    ///
    /// # Errors
    /// When that is no number, or there are fewer tasks.
    pub fn nth(tasks: &Ranges, environment: impl Fn(&str) -> Option<String>) -> Result<Self, FarmError> {
        let told = INDEX_VARIABLES.iter().find_map(|&name| Some((name, environment(name)?)));
        let (name, text) = told.unwrap_or(("no variable of an engine", "0".into()));
        let wrong = || {
            let last = tasks.len().saturating_sub(1);
            FarmError::Request(format!(
                "the index is {text:?} ({name}); expected a number from 0 to {last}, for the {} tasks named",
                tasks.len()
            ))
        };
        let task = text.trim().parse().ok().and_then(|n| tasks.iter().nth(n)).ok_or_else(wrong)?;
        Ok(Self::Tasks([*task].into()))
    }

    /// The numbers of its tasks in a job of `count`.
    pub fn tasks(&self, count: usize) -> Ranges {
        match self {
            Self::Tasks(tasks) => tasks.clone(),
            &Self::Shard(i, n) => {
                let bound = |i: u32| (u64::from(i) * count as u64 / u64::from(n.max(1))) as u32;
                (bound(i)..bound(i + 1)).collect()
            }
        }
    }
}

/// The folder of this machine that workers use unless another is named.
pub fn default_scratch() -> PathBuf {
    std::env::temp_dir().join("enfilade-farm")
}

/// The settings of a worker.
#[derive(Debug)]
pub struct Work<'a> {
    /// A folder of this machine: scenes are kept there for all workers of the machine, and frames until they are committed.
    pub scratch: &'a Path,
    /// The attempt of this worker.
    pub attempt: &'a Attempt,
    /// Ends the work; what was done of a frame is kept in the store.
    pub stop: &'a AtomicBool,
}

/// The record of an attempt, as it is kept in the store.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AttemptRecord {
    /// The attempt and its machine.
    #[serde(flatten)]
    pub attempt: Attempt,
    /// Number of the task.
    pub task: u32,
    /// Elapsed seconds.
    pub wall_s: f64,
    /// Seconds of all threads together.
    pub cpu_s: f64,
    /// Threads at work.
    pub threads: u32,
    /// Peak memory of the process until then; `None` if the system does not report it.
    #[serde(default)]
    pub peak_memory_bytes: Option<u64>,
    /// Frames that are this attempt's.
    pub committed: u32,
    /// Frames that another attempt committed first.
    pub lost: u32,
    /// Number of these frames of which the other attempt had made other bytes: there should be none.
    pub different: u32,
    /// Number of the committed frames that break a law of verification, by law: normally none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub broken: BTreeMap<String, u32>,
    /// The end of the attempt; `None` while it is at work, and for ever if it was killed.
    pub ended: Option<Ended>,
    /// Why, where it failed.
    pub error: Option<String>,
}

/// The end of an attempt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ended {
    /// Every frame of the task is committed.
    Done,
    /// Another attempt may succeed.
    Transient,
    /// Another attempt would fail in the same way.
    Permanent,
}

/// Does the tasks of `assignment`, and returns a record of each. A task that fails does not stop the others.
///
/// # Errors
/// When there is no such task, or the store does not answer.
pub fn work(job: &Job, assignment: &Assignment, work: &Work, reporter: &dyn Reporter) -> Result<Vec<AttemptRecord>, FarmError> {
    let numbers = assignment.tasks(job.plan.tasks.len());
    numbers.iter().try_for_each(|&number| job.task(number).map(drop))?;
    let mut records = Vec::new();
    for number in numbers {
        if work.stop.load(Ordering::Relaxed) {
            break;
        }
        records.push(do_task(job, number, work, reporter)?);
    }
    Ok(records)
}

fn do_task(job: &Job, number: u32, work: &Work, reporter: &dyn Reporter) -> Result<AttemptRecord, FarmError> {
    let name = format!("{ATTEMPTS}/{number:06}.{}.json", work.attempt.id);
    let time = Stopwatch::start();
    let mut record = AttemptRecord {
        attempt: work.attempt.clone(),
        task: number,
        wall_s: 0.0,
        cpu_s: 0.0,
        threads: rayon::current_num_threads() as u32,
        peak_memory_bytes: None,
        committed: 0,
        lost: 0,
        different: 0,
        broken: BTreeMap::new(),
        ended: None,
        error: None,
    };
    let missing = missing_frames(job, job.task(number)?)?;
    if missing.is_empty() {
        record.ended = Some(Ended::Done);
        return Ok(record);
    }
    put_record(job, &name, &record)?;
    let tally = Mutex::new(Tally::default());
    let result = make(job, number, &missing, work, &tally, reporter);
    let tally = tally.into_inner().unwrap_or_else(PoisonError::into_inner);
    (record.committed, record.lost, record.different, record.broken) = (tally.committed, tally.lost, tally.different, tally.broken);
    let time = time.of_frame();
    (record.wall_s, record.cpu_s, record.peak_memory_bytes) = (time.wall_s, time.cpu_s, time.peak_memory_bytes);
    record.ended = Some(match &result {
        Ok(()) => Ended::Done,
        Err(error) if error.is_transient() => Ended::Transient,
        Err(_) => Ended::Permanent,
    });
    record.error = result.err().map(|error| error.to_string());
    put_record(job, &name, &record)?;
    Ok(record)
}

fn put_record(job: &Job, name: &str, record: &AttemptRecord) -> Result<(), FarmError> {
    let text = serde_json::to_vec_pretty(record).map_err(|error| FarmError::Request(format!("a record has no JSON form: {error}")))?;
    job.store.put(name, text)
}

/// The frames of a task that are to be made. Markers of payloads that are not whole are removed: none could be committed beside them.
fn missing_frames(job: &Job, task: &Task) -> Result<BTreeSet<u32>, FarmError> {
    let part = &task.part;
    let markers = names(job, &FrameKey::done_folder(&part.scene, &part.camera), 0)?;
    let mut missing = BTreeSet::new();
    for key in keys(task) {
        let is_marked = markers.contains(&key.marker());
        if is_marked && is_whole(&job.store, &key)? {
            continue;
        }
        if is_marked {
            job.store.remove(&key.marker())?;
        }
        missing.insert(key.frame);
    }
    Ok(missing)
}

/// Number of missing frames of each task that is not done, by the task's number: those without a marker or without any payload. All of
/// these are listed once, since a listing is what stores are slow at, and none is opened.
pub(crate) fn missing_by_task(job: &Job) -> Result<BTreeMap<u32, usize>, FarmError> {
    // In this order, since a frame that is committed meanwhile gets its payload first.
    let (markers, payloads) = (names(job, DONE, 1)?, names(job, FRAMES, 1)?);
    let has_payload = |start: String| payloads.range(start.clone()..).next().is_some_and(|name| name.starts_with(&start));
    let is_there = |key: &FrameKey| markers.contains(&key.marker()) && has_payload(key.payloads());
    let missing = job.plan.tasks.iter().map(|task| keys(task).filter(|key| !is_there(key)).count());
    Ok((0..).zip(missing).filter(|&(_, count)| count > 0).collect())
}

/// The objects below `folder` that have at least `least_bytes` bytes.
fn names(job: &Job, folder: &str, least_bytes: u64) -> Result<BTreeSet<String>, FarmError> {
    Ok(job.store.list(folder)?.into_iter().filter(|(_, bytes)| *bytes >= least_bytes).map(|(name, _)| name).collect())
}

/// The frames of a task.
fn keys(task: &Task) -> impl Iterator<Item = FrameKey> {
    let part = &task.part;
    part.frames.iter().map(move |&frame| FrameKey { scene: part.scene.clone(), camera: part.camera.clone(), frame })
}

/// Counts of the frames that an attempt has committed or lost.
#[derive(Default)]
struct Tally {
    committed: u32,
    lost: u32,
    different: u32,
    broken: BTreeMap<String, u32>,
}

impl Tally {
    fn count(&mut self, commit: Commit, broken: &[String]) {
        match commit {
            Commit::Won => {
                self.committed += 1;
                broken.iter().for_each(|law| *self.broken.entry(law.clone()).or_default() += 1);
            }
            Commit::Lost { same } => {
                self.lost += 1;
                self.different += u32::from(!same);
            }
        }
    }
}

/// Makes the missing frames of a task in a folder of its own, and hands each in as it is finished.
fn make(
    job: &Job,
    number: u32,
    missing: &BTreeSet<u32>,
    work: &Work,
    tally: &Mutex<Tally>,
    reporter: &dyn Reporter,
) -> Result<(), FarmError> {
    let planned = &job.task(number)?.part;
    let key = |frame: u32| FrameKey { scene: planned.scene.clone(), camera: planned.camera.clone(), frame };

    // Fetch what the scene needs
    let io = |source| FarmError::io("make a folder in", work.scratch, source);
    std::fs::create_dir_all(work.scratch).map_err(io)?;
    let folder = tempfile::Builder::new().prefix("work-").tempdir_in(work.scratch).map_err(io)?;
    let out = folder.path();
    for (path, file) in job.files_of(&planned.scene) {
        let cached = fetch(job, work, &file.blake3)?;
        place(&cached, &out.join(path))?;
    }

    // Frames that lack nothing but the user's program, and what earlier attempts kept of others
    let hand_in = |frame: &Finished| {
        let commit = hand_in(job, out, number, frame, &work.attempt.id, work.stop)?;
        tally.lock().unwrap_or_else(PoisonError::into_inner).count(commit, &frame.broken);
        Ok(())
    };
    let mut part = Part { frames: missing.clone(), ..planned.clone() };
    for &frame in missing {
        if !job.plan.farm.after_frame.is_empty()
            && let Some(finished) = Finished::kept(job, out, &key(frame))?
        {
            hand_in(&finished)?;
            part.frames.remove(&frame);
        } else if let Some(bytes) = job.store.get(&key(frame).kept())? {
            write_bytes(&kept_frame(out, &part.scene, &part.camera, frame)?, &bytes)?;
        }
    }
    if part.frames.is_empty() {
        return Ok(());
    }

    // Render; the first frame that cannot be handed in ends the work
    let failure = Mutex::new(None);
    let finished = |frame: &FinishedFrame| {
        let handed_in = Finished::read(out, key(frame.frame), frame).and_then(|frame| hand_in(&frame));
        handed_in.map_err(|error| {
            let told = enfilade_pipeline::Error::Stage(error.to_string().into());
            *failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            told
        })
    };
    let result = render_part(out, &part, work.stop, &finished, reporter);

    // Keep the frame in the making for the next attempt
    if let Err(enfilade_pipeline::Error::Interrupted { frame, kept, .. }) = &result {
        let bytes = std::fs::read(kept).map_err(|source| FarmError::io("read", kept, source))?;
        job.store.put(&key(*frame).kept(), bytes)?;
    }
    match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => Ok(result?),
    }
}

/// A content of the store in this machine's cache.
fn fetch(job: &Job, work: &Work, blake3: &str) -> Result<PathBuf, FarmError> {
    let cached = work.scratch.join("cache").join(blake3);
    let whole = |bytes: &[u8]| blake3::hash(bytes).to_hex().as_str() == blake3;
    if std::fs::read(&cached).is_ok_and(|bytes| whole(&bytes)) {
        return Ok(cached);
    }
    let name = object_name(blake3);
    let damaged = |problem: &str| damaged_object(job, &name, problem);
    let bytes = job.store.get(&name)?.ok_or_else(|| damaged("is missing"))?;
    if !whole(&bytes) {
        return Err(damaged("does not hold what its name says"));
    }
    // Several workers of a machine may fetch the same at once: each writes a file of its own.
    let aside = cached.with_added_extension(&work.attempt.id);
    write_bytes(&aside, &bytes)?;
    std::fs::rename(&aside, &cached).map_err(|source| FarmError::io("put in place", &cached, source))?;
    Ok(cached)
}

/// An object that the plan names is not what it should be; planning into the same place does not put it there again.
pub(crate) fn damaged_object(job: &Job, name: &str, problem: &str) -> FarmError {
    let problem = format!("{problem}; plan the job again, in another place");
    FarmError::Damaged { place: job.store.full_name(name), problem }
}

/// Puts a file of the cache into a worker's folder. It is copied, since a stage may write over it.
fn place(cached: &Path, path: &Path) -> Result<(), FarmError> {
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(|source| FarmError::io("make", parent, source))?;
    }
    std::fs::copy(cached, path).map(drop).map_err(|source| FarmError::io("copy to", path, source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_ranges;

    #[test]
    fn shards_hold_every_task_once() {
        for (count, shards) in [(10, 3), (2, 5), (0, 2), (7, 1)] {
            let all: Vec<u32> = (0..shards).flat_map(|i| Assignment::Shard(i, shards).tasks(count)).collect();
            assert_eq!(all, (0..count as u32).collect::<Vec<_>>());
        }
    }

    #[test]
    fn an_engines_index_counts_the_tasks_named() {
        let tasks = parse_ranges("0-2,7").unwrap();
        let nth = |name: &'static str, index: &'static str| Assignment::nth(&tasks, move |asked| (asked == name).then(|| index.into()));
        assert_eq!(nth("JOB_COMPLETION_INDEX", "3").unwrap(), Assignment::Tasks([7].into()));
        assert_eq!(nth("AWS_BATCH_JOB_ARRAY_INDEX", "1").unwrap(), Assignment::Tasks([1].into()));
        assert_eq!(nth("SLURM_ARRAY_TASK_ID", "3").unwrap(), Assignment::Tasks([0].into()));
        for wrong in ["4", "-1", "x"] {
            let error = nth("JOB_COMPLETION_INDEX", wrong).unwrap_err().to_string();
            assert!(error.contains("JOB_COMPLETION_INDEX") && error.contains("0 to 3"), "{error}");
        }
    }
}

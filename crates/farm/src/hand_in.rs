//! A finished frame on its way into the store: the files that the user's program adds, its commit, and the files that are kept if the
//! program fails.

use crate::bundle::{PackedFile, pack, read, unpacked};
use crate::commit::{Commit, commit, read_marker, read_marker_at};
use crate::program::{self, Failure};
use crate::{FarmError, FrameKey, Job, Marker};
use enfilade_dataset::{Dataset, FrameTime, remove_if_there, write_bytes};
use enfilade_pipeline::{FarmConfig, FinishedFrame, Placeholder};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Longest time for which a finished frame is kept while the store does not accept it: a server that is restarted is back by then.
const PATIENCE: Duration = Duration::from_secs(600);
/// Between two tries to hand it in.
const PAUSE: Duration = Duration::from_secs(5);

/// A frame that is finished but for what the user's program adds.
pub(crate) struct Finished {
    pub key: FrameKey,
    /// In the order in which they are to be written: records after what they vouch for.
    pub files: Vec<PackedFile>,
    /// Laws of verification that it breaks.
    pub broken: Vec<String>,
    pub time: FrameTime,
}

impl Finished {
    /// A frame in the worker's folder `out`. It is read now, so that no program can change it afterwards.
    pub fn read(out: &Path, key: FrameKey, frame: &FinishedFrame) -> Result<Self, FarmError> {
        let broken = frame.broken.iter().map(ToString::to_string).collect();
        Ok(Self { key, files: read(out, &frame.files)?, broken, time: frame.time })
    }

    /// The frame that an earlier attempt has kept because the user's program failed, put into the worker's folder `out`. `None` when there
    /// is none, or its files are not those that were kept: then the frame is rendered.
    pub fn kept(job: &Job, out: &Path, key: &FrameKey) -> Result<Option<Self>, FarmError> {
        let [marker, archive] = key.kept_finished();
        let marker = match read_marker_at(&job.store, &marker) {
            Ok(Some(marker)) => marker,
            Ok(None) | Err(FarmError::Damaged { .. }) => return Ok(None),
            Err(error) => return Err(error),
        };
        let Some(bytes) = job.store.get(&archive)? else { return Ok(None) };
        if marker.key != *key || blake3::hash(&bytes).to_hex().as_str() != marker.blake3 {
            return Ok(None);
        }
        let Ok(files) = unpacked(&bytes, &job.store.full_name(&archive)) else { return Ok(None) };
        files.iter().try_for_each(|(path, content)| write_bytes(&out.join(path), content))?;
        let time = marker.time();
        Ok(Some(Self { key: key.clone(), files, broken: marker.broken, time }))
    }

    /// Keeps it for the next attempt.
    fn keep(&self, job: &Job, task: u32, attempt: &str) -> Result<(), FarmError> {
        let [name, archive] = self.key.kept_finished();
        let bytes = pack(&self.files)?;
        let blake3 = blake3::hash(&bytes).to_hex().to_string();
        let marker = Marker { payload: archive.clone(), bytes: bytes.len() as u64, blake3, ..self.marker(task, attempt) };
        let text = serde_json::to_vec_pretty(&marker).map_err(|error| FarmError::Request(format!("a marker has no JSON form: {error}")))?;
        job.store.put(&archive, bytes)?;
        job.store.put(&name, text)
    }

    /// Marker of the task, which names no payload yet.
    fn marker(&self, task: u32, attempt: &str) -> Marker {
        Marker {
            key: self.key.clone(),
            payload: String::new(),
            bytes: 0,
            blake3: String::new(),
            attempt: attempt.into(),
            task,
            broken: self.broken.clone(),
            wall_s: self.time.wall_s,
            cpu_s: self.time.cpu_s,
            peak_memory_bytes: self.time.peak_memory_bytes,
            threads: self.time.threads,
            after_frame_wall_s: None,
        }
    }
}

impl Marker {
    /// The rendering time of the frame.
    pub(crate) fn time(&self) -> FrameTime {
        FrameTime { wall_s: self.wall_s, cpu_s: self.cpu_s, peak_memory_bytes: self.peak_memory_bytes, threads: self.threads }
    }
}

/// Runs the user's program on a frame of task `task`, commits it with what that has left, and frees its place in the worker's folder `out`.
///
/// `attempt` is the name of the worker's attempt; `stop` ends the program, and waiting for a store.
pub(crate) fn hand_in(job: &Job, out: &Path, task: u32, frame: &Finished, attempt: &str, stop: &AtomicBool) -> Result<Commit, FarmError> {
    let (dataset, farm, key) = (Dataset::create(out)?, &job.plan.farm, &frame.key);
    let begun = Instant::now();
    let added = run_program(farm, &dataset, key, stop).inspect_err(|_| {
        // The program's failure is the error to report; if the frame cannot be kept, it is rendered again.
        let _ = frame.keep(job, task, attempt);
    })?;
    let after_frame_wall_s = (!farm.after_frame.is_empty()).then(|| begun.elapsed().as_secs_f64());
    let marker = Marker { after_frame_wall_s, ..frame.marker(task, attempt) };
    // The record of the frame comes last: a frame that has one is whole.
    let payload = pack(&[added.as_slice(), &frame.files].concat())?;
    let done = patiently(stop, PAUSE, || {
        // Another worker may have been first while this frame was being made: then nothing has to be transferred.
        let done = match read_marker(&job.store, key)? {
            Some(there) if there.attempt == marker.attempt => Commit::Won,
            Some(there) => Commit::Lost { same: there.blake3 == blake3::hash(&payload).to_hex().to_string() },
            None => commit(&job.store, payload.clone(), marker.clone())?,
        };
        job.store.remove(&key.kept())?;
        if !farm.after_frame.is_empty() {
            key.kept_finished().iter().try_for_each(|name| job.store.remove(name))?;
        }
        Ok(done)
    })?;
    frame.files.iter().try_for_each(|(path, _)| remove_if_there(&out.join(path)))?;
    dataset.remove_after_frame(&key.scene, &key.camera, key.frame)?;
    Ok(done)
}

/// Runs the user's program on a frame, if there is one; the files that it has left.
fn run_program(farm: &FarmConfig, dataset: &Dataset, key: &FrameKey, stop: &AtomicBool) -> Result<Vec<PackedFile>, FarmError> {
    if farm.after_frame.is_empty() {
        return Ok(Vec::new());
    }
    let FrameKey { scene, camera, frame } = key;
    let out = std::path::absolute(dataset.root()).map_err(|source| FarmError::io("find", dataset.root(), source))?;
    let made = std::path::absolute(dataset.begin_after_frame(scene, camera, *frame)?);
    let made = made.map_err(|source| FarmError::io("find", dataset.root(), source))?;
    let fill = |placeholder| match placeholder {
        Placeholder::FrameDir => out.clone().into_os_string(),
        Placeholder::OutDir => made.clone().into_os_string(),
        Placeholder::Scene => OsString::from(scene),
        Placeholder::Camera => OsString::from(camera),
        Placeholder::Frame => format!("{frame:04}").into(),
    };
    let Some((name, arguments)) = farm.command(fill) else { return Ok(Vec::new()) };
    let failed = |problem: String, is_transient: bool| {
        let place = format!("frame {frame} of {scene}/{camera}");
        FarmError::Program { program: name.into(), place, problem, is_transient }
    };
    let limit = Duration::try_from_secs_f64(farm.after_frame_timeout_s).unwrap_or(Duration::MAX);
    program::run(name, &arguments, &made, limit, stop).map_err(|Failure { problem, is_transient }| failed(problem, is_transient))?;
    let files = dataset
        .after_frame_files(scene, camera, *frame)
        .map_err(|error| failed(format!("has left what cannot be kept: {error}"), false))?;
    let files: Vec<PathBuf> = files.iter().map(|path| path.strip_prefix(dataset.root()).unwrap_or(path).into()).collect();
    read(dataset.root(), &files)
}

/// Does `act`, and again after a `pause` while it fails for no lasting reason, up to [`PATIENCE`] or until `stop`.
fn patiently<T>(stop: &AtomicBool, pause: Duration, mut act: impl FnMut() -> Result<T, FarmError>) -> Result<T, FarmError> {
    let begun = Instant::now();
    loop {
        let result = act();
        let again = result.as_ref().is_err_and(FarmError::is_transient) && begun.elapsed() < PATIENCE;
        if !again || stop.load(Ordering::Relaxed) {
            return result;
        }
        std::thread::sleep(pause);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finished_frame_outlasts_a_store_that_is_away_for_a_while() {
        let tries = |answers: &[Option<FarmError>], stop: bool| {
            let mut tried = 0;
            let result = patiently(&AtomicBool::new(stop), Duration::ZERO, || {
                tried += 1;
                match &answers[tried - 1] {
                    Some(FarmError::Io { action, path, source }) => Err(FarmError::io(action, path, source.kind().into())),
                    Some(error) => Err(FarmError::Request(error.to_string())),
                    None => Ok(()),
                }
            });
            (tried, result.is_ok())
        };
        let away = || Some(FarmError::io("write", Path::new("job/done"), std::io::ErrorKind::StaleNetworkFileHandle.into()));
        assert_eq!(tries(&[away(), away(), None], false), (3, true));
        assert_eq!(tries(&[away(), None], true), (1, false), "who asks it to end is heard");
        assert_eq!(tries(&[Some(FarmError::Request("no such task".into())), None], false), (1, false));
    }

    #[test]
    #[cfg(unix)]
    fn what_a_program_leaves_is_taken_and_what_it_leaves_of_other_kinds_is_its_failure() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let key = FrameKey { scene: "room".into(), camera: "cam_00".into(), frame: 7 };
        let run = |words: &[&str]| {
            let farm = FarmConfig { after_frame: words.iter().map(ToString::to_string).collect(), ..FarmConfig::default() };
            run_program(&farm, &dataset, &key, &AtomicBool::new(false))
        };
        let files =
            run(&["sh", "-c", "echo \"$1 in ${2##*/}\" >\"$3/told.txt\"", "x", "{scene} {camera} {frame}", "{out_dir}", "{out_dir}"])
                .unwrap();
        let path = PathBuf::from("scenes/room/_detail/cam_00/after_frame/frame.0007/told.txt");
        assert_eq!(files, [(path, b"room cam_00 0007 in frame.0007\n".to_vec())]);
        let files = run(&["sh", "-c", "[ -d \"$0/scenes\" ]", "{frame_dir}"]).unwrap();
        assert!(files.is_empty(), "what was there is not there again");
        let error = run(&["sh", "-c", "ln -s /etc/hostname host"]).unwrap_err();
        assert!(!error.is_transient() && error.to_string().contains("host cannot be stored: it is a link"), "{error}");
        let error = run(&["sh", "-c", "echo lost >&2; exit 9"]).unwrap_err().to_string();
        let expected = "after_frame: \"sh\" ended with exit code 9; expected 0; it said last:\nlost\n(frame 7 of room/cam_00 is kept";
        assert!(error.starts_with(expected), "{error}");
        assert!(run(&[]).unwrap().is_empty());
    }
}

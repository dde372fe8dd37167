//! Commits of frames: a frame becomes part of the result by a marker that only one attempt can create.

use crate::object_names::{DONE, FRAMES, KEPT};
use crate::{Created, FarmError, Store};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Duration;

/// Number of reads of a marker that exists but cannot be read yet, and the pause before each further read.
const READ_BACKS: u32 = 6;
const READ_BACK_PAUSE: Duration = Duration::from_millis(200);

/// Environment variables in which engines identify what they have started. They are copied into records, so that these can be joined to the
/// engine's own.
const ENGINE_VARIABLES: [&str; 14] = [
    "SLURM_JOB_ID",
    "SLURM_ARRAY_JOB_ID",
    "SLURM_ARRAY_TASK_ID",
    "SLURM_RESTART_COUNT",
    "SLURMD_NODENAME",
    "SLURM_CLUSTER_NAME",
    "JOB_COMPLETION_INDEX",
    "AWS_BATCH_JOB_ID",
    "AWS_BATCH_JOB_ARRAY_INDEX",
    "AWS_BATCH_JOB_ATTEMPT",
    "HQ_JOB_ID",
    "HQ_TASK_ID",
    "HQ_INSTANCE_ID",
    "OPENJD_SESSION_ID",
];

/// A frame of the job.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct FrameKey {
    /// Scene name.
    pub scene: String,
    /// Trajectory name.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
}

impl FrameKey {
    /// The folder of a trajectory's markers.
    pub(crate) fn done_folder(scene: &str, camera: &str) -> String {
        format!("{DONE}/{scene}/{camera}")
    }

    pub(crate) fn marker(&self) -> String {
        format!("{}/{:04}.json", Self::done_folder(&self.scene, &self.camera), self.frame)
    }

    /// Name of the object with the partly rendered frame that was kept for another worker.
    pub(crate) fn kept(&self) -> String {
        format!("{KEPT}/{}/{}/{:04}.partial", self.scene, self.camera, self.frame)
    }

    /// Names of the objects with the kept frame that was finished except for the user's program: a marker, and the files that it names.
    pub(crate) fn kept_finished(&self) -> [String; 2] {
        ["json", "tar"].map(|end| format!("{KEPT}/{}/{}/{:04}.{end}", self.scene, self.camera, self.frame))
    }

    /// Prefix of the names of its payloads, whoever made them.
    pub(crate) fn payloads(&self) -> String {
        format!("{FRAMES}/{}/{}/{:04}.", self.scene, self.camera, self.frame)
    }

    fn payload(&self, attempt: &str) -> String {
        format!("{}{attempt}.tar", self.payloads())
    }
}

/// One worker at work on one assignment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attempt {
    /// Unique identifier of the attempt.
    pub id: String,
    /// Name of the machine.
    pub host: String,
    /// The engine's environment variables, by name.
    pub engine: BTreeMap<String, String>,
}

impl Attempt {
    /// The attempt of this process on this machine; Slurm's name for the machine wins over its own.
    pub fn here() -> Self {
        let variable = |name: &str| std::env::var(name).ok();
        let host = variable("SLURMD_NODENAME").or_else(|| std::fs::read_to_string("/proc/sys/kernel/hostname").ok());
        Self::new(host.as_deref().map_or("node", str::trim), variable)
    }

    /// The attempt of this process, on machine `host`, started by the engine that `environment` identifies.
    pub fn new(host: &str, environment: impl Fn(&str) -> Option<String>) -> Self {
        let mut unique = [0; 6];
        // Without random numbers of the system, the process id and the clock's nanoseconds distinguish attempts.
        if getrandom::fill(&mut unique).is_err() {
            let nanoseconds = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |time| time.subsec_nanos());
            unique[..4].copy_from_slice(&nanoseconds.to_le_bytes());
        }
        let host: String = host.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' }).collect();
        let unique: String = unique.iter().map(|byte| format!("{byte:02x}")).collect();
        let engine = ENGINE_VARIABLES.iter().filter_map(|&name| Some((name.to_string(), environment(name)?))).collect();
        Self { id: format!("{host}-{}-{unique}", std::process::id()), host, engine }
    }
}

/// The record that a frame is done, and where its files are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// The frame.
    #[serde(flatten)]
    pub key: FrameKey,
    /// Name of the object with its files.
    pub payload: String,
    /// Length of that object.
    pub bytes: u64,
    /// BLAKE3 of that object.
    pub blake3: String,
    /// The attempt that made it.
    pub attempt: String,
    /// Number of its task.
    pub task: u32,
    /// Laws of verification that it breaks; normally none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub broken: Vec<String>,
    /// Elapsed seconds.
    pub wall_s: f64,
    /// Seconds of all threads together.
    pub cpu_s: f64,
    /// Peak memory of the process until then.
    pub peak_memory_bytes: Option<u64>,
    /// Threads at work.
    pub threads: Option<u32>,
    /// Elapsed seconds of the user's program, where one was run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after_frame_wall_s: Option<f64>,
}

/// The result of a commit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Commit {
    /// The frame is this attempt's.
    Won,
    /// Another attempt was first.
    Lost {
        /// True when it made the same bytes, as it should.
        same: bool,
    },
}

/// The marker of a frame, if it is done.
pub(crate) fn read_marker(store: &Store, key: &FrameKey) -> Result<Option<Marker>, FarmError> {
    read_marker_at(store, &key.marker())
}

/// The marker of a name.
pub(crate) fn read_marker_at(store: &Store, name: &str) -> Result<Option<Marker>, FarmError> {
    let Some(bytes) = store.get(name)? else { return Ok(None) };
    let marker = serde_json::from_slice(&bytes);
    marker.map(Some).map_err(|error| FarmError::Damaged {
        place: store.full_name(name),
        problem: format!("{error}; remove it and do its task again, which makes the frame again"),
    })
}

/// Whether the object that a frame's marker names exists and has the recorded length. A marker that cannot be read names nothing.
pub(crate) fn is_whole(store: &Store, key: &FrameKey) -> Result<bool, FarmError> {
    match read_marker(store, key) {
        Ok(Some(marker)) => Ok(store.size(&marker.payload)? == Some(marker.bytes)),
        Ok(None) | Err(FarmError::Damaged { .. }) => Ok(false),
        Err(error) => Err(error),
    }
}

/// Puts a frame's files into the store, and then its marker. `marker` names no payload yet.
pub(crate) fn commit(store: &Store, payload: Vec<u8>, marker: Marker) -> Result<Commit, FarmError> {
    let name = marker.key.payload(&marker.attempt);
    let marker =
        Marker { payload: name.clone(), bytes: payload.len() as u64, blake3: blake3::hash(&payload).to_hex().to_string(), ..marker };
    let text = serde_json::to_vec_pretty(&marker).map_err(|error| FarmError::Request(format!("a marker has no JSON form: {error}")))?;
    store.put(&name, payload)?;
    for _ in 0..READ_BACKS {
        if store.create(&marker.key.marker(), &text)? == Created::Yes {
            return Ok(Commit::Won);
        }
        // Taken, perhaps by this attempt itself, where the store's answer to an earlier request was lost.
        match read_marker(store, &marker.key)? {
            Some(there) if there.attempt == marker.attempt => return Ok(Commit::Won),
            Some(there) => return Ok(Commit::Lost { same: there.blake3 == marker.blake3 }),
            None => std::thread::sleep(READ_BACK_PAUSE),
        }
    }
    let problem = "is said to be there, and cannot be read".to_string();
    Err(FarmError::Unreliable { place: format!("{}/{}", store.url(), marker.key.marker()), problem })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marker(attempt: &str) -> Marker {
        Marker {
            key: FrameKey { scene: "room".into(), camera: "cam_00".into(), frame: 3 },
            payload: String::new(),
            bytes: 0,
            blake3: String::new(),
            attempt: attempt.into(),
            task: 0,
            broken: Vec::new(),
            wall_s: 1.0,
            cpu_s: 2.0,
            peak_memory_bytes: None,
            threads: Some(2),
            after_frame_wall_s: None,
        }
    }

    #[test]
    fn of_two_attempts_the_first_wins_and_the_other_learns_whether_it_made_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path().to_str().unwrap(), std::iter::empty()).unwrap();
        assert_eq!(commit(&store, b"bytes".to_vec(), marker("a")).unwrap(), Commit::Won);
        assert_eq!(commit(&store, b"bytes".to_vec(), marker("b")).unwrap(), Commit::Lost { same: true });
        assert_eq!(commit(&store, b"other".to_vec(), marker("c")).unwrap(), Commit::Lost { same: false });
        // The answer to the first request was lost, and the attempt tries again.
        assert_eq!(commit(&store, b"bytes".to_vec(), marker("a")).unwrap(), Commit::Won);
        let there = read_marker(&store, &marker("x").key).unwrap().unwrap();
        assert_eq!(store.get(&there.payload).unwrap().unwrap(), b"bytes");
        assert_eq!((there.attempt.as_str(), there.bytes), ("a", 5));
    }

    #[test]
    fn a_marker_counts_while_its_payload_is_there_and_as_long_as_it_says() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path().to_str().unwrap(), std::iter::empty()).unwrap();
        let key = marker("a").key;
        assert!(!is_whole(&store, &key).unwrap());
        commit(&store, b"bytes".to_vec(), marker("a")).unwrap();
        assert!(is_whole(&store, &key).unwrap());
        store.put(&key.payload("a"), b"byte".to_vec()).unwrap();
        assert!(!is_whole(&store, &key).unwrap());
        store.remove(&key.payload("a")).unwrap();
        assert!(!is_whole(&store, &key).unwrap());
        store.put(&key.marker(), b"{".to_vec()).unwrap();
        assert!(!is_whole(&store, &key).unwrap());
    }

    #[test]
    fn attempts_have_names_of_their_own_and_know_their_engine() {
        let slurm = |name: &str| (name == "SLURM_JOB_ID").then(|| "17".to_string());
        let (a, b) = (Attempt::new("node 1", slurm), Attempt::new("node 1", slurm));
        assert!(a.id != b.id && a.id.starts_with("node-1-"), "{a:?}");
        assert_eq!(a.engine, BTreeMap::from([("SLURM_JOB_ID".to_string(), "17".to_string())]));
    }
}

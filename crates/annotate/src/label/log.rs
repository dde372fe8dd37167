//! The log of edits: one line of JSON each, appended and brought to the disk before an edit counts.
//!
//! The first line says which scene the log is about and which labels it began with. The state is what follows from doing the rest in
//! order, so nothing is lost when the program dies; a last line that was cut short is dropped.

use super::source::Source;
use enfilade_dataset::{MeshFiles, number_runs};
use enfilade_scene::PartLabel;
use serde::{Deserialize, Serialize};
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Its name in the folder of labels.
pub const LOG: &str = enfilade_dataset::ANNOTATION_LOG;
const FORMAT: &str = "enfilade annotation log 1";

/// The first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Header {
    format: String,
    scene: String,
    /// That of [`enfilade_dataset::scene_hash`].
    scene_hash: String,
    parts: usize,
    faces: usize,
    initial_semantic: Vec<i16>,
    initial_instance: Vec<i16>,
}

/// A line after the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// From 1, one more with each line.
    pub revision: u64,
    /// When, in UTC.
    pub time: String,
    /// Who asked for it.
    pub client: String,
    /// What they call it, by which it is known when it comes again. Edits that came without have none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// What was done.
    pub edit: Edit,
}

/// What was done, with everything that it takes to do it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Edit {
    /// Pieces got labels.
    Label {
        /// For people.
        description: String,
        /// Which.
        pieces: Vec<u32>,
        /// The class of each from now on.
        semantic: Vec<i16>,
        /// The instance of each from now on.
        instance: Vec<i16>,
        /// Instance numbers from here on are free.
        next_instance: i32,
    },
    /// Faces became pieces of their own.
    Split {
        /// For people.
        description: String,
        /// The piece they were taken from.
        piece: u32,
        /// Names of the new ones.
        names: Vec<String>,
        /// Their faces, as runs of first number and count.
        faces: Vec<Vec<[u32; 2]>>,
    },
    /// The last edit that was not undone was undone.
    Undo,
    /// The last edit that was undone was done again.
    Redo,
}

impl Edit {
    /// What was done, for people.
    pub fn description(&self) -> &str {
        match self {
            Self::Label { description, .. } | Self::Split { description, .. } => description,
            Self::Undo => "Undo",
            Self::Redo => "Redo",
        }
    }
}

/// Why there is no log to go on with.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The file cannot be read or written.
    #[error("cannot {action} {}: {source}; check that the folder can be written, or name another with --labels", path.display())]
    Io {
        /// "read", "write" or "lock".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Another program has it open.
    #[error("{} is in use: somebody annotates this scene already; open that page, or end that program", .0.display())]
    InUse(PathBuf),
    /// It is about another scene.
    #[error(
        "{} is about another scene ({log}; here {scene}); name another folder with --labels, or move the log away to begin anew", path.display()
    )]
    OtherScene {
        /// The file.
        path: PathBuf,
        /// What it says.
        log: String,
        /// What is here.
        scene: String,
    },
    /// A line makes no sense.
    #[error("{}:{line}: {problem}; remove this line and those after it to go on from there, or bring back a copy", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// What is wrong with it.
        problem: String,
    },
}

/// An open log, locked for this program.
pub struct Log {
    path: PathBuf,
    file: File,
    /// Length of what is known to be good, bytes.
    length: u64,
}

/// What stands in a log.
pub struct Recorded {
    /// The labels that the parts began with.
    pub initial: Vec<PartLabel>,
    /// The edits in order.
    pub entries: Vec<Entry>,
    /// What was dropped, if anything.
    pub warning: Option<String>,
}

impl Log {
    /// Opens the log in `folder`, or begins one with the labels that the source comes with. One in which nothing was done begins
    /// anew: the scene may have got its labels since somebody looked at it.
    ///
    /// # Errors
    /// When the file cannot be had, is about another scene, or has a line that makes no sense.
    pub fn open(folder: &Path, source: &Source) -> Result<(Self, Recorded), LogError> {
        let path = folder.join(LOG);
        let at = &folder.join(LOG);
        let io = |action| move |source| LogError::Io { action, path: at.clone(), source };
        std::fs::create_dir_all(folder).map_err(io("write"))?;
        let mut file = File::options().create(true).truncate(false).read(true).write(true).open(&path).map_err(io("write"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(LogError::InUse(path)),
            // Some network file systems know no locks.
            Err(TryLockError::Error(e)) if e.kind() == std::io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(io("lock")(e)),
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(io("read"))?;
        let whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
        let mut warning = None;
        if whole < bytes.len() {
            warning = Some(format!("{}: the last line was cut short and is dropped", path.display()));
        }
        let mut log = Self { path, file, length: whole as u64 };
        let (initial, entries) = if whole == 0 { (Vec::new(), Vec::new()) } else { log.parse(&bytes[..whole], source)? };
        if entries.is_empty() {
            log.length = 0;
            log.begin(source)?;
            return Ok((log, Recorded { initial: source.labels.clone(), entries, warning }));
        }
        log.file.set_len(whole as u64).map_err(io("write"))?;
        Ok((log, Recorded { initial, entries, warning }))
    }

    /// Writes the first line.
    fn begin(&mut self, source: &Source) -> Result<(), LogError> {
        let header = Header {
            format: FORMAT.into(),
            scene: source.name.clone(),
            scene_hash: source.hash(),
            parts: source.parts.len(),
            faces: source.corners.len(),
            initial_semantic: source.labels.iter().map(|l| l.semantic).collect(),
            initial_instance: source.labels.iter().map(|l| l.instance).collect(),
        };
        self.write_line(&header).map_err(|source| LogError::Io { action: "write", path: self.path.clone(), source })
    }

    fn parse(&self, bytes: &[u8], source: &Source) -> Result<(Vec<PartLabel>, Vec<Entry>), LogError> {
        let wrong = |line: usize, problem: String| LogError::Line { path: self.path.clone(), line, problem };
        let mut lines = bytes.strip_suffix(b"\n").unwrap_or(bytes).split(|&b| b == b'\n').peekable();
        let first = lines.next().unwrap_or_default();
        let header: Header = serde_json::from_slice(first).map_err(|e| wrong(1, format!("not the beginning of a log: {e}")))?;
        if header.format != FORMAT {
            return Err(wrong(1, format!("the format is {:?}, expected {FORMAT:?}", header.format)));
        }
        if lines.peek().is_none() {
            return Ok((Vec::new(), Vec::new()));
        }
        if header.scene_hash != source.hash() {
            let describe = |name: &str, parts: usize, faces: usize| format!("{name:?} of {parts} parts and {faces} faces");
            return Err(LogError::OtherScene {
                path: self.path.clone(),
                log: describe(&header.scene, header.parts, header.faces),
                scene: describe(&source.name, source.parts.len(), source.corners.len()),
            });
        }
        let (semantic, instance) = (header.initial_semantic, header.initial_instance);
        if semantic.len() != source.parts.len() || instance.len() != source.parts.len() {
            return Err(wrong(1, format!("labels of {} parts, expected {}", semantic.len(), source.parts.len())));
        }
        let initial = semantic.into_iter().zip(instance).map(|(semantic, instance)| PartLabel { semantic, instance }).collect();
        let mut entries = Vec::new();
        for (i, line) in lines.enumerate() {
            let entry: Entry = serde_json::from_slice(line).map_err(|e| wrong(i + 2, e.to_string()))?;
            if entry.revision != i as u64 + 1 {
                return Err(wrong(i + 2, format!("revision {}, expected {}", entry.revision, i + 1)));
            }
            entries.push(entry);
        }
        Ok((initial, entries))
    }

    /// The problem of the entry with this revision.
    pub fn problem(&self, revision: u64, problem: String) -> LogError {
        LogError::Line { path: self.path.clone(), line: revision as usize + 1, problem }
    }

    /// Appends an edit. When this returns it is on the disk; when it fails the log is as it was.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn append(&mut self, entry: &Entry) -> Result<(), LogError> {
        self.write_line(entry).map_err(|source| {
            let _ = self.file.set_len(self.length); // the first error is the one to tell; a torn line is dropped when it is read
            LogError::Io { action: "write", path: self.path.clone(), source }
        })
    }

    fn write_line(&mut self, value: &impl Serialize) -> std::io::Result<()> {
        let mut line = serde_json::to_vec(value)?;
        line.push(b'\n');
        self.file.set_len(self.length)?;
        self.file.seek(SeekFrom::Start(self.length))?;
        self.file.write_all(&line)?;
        self.file.sync_data()?;
        self.length += line.len() as u64;
        Ok(())
    }
}

/// The object of every face of a mesh folder before any was split, and how many objects there were; `None` where none was, or
/// where the log in the folder does not tell.
///
/// The folder's tables say so too, but they are written one after the other: when the program dies meanwhile they do not fit.
pub fn unsplit(files: &MeshFiles) -> Option<(usize, Vec<u32>)> {
    let bytes = std::fs::read(files.file(LOG)).ok()?;
    let mut lines = bytes.split(|&b| b == b'\n');
    let whole = serde_json::from_slice::<Header>(lines.next()?).ok()?.parts;
    let split = |line: &[u8]| match serde_json::from_slice::<Entry>(line).ok()?.edit {
        Edit::Split { piece, faces, .. } => Some((piece, faces)),
        _ => None,
    };
    let splits: Vec<_> = lines.filter_map(split).collect();
    if splits.is_empty() {
        return None;
    }
    let mut object_of_face = files.read_objects_of_faces().ok()?;
    let end = object_of_face.len();
    // The faces of a piece were split off an object before, so what became of pieces tells nothing new.
    for (object, groups) in splits.iter().filter(|(piece, _)| (*piece as usize) < whole) {
        for face in groups.iter().filter_map(|runs| numbers(runs, end)).flatten() {
            let now = &mut object_of_face[face as usize];
            *now = if *now as usize >= whole { *object } else { *now };
        }
    }
    object_of_face.iter().all(|&object| (object as usize) < whole).then_some((whole, object_of_face))
}

/// Ascending numbers as runs of first number and count.
pub fn runs(numbers: &[u32]) -> Vec<[u32; 2]> {
    number_runs(numbers.iter().copied()).iter().map(|run| [*run.start(), run.end() - run.start() + 1]).collect()
}

/// The numbers of runs that lie below `end`; `None` when a run goes beyond it.
pub fn numbers(runs: &[[u32; 2]], end: usize) -> Option<Vec<u32>> {
    let inside = |[first, count]: &[u32; 2]| u64::from(*first) + u64::from(*count) <= end as u64;
    runs.iter().all(inside).then(|| runs.iter().flat_map(|&[first, count]| first..first + count).collect())
}

//! The log of edits: one line of JSON for each edit, appended and flushed to disk before the edit counts.
//!
//! The current labels are what results from replaying the log, so nothing is lost when the program is killed. An incomplete last line
//! is dropped.

use super::json_lines::JsonLines;
use super::scene::AnnotatedScene;
use enfilade_dataset::ANNOTATION_LOG;
use enfilade_label::annotation::{AnnotationError, Entry, FORMAT, FORMAT_OF_PEOPLE, Header, LogProblem, parse};
use enfilade_scene::PartLabel;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

/// Why the log cannot be opened or written.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The file cannot be read or written.
    #[error("cannot {action} {}: {source}; check that the folder can be written, or name another with --labels", path.display())]
    Io {
        /// "read", "write" or "lock".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: std::io::Error,
    },
    /// Another program has it open.
    #[error("{} is in use: somebody annotates this scene already; open that page, or end that program", .0.display())]
    InUse(PathBuf),
    /// The log is about another scene.
    #[error(
        "{} is about another scene ({log}; here {scene}); --carry {} takes its labels along, by names and shapes of parts; or name another \
         folder with --labels, or move the log away to start again",
        path.display(),
        path.parent().unwrap_or(path).display()
    )]
    OtherScene {
        /// The file.
        path: PathBuf,
        /// The scene that it is about.
        log: String,
        /// This scene.
        scene: String,
    },
    /// The log is of another form, which a newer program may have written, or a line is not valid: nothing in it is to be lost.
    #[error("{0}; or name another folder with --labels")]
    Content(#[from] AnnotationError),
}

/// An open log, locked for this program.
pub struct Log {
    path: PathBuf,
    lines: JsonLines,
}

/// Contents of a log.
pub struct Recorded {
    /// The labels that the parts began with.
    pub initial: Vec<PartLabel>,
    /// The edits in order.
    pub entries: Vec<Entry>,
    /// Description of dropped data, if any.
    pub warning: Option<String>,
}

impl Log {
    /// Opens the log in `folder`, or begins one with the labels that the scene comes with. A log without edits is begun again, because
    /// the scene may have got labels since it was last opened.
    ///
    /// # Errors
    /// When the file cannot be opened or locked, is about another scene, or has an invalid line.
    pub fn open(folder: &Path, scene: &AnnotatedScene) -> Result<(Self, Recorded), LogError> {
        let path = folder.join(ANNOTATION_LOG);
        let at = &folder.join(ANNOTATION_LOG);
        let io = |action| move |source| LogError::Io { action, path: at.clone(), source };
        std::fs::create_dir_all(folder).map_err(io("write"))?;
        let file = File::options().create(true).truncate(false).read(true).write(true).open(&path).map_err(io("write"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(LogError::InUse(path)),
            // Some network file systems know no locks.
            Err(TryLockError::Error(e)) if e.kind() == std::io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(e)) => return Err(io("lock")(e)),
        }
        let (lines, bytes, was_cut) = JsonLines::read(file).map_err(io("read"))?;
        let warning = was_cut.then(|| format!("{}: the last line was cut short and is dropped", path.display()));
        let mut log = Self { path, lines };
        let (initial, entries) = if bytes.is_empty() { (Vec::new(), Vec::new()) } else { log.parse(&bytes, scene)? };
        if entries.is_empty() {
            log.lines.clear();
            log.begin(scene)?;
            return Ok((log, Recorded { initial: scene.labels.clone(), entries, warning }));
        }
        log.lines.drop_incomplete().map_err(io("write"))?;
        Ok((log, Recorded { initial, entries, warning }))
    }

    /// Writes the first line.
    fn begin(&mut self, scene: &AnnotatedScene) -> Result<(), LogError> {
        let header = Header {
            format: FORMAT.into(),
            scene: scene.name.clone(),
            scene_hash: scene.hash(),
            parts: scene.parts.len(),
            faces: scene.corners.len(),
            initial_semantic: scene.labels.iter().map(|l| l.semantic).collect(),
            initial_instance: scene.labels.iter().map(|l| l.instance).collect(),
        };
        self.lines.append(&header).map_err(|source| LogError::Io { action: "write", path: self.path.clone(), source })
    }

    fn parse(&self, bytes: &[u8], scene: &AnnotatedScene) -> Result<(Vec<PartLabel>, Vec<Entry>), LogError> {
        let Some((header, entries)) = parse(bytes).map_err(|problem| AnnotationError::at(&self.path, problem))? else {
            return Ok((Vec::new(), Vec::new()));
        };
        if !entries.is_empty() && header.scene_hash != scene.hash() {
            let describe = |name: &str, parts: usize, faces: usize| format!("{name:?} of {parts} parts and {faces} faces");
            return Err(LogError::OtherScene {
                path: self.path.clone(),
                log: describe(&header.scene, header.parts, header.faces),
                scene: describe(&scene.name, scene.parts.len(), scene.corners.len()),
            });
        }
        let (semantic, instance) = (header.initial_semantic, header.initial_instance);
        let initial = semantic.into_iter().zip(instance).map(|(semantic, instance)| PartLabel { semantic, instance }).collect();
        Ok((initial, entries))
    }

    /// The problem of the entry with this revision.
    pub fn problem(&self, revision: u64, problem: String) -> LogError {
        AnnotationError::at(&self.path, LogProblem::of_edit(revision, problem)).into()
    }

    /// Appends an edit. On success it is on the disk; on failure the log is unchanged.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn append(&mut self, entry: &Entry) -> Result<(), LogError> {
        let io = |source| LogError::Io { action: "write", path: self.path.clone(), source };
        if entry.edit.is_of_people() {
            // Programs that do not know such edits then refuse the log for its format.
            self.lines.replace_in_first(FORMAT, FORMAT_OF_PEOPLE).map_err(io)?;
        }
        self.lines.append(entry).map_err(io)
    }
}

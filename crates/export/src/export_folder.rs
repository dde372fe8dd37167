//! The folder of an export: it grows under another name beside the target, and is renamed when everything is written.

use crate::selected_frames::SelectedFrames;
use crate::{ExportError, Format};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// What to do with a folder that is at the target and is no export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// The folder stays, and nothing is exported.
    Refuse,
    /// The folder is renamed to `<name>.old`.
    SetAside,
}

/// The result of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Frames of the dataset that are in it.
    pub frames: usize,
    /// Files, the record and the page for people included.
    pub files: usize,
    /// Bytes of these files.
    pub bytes: u64,
}

/// Last file of an export, and the sign by which one is known.
const RECORD: &str = "enfilade_export.json";

/// Format recorded in [`RECORD`].
const RECORD_FORMAT: &str = "enfilade export 1";

#[derive(Serialize, Deserialize)]
struct Record {
    kind: String,
    format: String,
    enfilade_version: String,
    files: usize,
    bytes: u64,
    /// Frame numbers by scene and camera.
    frames: BTreeMap<String, BTreeMap<String, Vec<u32>>>,
}

/// The folder in the making; it is removed unless the export is finished.
pub(crate) struct ExportFolder {
    target: PathBuf,
    aside: PathBuf,
    existing: Existing,
    files: AtomicUsize,
    bytes: AtomicU64,
    /// Text in front of the page for people.
    front_matter: OnceLock<String>,
    /// The page for people, where it is not the format's usual one.
    page: OnceLock<&'static str>,
}

impl ExportFolder {
    /// Makes the folder in which the export grows, and removes one that an interrupted export left.
    pub fn prepare(target: &Path, dataset: &Path, existing: Existing) -> Result<Self, ExportError> {
        check_apart(target, dataset)?;
        if is_taken(target) && existing == Existing::Refuse && !is_export(target) {
            let problem = "it exists and is no export; choose another folder, or move what is there to NAME.old with --force";
            return Err(ExportError::Place { path: target.into(), problem: problem.into() });
        }
        let aside = beside(target, ".", ".partial")?;
        remove(&aside)?;
        fs::create_dir_all(&aside).map_err(ExportError::at("create the folder", &aside))?;
        Ok(Self {
            target: target.into(),
            aside,
            existing,
            files: AtomicUsize::new(0),
            bytes: AtomicU64::new(0),
            front_matter: OnceLock::new(),
            page: OnceLock::new(),
        })
    }

    /// Writes a file; `name` has forward slashes.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        let path = self.path(name)?;
        fs::write(&path, bytes).map_err(ExportError::at("write", &path))?;
        self.count(bytes.len() as u64);
        Ok(())
    }

    /// Writes a value as JSON with line breaks.
    pub fn write_json(&self, name: &str, value: &impl Serialize) -> Result<(), ExportError> {
        let mut text = serde_json::to_string_pretty(value).expect("plain data encodes");
        text.push('\n');
        self.write(name, text.as_bytes())
    }

    /// Path of a file until the export is finished; its folder is created.
    pub fn path(&self, name: &str) -> Result<PathBuf, ExportError> {
        let path = self.aside.join(name);
        let parent = path.parent().unwrap_or(&self.aside);
        fs::create_dir_all(parent).map_err(ExportError::at("create the folder", parent))?;
        Ok(path)
    }

    /// Takes note of a file that was written at [`ExportFolder::path`].
    pub fn count(&self, bytes: u64) {
        self.files.fetch_add(1, Ordering::Relaxed);
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
    }

    /// Puts data for programs before the page for people.
    pub fn set_front_matter(&self, text: String) {
        self.front_matter.get_or_init(|| text);
    }

    /// Puts another page for people in the place of the format's own.
    pub fn set_page(&self, page: &'static str) {
        self.page.get_or_init(|| page);
    }

    /// Adds the page for people and the record, and puts the export in its place.
    pub fn finish(self, format: Format, selected: &SelectedFrames<'_>) -> Result<Exported, ExportError> {
        let front_matter = self.front_matter.get().map_or("", String::as_str);
        self.write("README.md", [front_matter, self.page.get().copied().unwrap_or(format.spec().readme)].concat().as_bytes())?;
        let mut frames: BTreeMap<String, BTreeMap<String, Vec<u32>>> = BTreeMap::new();
        for view in selected.views() {
            frames.entry(view.track.scene.clone()).or_default().entry(view.track.name.clone()).or_default().push(view.frame());
        }
        let (files, bytes) = (self.files.load(Ordering::Relaxed), self.bytes.load(Ordering::Relaxed));
        let (kind, enfilade_version) = (RECORD_FORMAT.to_string(), env!("CARGO_PKG_VERSION").to_string());
        self.write_json(RECORD, &Record { kind, format: format.spec().name.into(), enfilade_version, files, bytes, frames })?;
        self.take_place()?;
        let (files, bytes) = (self.files.load(Ordering::Relaxed), self.bytes.load(Ordering::Relaxed));
        Ok(Exported { frames: selected.views().count(), files, bytes })
    }

    fn take_place(&self) -> Result<(), ExportError> {
        if is_taken(&self.target) && !is_export(&self.target) && self.existing == Existing::SetAside {
            let old = beside(&self.target, "", ".old")?;
            if old.exists() {
                let problem = format!("what is there would become {}, which exists too; move one of them away", old.display());
                return Err(ExportError::Place { path: self.target.clone(), problem });
            }
            fs::rename(&self.target, &old).map_err(ExportError::at("move aside", &self.target))?;
        }
        remove(&self.target)?;
        fs::rename(&self.aside, &self.target).map_err(ExportError::at("put in place", &self.target))
    }
}

impl Drop for ExportFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.aside); // after `finish` there is none
    }
}

/// True when something other than an empty folder is at `path`.
fn is_taken(path: &Path) -> bool {
    match fs::read_dir(path) {
        Ok(mut entries) => entries.next().is_some(),
        Err(_) => path.symlink_metadata().is_ok(),
    }
}

/// True for a folder with the record of an export.
fn is_export(path: &Path) -> bool {
    let record = fs::read(path.join(RECORD)).ok().and_then(|bytes| serde_json::from_slice::<Record>(&bytes).ok());
    record.is_some_and(|record| record.kind == RECORD_FORMAT)
}

/// Refuses a target within the dataset and a dataset within the target: what is replaced must not be what is read.
fn check_apart(target: &Path, dataset: &Path) -> Result<(), ExportError> {
    let absolute = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.into());
    let (target_at, dataset_at) = (absolute(target), absolute(dataset));
    let problem = if dataset_at.starts_with(&target_at) {
        "the dataset is inside it; choose another folder"
    } else if target_at.starts_with(dataset_at.join("scenes")) {
        "it is among the dataset's scenes; choose another folder"
    } else {
        return Ok(());
    };
    Err(ExportError::Place { path: target.into(), problem: problem.into() })
}

/// `<prefix><name><suffix>` in the folder of `path`.
fn beside(path: &Path, prefix: &str, suffix: &str) -> Result<PathBuf, ExportError> {
    let problem = || ExportError::Place { path: path.into(), problem: "it has no name; name a folder".into() };
    let name = path.file_name().ok_or_else(problem)?.to_string_lossy();
    Ok(path.with_file_name(format!("{prefix}{name}{suffix}")))
}

/// Removes a folder that may not exist.
fn remove(path: &Path) -> Result<(), ExportError> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(ExportError::at("remove", path)(error)),
        _ => Ok(()),
    }
}

//! The folder `.enfilade` inside a dataset: data that a run needs to resume; readers of the dataset do not need it.
//!
//! ```text
//! OUT/.enfilade/lock                 held by the process at work
//! OUT/.enfilade/run.json             the resolved configuration, and the folder its relative paths start from
//! OUT/.enfilade/gathered.json        for a dataset made by other machines: the job whose files were brought here
//! OUT/.enfilade/split.json           how the dataset is divided, if that was chosen
//! OUT/.enfilade/.products/NAME.json  requests and inputs of a product of the dataset as a whole
//! OUT/.enfilade/.estimate/           trials of a forecast that must not change the folder
//! OUT/.enfilade/SCENE/scene.scene    the scene package
//! OUT/.enfilade/SCENE/first.scene    of a variation: the package of its first scene, which has what this one's lacks
//! OUT/.enfilade/SCENE/partial/       unfinished frames, to continue where a run was killed
//! OUT/.enfilade/SCENE/products/NAME.json  the same for a product of the scene
//! OUT/.enfilade/SCENE/STAGE.json     what the stage read and wrote, its warnings and times: written last, after all outputs
//! ```

use crate::error::Error;
pub(crate) use enfilade_dataset::SCENE_PACKAGE as PACKAGE;
use enfilade_dataset::{LOCK, WORKDIR, WorkLock, refuse_newer_layout, remove_folder};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The resolved configuration in the work folder.
pub(crate) const RUN: &str = "run.json";
/// The job whose files were brought here, if other machines made the dataset.
pub(crate) const GATHERED: &str = "gathered.json";
/// The choice of how the dataset is divided, if one was made.
pub(crate) const CHOICE: &str = "split.json";
/// Record of statistics by earlier versions.
const STATISTICS: &str = "statistics.json";
/// Folder for the trials of a forecast.
const ASIDE: &str = ".estimate";
/// The files beside the folders of scenes: no scene can have such a name.
pub(crate) const OWN_FILES: [&str; 5] = [LOCK, RUN, GATHERED, CHOICE, STATISTICS];

/// A dataset's work folder, locked for this process while the value lives.
#[derive(Debug)]
pub struct Workdir {
    out: PathBuf,
    _lock: WorkLock,
}

impl Workdir {
    /// Opens or creates the work folder of `out`, and locks it.
    ///
    /// # Errors
    /// When `out` is something other than a dataset or one of a newer layout, cannot be written or is not spelled in UTF-8, or another
    /// process works on it.
    pub fn create(out: &Path) -> Result<Self, Error> {
        refuse_other_text(out)?;
        if out.join(WORKDIR).is_dir() {
            refuse_newer_layout(out)?;
        } else {
            refuse_foreign_folder(out)?;
            fs::create_dir_all(out.join(WORKDIR)).map_err(Error::io("create", &out.join(WORKDIR)))?;
        }
        let workdir = Self { out: out.into(), _lock: WorkLock::take(out)? };
        // A forecast that was killed may have left it.
        remove_folder(&workdir.file(ASIDE))?;
        Ok(workdir)
    }

    /// Opens and locks the work folder of an existing dataset.
    ///
    /// # Errors
    /// If `out` has no dataset that `enfilade run` began, or another process works on it.
    pub fn open(out: &Path) -> Result<Self, Error> {
        if !out.join(WORKDIR).is_dir() {
            let found = if out.exists() { "has no work folder `.enfilade`" } else { "does not exist" };
            return Err(Error::usage(
                format!("{} {found}, so it is not a dataset that can be worked on", out.display()),
                "name the folder given to `enfilade run` as output, or make one: enfilade run --demo out",
            ));
        }
        Self::create(out)
    }

    /// The dataset's folder.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// A file of a scene's work folder; the folder exists afterwards.
    pub(crate) fn scene_file(&self, scene: &str, file: &str) -> Result<PathBuf, Error> {
        if OWN_FILES.contains(&scene) {
            let message = format!("no scene can be named {scene:?}: the work folder has a file of that name");
            return Err(Error::usage(message, "give the scene another name"));
        }
        let folder = self.out.join(WORKDIR).join(scene);
        fs::create_dir_all(&folder).map_err(Error::io("create", &folder))?;
        Ok(folder.join(file))
    }

    /// A file of the work folder itself.
    pub(crate) fn file(&self, file: &str) -> PathBuf {
        self.out.join(WORKDIR).join(file)
    }

    /// An empty folder to try things out in, which is removed with the value.
    pub(crate) fn aside(&self) -> Result<TempDir, Error> {
        let made = tempfile::Builder::new().prefix(ASIDE).rand_bytes(0).tempdir_in(self.out.join(WORKDIR));
        made.map_err(Error::io("create", &self.file(ASIDE)))
    }
}

/// Records and tables store paths as text, so a path that is not text would fail only when they are written.
pub(crate) fn refuse_other_text(path: &Path) -> Result<(), Error> {
    if path.to_str().is_some() {
        return Ok(());
    }
    Err(Error::usage(format!("the path {} is not UTF-8", path.display()), "rename the folder, or choose another one"))
}

/// Refuses a folder with other contents: it must not be filled with a dataset.
fn refuse_foreign_folder(out: &Path) -> Result<(), Error> {
    if out.is_symlink() && !out.exists() {
        let message = format!("the output {} is a broken link", out.display());
        return Err(Error::usage(message, "create its target folder, or name another one"));
    }
    if out.is_file() {
        return Err(Error::usage(format!("the output {} is a file", out.display()), "name a folder that does not exist yet"));
    }
    let Ok(mut entries) = fs::read_dir(out) else { return Ok(()) };
    let Some(entry) = entries.next() else { return Ok(()) };
    let found = entry.map(|e| e.file_name().to_string_lossy().into_owned()).unwrap_or_default();
    Err(Error::usage(
        format!("the output folder {} holds something else (among it {found:?}), and no dataset that was begun here", out.display()),
        "name an empty folder or one that does not exist yet",
    ))
}

/// Reads a file that this program wrote; `None` when it is not there or not of this version.
pub(crate) fn read_json<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&fs::read(path).ok()?).ok()
}

/// A BLAKE3 hash as hexadecimal text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Hash(pub String);

impl Hash {
    pub fn of_bytes(bytes: &[u8]) -> Self {
        Self(blake3::hash(bytes).to_hex().to_string())
    }

    /// The hash of the plain data `value`, by its JSON text.
    pub fn of<T: Serialize + ?Sized>(value: &T) -> Self {
        // Plain data of ours always has a JSON text; were it not so, an empty text would only cause work to be redone.
        Self::of_bytes(&serde_json::to_vec(value).unwrap_or_default())
    }

    /// The hash of a file's content.
    pub fn of_file(path: &Path) -> Result<Self, Error> {
        let mut hasher = blake3::Hasher::new();
        let mut file = File::open(path).map_err(Error::io("read", path))?;
        hasher.update_reader(&mut file).map_err(Error::io("read", path))?;
        Ok(Self(hasher.finalize().to_hex().to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_process_is_told_who_is_at_work() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        let first = Workdir::create(&out).unwrap();
        let error = Workdir::create(&out).unwrap_err();
        assert!(error.to_string().contains(&format!("another process (process {})", std::process::id())), "{error}");
        drop(first);
        Workdir::open(&out).unwrap();
    }

    #[test]
    #[cfg(unix)]
    fn links_that_lead_nowhere_or_in_a_circle_are_refused_in_words() {
        let dir = tempfile::tempdir().unwrap();
        for (name, target) in [("dangling", "gone"), ("circle", "circle")] {
            let link = dir.path().join(name);
            std::os::unix::fs::symlink(target, &link).unwrap();
            let error = Workdir::create(&link).unwrap_err();
            assert!(error.is_usage() && error.to_string().ends_with(&format!("{name} is a broken link")), "{error}");
        }
    }

    #[test]
    fn a_folder_to_try_things_out_in_goes_again_even_where_it_was_left_behind() {
        let dir = tempfile::tempdir().unwrap();
        let workdir = Workdir::create(dir.path()).unwrap();
        let aside = workdir.aside().unwrap();
        fs::write(aside.path().join("file"), "x").unwrap();
        let left = aside.keep();
        drop(workdir);
        let workdir = Workdir::open(dir.path()).unwrap();
        assert!(!left.exists());
        drop(workdir.aside().unwrap());
        assert!(!left.exists());
    }

    #[test]
    fn a_scene_with_the_name_of_a_file_of_the_work_folder_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let workdir = Workdir::create(dir.path()).unwrap();
        for name in ["lock", "run.json", "split.json", "gathered.json", "statistics.json"] {
            let error = workdir.scene_file(name, PACKAGE).unwrap_err();
            assert!(error.is_usage() && error.to_string().contains(name), "{error}");
        }
        workdir.scene_file("clock", PACKAGE).unwrap();
    }

    #[test]
    fn folders_with_something_else_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("thesis.tex"), "x").unwrap();
        let error = Workdir::create(dir.path()).unwrap_err();
        assert!(error.to_string().contains("thesis.tex") && error.is_usage(), "{error}");
        let error = Workdir::create(&dir.path().join("thesis.tex")).unwrap_err();
        assert!(error.to_string().ends_with("is a file"), "{error}");
        let error = Workdir::create(&dir.path().join("thesis.tex/out")).unwrap_err();
        assert!(error.hint().unwrap().contains("a part of the path is a file"), "{error:?}");
        assert!(Workdir::open(&dir.path().join("none")).unwrap_err().to_string().contains("does not exist"));
    }
}

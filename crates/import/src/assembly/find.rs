//! Finding the files that a scene refers to: by the path as written, by its name in another case, or by its name alone.

use super::Assembly;
use super::files::folder_of;
use std::path::{Path, PathBuf};

/// True for paths that begin at a root. Windows paths count too, since a file from Windows may be read on any system.
pub(crate) fn is_absolute(path: &str) -> bool {
    let has_drive = matches!(path.as_bytes(), [letter, b':', ..] if letter.is_ascii_alphabetic());
    has_drive || path.starts_with(['/', '\\'])
}

impl Assembly<'_> {
    /// The path of a file that the scene refers to by the paths `written`: one of them, or, since they are often of another machine, its
    /// name in one of `folders`. All are as the scene file would spell them; a folder is empty or has a slash at its end.
    pub(crate) fn find(&self, written: &[&str], folders: &[&str]) -> Option<String> {
        let named = written.iter().filter_map(|path| path.rsplit(['/', '\\']).next()).filter(|name| !name.is_empty());
        let beside = named.flat_map(|name| folders.iter().map(move |folder| format!("{folder}{name}")));
        let candidates: Vec<String> = written.iter().filter(|p| !p.is_empty()).map(|p| (*p).to_string()).chain(beside).collect();
        let exact = candidates.iter().find(|path| self.exact(path).is_some());
        exact.or_else(|| candidates.iter().find(|path| self.exists(path))).cloned()
    }

    /// The path of a file that the scene file refers to by `path`, for messages.
    pub(crate) fn path_of(&self, path: &str) -> PathBuf {
        self.resolve(path)
    }

    /// True when there is a file where the scene file's `path` leads, perhaps in other case.
    pub(crate) fn exists(&self, path: &str) -> bool {
        self.is_file(&self.resolve(path))
    }

    /// The file that `path` in the scene file means: relative to the folders to look in, or else to its own. Where none has it, a
    /// file whose name differs in case alone.
    pub(super) fn resolve(&self, path: &str) -> PathBuf {
        let in_other_case = || self.places().find_map(|folder| self.in_other_case(&self.within_folder(folder, path)));
        self.exact(path).or_else(in_other_case).unwrap_or_else(|| self.within_folder(folder_of(&self.file), path))
    }

    /// Reports it if the names of `path` and `file` differ in case.
    pub(crate) fn report_case(&mut self, path: &str, file: &Path) {
        let slashes = path.replace('\\', "/");
        let names = [path, &slashes].map(|written| Path::new(written).file_name());
        if let Some(found) = file.file_name()
            && !names.contains(&Some(found))
        {
            let found = found.to_string_lossy().into_owned();
            self.warn(
                format!("reference to {path:?}"),
                format!("there is no file of this name; {found:?}, which differs in case, was used"),
            );
        }
    }

    fn exact(&self, path: &str) -> Option<PathBuf> {
        self.places().map(|folder| self.within_folder(folder, path)).find(|file| self.is_file(file))
    }

    /// The folders in which files are looked for.
    pub(super) fn places(&self) -> impl Iterator<Item = &Path> {
        self.folders.iter().rev().map(PathBuf::as_path).chain([folder_of(&self.file)])
    }

    /// The only file in the folder of `file` whose name differs from its name in case alone. Archives ignore case themselves.
    pub(crate) fn in_other_case(&self, file: &Path) -> Option<PathBuf> {
        let wanted = file.file_name().filter(|_| self.archive.is_none())?.to_str()?.to_lowercase();
        let folder = Some(folder_of(file)).filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let names = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.file_name());
        let mut alike = names.filter(|name| name.to_str().is_some_and(|name| name.to_lowercase() == wanted));
        let first = alike.next()?;
        alike.next().is_none().then(|| file.with_file_name(first)).filter(|found| found.is_file())
    }

    /// The file `path` in a folder, with Windows separators understood.
    fn within_folder(&self, folder: &Path, path: &str) -> PathBuf {
        let plain = folder.join(path);
        if self.is_file(&plain) || !path.contains('\\') { plain } else { folder.join(path.replace('\\', "/")) }
    }

    /// True where there is a file at a path, on the disk or in the archive of the scene.
    pub(crate) fn is_file(&self, path: &Path) -> bool {
        self.archive.map_or_else(|| path.is_file(), |archive| archive.contains_path(path))
    }
}

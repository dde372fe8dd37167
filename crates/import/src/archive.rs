//! Files within a ZIP archive, read into memory one by one.

use crate::percent::percent_decoded;
use std::cell::{Cell, RefCell};
use std::io::{Cursor, Error, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use zip::ZipArchive;
use zip::result::ZipError;

/// A file within an archive may unpack to this many bytes.
const MAX_FILE_BYTES: u64 = 1 << 30;
/// All files of an archive together may unpack to this many bytes: a small file can unpack to a thousand times its size.
const MAX_BYTES: u64 = 8 << 30;

/// An archive that lies in memory.
pub(crate) struct Archive {
    file: PathBuf,
    names: Vec<String>,
    zip: RefCell<ZipArchive<Cursor<Vec<u8>>>>,
    left: Cell<u64>,
}

impl Archive {
    /// Opens the bytes of `file`.
    ///
    /// # Errors
    /// What is wrong with them, as the rest of a sentence.
    pub(crate) fn new(file: &Path, bytes: Vec<u8>) -> Result<Self, String> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|e| format!("not an archive that can be read ({e})"))?;
        let names = zip.file_names().filter(|n| !n.ends_with('/')).map(Into::into).collect();
        Ok(Self { file: file.to_path_buf(), names, zip: RefCell::new(zip), left: Cell::new(MAX_BYTES) })
    }

    /// The archive's own path.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// Names of all files within, in the order of the archive.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The name of the file that `name` means: spelled the same, in other case, or with `%20` and the like replaced.
    pub(crate) fn find(&self, name: &str) -> Option<&str> {
        let name = name.trim_start_matches('/');
        let among = |wanted: &str| {
            let exact = self.names.iter().find(|n| *n == wanted);
            exact.or_else(|| self.names.iter().find(|n| n.eq_ignore_ascii_case(wanted))).map(String::as_str)
        };
        among(name).or_else(|| among(&String::from_utf8_lossy(&percent_decoded(name))))
    }

    /// The bytes of the file of exactly this name.
    ///
    /// # Errors
    /// When there is none, it is damaged or encrypted, or too large.
    pub(crate) fn read(&self, name: &str) -> Result<Vec<u8>, Error> {
        let mut zip = self.zip.borrow_mut();
        let entry = zip.by_name(name).map_err(|e| match e {
            ZipError::FileNotFound => Error::new(ErrorKind::NotFound, "it is not in the archive"),
            other => Error::new(ErrorKind::InvalidData, other.to_string()),
        })?;
        let limit = MAX_FILE_BYTES.min(self.left.get());
        let mut bytes = Vec::new();
        entry.take(limit + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > limit {
            let problem = format!("it unpacks to more than {limit} bytes, which is all that may be read of it");
            return Err(Error::new(ErrorKind::FileTooLarge, problem));
        }
        self.left.set(self.left.get() - bytes.len() as u64);
        Ok(bytes)
    }

    /// The bytes of a file by its path, which begins with the archive's own.
    pub(crate) fn read_path(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let name = self.name_of(path).ok_or_else(|| Error::new(ErrorKind::NotFound, "it is not in the archive"))?;
        self.read(&name)
    }

    /// True when there is a file at a path that begins with the archive's own.
    pub(crate) fn contains_path(&self, path: &Path) -> bool {
        self.name_of(path).is_some()
    }

    fn name_of(&self, path: &Path) -> Option<String> {
        let mut parts: Vec<String> = Vec::new();
        for component in path.strip_prefix(&self.file).ok()?.components() {
            match component {
                Component::Normal(part) => parts.push(part.to_string_lossy().into_owned()),
                Component::CurDir => (),
                Component::ParentDir => drop(parts.pop()?),
                Component::RootDir | Component::Prefix(_) => return None,
            }
        }
        self.find(&parts.join("/")).map(Into::into)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::{SimpleFileOptions, ZipWriter};

    fn archive() -> Archive {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for name in ["3/My Sofa.obj", "3/cloth.PNG"] {
            zip.start_file(name, SimpleFileOptions::default()).unwrap();
            zip.write_all(name.as_bytes()).unwrap();
        }
        Archive::new(Path::new("a/home.sh3d"), zip.finish().unwrap().into_inner()).unwrap()
    }

    #[test]
    fn files_are_found_by_their_paths_whatever_their_case_and_escapes() {
        let archive = archive();
        assert_eq!(archive.find("3/My%20Sofa.obj"), Some("3/My Sofa.obj"));
        let bytes = archive.read_path(Path::new("a/home.sh3d/3/./x/../cloth.png")).unwrap();
        assert_eq!(bytes, b"3/cloth.PNG");
        for outside in ["a/home.sh3d/../secret", "a/other/3/cloth.PNG", "/etc/passwd", "a/home.sh3d/4"] {
            assert!(!archive.contains_path(Path::new(outside)), "{outside}");
            assert_eq!(archive.read_path(Path::new(outside)).unwrap_err().kind(), ErrorKind::NotFound);
        }
    }

    #[test]
    fn bytes_that_are_no_archive_and_budgets_that_are_spent_are_refused() {
        assert!(Archive::new(Path::new("a.zip"), b"PK no".to_vec()).err().unwrap().contains("not an archive"));
        let archive = archive();
        archive.left.set(12);
        assert_eq!(archive.read("3/cloth.PNG").unwrap().len(), 11);
        assert_eq!(archive.read("3/cloth.PNG").unwrap_err().kind(), ErrorKind::FileTooLarge);
    }
}

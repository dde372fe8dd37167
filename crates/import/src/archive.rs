//! Files within a ZIP archive, read into memory one by one.

use crate::percent::percent_decoded;
use std::cell::{Cell, RefCell};
use std::collections::{BTreeSet, HashSet};
use std::io::{Cursor, Error, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use zip::ZipArchive;
use zip::result::ZipError;

/// A file within an archive may unpack to this many bytes.
const MAX_FILE_BYTES: u64 = 1 << 30;
/// Greatest number of archives within an archive that are opened.
const MAX_INNER: usize = 8;
/// All files of an archive together may unpack to this many bytes: a small file can unpack to a thousand times its size.
const MAX_BYTES: u64 = 8 << 30;

/// An archive in memory.
pub(crate) struct Archive {
    file: PathBuf,
    names: Vec<String>,
    /// The archive of the file of each name, and its name there.
    entries: Vec<(usize, String)>,
    /// The archive itself, and those within it that were opened.
    zips: RefCell<Vec<ZipArchive<Cursor<Vec<u8>>>>>,
    left: Cell<u64>,
    /// Places of the files that were read by their paths.
    used: RefCell<BTreeSet<usize>>,
}

impl Archive {
    /// Opens the bytes of `file`.
    ///
    /// # Errors
    /// The fault, as the rest of a sentence.
    pub(crate) fn new(file: &Path, bytes: Vec<u8>) -> Result<Self, String> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|e| format!("not an archive that can be read ({e})"))?;
        let mut archive = Self {
            file: file.to_path_buf(),
            names: Vec::new(),
            entries: Vec::new(),
            zips: RefCell::default(),
            left: Cell::new(MAX_BYTES),
            used: RefCell::default(),
        };
        archive.add(zip, "");
        Ok(archive)
    }

    /// Opens the archives within the archive: their files are then in the folder of the archive that contains them. Damaged ones stay
    /// closed.
    pub(crate) fn open_inner(&mut self) {
        let inner: Vec<String> = self.names.iter().filter(|name| name.to_ascii_lowercase().ends_with(".zip")).cloned().collect();
        for name in inner.iter().take(MAX_INNER) {
            let zip = self.read(name).ok().and_then(|bytes| ZipArchive::new(Cursor::new(bytes)).ok());
            let folder = name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
            zip.into_iter().for_each(|zip| self.add(zip, &folder));
        }
    }

    /// Adds the files of an archive as files of `folder`. A name that is taken stays what it was.
    fn add(&mut self, zip: ZipArchive<Cursor<Vec<u8>>>, folder: &str) {
        let zips = self.zips.get_mut();
        let known: HashSet<String> =
            if folder.is_empty() && zips.is_empty() { HashSet::new() } else { self.names.iter().cloned().collect() };
        for raw in zip.file_names().filter(|name| !name.ends_with(['/', '\\'])) {
            let plain = plain_name(raw);
            let name = format!("{folder}{plain}");
            if !plain.is_empty() && !known.contains(&name) {
                self.names.push(name);
                self.entries.push((zips.len(), raw.to_string()));
            }
        }
        zips.push(zip);
    }

    /// The archive's own path.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// Names of all files within, in the order of the archive.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The name of the file that `name` refers to: spelled the same, in another case, or with `%20` and similar escapes replaced.
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
        let limit = MAX_FILE_BYTES.min(self.left.get());
        let bytes = self.start(name, limit + 1)?;
        if bytes.len() as u64 > limit {
            let problem = format!("it unpacks to more than {limit} bytes, which is all that may be read of it");
            return Err(Error::new(ErrorKind::FileTooLarge, problem));
        }
        self.left.set(self.left.get() - bytes.len() as u64);
        Ok(bytes)
    }

    /// The first bytes of the file of exactly this name, at most as many as given; none where it cannot be read.
    pub(crate) fn head(&self, name: &str, most: u64) -> Vec<u8> {
        self.start(name, most).unwrap_or_default()
    }

    fn start(&self, name: &str, most: u64) -> Result<Vec<u8>, Error> {
        let absent = || Error::new(ErrorKind::NotFound, "it is not in the archive");
        let (zip, raw) = self.place(name).and_then(|i| self.entries.get(i)).ok_or_else(absent)?;
        let mut zips = self.zips.borrow_mut();
        let entry = zips.get_mut(*zip).ok_or_else(absent)?.by_name(raw).map_err(|e| match e {
            ZipError::FileNotFound => absent(),
            other => Error::new(ErrorKind::InvalidData, other.to_string()),
        })?;
        let mut bytes = Vec::new();
        entry.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// The bytes of a file by its path, which begins with the archive's own.
    pub(crate) fn read_path(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let name = self.name_of(path).ok_or_else(|| Error::new(ErrorKind::NotFound, "it is not in the archive"))?;
        self.used.borrow_mut().extend(self.place(&name));
        self.read(&name)
    }

    /// True when the file at a path was read by its path.
    pub(crate) fn was_read(&self, path: &Path) -> bool {
        self.name_of(path).and_then(|name| self.place(&name)).is_some_and(|place| self.used.borrow().contains(&place))
    }

    /// The names in a folder of the archive, by its path, which begins with the archive's own: of folders or of files, in order.
    pub(crate) fn names_in(&self, folder: &Path, folders: bool) -> Vec<String> {
        let Some(parts) = self.parts_of(folder) else { return Vec::new() };
        let prefix = if parts.is_empty() { String::new() } else { format!("{}/", parts.join("/")) };
        let rest = self
            .names
            .iter()
            .filter_map(|name| name.get(..prefix.len()).filter(|p| p.eq_ignore_ascii_case(&prefix)).map(|_| &name[prefix.len()..]));
        let found: BTreeSet<&str> = match folders {
            true => rest.filter_map(|rest| rest.split_once('/')).map(|(folder, _)| folder).collect(),
            false => rest.filter(|rest| !rest.contains('/')).collect(),
        };
        found.into_iter().map(str::to_string).collect()
    }

    /// True when there is a folder at a path that begins with the archive's own.
    pub(crate) fn contains_folder(&self, path: &Path) -> bool {
        !self.names_in(path, true).is_empty() || !self.names_in(path, false).is_empty()
    }

    /// True when there is a file at a path that begins with the archive's own.
    pub(crate) fn contains_path(&self, path: &Path) -> bool {
        self.name_of(path).is_some()
    }

    fn name_of(&self, path: &Path) -> Option<String> {
        self.find(&self.parts_of(path)?.join("/")).map(Into::into)
    }

    /// The steps from the archive to a path; `None` where it leads out of the archive.
    fn parts_of(&self, path: &Path) -> Option<Vec<String>> {
        let mut parts: Vec<String> = Vec::new();
        for component in path.strip_prefix(&self.file).ok()?.components() {
            match component {
                Component::Normal(part) => parts.push(part.to_string_lossy().into_owned()),
                Component::CurDir => (),
                Component::ParentDir => drop(parts.pop()?),
                Component::RootDir | Component::Prefix(_) => return None,
            }
        }
        Some(parts)
    }
}

/// The path of a file within its archive as unpacking programs take it: separators of Windows are read, and steps that lead nowhere
/// (`./a`, `/a`, `a//b`) or out of the archive (`../a`) left out.
fn plain_name(raw: &str) -> String {
    let steps = raw.split(['/', '\\']).filter(|step| !matches!(*step, "" | "." | ".."));
    steps.collect::<Vec<_>>().join("/")
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
    fn folders_are_listed_and_archives_within_stand_in_their_place() {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let mut inner = ZipWriter::new(Cursor::new(Vec::new()));
        for name in ["scene.obj", "parts/leg.obj", "a.png"] {
            inner.start_file(name, SimpleFileOptions::default()).unwrap();
            inner.write_all(b"inner").unwrap();
        }
        let inner = inner.finish().unwrap().into_inner();
        for (name, bytes) in
            [("source/model.zip", &inner[..]), ("textures\\wood.png", b"wood"), ("source/a.png", b"outer"), ("source/bad.zip", b"PK")]
        {
            zip.start_file(name, SimpleFileOptions::default()).unwrap();
            zip.write_all(bytes).unwrap();
        }
        let mut archive = Archive::new(Path::new("m.zip"), zip.finish().unwrap().into_inner()).unwrap();
        archive.open_inner();
        assert_eq!(archive.names_in(Path::new("m.zip"), true), ["source", "textures"]);
        assert_eq!(archive.names_in(Path::new("m.zip/source/../source"), false), ["a.png", "bad.zip", "model.zip", "scene.obj"]);
        assert_eq!(archive.names_in(Path::new("m.zip/source"), true), ["parts"]);
        assert_eq!(archive.read_path(Path::new("m.zip/source/../textures/wood.png")).unwrap(), b"wood");
        assert_eq!(archive.read_path(Path::new("m.zip/source/parts/leg.obj")).unwrap(), b"inner");
        assert_eq!(archive.read_path(Path::new("m.zip/source/a.png")).unwrap(), b"outer");
        assert!(archive.contains_folder(Path::new("m.zip/textures")) && !archive.contains_folder(Path::new("m.zip/maps")));
        assert!(archive.names_in(Path::new("m.zip/.."), false).is_empty());
    }

    #[test]
    fn names_are_taken_as_unpacking_programs_take_them() {
        // What `unzip` writes for each of these names, below the folder in which it is started.
        let names = [("./a.obj", "a.obj"), ("/b.obj", "b.obj"), ("../c.obj", "c.obj"), ("d//./e.obj", "d/e.obj"), ("f\\g.obj", "f/g.obj")];
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (raw, _) in names {
            zip.start_file(raw, SimpleFileOptions::default()).unwrap();
            zip.write_all(raw.as_bytes()).unwrap();
        }
        let archive = Archive::new(Path::new("m.zip"), zip.finish().unwrap().into_inner()).unwrap();
        assert_eq!(archive.names(), names.map(|(_, name)| name));
        for (raw, name) in names {
            assert_eq!(archive.read_path(&Path::new("m.zip").join(name)).unwrap(), raw.as_bytes());
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

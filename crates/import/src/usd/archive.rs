//! usdz: a zip archive without compression, whose first file is the scene.

use std::collections::HashMap;
use std::io::Cursor;
use std::ops::Range;
use zip::{CompressionMethod, ZipArchive};

/// An archive in memory.
pub(super) struct Archive {
    bytes: Vec<u8>,
    files: HashMap<String, Range<usize>>,
    /// Name of the first file.
    pub first: String,
}

impl Archive {
    /// Finds the files of an archive.
    ///
    /// # Errors
    /// The place, and the fault there.
    pub(super) fn open(bytes: Vec<u8>) -> Result<Self, (String, String)> {
        let broken = |e: &dyn std::fmt::Display| {
            ("the archive".to_string(), format!("it is no zip archive or damaged ({e}); copy or export it again"))
        };
        let mut archive = ZipArchive::new(Cursor::new(bytes.as_slice())).map_err(|e| broken(&e))?;
        let mut files = HashMap::new();
        let mut first: Option<(usize, String)> = None;
        for i in 0..archive.len() {
            let file = archive.by_index_raw(i).map_err(|e| broken(&e))?;
            if file.is_dir() {
                continue;
            }
            // Writers of usdz do not always mark their names as UTF-8.
            let name = String::from_utf8(file.name_raw().to_vec()).unwrap_or_else(|_| file.name().to_string());
            if file.compression() != CompressionMethod::Stored || file.encrypted() {
                let problem = format!(
                    "it is compressed ({}) or encrypted, which usdz does not allow; pack the archive with usdzip",
                    file.compression()
                );
                return Err((format!("[{name}]"), problem));
            }
            let range = usize::try_from(file.data_start()).ok().zip(usize::try_from(file.size()).ok());
            let range = range.and_then(|(start, size)| Some(start..start.checked_add(size)?)).filter(|r| bytes.get(r.clone()).is_some());
            let Some(range) = range else {
                return Err((format!("[{name}]"), "it reaches beyond the archive's end; the archive is cut short".into()));
            };
            if first.as_ref().is_none_or(|(start, _)| range.start < *start) {
                first = Some((range.start, name.clone()));
            }
            files.insert(name, range);
        }
        let Some((_, first)) = first else { return Err(("the archive".into(), "it holds no files; export it again".into())) };
        Ok(Self { bytes, files, first })
    }

    /// The bytes of a file in the archive.
    pub(super) fn get(&self, name: &str) -> Option<&[u8]> {
        self.bytes.get(self.files.get(name)?.clone())
    }
}

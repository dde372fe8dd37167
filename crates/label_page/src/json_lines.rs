//! Files of JSON lines that grow by one line at a time, each flushed to the disk before it counts.
//!
//! A last line that was cut short, because the program was killed or the disk was full, does not count: the next one replaces it.

use serde::Serialize;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};

/// What the first line begins with is looked for in so many bytes.
const HEAD_BYTES: u64 = 256;

/// An open file of lines.
pub struct JsonLines {
    file: File,
    /// Length of the complete lines, bytes.
    length: u64,
}

impl JsonLines {
    /// The complete lines of a file that is open for reading and writing, and whether something incomplete follows them.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn read(mut file: File) -> std::io::Result<(Self, Vec<u8>, bool)> {
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        let whole = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |end| end + 1);
        let was_cut = whole < bytes.len();
        bytes.truncate(whole);
        Ok((Self { file, length: whole as u64 }, bytes, was_cut))
    }

    /// Drops all lines; the next one is the first.
    pub fn clear(&mut self) {
        self.length = 0;
    }

    /// Appends a line. When this returns it is on the disk; when it fails the lines are as they were.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn append(&mut self, value: &impl Serialize) -> std::io::Result<()> {
        let mut line = serde_json::to_vec(value)?;
        line.push(b'\n');
        let written = self.drop_incomplete().and_then(|()| self.file.write_all(&line)).and_then(|()| self.file.sync_data());
        match written {
            Ok(()) => self.length += line.len() as u64,
            // The first error is reported; what is incomplete is dropped now, or before the next line.
            Err(_) => drop(self.file.set_len(self.length)),
        }
        written
    }

    /// Replaces a text in the first line by another of the same length, if it is there. When this returns it is on the disk.
    ///
    /// # Errors
    /// When the file cannot be read or written.
    pub fn replace_in_first(&mut self, text: &str, by: &str) -> std::io::Result<()> {
        debug_assert_eq!(text.len(), by.len());
        let mut head = vec![0; self.length.min(HEAD_BYTES) as usize];
        self.file.seek(SeekFrom::Start(0))?;
        self.file.read_exact(&mut head)?;
        let line = head.split(|&byte| byte == b'\n').next().unwrap_or_default();
        if let Some(at) = line.windows(text.len()).position(|found| found == text.as_bytes()) {
            self.file.seek(SeekFrom::Start(at as u64))?;
            self.file.write_all(by.as_bytes())?;
            self.file.sync_data()?;
        }
        self.drop_incomplete()
    }

    /// Cuts off what follows the complete lines.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn drop_incomplete(&mut self) -> std::io::Result<()> {
        self.file.set_len(self.length)?;
        self.file.seek(SeekFrom::Start(self.length)).map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_was_cut_short_gives_way_to_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lines.jsonl");
        std::fs::write(&path, "1\n2\n{\"cut").unwrap();
        let open = || JsonLines::read(File::options().read(true).write(true).open(&path).unwrap()).unwrap();
        let (mut lines, whole, was_cut) = open();
        assert_eq!((whole.as_slice(), was_cut), (&b"1\n2\n"[..], true));
        lines.append(&3).unwrap();
        lines.append(&"four").unwrap();
        let (mut lines, whole, was_cut) = open();
        assert_eq!((whole.as_slice(), was_cut), (&b"1\n2\n3\n\"four\"\n"[..], false));
        lines.replace_in_first("1", "7").unwrap();
        lines.append(&8).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"7\n2\n3\n\"four\"\n8\n");
        lines.clear();
        lines.append(&5).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"5\n");
    }
}

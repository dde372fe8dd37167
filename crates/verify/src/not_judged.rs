//! Files that no law is about: what they were made from has changed since.

use enfilade_dataset::counted;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Files of products that are out of date, which are left out of verification until they are made again.
///
/// The caller has to know which these are; a dataset does not record it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NotJudged {
    files: BTreeSet<PathBuf>,
    /// Number of files by product.
    counts: BTreeMap<String, usize>,
}

impl NotJudged {
    /// Leaves out files of the product `name`, by their paths as the dataset's layout has them.
    pub fn leave_out(&mut self, name: &str, files: impl IntoIterator<Item = PathBuf>) {
        let before = self.files.len();
        self.files.extend(files);
        let more = self.files.len() - before;
        if more > 0 {
            *self.counts.entry(name.into()).or_default() += more;
        }
    }

    /// True when the file at `path` is left out.
    pub fn has(&self, path: &Path) -> bool {
        !self.files.is_empty() && self.files.contains(path)
    }

    /// True when a file of a frame in a folder is left out.
    pub(crate) fn has_of_frame(&self, folder: &Path, number: u32) -> bool {
        let prefix = format!("frame.{number:04}.");
        let next = self.files.range(folder.join(&prefix)..).next();
        let name = next.filter(|path| path.parent() == Some(folder)).and_then(|path| path.file_name());
        name.is_some_and(|name| name.to_string_lossy().starts_with(&prefix))
    }

    /// A line for the report; `None` where nothing was left out.
    pub(crate) fn note(&self, scene: &str) -> Option<String> {
        let each: Vec<String> = self.counts.iter().map(|(name, count)| format!("{name} ({})", counted(*count, "file"))).collect();
        (!each.is_empty()).then(|| format!("{scene}: not checked, because they are out of date: {}", each.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_note_counts_the_files_of_each_product() {
        let mut left_out = NotJudged::default();
        assert_eq!(left_out.note("room"), None);
        left_out.leave_out("sensors", ["a", "b"].map(PathBuf::from));
        left_out.leave_out("words", []);
        assert!(left_out.has(Path::new("a")) && !left_out.has(Path::new("c")));
        left_out.files.insert("x/frame.0002.depth.hdf5".into());
        let has = |folder: &str, number| left_out.has_of_frame(Path::new(folder), number);
        assert!(has("x", 2) && !has("x", 1) && !has("x", 3) && !has("y", 2));
        assert_eq!(left_out.note("room").unwrap(), "room: not checked, because they are out of date: sensors (2 files)");
    }
}

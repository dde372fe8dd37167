//! The version of a dataset's layout. The manifest names it first, so that it is known before anything else is read or changed.
//!
//! docs/layout-versions.md states what is read of other versions, and when the number rises.

use crate::{DatasetError, Layout};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The version of the layout that this program writes, and the newest that it reads.
pub const LAYOUT_VERSION: u32 = 1;

/// Format name in a manifest, before the number.
const NAME: &str = "enfilade dataset ";
/// More than a manifest has before the end of its first value.
const HEAD_BYTES: u64 = 256;

/// The format in manifests of this version.
pub(crate) fn format() -> String {
    format!("{NAME}{LAYOUT_VERSION}")
}

/// Refuses the dataset at `root` where its layout is newer than this program. Only the head of its manifest is read: other faults of a
/// manifest, or a missing one, are found by those who need it.
///
/// # Errors
/// When the layout is newer.
pub fn refuse_newer_layout(root: &Path) -> Result<(), DatasetError> {
    let (path, mut head) = (Layout::new(root).manifest(), Vec::new());
    let read = File::open(&path).and_then(|file| file.take(HEAD_BYTES).read_to_end(&mut head));
    match read.ok().and_then(|_| version(&String::from_utf8_lossy(&head))) {
        Some(found) if found > LAYOUT_VERSION => Err(newer(&path, &format!("the layout \"{NAME}{found}\""), &format!("{:?}", format()))),
        _ => Ok(()),
    }
}

/// The error about a file that a newer program has written: what was found there, and the newest that is known here.
pub(crate) fn newer(path: &Path, found: &str, known: &str) -> DatasetError {
    let here = env!("CARGO_PKG_VERSION");
    DatasetError::text(
        path,
        format!("found {found}, expected at most {known}: it is of a newer enfilade than this one, {here}; use a newer enfilade"),
    )
}

/// The version that the beginning of a manifest names; `None` where it does not begin like one.
fn version(head: &str) -> Option<u32> {
    let after = |text: &'_ str, token: &str| text.trim_start().strip_prefix(token).map(str::to_owned);
    let name = after(&after(&after(head, "{")?, "\"format\"")?, ":")?;
    let number = after(&name, "\"")?.strip_prefix(NAME)?.split_once('"')?.0.to_owned();
    number.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dataset;

    #[test]
    fn the_version_is_read_from_the_head_alone() {
        assert_eq!(version("{\n  \"format\": \"enfilade dataset 12\",\n  \"conv"), Some(12));
        assert_eq!(version("{\"format\":\"enfilade dataset 1\"}"), Some(1));
        for other in ["", "{", "{\"format\": 1}", "{\"format\": \"enfilade dataset 1", "{\"scenes\": {}}", "\u{fffd}"] {
            assert_eq!(version(other), None, "{other}");
        }
    }

    #[test]
    fn newer_layouts_are_refused_with_file_found_expected_and_advice_whatever_else_they_hold() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let manifest = dataset.layout().manifest();
        std::fs::write(&manifest, "{\"format\": \"enfilade dataset 2\", \"scenes\": [7], \"half").unwrap();
        let opened = [Dataset::open(folder.path()).map(drop), Dataset::create(folder.path()).map(drop), dataset.read_manifest().map(drop)];
        for error in opened.map(|opened| opened.unwrap_err().to_string()) {
            let expected = "manifest.json: found the layout \"enfilade dataset 2\", expected at most \"enfilade dataset 1\": it is of a newer \
                enfilade than this one";
            assert!(error.contains(expected) && error.ends_with("use a newer enfilade"), "{error}");
        }
        // Files of other programs are not refused.
        std::fs::write(&manifest, "{\"name\": \"somebody's own\"}").unwrap();
        Dataset::open(folder.path()).unwrap();
    }
}

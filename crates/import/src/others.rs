//! The scene files of a download beside the one that was read.

use std::path::{Path, PathBuf};

/// Greatest number of scene files that a message names.
const NAMED: usize = 3;

/// The scene files beside the one that was chosen.
pub(crate) struct Others {
    /// The folder or archive that contains them, in words for messages.
    pub place: &'static str,
    /// Name of the chosen one there.
    pub chosen: String,
    /// Name of each there, and its path.
    pub files: Vec<(String, PathBuf)>,
}

impl Others {
    /// Place and message about those that the scene was not made of; `None` if it was made of all.
    pub(crate) fn remark(&self, was_read: impl Fn(&Path) -> bool) -> Option<(&'static str, String)> {
        let left: Vec<String> = self.files.iter().filter(|(_, path)| !was_read(path)).map(|(name, _)| name.clone()).collect();
        let all = left.len() + 1;
        (all > 1).then(|| (self.place, format!("of {all} scene files {} was read, not {}", self.chosen, named(&left))))
    }
}

/// The first of these names, with a sign where there are more.
pub(crate) fn named(names: &[String]) -> String {
    let more = if names.len() > NAMED { ", …" } else { "" };
    format!("{}{more}", names.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", "))
}

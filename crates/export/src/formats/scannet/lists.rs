//! The lists of scans by which loaders know what to learn from: `scannetv2_{train,val,test}.txt`, by the dataset's own split.

use super::names::scan;
use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::selected_frames::{SelectedFrames, Track};
use enfilade_dataset::{DatasetError, Partition, SplitRow};
use enfilade_scene::Warning;
use std::collections::{BTreeMap, BTreeSet};

/// Writes the three lists, a name a line. Without a split everything is there to learn from.
pub(super) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let mut lists: BTreeMap<Partition, String> = Partition::ALL.map(|side| (side, String::new())).into();
    let mut torn = Vec::new();
    let rows = match selected.dataset.read_split() {
        Err(error) if DatasetError::is_not_found(&error) => None,
        rows => Some(rows?),
    };
    let rows: Option<BTreeMap<Key<'_>, Partition>> = rows.as_ref().map(|rows| rows.iter().filter_map(placed).collect());
    for track in &selected.tracks {
        match rows.as_ref().map_or(Some(Partition::Train), |rows| side(track, rows)) {
            Some(side) => lists.entry(side).or_default().push_str(&format!("{}\n", scan(track))),
            None => torn.push(scan(track)),
        }
    }
    if let Some(first) = torn.first() {
        let others = torn.len() - 1;
        let message = format!("{first} and {others} more are in no list: their frames are on no side of the split, or on several");
        selected.warn(Warning { place: selected.dataset.layout().split().display().to_string(), message });
    }
    if lists[&Partition::Train].is_empty() && lists.values().any(|list| !list.is_empty()) {
        let message =
            "no scan is in scannetv2_train.txt: no scene of this export is in train of the split; divide again (enfilade partition)";
        selected.warn(Warning { place: selected.dataset.layout().split().display().to_string(), message: message.into() });
    }
    lists.iter().try_for_each(|(side, list)| out.write(&format!("scannetv2_{}.txt", side.name()), list.as_bytes()))
}

/// Scene, camera and frame.
type Key<'r> = (&'r str, &'r str, u32);

fn placed(row: &SplitRow) -> Option<(Key<'_>, Partition)> {
    Some(((row.scene.as_str(), row.camera.as_str(), row.frame), *row.partition.as_ref().ok()?))
}

/// Partition of the scan's frames; `None` where they are in several or in none.
fn side(track: &Track, rows: &BTreeMap<Key<'_>, Partition>) -> Option<Partition> {
    let of_frame = |frame: u32| rows.get(&(track.scene.as_str(), track.name.as_str(), frame)).copied();
    let sides: BTreeSet<Partition> = track.views().filter_map(|view| of_frame(view.frame())).collect();
    sides.first().copied().filter(|_| sides.len() == 1)
}

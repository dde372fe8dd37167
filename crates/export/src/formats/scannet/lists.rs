//! The lists of scans by which loaders know what to learn from: `scannetv2_{train,val,test}.txt`, by the dataset's own partition.

use super::names::scan;
use crate::ExportError;
use crate::export_folder::ExportFolder;
use crate::selected_frames::{SelectedFrames, Track};
use enfilade_dataset::{DatasetError, PartitionRow, Side};
use enfilade_scene::Warning;
use std::collections::{BTreeMap, BTreeSet};

/// Writes the three lists, a name a line. Without a partition everything is there to learn from.
pub(super) fn write(selected: &SelectedFrames<'_>, out: &ExportFolder) -> Result<(), ExportError> {
    let mut lists: BTreeMap<Side, String> = Side::ALL.map(|side| (side, String::new())).into();
    let mut torn = Vec::new();
    let rows = match selected.dataset.read_partition() {
        Err(error) if DatasetError::is_not_found(&error) => None,
        rows => Some(rows?),
    };
    let rows: Option<BTreeMap<Key<'_>, Side>> = rows.as_ref().map(|rows| rows.iter().filter_map(placed).collect());
    for track in &selected.tracks {
        match rows.as_ref().map_or(Some(Side::Train), |rows| side(track, rows)) {
            Some(side) => lists.entry(side).or_default().push_str(&format!("{}\n", scan(track))),
            None => torn.push(scan(track)),
        }
    }
    if let Some(first) = torn.first() {
        let others = torn.len() - 1;
        let message = format!("{first} and {others} more are in no list: their frames are on no side of the partition, or on several");
        selected.warn(Warning { place: selected.dataset.layout().partition().display().to_string(), message });
    }
    if lists[&Side::Train].is_empty() && lists.values().any(|list| !list.is_empty()) {
        let message =
            "no scan is in scannetv2_train.txt: no scene of this export is in train of the partition; divide again (enfilade partition)";
        selected.warn(Warning { place: selected.dataset.layout().partition().display().to_string(), message: message.into() });
    }
    lists.iter().try_for_each(|(side, list)| out.write(&format!("scannetv2_{}.txt", side.name()), list.as_bytes()))
}

/// Scene, camera and frame.
type Key<'r> = (&'r str, &'r str, u32);

fn placed(row: &PartitionRow) -> Option<(Key<'_>, Side)> {
    Some(((row.scene.as_str(), row.camera.as_str(), row.frame), *row.side.as_ref().ok()?))
}

/// Side of the scan's frames; `None` where they are in several or in none.
fn side(track: &Track, rows: &BTreeMap<Key<'_>, Side>) -> Option<Side> {
    let of_frame = |frame: u32| rows.get(&(track.scene.as_str(), track.name.as_str(), frame)).copied();
    let sides: BTreeSet<Side> = track.views().filter_map(|view| of_frame(view.frame())).collect();
    sides.first().copied().filter(|_| sides.len() == 1)
}

//! Names of scans.

use crate::selected_frames::Track;

/// The name of a scan. Some loaders take no other than `scene0000_00`, which camera `cam_00` of a scene `scene0000` becomes.
pub fn scan(track: &Track) -> String {
    let digits = |text: &str, prefix: &str, count: usize| {
        let number = text.strip_prefix(prefix).filter(|rest| rest.len() == count && rest.bytes().all(|b| b.is_ascii_digit()));
        number.map(str::to_string)
    };
    let number = digits(&track.name, "cam_", 2).filter(|_| digits(&track.scene, "scene", 4).is_some());
    format!("{}_{}", track.scene, number.as_ref().unwrap_or(&track.name))
}

//! Lists of pairs of frames: `pairs.csv` at the dataset's root, and lists in its form that people make.

use crate::DatasetError;
use crate::tables::Table;
use serde::{Deserialize, Serialize};
use std::path::Path;

const NAMES: [&str; 5] = ["scene_name", "first_camera_name", "first_frame_id", "second_camera_name", "second_frame_id"];
const VALUES: [&str; 4] = ["first_seen_by_second", "second_seen_by_first", "baseline_m", "angle_deg"];

/// Two frames of a scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct FramePair {
    /// Name of the scene.
    pub scene: String,
    /// Camera and number of the first.
    pub first: (String, u32),
    /// Camera and number of the second.
    pub second: (String, u32),
}

/// A pair with what its frames have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct PairRow {
    /// The two frames.
    pub pair: FramePair,
    /// Share of the first one's surfaces that the second sees, 0 to 1.
    pub first_seen_by_second: f32,
    /// Share of the second one's surfaces that the first sees, 0 to 1.
    pub second_seen_by_first: f32,
    /// Distance between the camera centres, metres.
    pub baseline_m: f64,
    /// Angle between the viewing axes, degrees.
    pub angle_deg: f64,
}

/// Writes a list of pairs.
///
/// # Errors
/// When the file cannot be written.
pub fn write_pairs(path: &Path, rows: &[PairRow]) -> Result<(), DatasetError> {
    let mut table = Table::new(path, &[&NAMES[..], &VALUES].concat());
    let cells = |row: &PairRow| {
        let FramePair { scene, first, second } = &row.pair;
        let shares = [row.first_seen_by_second, row.second_seen_by_first].map(|share| format!("{share:.6}"));
        let names = [scene.clone(), first.0.clone(), first.1.to_string(), second.0.clone(), second.1.to_string()];
        let values = [format!("{:.6}", row.baseline_m), format!("{:.4}", row.angle_deg)];
        names.into_iter().chain(shares).chain(values).collect()
    };
    table.rows = rows.iter().map(cells).collect();
    table.write()
}

/// The pairs of a list, in its order; only the columns that name them need be there.
///
/// # Errors
/// When the file is missing, lacks one of these columns, or has a frame number that is none.
pub fn read_pairs(path: &Path) -> Result<Vec<FramePair>, DatasetError> {
    let table = Table::read(path)?;
    let at = table.columns(NAMES)?;
    let pair = |i: usize| {
        let cell = |column: usize| table.rows[i][at[column]].clone();
        Ok(FramePair { scene: cell(0), first: (cell(1), table.parse(i, at[2])?), second: (cell(3), table.parse(i, at[4])?) })
    };
    (0..table.rows.len()).map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_come_back_also_from_lists_with_fewer_columns() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pairs.csv");
        let pair = FramePair { scene: "room".into(), first: ("cam_00".into(), 3), second: ("cam_01".into(), 7) };
        let values =
            PairRow { pair: pair.clone(), first_seen_by_second: 0.25, second_seen_by_first: 1.0 / 3.0, baseline_m: 1.5, angle_deg: 30.0 };
        write_pairs(&path, &[values]).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let expected = "scene_name,first_camera_name,first_frame_id,second_camera_name,second_frame_id,first_seen_by_second,\
            second_seen_by_first,baseline_m,angle_deg\nroom,cam_00,3,cam_01,7,0.250000,0.333333,1.500000,30.0000\n";
        assert_eq!(text, expected);
        assert_eq!(read_pairs(&path).unwrap(), std::slice::from_ref(&pair));
        let short = "first_camera_name,first_frame_id,second_camera_name,second_frame_id,scene_name\ncam_00,3,cam_01,7,room\n";
        std::fs::write(&path, short).unwrap();
        assert_eq!(read_pairs(&path).unwrap(), [pair]);
        std::fs::write(&path, short.replace(",7,", ",seven,")).unwrap();
        let message = read_pairs(&path).unwrap_err().to_string();
        assert!(message.contains("line 2, column \"second_frame_id\""), "{message}");
    }
}

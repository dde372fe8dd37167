//! `metadata_images_split_scene_v1.csv`: every image of the dataset, whether it is meant for use, and on which side of the partition.
//! The format is Hypersim's, with Python's `True` and `False`; our file is at the dataset's root.

use crate::tables::Table;
use crate::{Dataset, DatasetError};
use std::str::FromStr;

const HEADER: [&str; 6] = ["scene_name", "camera_name", "frame_id", "included_in_public_release", "exclude_reason", "split_partition_name"];

/// A side of the partition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// To learn from.
    Train,
    /// To choose settings by.
    Val,
    /// To report numbers on.
    Test,
}

impl Side {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Train, Self::Val, Self::Test];

    /// Hypersim's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Val => "val",
            Self::Test => "test",
        }
    }
}

impl FromStr for Side {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|side| side.name() == name);
        found.ok_or_else(|| format!("expected train, val or test, found {name:?}"))
    }
}

/// An image of the partition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartitionRow {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
    /// Side of the partition, or why it is not meant for use.
    pub side: Result<Side, String>,
}

impl Dataset {
    /// Writes the partition.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_partition(&self, rows: &[PartitionRow]) -> Result<(), DatasetError> {
        let mut table = Table::new(&self.layout().partition(), &HEADER);
        let cells = |row: &PartitionRow| {
            let (included, reason, side) = match &row.side {
                Ok(side) => ("True", "", side.name()),
                Err(reason) => ("False", reason.as_str(), ""),
            };
            [&row.scene, &row.camera, row.frame.to_string().as_str(), included, reason, side].map(str::to_string).to_vec()
        };
        table.rows = rows.iter().map(cells).collect();
        table.write()
    }

    /// The partition, Hypersim's own included.
    ///
    /// # Errors
    /// When the file is missing or damaged.
    pub fn read_partition(&self) -> Result<Vec<PartitionRow>, DatasetError> {
        let path = self.layout().partition();
        let table = Table::read(&path)?;
        let at = table.columns(HEADER)?;
        let row = |i: usize| {
            let cell = |column: usize| table.rows[i][at[column]].clone();
            let side = match cell(3).as_str() {
                "True" => Ok(cell(5).parse().map_err(|problem| DatasetError::text(&path, format!("line {}: {problem}", i + 2)))?),
                "False" => Err(cell(4)),
                other => {
                    let problem = format!("line {}: included_in_public_release is {other:?}; expected True or False", i + 2);
                    return Err(DatasetError::text(&path, problem));
                }
            };
            Ok(PartitionRow { scene: cell(0), camera: cell(1), frame: table.parse(i, at[2])?, side })
        };
        (0..table.rows.len()).map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_has_hypersims_columns_and_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let row = |frame, side| PartitionRow { scene: "ai_001_001".into(), camera: "cam_00".into(), frame, side };
        let rows = [row(0, Ok(Side::Train)), row(1, Err("blank".into())), row(2, Ok(Side::Test))];
        dataset.write_partition(&rows).unwrap();
        let text = std::fs::read_to_string(dataset.root().join("metadata_images_split_scene_v1.csv")).unwrap();
        let expected = "scene_name,camera_name,frame_id,included_in_public_release,exclude_reason,split_partition_name\n\
            ai_001_001,cam_00,0,True,,train\nai_001_001,cam_00,1,False,blank,\nai_001_001,cam_00,2,True,,test\n";
        assert_eq!(text, expected);
        assert_eq!(dataset.read_partition().unwrap(), rows);
    }
}

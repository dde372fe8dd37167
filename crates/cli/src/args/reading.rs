//! How datasets are opened that are read and not made, and which of their frames are chosen.

use super::values::parse_range;
use clap::Args;
use enfilade_dataset::{CameraTable, Dataset, DatasetError};
use std::path::{Path, PathBuf};

/// `--scene`, `--camera` and `--frames`.
#[derive(Args)]
pub struct FramesArg {
    /// Only the scenes of these names ("bed*", "hall,bedroom")
    #[arg(long, value_name = "PATTERN", visible_alias = "scenes")]
    pub scene: Option<String>,
    /// Only the cameras of these names ("cam_00", "cam_0*")
    #[arg(long, value_name = "PATTERN", visible_alias = "cameras")]
    pub camera: Option<String>,
    /// Only frames of these numbers: 0..10 (without 10), 5.. or 7
    #[arg(long, value_name = "RANGE", value_parser = parse_range, allow_negative_numbers = true)]
    pub frames: Option<std::ops::Range<u32>>,
}

/// `--cameras-csv`.
#[derive(Args)]
#[command(next_help_heading = "Hypersim's own data (docs/hypersim.md)")]
pub struct CamerasArg {
    /// Apple's metadata_camera_parameters.csv [default: in the dataset's folder or the one above]
    #[arg(long, value_name = "CSV")]
    pub cameras_csv: Option<PathBuf>,
}

impl CamerasArg {
    /// The dataset in `folder` with these cameras, also if nothing has been made there yet.
    pub fn open_or_await(&self, folder: &Path) -> Result<Dataset, DatasetError> {
        match self.open(folder) {
            Err(DatasetError::NotADataset { .. }) => Dataset::awaited(folder),
            opened => opened,
        }
    }

    /// The dataset in `folder` with these cameras.
    pub fn open(&self, folder: &Path) -> Result<Dataset, DatasetError> {
        let dataset = Dataset::open(folder)?;
        Ok(match &self.cameras_csv {
            Some(table) => {
                // What needs little of it makes do without one, and a mistyped name would pass for that.
                CameraTable::read(table)?;
                dataset.with_camera_table(table)
            }
            None => dataset,
        })
    }
}

//! How datasets are opened that are read and not made.

use clap::Args;
use enfilade_dataset::{CameraTable, Dataset, DatasetError};
use std::path::{Path, PathBuf};

/// `--cameras-csv`.
#[derive(Args)]
#[command(next_help_heading = "Hypersim's own data (docs/hypersim.md)")]
pub struct CamerasArg {
    /// Apple's metadata_camera_parameters.csv [default: in the dataset's folder or the one above]
    #[arg(long, value_name = "CSV")]
    pub cameras_csv: Option<PathBuf>,
}

impl CamerasArg {
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

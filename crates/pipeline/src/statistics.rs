//! The statistics of a dataset, with a note in the work folder of what was written, by which a run finds files that are damaged or gone.

use crate::workdir::{STATISTICS, read_json};
use enfilade_dataset::{Dataset, DatasetError, FileRecord, WORKDIR, write_json};
use enfilade_scene::Cx;
use enfilade_show::stats::{self, StatsConfig, StatsSummary};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files of the statistics, by their paths within the folder.
type Written = BTreeMap<PathBuf, FileRecord>;

/// Writes statistics of a dataset. Those in its own folder stay as they are asked for here until its frames change.
///
/// # Errors
/// When a file cannot be read or written, or there is nothing to compare with.
pub fn write_statistics(dataset: &Dataset, config: &StatsConfig, cx: &dyn Cx) -> Result<StatsSummary, DatasetError> {
    // Data of others have no work folder.
    if config.folder.is_some() || !dataset.root().join(WORKDIR).is_dir() {
        return stats::write_statistics(dataset, config, cx);
    }
    // From here on the old note must not speak of the new files.
    write_note(dataset, &Written::new())?;
    let summary = stats::write_statistics(dataset, config, cx)?;
    let folder = dataset.layout().statistics_dir();
    let written = |path: &PathBuf| Ok((within(&folder, path), FileRecord::of(path)?));
    write_note(dataset, &summary.files.iter().map(written).collect::<Result<_, DatasetError>>()?)?;
    Ok(summary)
}

/// Whether a dataset has statistics as they were written. Where earlier versions wrote them, it is not known how.
pub(crate) fn statistics_are_whole(dataset: &Dataset) -> bool {
    let (folder, files) = (dataset.layout().statistics_dir(), read_json::<Written>(&note(dataset)).unwrap_or_default());
    let is_whole = |(path, file): (&PathBuf, &FileRecord)| FileRecord::of(&folder.join(path)).is_ok_and(|found| found == *file);
    dataset.layout().statistics().is_file() && files.iter().all(is_whole)
}

fn within(folder: &Path, path: &Path) -> PathBuf {
    path.strip_prefix(folder).unwrap_or(path).into()
}

fn write_note(dataset: &Dataset, files: &Written) -> Result<(), DatasetError> {
    // Paths are text: a work folder is refused where they are not.
    write_json(&note(dataset), files)
}

fn note(dataset: &Dataset) -> PathBuf {
    dataset.root().join(WORKDIR).join(STATISTICS)
}

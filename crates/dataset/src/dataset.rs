//! A dataset as a handle: its layout, and the table of cameras that is read. What it reads and writes is in the files beside this one.

use crate::{DatasetError, Layout, refuse_newer_layout};
use std::path::{Path, PathBuf};

/// A dataset on disk.
///
/// It contains nothing but its paths, so it is cheap to clone and can be shared by threads. Files are read at the moment of the call.
/// Different frames may be written at the same time; the tables of one scene, and the tables at the root, are written by one thread at a
/// time.
///
/// ```
/// use enfilade_dataset::{Dataset, Side, PartitionRow};
/// # let folder = tempfile::tempdir()?;
/// let dataset = Dataset::create(folder.path().join("homes"))?;
/// let row = PartitionRow { scene: "home_001".into(), camera: "cam_00".into(), frame: 7, side: Ok(Side::Train) };
/// dataset.write_partition(&[row.clone()])?;
/// assert_eq!(Dataset::open(dataset.root())?.read_partition()?, [row]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Dataset {
    layout: Layout,
    /// The table of cameras that is read, where it is not the dataset's own.
    camera_table: Option<PathBuf>,
}

impl Dataset {
    /// The dataset at `root`, which is made if it does not exist. What is already there is kept.
    ///
    /// # Errors
    /// When the folder cannot be made, or contains a dataset of a newer layout.
    pub fn create(root: impl AsRef<Path>) -> Result<Self, DatasetError> {
        let layout = Layout::new(root.as_ref());
        refuse_newer_layout(root.as_ref())?;
        std::fs::create_dir_all(layout.scenes_dir()).map_err(DatasetError::at("create the folder", layout.scenes_dir()))?;
        Ok(Self { layout, camera_table: None })
    }

    /// The dataset at `root`: ours, the Hypersim toolkit's, or a folder of unpacked Hypersim archives, whose scenes are directly under the
    /// root. Hypersim's table of cameras, which is distributed apart from the archives, may also be in the folder above.
    ///
    /// # Errors
    /// When the folder cannot be read, is no dataset, or contains one of a newer layout.
    pub fn open(root: impl AsRef<Path>) -> Result<Self, DatasetError> {
        let layout = Layout::new(root.as_ref());
        refuse_newer_layout(root.as_ref())?;
        if layout.scenes_dir().is_dir() {
            return Ok(Self { camera_table: table_nearby(&layout), layout });
        }
        let layout = Layout::flat(root.as_ref());
        if layout.root().join("_detail").is_dir() {
            let problem = "it is one scene of a dataset; name the dataset's folder, and --scene if the command has that".to_string();
            return Err(DatasetError::NotADataset { root: root.as_ref().to_path_buf(), problem });
        }
        let dataset = Self { camera_table: table_nearby(&layout), layout };
        if dataset.scenes()?.is_empty() {
            let problem = "it has no folder \"scenes\" and no folder with \"_detail\" or \"images\" in it; check the path".to_string();
            return Err(DatasetError::NotADataset { root: root.as_ref().to_path_buf(), problem });
        }
        Ok(dataset)
    }

    /// The dataset that a run is about to make in a folder that is there and has no folders yet, apart from hidden ones.
    ///
    /// # Errors
    /// When the folder cannot be read, or has folders that are no dataset.
    pub fn awaited(root: impl AsRef<Path>) -> Result<Self, DatasetError> {
        let root = root.as_ref();
        let mut entries = std::fs::read_dir(root).map_err(DatasetError::at("read the folder", root))?.flatten();
        let is_folder = |entry: std::fs::DirEntry| !entry.file_name().to_string_lossy().starts_with('.') && entry.path().is_dir();
        if entries.any(is_folder) { Self::open(root) } else { Ok(Self { layout: Layout::new(root), camera_table: None }) }
    }

    /// The dataset's folder.
    pub fn root(&self) -> &Path {
        self.layout.root()
    }

    /// A dataset that reads the cameras of another table, in the form of Hypersim's `metadata_camera_parameters.csv`.
    #[must_use]
    pub fn with_camera_table(self, table: impl Into<PathBuf>) -> Self {
        Self { camera_table: Some(table.into()), ..self }
    }

    /// A dataset that writes pictures, contact sheets and exposures to another folder, which gets the same tree. Nothing is written beside
    /// the images of others.
    #[must_use]
    pub fn with_pictures_in(self, folder: impl Into<PathBuf>) -> Self {
        Self { layout: self.layout.with_pictures_in(folder), ..self }
    }

    /// The table of cameras that is read; it need not be there.
    pub fn camera_table(&self) -> PathBuf {
        self.camera_table.clone().unwrap_or_else(|| self.layout.camera_parameters())
    }

    /// The paths of all files.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }
}

/// Folders in which people have Hypersim's table: the dataset's, the toolkit's within it, and the same of the folder above.
fn table_nearby(layout: &Layout) -> Option<PathBuf> {
    const TOOLKIT: &str = "contrib/mikeroberts3000";
    let own = layout.camera_parameters();
    let name = own.file_name()?;
    let root = std::fs::canonicalize(layout.root()).ok()?;
    let above = root.parent();
    let folders =
        [Some(layout.scenes_dir().to_path_buf()), Some(root.join(TOOLKIT)), above.map(Path::to_path_buf), above.map(|a| a.join(TOOLKIT))];
    let mut tables = folders.into_iter().flatten().map(|folder| folder.join(name));
    (!own.is_file()).then(|| tables.find(|table| table.is_file())).flatten()
}

use crate::{DatasetError, Layout};
use std::path::Path;

/// A dataset on disk.
///
/// It holds nothing but its paths, so it is cheap to clone and can be shared by threads. What is read is read at the moment of
/// the call. Different frames may be written at the same time; the tables of one scene, and the tables at the root, are
/// written by one thread at a time.
#[derive(Clone, Debug)]
pub struct Dataset {
    layout: Layout,
}

impl Dataset {
    /// The dataset at `root`, which is made if it does not exist. What is already there is kept.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn create(root: impl AsRef<Path>) -> Result<Self, DatasetError> {
        let layout = Layout::new(root.as_ref());
        std::fs::create_dir_all(layout.scenes_dir()).map_err(DatasetError::at("create the folder", layout.scenes_dir()))?;
        Ok(Self { layout })
    }

    /// The dataset at `root`: ours, the Hypersim toolkit's, or a folder of unpacked Hypersim archives, whose scenes lie directly
    /// under the root.
    ///
    /// # Errors
    /// When the folder cannot be read or is no dataset.
    pub fn open(root: impl AsRef<Path>) -> Result<Self, DatasetError> {
        let layout = Layout::new(root.as_ref());
        if layout.scenes_dir().is_dir() {
            return Ok(Self { layout });
        }
        let dataset = Self { layout: Layout::flat(root.as_ref()) };
        if dataset.scenes()?.is_empty() {
            let problem = "it has no folder \"scenes\" and no folder with \"_detail\" or \"images\" in it; check the path".to_string();
            return Err(DatasetError::NotADataset { root: root.as_ref().to_path_buf(), problem });
        }
        Ok(dataset)
    }

    /// The dataset's folder.
    pub fn root(&self) -> &Path {
        self.layout.root()
    }

    /// Where everything lies.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }
}

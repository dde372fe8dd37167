//! Options of `enfilade annotate`: which scene to annotate, and where its labels and classes are.

use enfilade_import::UpAxis;
use std::path::PathBuf;

/// What to annotate.
#[derive(Clone, Debug, Default)]
pub struct AnnotateOptions {
    /// A scene file, a dataset, a scene's folder in it, or a Hypersim mesh folder.
    pub path: PathBuf,
    /// Which of a dataset's scenes.
    pub scene: Option<String>,
    /// Where labels go, if not the folder of the dataset or beside the file.
    pub labels: Option<PathBuf>,
    /// A folder with labels of an earlier version of the scene, which are carried over by names and shapes.
    pub carry: Option<PathBuf>,
    /// A list of classes, if not the one in the folder of labels or NYU40.
    pub classes: Option<PathBuf>,
    /// Metres per unit of a scene file, if not 1; multiplies the unit stated in the file.
    pub meters_per_unit: Option<f64>,
    /// The axis that points up in a scene file, if not the one that its format states.
    pub up_axis: Option<UpAxis>,
}

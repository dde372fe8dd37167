//! From names in an address to files of the dataset, and to no others.

use super::Viewer;
use super::cache::Stamp;
use crate::serve::ApiProblem;
use enfilade_dataset::{DatasetError, Layout, check_name};
use std::path::Path;

/// A scene, a camera of it and the number of a frame, of names that can be parts of paths.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct FramePlace {
    /// Scene name.
    pub scene: String,
    /// Camera name.
    pub camera: String,
    /// Frame number.
    pub frame: u32,
}

impl FramePlace {
    /// The place of an address.
    ///
    /// # Errors
    /// 400 when a name cannot be part of a path or the frame is no number.
    pub fn parse([scene, camera, frame]: [String; 3]) -> Result<Self, ApiProblem> {
        check_name("scene name", &scene).map_err(problem)?;
        check_name("camera name", &camera).map_err(problem)?;
        let wrong = || ApiProblem::bad_request(format!("the frame is {frame:?}"), "give its number, such as 0 or 12");
        // A sign or blanks would be taken by `parse`, and make two addresses of one frame.
        let digits = frame.bytes().all(|b| b.is_ascii_digit());
        let frame = frame.parse().ok().filter(|_| digits).ok_or_else(wrong)?;
        Ok(Self { scene, camera, frame })
    }
}

/// What a problem with the dataset is to the one who asked.
pub fn problem(error: DatasetError) -> ApiProblem {
    let text = error.to_string();
    if error.is_not_found() {
        return ApiProblem::not_found(text, "look at /api/view/dataset for what there is; it may not be made yet");
    }
    match error {
        DatasetError::Name { .. } => ApiProblem::bad_request(text, "use the names that /api/view/dataset lists"),
        _ => ApiProblem::failed(text, "mend or delete the file that is named"),
    }
}

/// `None` instead of the error that a file does not exist.
pub fn optional<T>(result: Result<T, DatasetError>) -> Result<Option<T>, ApiProblem> {
    match result {
        Err(error) if error.is_not_found() => Ok(None),
        other => other.map(Some).map_err(problem),
    }
}

impl Viewer {
    /// Where things lie.
    pub(super) fn layout(&self) -> &Layout {
        self.dataset.layout()
    }

    /// A path relative to the dataset's folder, with forward slashes.
    pub(super) fn in_dataset(&self, path: &Path) -> String {
        let inside = path.strip_prefix(self.dataset.root()).unwrap_or(path);
        inside.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
    }

    /// Checks that a file or folder lies in the dataset's folder once symbolic links are followed, as far as it exists.
    ///
    /// # Errors
    /// 403 when it lies elsewhere.
    pub(super) fn allow(&self, path: &Path) -> Result<(), ApiProblem> {
        // What does not exist leads nowhere; the one who reads it says that it is missing.
        let Ok(real) = std::fs::canonicalize(path) else { return Ok(()) };
        if real.starts_with(&self.root) {
            return Ok(());
        }
        let inside = path.strip_prefix(self.dataset.root()).unwrap_or(path);
        let error = format!("{} leads out of the dataset's folder", inside.display());
        Err(ApiProblem::forbidden(error, "copy what the symbolic link leads to into the dataset, or open the folder that has it"))
    }

    /// [`Viewer::allow`] for several.
    pub(super) fn allow_all<P: AsRef<Path>>(&self, paths: impl IntoIterator<Item = P>) -> Result<(), ApiProblem> {
        paths.into_iter().try_for_each(|path| self.allow(path.as_ref()))
    }

    /// Checks a scene's name and that it is there.
    ///
    /// # Errors
    /// 400 for a name that cannot be part of a path, 404 for a scene that is not there, 403 for one that lies elsewhere.
    pub(super) fn check_scene(&self, scene: &str) -> Result<(), ApiProblem> {
        check_name("scene name", scene).map_err(problem)?;
        if !self.layout().detail_dir(scene).is_dir() && !self.layout().images_dir(scene).is_dir() {
            return Err(ApiProblem::not_found(
                format!("there is no scene {scene:?}"),
                "look at /api/view/dataset for the names of the scenes",
            ));
        }
        self.allow_all([self.layout().scene_dir(scene), self.layout().detail_dir(scene), self.layout().images_dir(scene)])
    }

    /// Checks a scene's and a camera's name and that they are there.
    ///
    /// # Errors
    /// As [`Viewer::check_scene`].
    pub(super) fn check_camera(&self, scene: &str, camera: &str) -> Result<(), ApiProblem> {
        self.check_scene(scene)?;
        check_name("camera name", camera).map_err(problem)?;
        self.allow_all([self.layout().metadata_cameras(scene), self.layout().camera_dir(scene, camera)])?;
        let known = self.dataset.cameras(scene).map_err(problem)?.iter().any(|name| name == camera);
        if known {
            return Ok(());
        }
        let help = format!("look at /api/view/scene/{scene} for the names of its cameras");
        Err(ApiProblem::not_found(format!("the scene {scene:?} has no camera {camera:?}"), help))
    }
}

/// Length and time of change of a file; nothing where it cannot be had, so that whoever reads it says why.
pub fn stamp(path: &Path) -> Stamp {
    std::fs::metadata(path).map_or((0, None), |data| (data.len(), data.modified().ok()))
}

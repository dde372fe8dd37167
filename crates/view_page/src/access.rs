//! The files of the dataset that requests may read: files of existing scenes and cameras, inside of its folder.

use super::place::problem;
use super::viewer::Viewer;
use enfilade_dataset::{Layout, check_name};
use enfilade_serve::ApiProblem;
use std::path::Path;

impl Viewer {
    /// The paths of the dataset's files.
    pub(super) fn layout(&self) -> &Layout {
        self.dataset.layout()
    }

    /// A path relative to the dataset's folder, with forward slashes.
    pub(super) fn in_dataset(&self, path: &Path) -> String {
        let inside = path.strip_prefix(self.dataset.root()).unwrap_or(path);
        inside.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
    }

    /// Checks that a file or folder is in the dataset's folder once symbolic links are followed, as far as it exists.
    ///
    /// # Errors
    /// 403 if it is elsewhere.
    pub(super) fn allow(&self, path: &Path) -> Result<(), ApiProblem> {
        // A path that does not exist is harmless; reading it will report that it is missing.
        let Ok(real) = std::fs::canonicalize(path) else { return Ok(()) };
        let inside = path.strip_prefix(self.dataset.root()).unwrap_or(path);
        if real.starts_with(&self.root) {
            // Opening a pipe would wait for somebody who writes into it.
            let waits = std::fs::metadata(&real).is_ok_and(|data| !data.is_file() && !data.is_dir());
            let error = || format!("{} is neither a file nor a folder", inside.display());
            return if waits { Err(ApiProblem::forbidden(error(), "remove it from the dataset")) } else { Ok(()) };
        }
        let error = format!("{} leads out of the dataset's folder", inside.display());
        Err(ApiProblem::forbidden(error, "copy what the symbolic link leads to into the dataset, or open the folder that has it"))
    }

    /// [`Viewer::allow`] for several.
    pub(super) fn allow_all<P: AsRef<Path>>(&self, paths: impl IntoIterator<Item = P>) -> Result<(), ApiProblem> {
        paths.into_iter().try_for_each(|path| self.allow(path.as_ref()))
    }

    /// Checks a scene's name and that the scene exists.
    ///
    /// # Errors
    /// 400 for a name that cannot be part of a path, 404 for a scene that does not exist, 403 for one that is elsewhere.
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

//! The scene package that frames were rendered from, if the dataset still has it: with it, rays decide what hides what.

use crate::{Filmed, MultiviewError};
use enfilade_dataset::read_package;
use enfilade_render::{Lookout, RenderError};
use enfilade_scene::{Cx, Scene, Warning};
use std::path::PathBuf;

/// A scene as it was rendered.
pub struct ScenePackage {
    path: PathBuf,
    /// Everything that the frames show.
    pub scene: Scene,
}

impl ScenePackage {
    /// The package of the scene that was filmed; `None` where there is none, or it is another one than some frame was rendered from,
    /// of which `cx` is warned.
    ///
    /// # Errors
    /// When it is there but cannot be read.
    pub fn read(filmed: &Filmed<'_>, cx: &dyn Cx) -> Result<Option<Self>, MultiviewError> {
        let path = filmed.dataset.layout().scene_package(&filmed.scene);
        let wrong = |problem: String| MultiviewError::Package { path: path.clone(), problem };
        let bytes = match std::fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            bytes => bytes.map_err(|error| wrong(format!("cannot be read: {error}")))?,
        };
        if let Some((camera, frame)) = rendered_from_another(filmed, &bytes)? {
            let message = format!(
                "{camera}/frame.{frame:04} was rendered from another version of the scene than the package in the work folder, which is not \
                 used; run again, which renders anew what is out of date"
            );
            cx.warn(Warning { place: filmed.scene.clone(), message });
            return Ok(None);
        }
        let scene = read_package(&path, &bytes).map_err(|error| wrong(error.to_string()))?;
        Ok(Some(Self { path, scene }))
    }

    /// The scene prepared for rays. Building its hierarchy takes time, so do it once for all queries.
    ///
    /// # Errors
    /// When the scene cannot be used.
    pub(crate) fn lookout(&self) -> Result<Lookout<'_>, MultiviewError> {
        Lookout::new(&self.scene).map_err(|error| self.wrong(&error))
    }

    /// The scene prepared for rays that look through surfaces.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn lookout_through_surfaces(&self) -> Result<Lookout<'_>, MultiviewError> {
        Lookout::through_surfaces(&self.scene).map_err(|error| self.wrong(&error))
    }

    /// The scene as the rows of a frame show it, [`Filmed::moments`], prepared for rays.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn ready<'s>(&self, moments: &'s [(u32, Scene)]) -> Result<Lookout<'s>, MultiviewError> {
        Lookout::of_rows(moments).map_err(|error| self.wrong(&error))
    }

    /// [`ScenePackage::ready`] for rays that look through surfaces.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn ready_through_surfaces<'s>(&self, moments: &'s [(u32, Scene)]) -> Result<Lookout<'s>, MultiviewError> {
        Lookout::through_surfaces_of_rows(moments).map_err(|error| self.wrong(&error))
    }

    fn wrong(&self, error: &RenderError) -> MultiviewError {
        MultiviewError::Package { path: self.path.clone(), problem: error.to_string() }
    }
}

/// The first frame whose record has the checksum of another package. Records of earlier versions have no checksum.
fn rendered_from_another(filmed: &Filmed<'_>, bytes: &[u8]) -> Result<Option<(String, u32)>, MultiviewError> {
    let found = blake3::hash(bytes).to_hex();
    for (camera, number) in (0..filmed.len()).map(|frame| filmed.name(frame)) {
        let recipe = filmed.dataset.frame_record(&filmed.scene, camera, number)?.and_then(|record| record.recipe);
        if recipe.is_some_and(|recipe| recipe.scene_blake3 != found.as_str()) {
            return Ok(Some((camera.into(), number)));
        }
    }
    Ok(None)
}

//! Which frames `make` works on, and the scene that they were rendered from.

use crate::args::FramesArg;
use crate::outcome::Problem;
use enfilade_dataset::{ChosenFrames, Dataset};
use enfilade_multiview::{Filmed, ScenePackage};
use enfilade_scene::Cx;

/// The names of the cameras that a pattern means; `None` for all.
pub fn cameras(dataset: &Dataset, scenes: &[String], pattern: Option<&str>) -> Result<Option<Vec<String>>, Problem> {
    let Some(pattern) = pattern else { return Ok(None) };
    Ok(Some(enfilade_pipeline::select("camera", &dataset.camera_names(scenes)?, Some(pattern))?))
}

/// The frames that `--scene`, `--camera` and `--frames` mean.
pub fn chosen_frames(dataset: &Dataset, args: &FramesArg) -> Result<ChosenFrames, Problem> {
    let scenes = enfilade_pipeline::select("scene", &dataset.scenes()?, args.scene.as_deref())?;
    let cameras = cameras(dataset, &scenes, args.camera.as_deref())?;
    Ok(ChosenFrames { scenes, cameras, frames: args.frames.clone() })
}

/// What to say where these mean no frame that is there.
pub fn nothing_chosen() -> Problem {
    Problem::of_data("no existing frame was selected", "choose others, or render them: enfilade run")
}

/// Calls `work` for every scene of which frames are chosen, with what was filmed, these frames and the scene itself.
pub fn each_filmed(
    dataset: &Dataset,
    chosen: &ChosenFrames,
    cx: &dyn Cx,
    mut work: impl FnMut(&str, &Filmed<'_>, &[usize], &ScenePackage) -> Result<(), Problem>,
) -> Result<(), Problem> {
    for scene in &chosen.scenes {
        let filmed = Filmed::read(dataset, scene, chosen.cameras.as_deref(), cx)?;
        let frames = filmed.numbered(chosen.frames.as_ref());
        if !frames.is_empty() {
            work(scene, &filmed, &frames, &package(dataset, scene, &filmed, cx)?)?;
        }
    }
    Ok(())
}

/// The scene that was filmed, for verbs that cannot do without.
///
/// # Errors
/// When it is not there, or is another one than the frames were rendered from.
pub fn package(dataset: &Dataset, scene: &str, filmed: &Filmed<'_>, cx: &dyn Cx) -> Result<ScenePackage, Problem> {
    ScenePackage::read(filmed, cx)?.ok_or_else(|| {
        let message =
            format!("{} is not the scene that {scene} was rendered from, or not there", dataset.layout().scene_package(scene).display());
        Problem::of_data(message, "rays need it: use the dataset where `enfilade run` made it, and run it again where it is out of date")
    })
}

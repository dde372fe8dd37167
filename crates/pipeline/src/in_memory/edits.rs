//! Edits of a scene in memory: each gives a new one, which shares what did not change.

use super::LoadedScene;
use crate::config::FileSource;
use crate::error::Error;
use crate::intake::{labelled, load_file};
use enfilade_compose::{MotionGroup, with_motion};
use enfilade_dataset::counted;
use enfilade_import::scene_name;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{Cx, EditError, LabelledScene, MaterialChoice, NewThing, Scene, Warning};
use std::path::Path;

/// How a scene file becomes part of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilePlace {
    /// Name of the object that contains what is added; the file's name without the extension unless given.
    pub name: Option<String>,
    /// A material instead of all of its own.
    pub material: Option<MaterialChoice>,
    /// Placement of the file's space, in metres and with z up.
    pub world_from_file: DAffine3,
    /// NYU40 class of all that is added, as one instance; the file's own labels unless given.
    pub class: Option<i16>,
}

impl LoadedScene {
    /// A scene without anything, to be filled.
    pub fn empty(name: &str) -> Self {
        Self::new(name.into(), LabelledScene::default(), Vec::new(), serde_json::json!({}))
    }

    /// The scene after an edit. The edited one is as it was; what rays need is prepared for the new one with its first picture.
    ///
    /// # Errors
    /// When the edit refuses.
    pub fn edited(&self, edit: impl FnOnce(&LabelledScene) -> Result<LabelledScene, EditError>) -> Result<Self, Error> {
        let contents = edit(&self.contents).map_err(refused)?;
        Ok(Self::new(self.name.clone(), contents, self.warnings.clone(), self.report.clone()))
    }

    /// The scene in which one more thing moves, as a `[[motion]]` of a dataset moves it. Rendered as it is, it is at rest.
    ///
    /// # Errors
    /// When a value cannot be, or the scene has no such thing.
    pub fn with_motion(&self, motion: &MotionGroup) -> Result<Self, Error> {
        let scene = with_motion(self.scene(), std::slice::from_ref(motion));
        let scene = scene.map_err(|error| Error::usage(error.to_string(), "docs/motion.md has the keys"))?;
        self.edited(|before| Ok(LabelledScene { scene, labels: before.labels.clone(), picture_files: before.picture_files.clone() }))
    }

    /// The scene as it is at a moment, seconds; nothing in it moves.
    #[must_use]
    pub fn still_at(&self, time_s: f64) -> Self {
        let LabelledScene { scene, labels, picture_files } = &**self.contents();
        let contents = LabelledScene { scene: scene.still_at(time_s), labels: labels.clone(), picture_files: picture_files.clone() };
        Self::new(self.name.clone(), contents, self.warnings.clone(), self.report.clone())
    }

    /// The scene with all parts and lights of the file of `source` (its path is used unchanged), read as [`LoadedScene::read`] reads it but for
    /// the inspection of rooms. Its surroundings and cameras are left out. The warnings of its import, and what was left out, join those of the
    /// scene.
    ///
    /// # Errors
    /// If the file cannot be imported, or the edit is not possible.
    pub fn with_file(&self, source: &FileSource, place: &FilePlace, cx: &dyn Cx) -> Result<Self, Error> {
        let file = Path::new(&source.file);
        let mut imported = load_file(source, file, &|path| Ok(path.into()), cx)?;
        let told = told(&imported.scene).into_iter().map(|message| Warning { place: source.file.clone(), message });
        let warnings: Vec<Warning> = std::mem::take(&mut imported.report.warnings).into_iter().chain(told).collect();
        let offset = imported.report.offset_m.map_or(DVec3::ZERO, DVec3::from);
        let new = NewThing {
            name: place.name.clone().unwrap_or_else(|| scene_name(file)),
            of: &labelled(imported),
            material: place.material.clone(),
            // A file far from its origin was moved to the origin.
            world_from_thing: place.world_from_file * DAffine3::from_translation(offset),
            class: place.class,
        };
        let mut edited = self.edited(|scene| scene.with_thing(&new))?;
        edited.warnings.extend(warnings);
        Ok(edited)
    }
}

/// The error of an edit; what it would say of the nearest name is what to do.
fn refused(error: EditError) -> Error {
    match error {
        EditError::Unknown { kind, name, nearest: Some(nearest) } => {
            Error::usage(format!("the scene has no {kind} {name:?}"), format!("did you mean {nearest:?}?"))
        }
        error => Error::usage(error.to_string(), "the scene is as it was"),
    }
}

/// What of an added scene comes along, and what does not.
fn told(scene: &Scene) -> Vec<String> {
    let mut told = Vec::new();
    if !scene.lights.is_empty() {
        told.push(format!("its {} came with its parts", counted(scene.lights.len(), "light")));
    }
    if scene.environment.is_some() {
        told.push("its surroundings were left out: a scene has one sky".into());
    }
    if !scene.cameras.is_empty() {
        let verb = if scene.cameras.len() == 1 { "was" } else { "were" };
        told.push(format!("its {} {verb} left out", counted(scene.cameras.len(), "camera")));
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Quality, RenderChoices};
    use crate::in_memory::Shot;
    use enfilade_geometry::Mesh;
    use enfilade_math::{Rgb, Vec3};
    use enfilade_scene::{Camera, Environment, Intrinsics, Material, NewPart, PartLabel, Pose, Quiet, to_bytes_with_labels};
    use std::sync::Arc;

    fn cube(name: &str) -> NewPart {
        NewPart { class: Some(29), ..NewPart::new(name, Mesh::cuboid(Vec3::ONE), Material::diffuse("grey", Rgb::splat(0.5)).into()) }
    }

    #[test]
    fn a_file_comes_with_its_labels_and_its_warnings_and_without_its_sky() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("crate.scene");
        let mut model = LabelledScene::default().with_part(&cube("crate")).unwrap();
        model.scene.environment = Some(Environment::Constant { radiance: Rgb::WHITE });
        std::fs::write(&file, to_bytes_with_labels(&model.scene, &model.labels)).unwrap();
        let source = FileSource::of(file.to_string_lossy());
        let scene = LoadedScene::empty("hall").edited(|scene| scene.with_part(&cube("box"))).unwrap();
        let place = FilePlace { world_from_file: DAffine3::from_translation(DVec3::X * 3.0), ..FilePlace::default() };
        let both = scene.with_file(&source, &place, &Quiet).unwrap();
        assert_eq!(both.scene().parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["box", "crate"]);
        assert_eq!(both.labels().parts, [1, 2].map(|instance| PartLabel { semantic: 29, instance }));
        assert!(both.scene().environment.is_none() && both.scene().meshes.len() == 1);
        assert!(Arc::ptr_eq(&both.scene().meshes[0], &scene.scene().meshes[0]));
        assert!(both.warnings().iter().any(|warning| warning.message.contains("surroundings were left out")), "{:?}", both.warnings());
        assert!((scene.warnings().is_empty(), scene.scene().parts.len()) == (true, 1));
    }

    #[test]
    fn scenes_without_parts_or_light_are_refused_as_their_files_are() {
        let view = (Camera::from(Intrinsics::from_fov_x(8, 6, 1.0)), Pose::look_at(0, DVec3::splat(5.0), DVec3::ZERO, DVec3::Z).unwrap());
        let shot = Shot::new(Quality::Draft, &RenderChoices { samples: Some(1), ..RenderChoices::default() }, 0).unwrap();
        let refused = |scene: &LoadedScene| scene.render(std::slice::from_ref(&view), &shot, &Quiet).unwrap_err().to_string();
        let empty = LoadedScene::empty("nothing");
        assert!(refused(&empty).contains("no visible parts"), "{}", refused(&empty));
        assert!(empty.view(None, &Quiet).is_err() && empty.plan_svg(100).starts_with("<svg") && empty.summary().starts_with("0 parts"));
        let dark = empty.edited(|scene| scene.with_part(&cube("box"))).unwrap();
        assert!(refused(&dark).contains("no light"), "{}", refused(&dark));
        let error = dark.edited(|scene| scene.without(&["boxes"])).err().unwrap();
        assert!(error.is_usage() && error.hint().unwrap() == "did you mean \"box\"?", "{error}");
    }
}

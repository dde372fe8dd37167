//! Edits of scenes: each takes a scene and gives a new one, which shares what did not change.
//!
//! Parts are named: the name of a part stands for this part, any other name for all parts of the object of that name, and lights whose
//! names begin with the given name and a slash belong to it. What is not named keeps its place, its number relative to others, its label and
//! its instance. Every result passes the checks of [`Scene::validate`], except that it may be empty, so that a scene can be built from nothing.
//!
//! ```
//! use enfilade_geometry::Mesh;
//! use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
//! use enfilade_scene::{LabelledScene, Material, MaterialChoice, NewPart};
//!
//! let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
//! let sail = NewPart::new("sail", mesh, MaterialChoice::from(Material::diffuse("cloth", Rgb::splat(0.8))));
//! let one = LabelledScene::default().with_part(&sail)?;
//! let two = one.with_part(&NewPart { world_from_mesh: DAffine3::from_translation(DVec3::X), ..sail })?;
//! assert_eq!([&two.scene.parts[0].name, &two.scene.parts[1].name], ["sail", "sail_2"]);
//! assert_eq!((two.scene.meshes.len(), two.scene.materials.len()), (1, 1));
//! assert_eq!(two.without(&["sail_2"])?, one);
//! assert_eq!(two.without(&["sial"]).unwrap_err().to_string(), "the scene has no part or object \"sial\"; did you mean \"sail\"?");
//! # Ok::<(), enfilade_scene::EditError>(())
//! ```

mod add;
mod lights;
mod materials;
mod names;
mod place;
mod select;
#[cfg(test)]
mod tests;
mod unused;

pub use add::{NewPart, NewThing};
pub use materials::MaterialChoice;
pub use names::printable;

use crate::{Labels, PictureFiles, Scene, SceneError};
use enfilade_options::closest;

/// A scene with what belongs to its parts and pictures. Its edits take names: of a part, or else of an object, for all of the object's parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LabelledScene {
    /// The scene.
    pub scene: Scene,
    /// One label per part.
    pub labels: Labels,
    /// Files of pictures that are still as they came.
    pub picture_files: PictureFiles,
}

/// Why an edit cannot be done.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// A name of nothing.
    #[error("the scene has no {kind} {name:?}{}", meant(nearest.as_deref()))]
    Unknown {
        /// What it would be: "part or object", "material", "light", "camera".
        kind: &'static str,
        /// The name.
        name: String,
        /// The name that is most like it.
        nearest: Option<String>,
    },
    /// A name of several objects.
    #[error("{count} objects are named {name:?}; name their parts, such as {part:?}")]
    Ambiguous {
        /// The name.
        name: String,
        /// Number of objects of that name.
        count: usize,
        /// A part of the first.
        part: String,
    },
    /// What a scene file would be refused for, with the name of the part.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl EditError {
    /// The error for a name that is none of `known`.
    fn unknown(kind: &'static str, name: &str, known: &[&str]) -> Self {
        Self::Unknown { kind, name: name.into(), nearest: closest(name, known).map(Into::into) }
    }

    /// The error for something of `what` that is wrong.
    fn value(what: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Scene(SceneError::Value { what: what.into(), problem: problem.into() })
    }
}

fn meant(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean {name:?}?"))
}

impl LabelledScene {
    /// The result of an edit of this scene, if it is valid.
    fn checked(&self, edited: Self) -> Result<Self, EditError> {
        edited.scene.validate_after(&self.scene)?;
        let (labels, parts) = (edited.labels.parts.len(), edited.scene.parts.len());
        if labels == parts { Ok(edited) } else { Err(EditError::value("labels", format!("found {labels} for {parts} parts"))) }
    }
}

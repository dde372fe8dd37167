//! The objects that `[[object]]` of `dataset.toml` placed in a scene, `_detail/placed_objects.json`: models, poses, what each rests on, and
//! what could not be placed.

use crate::frames::read_json;
use crate::{Dataset, DatasetError, check_name, write_json};
use serde::{Deserialize, Serialize};

/// The objects placed in a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlacedObjects {
    /// The library that simulated how they come to rest, and its version.
    pub solver: String,
    /// In the order in which they were placed.
    pub objects: Vec<PlacedObject>,
    /// What could not be placed.
    pub missing: Vec<MissingObject>,
}

/// One object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlacedObject {
    /// Name of the object in the scene: its part has this name, or its parts begin with it and a slash.
    pub name: String,
    /// Number of its instance.
    pub instance: i16,
    /// NYU40 class, or −1.
    pub semantic: i16,
    /// The model's file, as `dataset.toml` names it.
    pub model: String,
    /// Size over that in the file, once it is in metres. Objects of one model and one scale are copies of one another.
    pub scale: f64,
    /// Rigid pose, metres, row-major: places the model, in metres and scaled, z up, in the world.
    pub world_from_model: [[f64; 4]; 4],
    /// Name of the object or part that it rests on; of several, the one that carries most.
    pub rests_on: String,
    /// True for objects that are there to distract: no exports name them as targets, and cameras do not look at them.
    #[serde(default)]
    pub is_distractor: bool,
    /// Share of the planned frames in which it is to be visible, 0 to 1.
    #[serde(default)]
    pub visible_share: f64,
}

/// An object that could not be placed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissingObject {
    /// The model's file.
    pub model: String,
    /// Why.
    pub reason: String,
}

impl Dataset {
    /// Writes the objects placed in a scene.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_placed_objects(&self, scene: &str, placed: &PlacedObjects) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        write_json(&self.layout().placed_objects(scene), placed)
    }

    /// The objects placed in a scene; `None` where `dataset.toml` places none.
    ///
    /// # Errors
    /// When the file is damaged, or of a newer version of the program.
    pub fn read_placed_objects(&self, scene: &str) -> Result<Option<PlacedObjects>, DatasetError> {
        read_json(&self.layout().placed_objects(scene), "import the scene again, which rewrites it")
    }
}

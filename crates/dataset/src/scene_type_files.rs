//! `metadata_camera_trajectories.csv`: what kind of room each camera goes through, in the words of Hypersim's file of that name, which is
//! in `evermotion_dataset/analysis` of its toolkit. Ours is at the dataset's root, where NICR's `prepare_dataset` (which prepares Hypersim
//! for EMSANet) looks for it before it downloads Hypersim's. It has only the columns about scenes.

use crate::tables::Table;
use crate::{Dataset, DatasetError};

const HEADER: [&str; 3] = ["Animation", "Scene type", "Notes"];

/// The types of scenes that Hypersim's file has, spelled as there.
pub const SCENE_TYPES: [&str; 22] = [
    "Art gallery",
    "Bathroom",
    "Bedroom",
    "Courtyard",
    "Dining room",
    "Hall",
    "Hallway",
    "Hotel lobby",
    "Kitchen",
    "Lecture theater",
    "Library",
    "Living room",
    "Office",
    "Office (building foyer)",
    "Office (conference room)",
    "Office (home)",
    "Office (waiting area)",
    "Other",
    "Restaurant",
    "Retail space",
    "Staircase",
    "Transit station",
];

/// The type of scene that is called this, in capitals or not, as Hypersim's file spells it.
pub fn scene_type(name: &str) -> Option<&'static str> {
    SCENE_TYPES.into_iter().find(|known| known.eq_ignore_ascii_case(name.trim()))
}

/// The kind of room that a camera goes through.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneTypeRow {
    /// Name of the scene.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// One of [`SCENE_TYPES`].
    pub scene_type: &'static str,
    /// More about it, or nothing.
    pub notes: String,
}

impl Dataset {
    /// Writes the types of scenes, unless the file has them already.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_scene_types(&self, rows: &[SceneTypeRow]) -> Result<(), DatasetError> {
        let path = self.layout().scene_types();
        let mut table = Table::new(&path, &HEADER);
        let cells = |row: &SceneTypeRow| vec![format!("{}_{}", row.scene, row.camera), row.scene_type.to_string(), row.notes.clone()];
        table.rows = rows.iter().map(cells).collect();
        let is_there = Table::read(&path).is_ok_and(|old| old.header == table.header && old.rows == table.rows);
        if is_there { Ok(()) } else { table.write() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_known_in_any_case() {
        assert_eq!((scene_type("living room"), scene_type("Kitchen "), scene_type("pantry")), (Some("Living room"), Some("Kitchen"), None));
    }

    /// `prepare_dataset` finds the camera by: `re.split("(_cam_[0-9][0-9])", animation)[:2]`.
    #[test]
    fn animations_are_scene_and_camera_as_hypersim_has_them() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let row =
            |camera: &str, scene_type| SceneTypeRow { scene: "home_1".into(), camera: camera.into(), scene_type, notes: "living".into() };
        dataset.write_scene_types(&[row("cam_00", "Living room"), row("cam_01", "Other")]).unwrap();
        let text = std::fs::read_to_string(folder.path().join("metadata_camera_trajectories.csv")).unwrap();
        assert_eq!(text, "Animation,Scene type,Notes\nhome_1_cam_00,Living room,living\nhome_1_cam_01,Other,living\n");
    }
}

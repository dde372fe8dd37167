//! The keys of `dataset.toml`.

use super::camera::CameraConfig;
use super::choices::Quality;
use super::farm::FarmKeys;
use super::import::ImportKeys;
use super::products::ProductKey;
use super::rendering::RenderSection;
use super::settings::CameraChoice;
use enfilade_explore::{CarveKeys, PlanKeys, Preset};
use enfilade_options::keys;
use enfilade_vary::VaryKeys;
use enfilade_verify::view_gates::GateKeys;
use serde::de::{
    MapAccess, SeqAccess, Unexpected, Visitor,
    value::{MapAccessDeserializer, SeqAccessDeserializer},
};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

keys! {
    /// The file.
    pub(super) struct Document {
        /// Name of the dataset, and of the output folder unless `-o` gives one; the name of the file's folder unless it is given.
        pub name: Option<Spanned<String>>,
        pub import: ImportKeys,
        pub farm: FarmKeys,
        pub scene: Vec<Spanned<SceneKeys>>,
    } with {
        pub level: LevelKeys,
    }
}

keys! {
    /// A `[[scene]]`.
    pub(super) struct SceneKeys {
        /// Name of the scene in the dataset; it becomes a folder.
        pub name: Option<Spanned<String>>,
        /// The scene file.
        pub file: Option<Spanned<String>>,
        /// Pattern in place of name and file, such as `"hssd/scenes/*.scene_instance.json"`: each file that it means is a scene, named
        /// after its file.
        pub files: Option<Spanned<String>>,
        /// Generated home in place of a file: a table, as below.
        pub home: Option<Spanned<toml::Table>>,
        /// Number of homes in place of one, 1 to 100 000: their seeds follow on the home's, and their names end with a number.
        pub count: Option<Spanned<u32>>,
        /// Name of the scene in the label table; its own name unless it is given.
        pub label_scene: Option<String>,
        /// What kind of room it is, in Hypersim's words, such as `"Living room"` or `"Office (home)"`: for `metadata_camera_trajectories.csv`. Homes
        /// know it by themselves; of other scenes it is `"Other"` unless it is given.
        pub scene_type: Option<Spanned<String>>,
        /// Where trajectories begin: names of cameras in the file, or `{ position = [x, y, z], look_at = [x, y, z] }` in metres; or
        /// `"found"`. Without it they begin at the file's cameras that stand in a building, else at places that are found.
        pub cameras: CamerasKey,
    } with {
        pub import: ImportKeys,
        pub level: LevelKeys,
    }
}

keys! {
    /// The keys of the file's top level and of every scene alike, as one of the two has them.
    pub(super) struct LevelKeys {
        /// Decides everything random.
        pub seed: Option<u64>,
        /// Poses of each trajectory.
        pub frames: Option<Spanned<u32>>,
        /// Whose rules: `default` ours, `paper` those of Hypersim's paper, `hypersim` those of its programs. It sets carving, walks, gates
        /// and camera; every key wins over it.
        pub preset: Option<Preset>,
        /// How good pictures become, in one word: it sets `samples` of `[render]`, and `reference` all that makes a picture unbiased.
        pub quality: Option<Quality>,
        /// Label table, a CSV file; without it labels are those that come with the scene.
        pub labels: Option<Spanned<String>>,
        /// Models of yours that are placed in scenes: `[[object]]` tables, as below. Those of a scene replace those of the file.
        pub object: Option<Vec<Spanned<toml::Table>>>,
        /// What moves in scenes, and how: `[[motion]]` tables, as below. Those of a scene replace those of the file.
        pub motion: Option<Vec<Spanned<toml::Table>>>,
        /// What is made of finished frames as well: words such as `"pairs"` and `"words"`, and tables such as `{ sensors = "sensors.toml" }`.
        pub products: Option<Spanned<Vec<ProductKey>>>,
        pub render: RenderSection,
        /// What pictures are taken with; that of a scene replaces that of the file as a whole.
        pub camera: Option<Spanned<CameraConfig>>,
        pub plan: PlanKeys,
        pub carve: CarveKeys,
        pub gate: GateKeys,
        pub vary: VaryKeys,
    }
}

/// `cameras`: which of the file's, or "found".
#[derive(Default)]
pub(super) struct CamerasKey {
    pub chosen: Vec<CameraChoice>,
    /// The file's do not count.
    pub found: bool,
}

impl<'de> Deserialize<'de> for CamerasKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListOrFound;
        impl<'de> Visitor<'de> for ListOrFound {
            type Value = CamerasKey;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a list of cameras, or \"found\" for places that are found in the scene, whatever cameras its file has")
            }
            fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<CamerasKey, E> {
                match word {
                    "found" => Ok(CamerasKey { chosen: Vec::new(), found: true }),
                    other => Err(E::invalid_value(Unexpected::Str(other), &self)),
                }
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<CamerasKey, A::Error> {
                let list = Vec::<CameraKey>::deserialize(SeqAccessDeserializer::new(list))?;
                Ok(CamerasKey { chosen: list.into_iter().map(|camera| camera.0).collect(), found: false })
            }
        }
        deserializer.deserialize_any(ListOrFound)
    }
}

/// A camera's name, or a table with its place.
struct CameraKey(CameraChoice);

/// The table of a camera that is placed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlacedCamera {
    position: [f64; 3],
    look_at: [f64; 3],
}

impl<'de> Deserialize<'de> for CameraKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrPlace;
        impl<'de> Visitor<'de> for NameOrPlace {
            type Value = CameraChoice;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a camera's name, or a table { position = [x, y, z], look_at = [x, y, z] }")
            }
            fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<CameraChoice, E> {
                Ok(CameraChoice::Named(name.into()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<CameraChoice, A::Error> {
                let PlacedCamera { position, look_at } = PlacedCamera::deserialize(MapAccessDeserializer::new(map))?;
                Ok(CameraChoice::Placed { position, look_at })
            }
        }
        deserializer.deserialize_any(NameOrPlace).map(CameraKey)
    }
}

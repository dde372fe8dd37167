//! The keys of `dataset.toml`.

use super::camera::CameraConfig;
use super::choices::Quality;
use super::farm::FarmKeys;
use super::patch::{CarvePatch, GatePatch, PlanPatch, RenderPatch};
use super::products::ProductKey;
use super::settings::{CameraChoice, Lamps};
use enfilade_explore::Preset;
use enfilade_import::EnvironmentOverride;
use enfilade_import::UpAxis;
use serde::de::{
    MapAccess, SeqAccess, Unexpected, Visitor,
    value::{MapAccessDeserializer, SeqAccessDeserializer},
};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    /// Name of the dataset, and of the output folder unless `-o` gives one; the name of the file's folder unless it is given.
    pub name: Option<Spanned<String>>,
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
    /// What is made of finished frames as well: words such as `"pairs"` and `"words"`, and tables such as `{ sensors = "sensors.toml" }`.
    pub products: Option<Spanned<Vec<ProductKey>>>,
    #[serde(default)]
    pub import: ImportKeys,
    #[serde(default)]
    pub render: RenderPatch,
    pub camera: Option<Spanned<CameraConfig>>,
    #[serde(default)]
    pub plan: PlanPatch,
    #[serde(default)]
    pub carve: CarvePatch,
    #[serde(default)]
    pub gate: GatePatch,
    #[serde(default)]
    pub farm: FarmKeys,
    #[serde(default)]
    pub scene: Vec<Spanned<SceneKeys>>,
}

/// `[import]`.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImportKeys {
    /// Metres per unit of the file; where the file states its unit this multiplies it.
    pub meters_per_unit: Option<Spanned<f64>>,
    /// The axis that points up, where the file does not say; without it the format's own.
    pub up_axis: Option<UpAxis>,
    /// What surrounds the scene instead of the file's own surroundings: a table, as below, or one of the words `"sky"` and
    /// `"overcast"`.
    pub environment: Option<Spanned<EnvironmentOverride>>,
    /// Hangs lamps below the ceiling of every room.
    pub lamps: Option<Lamps>,
    /// Keep only the first of faces with the same corners.
    pub drop_doubled_faces: Option<bool>,
    /// Makes clear panes of parts or materials of these names, in which `*` stands for any characters, where glass has lost that it lets light
    /// through.
    pub panes: Option<Vec<String>>,
    /// Uses grey, with a warning, where a texture is missing.
    pub allow_missing_textures: Option<bool>,
    /// Leaves out meshes whose file is missing or damaged, with a warning (Mitsuba, pbrt, URDF, SDF).
    pub allow_missing_meshes: Option<bool>,
}

/// A `[[scene]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneKeys {
    /// Name of the scene in the dataset; it becomes a folder.
    pub name: Option<Spanned<String>>,
    /// The scene file.
    pub file: Option<Spanned<String>>,
    /// Instead of name and file, a pattern such as `"hssd/scenes/*.scene_instance.json"`: each file that it means is a scene, named
    /// after its file.
    pub files: Option<Spanned<String>>,
    /// Instead of a file, a generated home: a table, as below.
    pub home: Option<Spanned<toml::Table>>,
    /// Instead of one home as many, 1 to 100 000: their seeds follow on the home's, and their names end with a number.
    pub count: Option<Spanned<u32>>,
    pub meters_per_unit: Option<Spanned<f64>>,
    pub up_axis: Option<UpAxis>,
    pub environment: Option<Spanned<EnvironmentOverride>>,
    pub lamps: Option<Lamps>,
    pub drop_doubled_faces: Option<bool>,
    pub panes: Option<Vec<String>>,
    pub allow_missing_textures: Option<bool>,
    pub allow_missing_meshes: Option<bool>,
    pub labels: Option<Spanned<String>>,
    pub products: Option<Spanned<Vec<ProductKey>>>,
    /// Name of the scene in the label table; its own name unless it is given.
    pub label_scene: Option<String>,
    /// What kind of room it is, in Hypersim's words, such as `"Living room"` or `"Office (home)"`: for `metadata_camera_trajectories.csv`. Homes
    /// know it by themselves; of other scenes it is `"Other"` unless it is given.
    pub scene_type: Option<Spanned<String>>,
    /// Where trajectories begin: names of cameras in the file, or `{ position = [x, y, z], look_at = [x, y, z] }` in metres; or
    /// `"found"`. Without it they begin at the file's cameras that stand in a building, else at places that are found.
    #[serde(default)]
    pub cameras: CamerasKey,
    pub seed: Option<u64>,
    pub frames: Option<Spanned<u32>>,
    pub preset: Option<Preset>,
    pub quality: Option<Quality>,
    #[serde(default)]
    pub render: RenderPatch,
    /// Replaces that of the file as a whole.
    pub camera: Option<Spanned<CameraConfig>>,
    #[serde(default)]
    pub plan: PlanPatch,
    #[serde(default)]
    pub carve: CarvePatch,
    #[serde(default)]
    pub gate: GatePatch,
}

/// The keys that stand at the file's top level and in every scene alike, as one of the two has them.
///
/// The two do not share them by serde's `flatten`: it reads through a buffer that has no places in the text, so values could not be
/// `Spanned`, and unknown keys would be told without their place and without the keys that there are.
#[derive(Clone, Copy)]
pub(super) struct Level<'a> {
    pub frames: Option<&'a Spanned<u32>>,
    pub quality: Option<Quality>,
    pub camera: Option<&'a Spanned<CameraConfig>>,
    pub render: &'a RenderPatch,
    pub plan: &'a PlanPatch,
    pub carve: &'a CarvePatch,
    pub gate: &'a GatePatch,
}

impl Document {
    pub fn level(&self) -> Level<'_> {
        let Self { frames, quality, camera, render, plan, carve, gate, .. } = self;
        let (frames, camera) = (frames.as_ref(), camera.as_ref());
        Level { frames, quality: *quality, camera, render, plan, carve, gate }
    }
}

impl SceneKeys {
    pub fn level(&self) -> Level<'_> {
        let Self { frames, quality, camera, render, plan, carve, gate, .. } = self;
        let (frames, camera) = (frames.as_ref(), camera.as_ref());
        Level { frames, quality: *quality, camera, render, plan, carve, gate }
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

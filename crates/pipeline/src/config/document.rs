//! The keys of `dataset.toml`.

use super::camera::CameraConfig;
use super::choices::Quality;
use super::farm::FarmKeys;
use super::patch::{CarvePatch, GatePatch, PlanPatch, RenderPatch};
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
    pub name: Option<Spanned<String>>,
    pub seed: Option<u64>,
    pub frames: Option<Spanned<u32>>,
    pub preset: Option<Preset>,
    pub quality: Option<Quality>,
    pub labels: Option<Spanned<String>>,
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
    pub meters_per_unit: Option<Spanned<f64>>,
    pub up_axis: Option<UpAxis>,
    pub environment: Option<Spanned<EnvironmentOverride>>,
    pub lamps: Option<Lamps>,
    pub drop_doubled_faces: Option<bool>,
    pub allow_missing_textures: Option<bool>,
}

/// A `[[scene]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneKeys {
    pub name: Option<Spanned<String>>,
    pub file: Option<Spanned<String>>,
    /// A pattern: each file that it means is a scene.
    pub files: Option<Spanned<String>>,
    pub home: Option<Spanned<toml::Table>>,
    pub meters_per_unit: Option<Spanned<f64>>,
    pub up_axis: Option<UpAxis>,
    pub environment: Option<Spanned<EnvironmentOverride>>,
    pub lamps: Option<Lamps>,
    pub drop_doubled_faces: Option<bool>,
    pub allow_missing_textures: Option<bool>,
    pub labels: Option<Spanned<String>>,
    pub label_scene: Option<String>,
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

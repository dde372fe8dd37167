//! The JSON of a house, as far as it is used.

use super::super::json::or_default;
use super::super::listed::Listed;
use enfilade_math::DVec3;
use serde::Deserialize;

#[derive(Deserialize)]
pub(crate) struct House {
    #[serde(default)]
    pub furniture: Listed<Furniture>,
    #[serde(default)]
    pub mesh: Listed<Surface>,
    #[serde(default)]
    pub material: Listed<Paint>,
    #[serde(default, deserialize_with = "or_default")]
    pub lights: Vec<serde_json::Value>,
    pub scene: Rooms,
}

#[derive(Deserialize)]
pub(crate) struct Furniture {
    pub uid: String,
    pub jid: String,
    pub category: Option<String>,
    #[serde(default, deserialize_with = "or_default")]
    pub valid: bool,
}

/// A mesh of the building.
#[derive(Deserialize)]
pub(crate) struct Surface {
    pub uid: String,
    #[serde(default, deserialize_with = "or_default")]
    pub r#type: String,
    #[serde(default, deserialize_with = "or_default")]
    pub material: String,
    pub xyz: Vec<f64>,
    #[serde(default, deserialize_with = "or_default")]
    pub normal: Vec<f32>,
    #[serde(default, deserialize_with = "or_default")]
    pub uv: Vec<f32>,
    pub faces: Vec<u32>,
}

#[derive(Deserialize)]
pub(crate) struct Paint {
    pub uid: String,
    #[serde(default, deserialize_with = "or_default")]
    pub jid: String,
    /// Location of the picture on the authors' servers; empty if there is none.
    #[serde(default, deserialize_with = "or_default")]
    pub texture: String,
    /// Red, green, blue and opacity, 0 … 255, in sRGB.
    pub color: Option<Vec<f32>>,
    /// Three by three, row by row.
    #[serde(rename = "UVTransform")]
    pub uv_transform: Option<Vec<f32>>,
}

#[derive(Deserialize)]
pub(crate) struct Rooms {
    #[serde(default)]
    pub room: Listed<Room>,
}

#[derive(Deserialize)]
pub(crate) struct Room {
    /// What the room is for.
    #[serde(default, deserialize_with = "or_default")]
    pub r#type: String,
    #[serde(default, deserialize_with = "or_default")]
    pub instanceid: String,
    #[serde(default)]
    pub children: Listed<Child>,
}

/// Something in a room.
#[derive(Deserialize)]
pub(crate) struct Child {
    pub r#ref: String,
    #[serde(default, deserialize_with = "or_default")]
    pub pos: DVec3,
    #[serde(default = "no_turn")]
    pub rot: [f64; 4],
    #[serde(default = "one")]
    pub scale: DVec3,
}

fn no_turn() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

fn one() -> DVec3 {
    DVec3::ONE
}

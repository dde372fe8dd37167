//! The JSON of a house, as far as it is used.

use super::super::json::or_default;
use super::super::listed::Listed;
use enfilade_math::DVec3;
use serde::Deserialize;
use serde_json::Value;

#[derive(Deserialize)]
pub(crate) struct House {
    #[serde(default)]
    pub rooms: Listed<Room>,
    #[serde(default)]
    pub walls: Listed<Wall>,
    #[serde(default)]
    pub doors: Listed<Opening>,
    #[serde(default)]
    pub windows: Listed<Opening>,
    #[serde(default)]
    pub objects: Listed<Thing>,
    #[serde(rename = "proceduralParameters")]
    pub parameters: Option<Parameters>,
}

/// A point.
#[derive(Clone, Copy, Deserialize)]
pub(crate) struct Xyz {
    pub x: f64,
    pub y: f64,
    #[serde(default, deserialize_with = "or_default")]
    pub z: f64,
}

impl Xyz {
    pub fn point(self) -> DVec3 {
        DVec3::new(self.x, self.y, self.z)
    }
}

/// Angles, degrees.
#[derive(Clone, Copy, Default, Deserialize)]
pub(crate) struct Euler {
    #[serde(default, deserialize_with = "or_default")]
    pub x: f64,
    #[serde(default, deserialize_with = "or_default")]
    pub y: f64,
    #[serde(default, deserialize_with = "or_default")]
    pub z: f64,
}

#[derive(Deserialize)]
pub(crate) struct Room {
    pub id: String,
    #[serde(rename = "roomType", default, deserialize_with = "or_default")]
    pub kind: String,
    #[serde(rename = "floorPolygon", default, deserialize_with = "or_default")]
    pub floor: Vec<Xyz>,
    #[serde(rename = "floorMaterial")]
    pub material: Option<Value>,
}

#[derive(Deserialize)]
pub(crate) struct Wall {
    pub id: String,
    #[serde(default, deserialize_with = "or_default")]
    pub polygon: Vec<Xyz>,
    #[serde(rename = "roomId", default, deserialize_with = "or_default")]
    pub room: String,
    #[serde(default, deserialize_with = "or_default")]
    pub empty: bool,
    pub material: Option<Value>,
}

/// A door or window.
#[derive(Deserialize)]
pub(crate) struct Opening {
    pub id: String,
    #[serde(rename = "assetId", default, deserialize_with = "or_default")]
    pub asset: String,
    pub wall0: Option<String>,
    pub wall1: Option<String>,
    #[serde(rename = "holePolygon", default, deserialize_with = "or_default")]
    pub hole: Vec<Xyz>,
    #[serde(rename = "boundingBox")]
    pub bounds: Option<Bounds>,
    #[serde(rename = "assetPosition")]
    pub position: Option<Xyz>,
}

#[derive(Deserialize)]
pub(crate) struct Bounds {
    pub min: Xyz,
    pub max: Xyz,
}

impl Opening {
    /// Two corners of the hole: along `wall0` from its start, and up, metres.
    pub fn corners(&self) -> Option<[Xyz; 2]> {
        let of_bounds = self.bounds.as_ref().map(|b| [b.min, b.max]);
        let of_polygon = if let [first, second, ..] = self.hole[..] { Some([first, second]) } else { None };
        of_polygon.or(of_bounds)
    }
}

/// An object.
#[derive(Deserialize)]
pub(crate) struct Thing {
    #[serde(default, deserialize_with = "or_default")]
    pub id: String,
    #[serde(rename = "assetId", default, deserialize_with = "or_default")]
    pub asset: String,
    pub position: Option<Xyz>,
    #[serde(default, deserialize_with = "or_default")]
    pub rotation: Euler,
    #[serde(default)]
    pub children: Listed<Self>,
}

#[derive(Deserialize)]
pub(crate) struct Parameters {
    #[serde(default)]
    pub lights: Listed<Lamp>,
}

#[derive(Deserialize)]
pub(crate) struct Lamp {
    #[serde(default, deserialize_with = "or_default")]
    pub id: String,
    #[serde(default, deserialize_with = "or_default")]
    pub r#type: String,
    pub position: Xyz,
    pub rotation: Option<Euler>,
    #[serde(default = "one")]
    pub intensity: f64,
    pub rgb: Option<Rgb>,
}

#[derive(Clone, Copy, Deserialize)]
pub(crate) struct Rgb {
    pub r: f64,
    pub g: f64,
    pub b: f64,
}

fn one() -> f64 {
    1.0
}

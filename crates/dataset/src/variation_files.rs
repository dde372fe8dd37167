//! What a variation of a scene differs in from the scene that it varies, `_detail/variation.json`.

use crate::frames::read_json;
use crate::{Dataset, DatasetError, check_name, write_json};
use serde::{Deserialize, Serialize};

/// First key of the file, and its version.
const FORMAT: &str = "enfilade variation 1";

/// A variation of a scene. Lists have what differs, in the order of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// Kind and version of the file.
    pub format: String,
    /// Name of the scene that it is a variation of.
    pub of: String,
    /// Number of the variation, from 1.
    pub number: u32,
    /// Number of its light, from 0: variations of one scene with the same number have the same one.
    pub light_set: u32,
    /// Number of its set of materials.
    pub material_set: u32,
    /// Number of its arrangement.
    pub arrangement_set: u32,
    /// Whether every triangle is where it is in the first scene; its free space and trajectories are that scene's then.
    pub keeps_geometry: bool,
    /// Offset of the exposure of displayed pictures, stops.
    pub exposure_stops: f64,
    /// Sun and sky; `None` where they do not vary.
    pub sky: Option<VariedSky>,
    /// Every lamp, where they vary.
    pub lamps: Vec<VariedLamp>,
    /// The materials of another colour or texture.
    pub materials: Vec<VariedMaterial>,
    /// The things in another pose.
    pub moved: Vec<MovedThing>,
    /// Names of the things that are not there.
    pub removed: Vec<String>,
}

/// Sun and sky of a variation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariedSky {
    /// Part of the day: day, evening or night.
    pub moment: String,
    /// Latitude, degrees, north positive.
    pub latitude_deg: f32,
    /// Day of the year, 1 to 365.
    pub day_of_year: u32,
    /// Hour of true solar time.
    pub hour: f32,
    /// Elevation of the sun, degrees.
    pub sun_elevation_deg: f32,
    /// Share of the sky under cloud.
    pub cloud: f32,
    /// Haze of the clear part.
    pub turbidity: f32,
    /// What is seen outside.
    pub outside: String,
}

/// A lamp of a variation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariedLamp {
    /// Name of its object, part or light.
    pub name: String,
    /// Whether it is lit.
    pub lit: bool,
    /// Colour temperature, kelvin.
    pub kelvin: f64,
    /// Factor on its power in the first scene.
    pub power: f64,
}

/// A material of a variation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariedMaterial {
    /// Name of the material.
    pub name: String,
    /// Name of the first scene's material that it is made from, where parts of several classes share that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// Class of most of its surfaces.
    pub class: String,
    /// Mean reflectance before, linear RGB.
    pub from: [f32; 3],
    /// Mean reflectance, linear RGB.
    pub to: [f32; 3],
    /// What it is now, such as "tiles", where it has another texture than before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture: Option<String>,
}

/// A thing of a variation that is elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MovedThing {
    /// Name of the object or part.
    pub name: String,
    /// Number of its instance.
    pub instance: i16,
    /// How far the middle of its box has moved, metres.
    pub shift_m: [f64; 3],
    /// How far it has turned, counter-clockwise seen from above, degrees.
    pub turn_deg: f64,
    /// Name of the thing that carries it, if it moved with that.
    pub carried_by: Option<String>,
}

impl Variation {
    /// The variation `number` of the scene `of`, which differs in nothing yet.
    pub fn new(of: &str, number: u32, [light_set, material_set, arrangement_set]: [u32; 3]) -> Self {
        Self {
            format: FORMAT.into(),
            of: of.into(),
            number,
            light_set,
            material_set,
            arrangement_set,
            keeps_geometry: true,
            exposure_stops: 0.0,
            sky: None,
            lamps: Vec::new(),
            materials: Vec::new(),
            moved: Vec::new(),
            removed: Vec::new(),
        }
    }
}

impl Dataset {
    /// Writes what a variation differs in.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_variation(&self, scene: &str, variation: &Variation) -> Result<(), DatasetError> {
        check_name("scene name", scene)?;
        write_json(&self.layout().variation(scene), variation)
    }

    /// What a scene differs in from the one that it varies; `None` for scenes that are no variations.
    ///
    /// # Errors
    /// When the file is damaged, or of a newer version of the program.
    pub fn read_variation(&self, scene: &str) -> Result<Option<Variation>, DatasetError> {
        let (path, remedy) = (self.layout().variation(scene), "import the scene again, which rewrites it");
        let Some(variation) = read_json::<Variation>(&path, remedy)? else { return Ok(None) };
        if variation.format != FORMAT {
            let problem = format!("it is of the form {:?}, expected {FORMAT:?}; {remedy}", variation.format);
            return Err(DatasetError::text(&path, problem));
        }
        Ok(Some(variation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variations_come_back_and_other_forms_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = Dataset::create(folder.path()).unwrap();
        let variation = Variation { exposure_stops: 0.5, removed: vec!["vase".into()], ..Variation::new("room", 3, [2, 0, 2]) };
        assert_eq!(dataset.read_variation("room_v03").unwrap(), None);
        dataset.write_variation("room_v03", &variation).unwrap();
        assert_eq!(dataset.read_variation("room_v03").unwrap(), Some(variation.clone()));
        dataset.write_variation("room_v03", &Variation { format: "enfilade variation 2".into(), ..variation }).unwrap();
        let message = dataset.read_variation("room_v03").unwrap_err().to_string();
        assert!(message.contains("expected \"enfilade variation 1\""), "{message}");
    }
}

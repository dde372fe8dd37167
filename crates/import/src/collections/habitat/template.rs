//! The template of a stage or an object: its model, its frame and its scale.

use super::super::lenient::Lenient;
use super::dataset::Attributes;
use crate::ImportError;
use enfilade_math::{DMat3, DVec3};
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Axes that are farther from a right angle than this cosine are no frame.
const SKEW: f64 = 1e-4;

/// The attributes of a template that are used.
#[derive(Deserialize)]
pub(super) struct Template {
    render_asset: Option<String>,
    collision_asset: Option<String>,
    up: Option<DVec3>,
    front: Option<DVec3>,
    #[serde(default = "one")]
    pub scale: DVec3,
    #[serde(default = "unit")]
    pub units_to_meters: f64,
    #[serde(rename = "COM")]
    pub center_of_mass: Option<DVec3>,
    pub semantic_id: Option<i64>,
    pub urdf_filepath: Option<String>,
    #[serde(default = "unit")]
    pub uniform_scale: f64,
    #[serde(skip)]
    file: PathBuf,
}

fn one() -> DVec3 {
    DVec3::ONE
}

fn unit() -> f64 {
    1.0
}

impl Template {
    /// The template of these attributes.
    ///
    /// # Errors
    /// When one of them is of another type.
    pub fn new(attributes: Attributes) -> Result<Self, ImportError> {
        let Attributes { values, file } = attributes;
        let problem = |e| format!("{e}; expected the attributes of a Habitat template, so unpack the dataset again");
        let template: Self =
            Self::deserialize(Lenient(Value::Object(values))).map_err(|e| ImportError::malformed(&file, "attributes", problem(e)))?;
        Ok(Self { file, ..template })
    }

    /// The file of its model.
    pub fn model(&self) -> Option<PathBuf> {
        let named = [&self.render_asset, &self.collision_asset];
        named.into_iter().flatten().find(|name| !name.is_empty()).map(|name| self.beside(name))
    }

    /// A file that the template names, in the template's folder.
    pub fn beside(&self, name: &str) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(name.replace('\\', "/"))
    }

    /// The rotation that takes the model's up and front to y and −z. `None` where they are no frame.
    pub fn frame(&self, is_stage: bool) -> Option<DMat3> {
        let from_glb = self.model().is_some_and(|file| file.extension().is_some_and(|e| e == "glb"));
        let (up, front) = if is_stage && from_glb { (DVec3::Z, DVec3::Y) } else { (DVec3::Y, DVec3::NEG_Z) };
        let (up, front) = (self.up.unwrap_or(up).try_normalize()?, self.front.unwrap_or(front).try_normalize()?);
        (up.dot(front).abs() < SKEW).then(|| DMat3::from_cols(front.cross(up), up, -front).transpose())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn template(json: &str) -> Template {
        Template::new(Attributes { values: serde_json::from_str(json).unwrap(), file: "objects/a.object_config.json".into() }).unwrap()
    }

    #[test]
    fn up_and_front_become_y_and_minus_z() {
        let turned = template(r#"{"render_asset": "a.glb", "up": [0, 0, 1], "front": [0, 1, 0]}"#);
        let frame = turned.frame(false).unwrap();
        assert_eq!((frame * DVec3::Z, frame * DVec3::Y, frame * DVec3::X), (DVec3::Y, DVec3::NEG_Z, DVec3::X));
        assert_eq!(turned.model(), Some("objects/a.glb".into()));
        let plain = template(r#"{"render_asset": "a.glb"}"#);
        assert_eq!(plain.frame(false), Some(DMat3::IDENTITY));
        assert_eq!(plain.frame(true), Some(frame));
        assert_eq!(template(r#"{"up": [0, 1, 0], "front": [0, 1, 0]}"#).frame(false), None);
    }
}

//! What the user knows about a scene file that the file does not say: unit, upward axis, environment.

use crate::{EnvironmentOverride, ImportError};
use enfilade_math::{DMat3, DVec3};
use enfilade_options::words;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

words! {
    /// The axis of the file that points up.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum UpAxis {
        /// +y is up, as in glTF.
        #[serde(rename = "y")]
        Y = "y",
        /// +z is up, as in this workspace.
        #[serde(rename = "z")]
        Z = "z",
        /// +x is up: a room that lies on its side.
        #[serde(rename = "x")]
        X = "x",
        /// −x is up.
        #[serde(rename = "-x")]
        MinusX = "-x",
        /// −y is up.
        #[serde(rename = "-y")]
        MinusY = "-y",
        /// −z is up.
        #[serde(rename = "-z")]
        MinusZ = "-z",
    }
}

impl UpAxis {
    /// The axis nearest to a direction in the file's axes.
    pub fn nearest(direction: DVec3) -> Self {
        let [x, y, z] = direction.abs().to_array();
        match (x > y.max(z), y > z) {
            (true, _) if direction.x < 0.0 => Self::MinusX,
            (true, _) => Self::X,
            (_, true) if direction.y < 0.0 => Self::MinusY,
            (_, true) => Self::Y,
            _ if direction.z < 0.0 => Self::MinusZ,
            _ => Self::Z,
        }
    }

    /// The rotation that turns this axis to z.
    pub(crate) fn world_from_file(self) -> DMat3 {
        let [x, y, z] = match self {
            Self::X => [DVec3::Z, DVec3::Y, DVec3::NEG_X],
            Self::Y => [DVec3::X, DVec3::Z, DVec3::NEG_Y],
            Self::Z => [DVec3::X, DVec3::Y, DVec3::Z],
            Self::MinusX => [DVec3::NEG_Z, DVec3::Y, DVec3::X],
            Self::MinusY => [DVec3::X, DVec3::NEG_Z, DVec3::Y],
            Self::MinusZ => [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z],
        };
        DMat3::from_cols(x, y, z)
    }
}

/// What the user knows about a scene file that the file does not say.
///
/// ```
/// use enfilade_import::{ImportOptions, UpAxis, load};
/// use enfilade_scene::Quiet;
///
/// # let folder = tempfile::tempdir()?;
/// // A scan in millimetres with z up, which the file cannot say.
/// let file = folder.path().join("scan.obj");
/// std::fs::write(&file, "v 0 0 0\nv 4000 0 0\nv 0 3000 0\nf 1 2 3\n")?;
///
/// let options = ImportOptions { meters_per_unit: 0.001, up_axis: Some(UpAxis::Z), ..ImportOptions::default() };
/// let scene = load(&file, &options, &Quiet)?.scene;
/// assert_eq!(scene.world_corners(&scene.parts[0], 0)[2].to_array(), [0.0, 3.0, 0.0]);
///
/// // A unit that makes no sense is refused before the file is read.
/// let error = load(&file, &ImportOptions { meters_per_unit: 0.0, ..options }, &Quiet).unwrap_err();
/// assert!(error.to_string().starts_with("import option meters_per_unit: found 0"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImportOptions {
    /// Metres per unit of the file; 1 by default. Where the file states its own unit (USD, FBX, V-Ray scenes, Sweet Home 3D) this multiplies it.
    /// Scene packages are in metres, and anything but 1 is an error.
    pub meters_per_unit: f64,
    /// The axis that points up; by default the file's own (USD, FBX and V-Ray scenes state it), else the format's own. In scene
    /// packages z points up, and y is an error.
    pub up_axis: Option<UpAxis>,
    /// Replaces or sets the environment.
    pub environment: Option<EnvironmentOverride>,
    /// Goes on with plain grey where a texture is missing or broken, with a warning each; off by default.
    pub allow_missing_textures: bool,
    /// Goes on without a mesh whose file is missing or broken, with a warning each, in scenes that refer to such files (Mitsuba, pbrt, URDF,
    /// SDF, MJCF); off by default.
    pub allow_missing_meshes: bool,
    /// Groups of geoms of MuJoCo's models that are read; 0, 1 and 2 if none is given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub geom_groups: Vec<u32>,
    /// A stored run of a simulator, whose states the joints have over time (MJCF, URDF): `.npz` or `.csv`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub states: Option<PathBuf>,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self {
            meters_per_unit: 1.0,
            up_axis: None,
            environment: None,
            allow_missing_textures: false,
            allow_missing_meshes: false,
            geom_groups: Vec::new(),
            states: None,
        }
    }
}

impl ImportOptions {
    /// Checks the range of every number.
    ///
    /// # Errors
    /// [`ImportError::Option`] for the first one that is out of its range.
    pub fn validate(&self) -> Result<(), ImportError> {
        let metres = self.meters_per_unit;
        if !(metres.is_finite() && metres > 0.0) {
            let problem = format!("found {metres}; expected a number above zero, such as 1, 0.01 or 0.0254");
            return Err(ImportError::Option { option: "meters_per_unit", problem });
        }
        match self.environment.as_ref().and_then(EnvironmentOverride::problem) {
            Some(problem) => Err(ImportError::Option { option: "environment", problem }),
            None => Ok(()),
        }
    }
}

/// Where it is stated which way is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpStated {
    /// Nowhere.
    Nowhere,
    /// In the rules of the format alone, which programs that write it break: libraries of Python write scenes with z up as glTF as they are.
    ByRule,
    /// In the file, or by [`ImportOptions::up_axis`](crate::ImportOptions::up_axis).
    ByFile,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_is_turned_upward_by_a_rotation_and_is_called_alike_everywhere() {
        for axis in UpAxis::ALL {
            let turned = axis.world_from_file();
            assert_eq!(turned.determinant(), 1.0, "{axis:?}");
            assert_eq!(UpAxis::nearest(turned.transpose() * DVec3::new(0.1, -0.2, 0.9)), axis);
            assert_eq!(serde_json::to_string(&axis).unwrap(), format!("{:?}", axis.name()));
        }
        let quarter = UpAxis::Y.world_from_file();
        assert_eq!(quarter * DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, -3.0, 2.0));
    }
}

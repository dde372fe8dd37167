//! Lights and cameras that come, go and move.

use super::names::{printable, unique};
use super::{EditError, LabelledScene};
use crate::{Light, StartCamera};
use enfilade_math::{DAffine3, DMat3, Mat3, Vec3, nearest_rotation, place};

impl LabelledScene {
    /// The scene with one more light; where a light has its name, it gets a number.
    ///
    /// # Errors
    /// When a number of it is not finite.
    pub fn with_light(&self, light: Light) -> Result<Self, EditError> {
        let name = unique(printable(light.name(), "light"), |name| self.scene.lights.iter().any(|known| known.name() == name));
        let mut edited = self.clone();
        edited.scene.lights.push(light.renamed(name));
        self.checked(edited)
    }

    /// The scene without the lights of that name.
    ///
    /// # Errors
    /// When there is none.
    pub fn without_light(&self, name: &str) -> Result<Self, EditError> {
        let mut edited = self.clone();
        let gone = self.scene.lights.iter().zip(0..).filter(|(light, _)| light.name() == name).map(|(_, number)| number);
        edited.scene.remove_lights(&gone.collect());
        let names: Vec<&str> = self.scene.lights.iter().map(Light::name).collect();
        if edited.scene.lights.len() == names.len() { Err(EditError::unknown("light", name, &names)) } else { Ok(edited) }
    }

    /// The scene with one more camera; where a camera has its name, it gets a number.
    ///
    /// # Errors
    /// When its axes are not orthonormal.
    pub fn with_camera(&self, camera: StartCamera) -> Result<Self, EditError> {
        let name = unique(printable(&camera.name, "camera"), |name| self.scene.cameras.iter().any(|known| known.name == name));
        let mut edited = self.clone();
        edited.scene.cameras.push(StartCamera { name, ..camera });
        self.checked(edited)
    }

    /// The scene without the cameras of that name.
    ///
    /// # Errors
    /// When there is none.
    pub fn without_camera(&self, name: &str) -> Result<Self, EditError> {
        let mut edited = self.clone();
        let gone = self.scene.cameras.iter().zip(0..).filter(|(camera, _)| camera.name == name).map(|(_, number)| number);
        edited.scene.remove_cameras(&gone.collect());
        let names: Vec<&str> = self.scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
        if edited.scene.cameras.len() == names.len() { Err(EditError::unknown("camera", name, &names)) } else { Ok(edited) }
    }
}

impl Light {
    /// The light under another name.
    #[must_use]
    pub(super) fn renamed(mut self, new: String) -> Self {
        match &mut self {
            Self::Point { name, .. } | Self::Spot { name, .. } | Self::Profile { name, .. } | Self::Directional { name, .. } => *name = new,
        }
        self
    }

    /// The light moved by a map of the world to itself; its strength stays, whatever the map's scale.
    pub(crate) fn moved(&self, world_from_before: &DAffine3) -> Self {
        let mut light = self.clone();
        let turned = |d: Vec3| world_from_before.transform_vector3(d.as_dvec3()).normalize_or(d.as_dvec3()).as_vec3();
        match &mut light {
            Self::Point { position, .. } => *position = place(world_from_before, *position),
            Self::Spot { position, direction, .. } => {
                *position = place(world_from_before, *position);
                *direction = turned(*direction);
            }
            Self::Profile { position, web_from_world, .. } => {
                *position = place(world_from_before, *position);
                let before_from_world = nearest_orthonormal(world_from_before.matrix3).transpose();
                *web_from_world *= Mat3::from_cols_array(&before_from_world.to_cols_array().map(|v| v as f32));
            }
            Self::Directional { direction, .. } => *direction = turned(*direction),
        }
        light
    }
}

/// The nearest rotation, or the nearest one that also mirrors.
fn nearest_orthonormal(m: DMat3) -> DMat3 {
    let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    nearest_rotation(m * sign).unwrap_or(DMat3::IDENTITY) * sign
}

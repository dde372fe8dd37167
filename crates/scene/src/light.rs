//! Lights without a surface: point, spot, measured and directional ones. Emission is RGB, in radiometric units.

use crate::PhotometricWeb;
use enfilade_math::{Mat3, Rgb, Vec3};
use serde::{Deserialize, Serialize};

/// A light without a surface in the scene. Emissive surfaces are materials; the surroundings are the environment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Light {
    /// Radiates equally in all directions from a point.
    Point {
        /// Name from the file.
        name: String,
        /// World position.
        position: Vec3,
        /// Radiant intensity, W/sr.
        intensity: Rgb,
    },
    /// A point light within a cone, dimming between the two angles.
    Spot {
        /// Name from the file.
        name: String,
        /// World position.
        position: Vec3,
        /// Unit axis, in the direction in which light travels.
        direction: Vec3,
        /// Radiant intensity on the axis, W/sr.
        intensity: Rgb,
        /// Full intensity within this angle from the axis, radians.
        inner_rad: f32,
        /// None beyond this one.
        outer_rad: f32,
        /// Falloff between them.
        falloff: SpotFalloff,
    },
    /// A point light with a measured distribution of intensity (IES).
    Profile {
        /// Name from the file.
        name: String,
        /// World position.
        position: Vec3,
        /// Rotation that takes world directions into the web's own space.
        web_from_world: Mat3,
        /// Multiplies the web's candela, which count as W/sr.
        intensity: Rgb,
        /// The distribution.
        web: Box<PhotometricWeb>,
    },
    /// Light from far away: parallel, or from a disk in the sky such as the sun.
    Directional {
        /// Name from the file.
        name: String,
        /// Unit direction the light travels in.
        direction: Vec3,
        /// Irradiance on a surface facing the light, W/m².
        irradiance: Rgb,
        /// Angular radius of the disk; 0 for exactly parallel light (the sun: 0.00465).
        angular_radius_rad: f32,
    },
}

/// Falloff of a spot from the inner angle to the outer one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SpotFalloff {
    /// The square of a line in the angle's cosine (glTF's `KHR_lights_punctual`).
    CosineSquare,
    /// A line in the angle (Mitsuba's `spot`).
    Angle,
    /// 3x² − 2x³ of a line x in the angle's cosine (Blender's spots).
    SmoothCosine,
    /// 3x² − 2x³ of a line x in the angle (UsdLux's `shaping:cone:softness`).
    SmoothAngle,
}

impl Light {
    /// True when all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        match self {
            Self::Point { position, intensity, .. } => position.is_finite() && intensity.is_finite(),
            Self::Spot { position, direction, intensity, inner_rad, outer_rad, .. } => {
                position.is_finite() && direction.is_finite() && intensity.is_finite() && inner_rad.is_finite() && outer_rad.is_finite()
            }
            // A web's own numbers were checked when it was made.
            Self::Profile { position, web_from_world, intensity, .. } => {
                position.is_finite() && web_from_world.is_finite() && intensity.is_finite()
            }
            Self::Directional { direction, irradiance, angular_radius_rad, .. } => {
                direction.is_finite() && irradiance.is_finite() && angular_radius_rad.is_finite()
            }
        }
    }

    /// The name given in the file.
    pub fn name(&self) -> &str {
        match self {
            Self::Point { name, .. } | Self::Spot { name, .. } | Self::Profile { name, .. } | Self::Directional { name, .. } => name,
        }
    }
}

//! Light from infinitely far away: one radiance, or an equirectangular image with Mitsuba's layout and a map from directions to it.

use enfilade_math::{Mat3, Rgb, Vec2, Vec3, angle};
use serde::{Deserialize, Serialize};
use std::f32::consts::{PI, TAU};

/// Light from infinitely far away, from all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Environment {
    /// Light of the same radiance from everywhere.
    Constant {
        /// Radiance.
        radiance: Rgb,
    },
    /// An equirectangular image; see [`uv_from_direction`] for its layout.
    Map {
        /// Index into `Scene::images`.
        image: u32,
        /// Polar angles of the image's rows.
        rows: MapRows,
        /// Multiplies the image.
        scale: Rgb,
        /// Rotation that takes world directions into the map's own space.
        map_from_world: Mat3,
    },
}

impl Environment {
    /// True if all its numbers are finite, except for the image's.
    pub(crate) fn is_finite(&self) -> bool {
        match self {
            Self::Constant { radiance } => radiance.is_finite(),
            Self::Map { scale, map_from_world, .. } => scale.is_finite() && map_from_world.is_finite(),
        }
    }
}

/// How the rows of an equirectangular image are distributed between the zenith and the nadir.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapRows {
    /// Each fills one of as many equal bands, so that the image's borders are the poles.
    Bands,
    /// The first and the last are the poles themselves, the others evenly between (Mitsuba's `envmap`).
    PoleToPole,
}

impl MapRows {
    /// The share of the image's height, from its upper border, that shows the polar angle θ = `v`·π.
    #[inline]
    pub fn place(self, v: f32, height: u32) -> f32 {
        match self {
            Self::Bands => v,
            Self::PoleToPole => (v * (height as f32 - 1.0) + 0.5) / height as f32,
        }
    }
}

/// Place in the equirectangular image of a unit direction in the map's space, which has y up: x across on [0,1), y downward
/// from the top row on `[0,1]`. x = atan2(dx, −dz) / 2π, as in Mitsuba: the left border is −z, the middle +z.
#[inline]
pub fn uv_from_direction(d: Vec3) -> Vec2 {
    let x = angle::atan2(d.x, -d.z) / TAU;
    Vec2::new(x - x.floor(), angle::acos(d.y) / PI)
}

/// Inverse of [`uv_from_direction`].
#[inline]
pub fn direction_from_uv(uv: Vec2) -> Vec3 {
    let (sin_phi, cos_phi) = angle::sin_cos_turns(uv.x);
    let (sin_theta, cos_theta) = angle::sin_cos_turns(0.5 * uv.y);
    Vec3::new(sin_phi * sin_theta, cos_theta, -cos_phi * sin_theta)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_round_trip_through_the_map() {
        for d in [Vec3::X, Vec3::NEG_Z, Vec3::Z, Vec3::new(0.3, -0.5, 0.8), Vec3::new(-0.2, 0.9, -0.1)] {
            let d = d.normalize();
            assert!((direction_from_uv(uv_from_direction(d)) - d).length() < 1e-5, "{d}");
        }
    }

    #[test]
    fn rows_lie_between_the_poles_or_on_them() {
        for (v, in_bands, on_poles) in [(0.0, 0.0, 0.125), (0.5, 0.5, 0.5), (1.0, 1.0, 0.875), (1.0 / 3.0, 1.0 / 3.0, 0.375)] {
            assert!((MapRows::Bands.place(v, 4) - in_bands).abs() < 1e-6);
            assert!((MapRows::PoleToPole.place(v, 4) - on_poles).abs() < 1e-6);
        }
    }
}

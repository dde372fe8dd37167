//! A plane of a roof, as rooms use it.

use enfilade_math::{DAffine3, DMat3, DVec2, Vec2};
use enfilade_scene::Slope;

/// A sloping part of a ceiling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incline {
    /// The plane, as files state it.
    pub slope: Slope,
    at: Vec2,
    low: f32,
    gradient: Vec2,
}

impl Incline {
    pub(super) fn new(slope: Slope) -> Self {
        let gradient = (slope.uphill() * slope.rise()).as_vec2();
        Self { slope, at: DVec2::from(slope.from).as_vec2(), low: slope.low_z_m as f32, gradient }
    }

    /// Height over a point, metres.
    pub fn z(&self, p: Vec2) -> f32 {
        self.low + (p - self.at).dot(self.gradient)
    }

    /// Metres that it rises on a level metre.
    pub fn rise(&self) -> f32 {
        self.gradient.length()
    }

    /// The space of the plane: x along its lower edge, y uphill within it, z upwards from it.
    pub fn pose(&self) -> DAffine3 {
        let (up, uphill) = (-self.slope.normal(), self.slope.uphill());
        let along = -uphill.perp();
        let turn = DMat3::from_cols(along.extend(0.0), up.cross(along.extend(0.0)), up);
        DAffine3::from_mat3_translation(turn, DVec2::from(self.slope.from).extend(self.slope.low_z_m))
    }
}

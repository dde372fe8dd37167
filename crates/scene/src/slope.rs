//! Sloping ceilings under a roof: planes that rise from a line, below which the space of a room ends.

use enfilade_math::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A plane that rises to the left of a line, seen from above.
///
/// ```
/// use enfilade_scene::Slope;
/// // From a knee wall of 1.2 m in the south, northwards.
/// let slope = Slope { from: [0.0, 0.0], to: [5.0, 0.0], low_z_m: 1.2, pitch_deg: 45.0 };
/// assert!((slope.z_m([3.0, 0.8].into()) - 2.0).abs() < 1e-12);
/// assert!((slope.normal() - enfilade_math::DVec3::new(0.0, 0.5f64.sqrt(), -0.5f64.sqrt())).length() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Slope {
    /// Beginning of its lower edge, seen from above.
    pub from: [f64; 2],
    /// End of its lower edge; the plane rises to the left of someone who goes there.
    pub to: [f64; 2],
    /// Height of the lower edge, metres.
    pub low_z_m: f64,
    /// Angle between the plane and the level, degrees.
    pub pitch_deg: f64,
}

/// A sloping part of a room's ceiling: the ceiling is where the lowest of its slopes and its level is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CeilingSlope {
    /// The room, by its place in the list of rooms.
    pub room: usize,
    /// The plane.
    #[serde(flatten)]
    pub slope: Slope,
}

impl Slope {
    /// Unit vector uphill, seen from above.
    pub fn uphill(&self) -> DVec2 {
        (DVec2::from(self.to) - DVec2::from(self.from)).normalize_or_zero().perp()
    }

    /// Metres that it rises on a level metre.
    pub fn rise(&self) -> f64 {
        self.pitch_deg.to_radians().tan()
    }

    /// Height of the plane over a point.
    pub fn z_m(&self, p: DVec2) -> f64 {
        self.low_z_m + self.rise() * (p - DVec2::from(self.from)).dot(self.uphill())
    }

    /// Unit normal, downwards into the room.
    pub fn normal(&self) -> DVec3 {
        (self.uphill() * self.rise()).extend(-1.0).normalize()
    }

    /// Signed distance of a point from the plane, positive below it.
    pub fn distance_m(&self, p: DVec3) -> f64 {
        self.normal().dot(p - DVec2::from(self.from).extend(self.low_z_m))
    }

    /// The plane, moved.
    #[must_use]
    pub fn moved(self, by: DVec3) -> Self {
        let end = |p: [f64; 2]| (DVec2::from(p) + by.truncate()).to_array();
        Self { from: end(self.from), to: end(self.to), low_z_m: self.low_z_m + by.z, ..self }
    }
}

//! The place of a mark.

use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Vec2};

/// Where a mark is: a rectangle whose middle is the origin of the pose, along its x and y.
pub(super) struct Place {
    pub pose: DAffine3,
    pub half: Vec2,
    /// The film, if it is not that rectangle.
    pub film: Option<Mesh>,
}

impl Place {
    /// A flat place.
    pub fn flat(pose: DAffine3, half: Vec2) -> Self {
        Self { pose, half, film: None }
    }
}

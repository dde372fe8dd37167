//! The rays of a pinhole image: one through the centre of every pixel, as a corner and two steps.

use enfilade_math::Vec3;

/// Rays of a pinhole image: the one through the centre of pixel (x, y) has the direction `corner + x · right + y · down`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeRays {
    /// Camera centre.
    pub origin: Vec3,
    /// Through the centre of the pixel in the upper left corner. Its length along the optical axis is 1.
    pub corner: Vec3,
    /// From a pixel to the next in its row; at a right angle to the optical axis.
    pub right: Vec3,
    /// From a pixel to the one below; at a right angle to the optical axis.
    pub down: Vec3,
}

impl PinholeRays {
    /// The ray through the centre of a pixel. Not a unit vector.
    #[inline]
    pub fn direction(&self, x: f32, y: f32) -> Vec3 {
        self.corner + x * self.right + y * self.down
    }

    /// The unit vector along the optical axis.
    pub fn forward(&self) -> Vec3 {
        let axis = self.right.cross(self.down).normalize();
        if axis.dot(self.corner) < 0.0 { -axis } else { axis }
    }
}

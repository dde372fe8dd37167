//! Points that stay on their triangle while its corners move.

use crate::prepared::RenderScene;
use enfilade_math::DVec3;

/// A point on a triangle of a scene, whatever shape the scene's parts have at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrianglePoint {
    triangle: u32,
    /// Of the corners; they add up to one.
    weights: [f64; 3],
}

impl TrianglePoint {
    /// A world point in the plane of a triangle.
    pub(crate) fn of(scene: &RenderScene<'_>, triangle: u32, p_world: DVec3) -> Self {
        let [a, b, c] = scene.triangles.get(triangle).corners.map(|corner| corner.as_dvec3());
        let (ab, ac, ap) = (b - a, c - a, p_world - a);
        let normal = ab.cross(ac);
        let area2 = normal.length_squared();
        let [to_b, to_c] = [ap.cross(ac).dot(normal) / area2, ab.cross(ap).dot(normal) / area2];
        Self { triangle, weights: [1.0 - to_b - to_c, to_b, to_c] }
    }

    /// The point's place in the scene at a moment.
    pub(crate) fn place(&self, scene: &RenderScene<'_>) -> DVec3 {
        let corners = scene.triangles.get(self.triangle).corners;
        corners.iter().zip(self.weights).map(|(corner, weight)| corner.as_dvec3() * weight).sum()
    }
}

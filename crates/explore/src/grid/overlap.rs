//! Does a triangle touch a box? Separating axes: Akenine-Möller 2001, "Fast 3D Triangle-Box Overlap Testing".

use enfilade_math::DVec3;

/// A triangle prepared for many overlap tests against boxes.
pub(crate) struct OverlapTest {
    corners: [DVec3; 3],
    edges: [DVec3; 3],
    normal: DVec3,
}

impl OverlapTest {
    pub(crate) fn new(corners: [DVec3; 3]) -> Self {
        let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
        Self { corners, edges, normal: edges[0].cross(edges[1]) }
    }

    /// True when the triangle and the box have a point in common, borders included. Points and segments (triangles without area)
    /// count as they are.
    pub(crate) fn touches(&self, center: DVec3, half: DVec3) -> bool {
        let v = self.corners.map(|p| p - center);
        let outside = v[0].min(v[1]).min(v[2]).cmpgt(half) | v[0].max(v[1]).max(v[2]).cmplt(-half);
        if outside.any() || self.normal.dot(v[0]).abs() > self.normal.abs().dot(half) {
            return false;
        }
        self.edges.iter().all(|edge| {
            // Cross products of the edge with the three axes of the box.
            let axes = [DVec3::new(0.0, -edge.z, edge.y), DVec3::new(edge.z, 0.0, -edge.x), DVec3::new(-edge.y, edge.x, 0.0)];
            axes.iter().all(|axis| {
                let p = v.map(|corner| axis.dot(corner));
                let radius = axis.abs().dot(half);
                p[0].min(p[1]).min(p[2]) <= radius && p[0].max(p[1]).max(p[2]) >= -radius
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::Rng;

    fn random_point(rng: &mut Rng, size: f64) -> DVec3 {
        DVec3::from([0; 3].map(|_| size * (2.0 * rng.next_f64() - 1.0)))
    }

    #[test]
    fn a_point_of_the_triangle_inside_the_box_means_overlap() {
        let mut rng = Rng::new(5);
        let half = DVec3::splat(0.5);
        let (mut found, mut missed) = (0, 0);
        for _ in 0..3000 {
            let corners = [0; 3].map(|_| random_point(&mut rng, 2.0));
            let touches = OverlapTest::new(corners).touches(DVec3::ZERO, half);
            let sampled = (0..400).any(|_| {
                let (a, b) = (rng.next_f64(), rng.next_f64());
                let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
                let p = corners[0] + a * (corners[1] - corners[0]) + b * (corners[2] - corners[0]);
                p.abs().cmple(half).all()
            });
            assert!(touches || !sampled, "{corners:?}");
            found += usize::from(sampled);
            missed += usize::from(touches && !sampled);
        }
        assert!(found > 500 && missed * 20 < found, "{found} overlaps seen by samples, {missed} others: too many false ones");
    }

    #[test]
    fn only_the_cross_axes_tell_a_near_miss_of_an_edge() {
        // A triangle across the box's edge at x = y = 0.5, tilted in all axes: its plane crosses the box, it does not.
        let near = [DVec3::new(1.02, 0.0, -1.0), DVec3::new(0.0, 1.02, 1.0), DVec3::new(1.5, 1.5, 0.0)];
        assert!(!OverlapTest::new(near).touches(DVec3::ZERO, DVec3::splat(0.5)));
        let crossing = near.map(|p| p - DVec3::new(0.02, 0.02, 0.0));
        assert!(OverlapTest::new(crossing).touches(DVec3::ZERO, DVec3::splat(0.5)));
    }

    #[test]
    fn triangles_without_area_count_as_points_and_segments() {
        let half = DVec3::splat(0.5);
        assert!(OverlapTest::new([DVec3::splat(0.2); 3]).touches(DVec3::ZERO, half));
        assert!(!OverlapTest::new([DVec3::splat(0.7); 3]).touches(DVec3::ZERO, half));
        let segment = [DVec3::splat(-3.0), DVec3::splat(3.0), DVec3::splat(1.0)];
        assert!(OverlapTest::new(segment).touches(DVec3::ZERO, half));
        assert!(!OverlapTest::new(segment.map(|p| p + DVec3::X * 1.1)).touches(DVec3::ZERO, half));
    }
}

//! Windows as portals: the environment reaches a room only through them, so its light is sampled there.
//!
//! A portal is the bounding rectangle of thin panes that lie in one plane, sampled uniformly over its area, whatever the sky
//! behind it: the simplest form of what Bitterli, Novák & Jarosz 2015, "Portal-Masked Environment Map Sampling", do exactly.

use crate::triangle::Triangle;
use enfilade_math::Vec3;
use enfilade_scene::{Bsdf, Scene};

/// Smaller rectangles are drinking glasses and picture frames, in square metres.
const MIN_AREA: f32 = 0.1;
/// The most portals kept, the largest first.
const MAX_PORTALS: usize = 16;
/// Panes count as in one plane within this angle (cosine) and this distance in metres.
const SAME_NORMAL: f32 = 0.999;
const SAME_PLANE_M: f32 = 0.06;
/// Points nearer to the plane than this do not sample the portal, in metres: they see it edge-on.
const MIN_HEIGHT_M: f32 = 1e-3;

/// A rectangle through which the sky is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portal {
    corner: Vec3,
    /// Orthogonal sides.
    side_u: Vec3,
    side_v: Vec3,
    normal: Vec3,
    area: f32,
}

impl Portal {
    /// Roughly the solid angle seen from `p`: the weight with which the portal is chosen.
    #[inline]
    fn weight(&self, p: Vec3) -> f32 {
        let to = self.corner + 0.5 * (self.side_u + self.side_v) - p;
        let height = (p - self.corner).dot(self.normal).abs();
        if height < MIN_HEIGHT_M {
            return 0.0;
        }
        self.area / (to.length_squared() + self.area)
    }

    /// Density per solid angle at `p` of the direction `d` under uniform sampling of the area; zero when `d` misses.
    #[inline]
    fn pdf(&self, p: Vec3, d: Vec3) -> f32 {
        let cos = d.dot(self.normal);
        let t = (self.corner - p).dot(self.normal) / cos;
        if !(t > 0.0 && t.is_finite()) {
            return 0.0;
        }
        let q = p + d * t - self.corner;
        let (u, v) = (q.dot(self.side_u) / self.side_u.length_squared(), q.dot(self.side_v) / self.side_v.length_squared());
        if (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v) { t * t / (self.area * cos.abs()) } else { 0.0 }
    }
}

/// All portals of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Portals(Vec<Portal>);

impl Portals {
    /// A direction from `p` through a portal; `None` when none can be seen from there.
    pub fn sample(&self, p: Vec3, u: [f32; 3]) -> Option<Vec3> {
        let total: f32 = self.0.iter().map(|portal| portal.weight(p)).sum();
        if total <= 0.0 {
            return None;
        }
        let mut rest = u[2] * total;
        let chosen = self.0.iter().find(|portal| {
            let weight = portal.weight(p);
            let found = rest < weight;
            rest -= weight;
            found
        })?;
        (chosen.corner + chosen.side_u * u[0] + chosen.side_v * u[1] - p).try_normalize()
    }

    /// Density per solid angle of [`Portals::sample`]; `None` when no portal can be seen from `p`.
    pub fn pdf(&self, p: Vec3, d: Vec3) -> Option<f32> {
        let (mut total, mut sum) = (0.0, 0.0);
        for portal in &self.0 {
            let weight = portal.weight(p);
            total += weight;
            if weight > 0.0 {
                sum += weight * portal.pdf(p, d);
            }
        }
        (total > 0.0).then(|| sum / total)
    }
}

/// Finds the portals: thin panes, gathered by plane.
pub(super) fn find(scene: &Scene, triangles: &[Triangle]) -> Portals {
    let is_pane: Vec<bool> = scene.materials.iter().map(|m| matches!(m.bsdf, Bsdf::ThinDielectric { .. })).collect();
    let mut planes: Vec<(Vec3, f32, Vec<Vec3>, f32)> = Vec::new();
    for triangle in triangles.iter().filter(|t| is_pane[t.material as usize]) {
        let Some(n) = triangle.cross().try_normalize() else { continue };
        // Both faces of a pane lie in one plane.
        let n = if (n.x, n.y, n.z) < (0.0, 0.0, 0.0) { -n } else { n };
        let offset = n.dot(triangle.corners[0]);
        let plane = planes.iter_mut().find(|(m, d, ..)| n.dot(*m) > SAME_NORMAL && (offset - d).abs() < SAME_PLANE_M);
        match plane {
            Some((_, _, points, area)) => {
                points.extend(triangle.corners);
                *area += triangle.area();
            }
            None => planes.push((n, offset, triangle.corners.to_vec(), triangle.area())),
        }
    }
    let mut portals: Vec<Portal> = planes.iter().filter_map(|(n, _, points, area)| rectangle(*n, points, *area)).collect();
    portals.sort_by(|a, b| b.area.total_cmp(&a.area));
    portals.truncate(MAX_PORTALS);
    Portals(portals)
}

/// The upright bounding rectangle of points in a plane; `None` when it is small or mostly empty.
fn rectangle(normal: Vec3, points: &[Vec3], area_of_panes: f32) -> Option<Portal> {
    let u = Vec3::Z.cross(normal).try_normalize().unwrap_or(Vec3::X);
    let v = normal.cross(u);
    let range =
        |axis: Vec3| points.iter().map(|p| p.dot(axis)).fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
    let ((u0, u1), (v0, v1)) = (range(u), range(v));
    let area = (u1 - u0) * (v1 - v0);
    if area < MIN_AREA || area_of_panes < 0.3 * area {
        return None;
    }
    let corner = u * u0 + v * v0 + normal * normal.dot(points[0]);
    Some(Portal { corner, side_u: u * (u1 - u0), side_v: v * (v1 - v0), normal, area })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_through_portals_follow_their_density() {
        let portals = Portals(vec![
            Portal { corner: Vec3::new(-1.0, 2.0, 0.5), side_u: Vec3::X * 2.0, side_v: Vec3::Z, normal: Vec3::Y, area: 2.0 },
            Portal { corner: Vec3::new(3.0, -1.0, 0.0), side_u: Vec3::Y, side_v: Vec3::Z * 2.0, normal: Vec3::X, area: 2.0 },
        ]);
        let p = Vec3::new(0.3, 0.1, 0.2);
        let test = enfilade_testkit::ChiSquare::directions(200_000, |u| portals.sample(p, u), |d| portals.pdf(p, d).unwrap());
        test.assert("portals", 1);
        assert_eq!(Portals::default().pdf(p, Vec3::X), None);
        // In the plane of the only portal nothing is seen of it.
        assert!(Portals(portals.0[..1].to_vec()).sample(Vec3::new(5.0, 2.0, 0.0), [0.5; 3]).is_none());
    }
}

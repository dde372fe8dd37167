//! Coordinates of surveys: positions far from the origin of their coordinates, such as those of a map (UTM), are stored relative to a point
//! nearby.
//!
//! Meshes and rays are in single precision, whose numbers are half a metre apart at the magnitude of northings. So a mesh far from the
//! origin has positions relative to a point of its own, and a placement in double precision. A scene far from the origin is moved, and the
//! report says by how much.

use super::Assembly;
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Vec3};
use enfilade_scene::{Light, Part, Scene};

/// Distance from the origin beyond which numbers of single precision are a millimetre apart, metres.
pub(crate) const FAR_M: f64 = 8192.0;
/// Things nearer than this along an axis are not moved along it, metres: numbers there are a tenth of a millimetre apart.
const NEAR_M: f64 = 1024.0;
/// Things whose extent exceeds this share of their distance from the origin are not moved: they would gain little from a nearer origin.
const REACH: f64 = 0.25;

/// The point, in whole units, from which positions of a mesh count: zero unless they are far from it, and together.
pub(crate) fn origin_of(points: impl Iterator<Item = DVec3> + Clone, meters_per_unit: f64) -> DVec3 {
    let is_far = |p: DVec3| p.is_finite() && p.abs().max_element() * meters_per_unit.abs() >= FAR_M;
    if points.clone().any(is_far) { origin(points.map(|p| (p, 0.0)).collect(), meters_per_unit) } else { DVec3::ZERO }
}

/// Positions in single precision from a point.
pub(crate) fn positions_from(origin: DVec3, points: &[DVec3]) -> Vec<Vec3> {
    points.iter().map(|p| (*p - origin).as_vec3()).collect()
}

/// Origin for places, each with how far it reaches around its middle, as [`origin_of`]. Medians, because a stray place shall not decide.
fn origin(mut places: Vec<(DVec3, f64)>, meters_per_unit: f64) -> DVec3 {
    places.retain(|(middle, reach)| middle.is_finite() && reach.is_finite());
    let middle = DVec3::from_array([0, 1, 2].map(|axis| median(places.iter().map(|(p, _)| p[axis]).collect())));
    let reach = median(places.iter().map(|(p, reach)| (*p - middle).abs().max_element() + reach).collect());
    let far = middle.abs().max_element();
    if far * meters_per_unit.abs() < FAR_M || reach > REACH * far {
        return DVec3::ZERO;
    }
    DVec3::from_array(middle.to_array().map(|c| if c.abs() * meters_per_unit.abs() < NEAR_M { 0.0 } else { c.round() }))
}

/// The median, of two the higher; zero of none.
fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

impl Assembly<'_> {
    /// Moves a scene that is far off to the origin, with a warning that says by how much.
    pub(super) fn bring_near(&mut self) {
        let offset = if self.archive.is_none() { origin(places(&self.scene), 1.0) } else { DVec3::ZERO };
        if offset == DVec3::ZERO {
            return;
        }
        self.scene.parts.iter_mut().for_each(|part| part.world_from_mesh.translation -= offset);
        self.scene.cameras.iter_mut().for_each(|camera| camera.position -= offset);
        for body in &mut self.scene.bodies {
            if let Some(moved) = body.carried(&DAffine3::from_translation(-offset)) {
                *body = moved;
            }
        }
        for (light, exact) in self.scene.lights.iter_mut().zip(&self.light_positions) {
            match light {
                Light::Point { position, .. } | Light::Spot { position, .. } | Light::Profile { position, .. } => {
                    *position = (*exact - offset).as_vec3();
                }
                Light::Directional { .. } => (),
            }
        }
        let far = offset.abs().max_element();
        let step_mm = 1000.0 * (far.log2().floor() - 23.0).exp2();
        let message = format!(
            "the scene stands {:.0} km from the origin of its coordinates, where single precision knows steps of {step_mm:.0} mm; \
             ({}, {}, {}) m were subtracted from all positions (z up): add them to get back, and subtract them from poses that you give",
            far / 1000.0,
            offset.x,
            offset.y,
            offset.z
        );
        self.warn("coordinates", message);
        self.offset_m = Some(offset.to_array());
    }
}

/// The middle of each part in the world, and how far the part reaches from it along an axis.
fn places(scene: &Scene) -> Vec<(DVec3, f64)> {
    let boxes: Vec<(DVec3, DVec3)> = scene.meshes.iter().map(|mesh| bounds(mesh)).collect();
    let placed = |part: &Part| {
        let (min, max) = boxes[part.mesh as usize];
        let to_world: DAffine3 = part.world_from_mesh;
        let (half, m) = (0.5 * (max - min), to_world.matrix3);
        let reach = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
        (to_world.transform_point3(0.5 * (min + max)), reach.max_element())
    };
    scene.parts.iter().map(placed).collect()
}

fn bounds(mesh: &Mesh) -> (DVec3, DVec3) {
    let points = mesh.positions.iter().map(|p| p.as_dvec3());
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_far_and_together_is_told_from_another_point() {
        let cube = |middle: DVec3, size: f64| {
            (0..8).map(move |i| middle + size * DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into()))
        };
        let utm = DVec3::new(445_123.4, 31.0, 5_411_234.6);
        assert_eq!(origin_of(cube(utm, 0.25), 1.0), DVec3::new(445_124.0, 0.0, 5_411_235.0));
        // One stray vertex does not decide.
        assert_eq!(origin_of(cube(utm, 0.25).chain([DVec3::ZERO]), 1.0), DVec3::new(445_123.0, 0.0, 5_411_235.0));
        for (near, unit) in [(cube(DVec3::splat(8000.0), 4.0), 1.0), (cube(utm, 4.0), 0.001), (cube(DVec3::splat(-1e6), 2e6), 1.0)] {
            assert_eq!(origin_of(near, unit), DVec3::ZERO);
        }
        assert_eq!(origin_of(cube(utm * 1000.0, 500.0), 0.001).x, 445_123_900.0);
        assert_eq!(origin_of([DVec3::NAN, DVec3::INFINITY].into_iter(), 1.0), DVec3::ZERO);
    }
}

//! The transparent bodies of a scene, as aims for light that curved ones bend.

use crate::surface::Surface;
use enfilade_math::{Bounds3, Rng, Vec3, warp};
use enfilade_scene::{Bsdf, Part, PartId, Scene};
use std::collections::BTreeMap;

/// Up to this fraction of its area, a body may have faces that are not parallel to its three largest pairs: panes and blocks with bevels.
const BEVELS: f64 = 0.05;
/// Normals count as parallel when they agree to about this.
const NORMAL_STEPS: f32 = 64.0;
/// Where curved bodies fill this fraction of the hemisphere, light by way of them is always looked for; where they fill less, with a
/// proportional chance.
const LARGE: f32 = 0.02;

/// The transparent bodies of a scene.
#[derive(Default)]
pub(crate) struct Bodies {
    /// True when a material may be the border of one.
    pub any: bool,
    /// By their parts.
    all: Vec<Body>,
    /// Those that are no panes or blocks.
    curved: Vec<Body>,
}

/// The sphere around a body.
#[derive(Clone, Copy)]
pub(super) struct Body {
    part: PartId,
    center: Vec3,
    radius: f32,
}

impl Bodies {
    pub fn of(scene: &Scene) -> Self {
        let any = scene.materials.iter().any(|m| may_be_body(&m.bsdf));
        let parts = scene.parts.iter().enumerate().filter(|(_, part)| may_be_body(&scene.materials[part.material as usize].bsdf));
        let all: Vec<Body> = parts.map(|(k, part)| Body::around(scene, k as PartId, part)).collect();
        let curved = all.iter().copied().filter(|body| is_curved(scene, &scene.parts[body.part as usize])).collect();
        Self { any, all, curved }
    }

    /// Whether a body may bend light to places that a straight line does not show.
    #[inline]
    pub fn are_curved(&self) -> bool {
        !self.curved.is_empty()
    }

    /// The body of a part.
    pub(super) fn find(&self, part: PartId) -> Option<&Body> {
        self.all.binary_search_by_key(&part, |body| body.part).ok().map(|k| &self.all[k])
    }

    /// About the fraction of a hemisphere that curved ones fill, seen from a point.
    pub(super) fn seen_from(&self, from: &Surface<'_>) -> f32 {
        self.curved.iter().map(|body| body.seen_from(from)).sum()
    }

    /// The chance with which light is looked for by way of curved ones from a point where they fill `seen` of the hemisphere.
    pub(super) fn chance(seen: f32) -> f32 {
        (seen / LARGE).min(1.0)
    }

    /// Draws a curved one by how large it seems from a point: the one at `left` when what each fills is put in a row.
    pub(super) fn choose(&self, from: &Surface<'_>, mut left: f32) -> Option<&Body> {
        self.curved.iter().find(|body| {
            left -= body.seen_from(from);
            left < 0.0
        })
    }
}

impl Body {
    fn around(scene: &Scene, number: PartId, part: &Part) -> Self {
        let center = Bounds3::from_points(scene.world_positions(part)).center();
        let square = scene.world_positions(part).map(|p| p.distance_squared(center)).fold(0.0, f32::max);
        Self { part: number, center, radius: square.sqrt() }
    }

    /// A point in the sphere around it.
    pub fn point(&self, rng: &mut Rng) -> Vec3 {
        self.center + warp::sphere([rng.next_f32(), rng.next_f32()]) * (self.radius * rng.next_f32())
    }

    /// About the fraction of a hemisphere that it fills, seen from a point; 0 below the horizon of an opaque surface.
    fn seen_from(&self, from: &Surface<'_>) -> f32 {
        let to = self.center - from.p;
        let below = to.dot(from.ng) < -self.radius && !from.material.bsdf.transmits();
        if below { 0.0 } else { 0.5 * self.radius * self.radius / to.length_squared().max(self.radius * self.radius) }
    }
}

/// Whether a material may be the border of a transparent body.
fn may_be_body(bsdf: &Bsdf) -> bool {
    match bsdf {
        Bsdf::Dielectric { .. } => true,
        Bsdf::Principled(p) => p.solid && p.transmission.factor > 0.0,
        Bsdf::Blend { first, second, .. } => may_be_body(first) || may_be_body(second),
        _ => false,
    }
}

/// Whether a part bends light as more than a pane or a block does: smooth normals, or faces in more than three pairs of directions.
fn is_curved(scene: &Scene, part: &Part) -> bool {
    let mesh = &scene.meshes[part.mesh as usize];
    let positions: Vec<Vec3> = scene.world_positions(part).collect();
    let (mut areas, mut all) = (BTreeMap::<[i32; 3], f64>::new(), 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| positions[k as usize]);
        let across = (b - a).cross(c - a);
        let area = f64::from(across.length());
        let Some(normal) = across.try_normalize() else { continue };
        let bends = triangle.windows(2).any(|pair| match (mesh.normals.get(pair[0] as usize), mesh.normals.get(pair[1] as usize)) {
            (Some(n), Some(m)) => n.distance_squared(*m) > 1.0 / (NORMAL_STEPS * NORMAL_STEPS),
            _ => false,
        });
        all += area;
        if !bends {
            // Opposite normals count as one.
            let cell = (normal * NORMAL_STEPS).round().to_array().map(|v| v as i32);
            *areas.entry(cell.max(cell.map(|v| -v))).or_default() += area;
        }
    }
    let mut areas: Vec<f64> = areas.into_values().collect();
    areas.sort_by(|a, b| b.total_cmp(a));
    areas.iter().take(3).sum::<f64>() < (1.0 - BEVELS) * all
}

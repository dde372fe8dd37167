//! Every surface along the ray through a pixel's centre, straight on through all of them, and the first that lets no light through on the way
//! that glass bends.

use crate::geometry_pass::{Sighting, exact_distance, sighting};
use crate::prepared::{AlphaTest, RenderScene};
use crate::rows::Rows;
use crate::surface::Surface;
use crate::texture::Cone;
use crate::vertex::body;
use enfilade_frame::f16;
use enfilade_geometry::Hit;
use enfilade_math::{Ray, Vec3};
use enfilade_scene::CameraView;

/// Surfaces of one part that are no farther apart, as a share of the distance, and face the same way are one.
const SAME: f32 = 1e-6;
/// The most surfaces at which a way is bent or mirrored within glass.
const MAX_BENDS: usize = 64;

/// The surfaces along the rays of a view's pixels, row by row, and for each pixel from near to far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RaySurfaces {
    /// Surfaces per pixel: farther ones are left out.
    pub count: usize,
    /// Euclidean distance from the camera centre, metres; NaN beyond the last surface.
    pub distance_m: Vec<f32>,
    /// Part number from 1, as in `render_entity_id`; −1 beyond the last surface.
    pub entity: Vec<i16>,
    /// 1: the front of the surface is seen, to which its outward normals point; 2: its back; 0 beyond the last surface.
    pub side: Vec<u8>,
    /// Unit normal of the flat triangle, world, facing the camera; NaN beyond the last surface.
    pub normal_world: Vec<[f16; 3]>,
    /// By pixel: what the ray ends on if glass bends it as it bends light.
    pub bent: Vec<Bent>,
}

/// The first surface that lets no light through, on a way that is refracted where it enters and leaves glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bent {
    /// Length of the way, metres; NaN where it meets none.
    pub way_m: f32,
    /// Where it ends, world, metres; NaN where it meets none.
    pub position: [f32; 3],
    /// Part number from 1; −1 where it meets none.
    pub entity: i16,
}

impl Bent {
    const NONE: Self = Self { way_m: f32::NAN, position: [f32::NAN; 3], entity: -1 };
}

/// One surface along a ray.
#[derive(Clone, Copy)]
struct Met {
    distance_m: f32,
    entity: i16,
    side: u8,
    normal: [f16; 3],
}

impl Met {
    const NONE: Self = Self { distance_m: f32::NAN, entity: -1, side: 0, normal: [f16::NAN; 3] };

    /// True if the surface `before` is in the same place.
    fn is_at(&self, before: &Self) -> bool {
        self.distance_m - before.distance_m <= SAME * self.distance_m
    }

    /// True of the same side of one part.
    fn is_side_of(&self, other: &Self) -> bool {
        self.entity == other.entity && self.side == other.side
    }
}

/// The first `count` surfaces that the ray through each pixel's centre meets.
pub(crate) fn surfaces(rows: &Rows<'_, '_>, view: &CameraView<'_>, count: usize) -> RaySurfaces {
    let [width, height] = view.camera().size();
    let pixel = |index: u32| {
        let mut met = vec![Met::NONE; count];
        let centre = (f64::from(index % width) + 0.5, f64::from(index / width) + 0.5);
        let scene = rows.at(centre.1);
        let Some(first) = sighting(scene, view, centre) else { return (met, Bent::NONE) };
        along(scene, &first, &mut met);
        (met, bent(scene, &first))
    };
    let pixels: Vec<(Vec<Met>, Bent)> = enfilade_parallel::map_up_to((width * height) as usize, |index| pixel(index as u32));
    let met = || pixels.iter().flat_map(|(met, _)| met);
    RaySurfaces {
        count,
        distance_m: met().map(|met| met.distance_m).collect(),
        entity: met().map(|met| met.entity).collect(),
        side: met().map(|met| met.side).collect(),
        normal_world: met().map(|met| met.normal).collect(),
        bent: pixels.iter().map(|(_, bent)| *bent).collect(),
    }
}

/// Follows the ray straight on from the surface that it meets first. The hierarchy must ask about every triangle.
fn along(scene: &RenderScene<'_>, first: &Sighting<'_>, met: &mut [Met]) {
    let origin = first.p_world - first.direction * first.distance_m;
    let ray = Ray::new(origin.as_vec3(), first.direction.as_vec3());
    let mut triangles = vec![first.triangle];
    let (mut surface, mut distance_m, mut count) = (first.surface.clone(), first.distance_m, 0);
    while count < met.len() {
        let triangle = scene.triangles.get(surface.triangle);
        let side = if surface.outside { 1 } else { 2 };
        let normal = surface.ng.to_array().map(f16::from_f32);
        let found = Met { distance_m: distance_m as f32, entity: (triangle.part + 1) as i16, side, normal };
        // On an edge both triangles of one surface are met.
        if !met[..count].iter().rev().take_while(|before| found.is_at(before)).any(|before| found.is_side_of(before)) {
            met[count] = found;
            count += 1;
        }
        let is_new = |hit: &Hit| !triangles.contains(&hit.triangle) && scene.is_present(hit, AlphaTest::Half);
        let Some(hit) = scene.bvh.closest_filtered(&ray, is_new) else { return };
        triangles.push(hit.triangle);
        surface = scene.surface(&hit, ray.direction, &Cone::POINT);
        // Along the exact ray; where two surfaces coincide, rounding must not change their order.
        let exact = exact_distance(scene.triangles.get(hit.triangle).corners, origin, first.direction);
        distance_m = exact.unwrap_or(f64::from(hit.t)).max(distance_m);
    }
}

/// Follows the way that light takes through glass to the first surface that lets none through.
fn bent(scene: &RenderScene<'_>, first: &Sighting<'_>) -> Bent {
    let (mut surface, mut direction) = (first.surface.clone(), first.direction.as_vec3());
    let (mut way_m, mut position) = (first.distance_m, first.p_world.as_vec3());
    for _ in 0..MAX_BENDS {
        if surface.appearance(scene).transmission == 0.0 {
            let entity = (scene.triangles.get(surface.triangle).part + 1) as i16;
            return Bent { way_m: way_m as f32, position: position.to_array(), entity };
        }
        direction = beyond(&surface, direction);
        let Some(hit) = scene.closest(&surface.ray(direction), AlphaTest::Half) else { break };
        let next = scene.surface(&hit, direction, &Cone::POINT);
        // Between the surfaces themselves: rays begin a little off them.
        way_m += f64::from(next.p.distance(surface.p));
        position = next.p;
        surface = next;
    }
    Bent::NONE
}

/// The direction after a surface that light passes: straight on behind a pane, refracted at the border of a body, mirrored where that is not
/// possible (Snell's law, with the index of air as 1).
fn beyond(surface: &Surface<'_>, direction: Vec3) -> Vec3 {
    let Some((eta, _)) = body(&surface.material.bsdf) else { return direction };
    let ratio = if surface.outside { 1.0 / eta } else { eta };
    let bend = |normal: Vec3| match direction.refract(normal, ratio) {
        Vec3::ZERO => direction.reflect(normal),
        refracted => refracted.normalize(),
    };
    let (by_shading, by_face) = (bend(surface.ns), bend(surface.ng));
    // Bumps must not turn a way back that the face lets through.
    if by_shading.dot(surface.ng) * by_face.dot(surface.ng) > 0.0 { by_shading } else { by_face }
}

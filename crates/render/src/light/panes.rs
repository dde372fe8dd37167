//! Finds the fixtures of a scene, and for them the panes that the sky shines through: the parts that windows are made of, regardless of
//! their names.

use super::bounds::LightBounds;
use super::delta;
use super::fixtures::{Fixtures, Pane};
use super::lights::Lights;
use crate::prepared::RenderScene;
use crate::triangles::emits;
use enfilade_math::{Bounds3, Distribution1, Onb, Ray, Rng, Vec3, hash_u64, warp};
use enfilade_scene::{Part, PartId};

/// The second-longest side of the box around a pane is at least this long, metres: no drinking glass is one.
const MIN_SIDE_M: f32 = 0.15;
/// Rays that ask whether the sky shines through a part, and how many of them must find it.
const RAYS: u32 = 96;
const MIN_FOUND: u32 = 6;
/// Rays begin this far before a pane, metres: behind no picture light continues as far.
const BEFORE_M: f32 = 0.3;

impl Lights<'_> {
    /// Finds what lights a scene, thing by thing.
    pub fn find_fixtures(ready: &RenderScene<'_>) -> Fixtures {
        let (scene, lights) = (ready.scene, &ready.lights);
        let at_points = scene.lights.iter().enumerate().filter_map(|(number, light)| Some((number, delta::light_bounds(light)?)));
        let (numbers, bounds): (Vec<usize>, Vec<LightBounds>) = at_points.unzip();
        let emitters: Vec<LightBounds> = lights.surfaces.bounds.iter().copied().chain(bounds).collect();
        let panes = if lights.sky.is_some() { panes(ready) } else { Vec::new() };
        let far = [lights.sky.is_some(), !lights.distant.is_empty()];
        Fixtures::new(scene, &emitters, &panes, &lights.surfaces.part_of_patch, &numbers, far)
    }
}

/// The panes of a scene, in the order of its parts. The result depends only on the scene, not on the number of threads.
fn panes(ready: &RenderScene<'_>) -> Vec<Pane> {
    let scene = ready.scene;
    let is_glass = |part: &Part| scene.materials[part.material as usize].bsdf.transmits() && !emits(scene, part);
    let of_part = |number: usize| {
        let part = &scene.parts[number];
        if is_glass(part) { pane(ready, number as PartId, part) } else { None }
    };
    enfilade_parallel::flat_map_up_to(scene.parts.len(), of_part)
}

/// The pane that a part is, if the sky shines through it with no other pane beyond: glass within a room is none.
fn pane(ready: &RenderScene<'_>, number: PartId, part: &Part) -> Option<Pane> {
    let scene = ready.scene;
    let bounds = Bounds3::from_points(scene.world_positions(part));
    let mut sides = bounds.extent().to_array();
    sides.sort_by(f32::total_cmp);
    if sides[1] < MIN_SIDE_M {
        return None;
    }
    let corners: Vec<Vec3> = scene.world_positions(part).collect();
    let triangles = &scene.meshes[part.mesh as usize].triangles;
    let normal_of = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| corners[i as usize]);
        (b - a).cross(c - a)
    };
    let areas: Vec<f32> = triangles.iter().map(|triangle| 0.5 * normal_of(triangle).length()).collect();
    let by_area = Distribution1::new(&areas)?;

    let mut rng = Rng::new(hash_u64(0x9a_7e5 ^ (u64::from(number) << 32)));
    let mut found = 0;
    for _ in 0..RAYS {
        let (chosen, _, _) = by_area.sample(rng.next_f32());
        let [a, b, c] = triangles[chosen].map(|i| corners[i as usize]);
        let weights = warp::triangle([rng.next_f32(), rng.next_f32()]);
        let at = a + (b - a) * weights.x + (c - a) * weights.y;
        let Some(normal) = normal_of(&triangles[chosen]).try_normalize() else { continue };
        let toward = warp::cosine_hemisphere([rng.next_f32(), rng.next_f32()]);
        let direction = Onb::from_z(if rng.next_f32() < 0.5 { normal } else { -normal }).to_world(toward);
        let (through, outermost) = ready.transmittance_and_pane(&Ray::new(at - direction * BEFORE_M, direction), Some);
        found += u32::from(!through.is_black() && outermost == Some(number));
    }
    (found >= MIN_FOUND).then(|| Pane { part: number, bounds, area_m2: by_area.total() as f32 })
}

//! How much light from where falls on the surfaces of a room, directly: by it the units of its file get a meaning.
//!
//! Points are drawn on surfaces that face upward and have something above them, evenly by area; rays from each, in proportion to the
//! cosine, and to every light without a surface. Light through clear panes counts, light that bounces does not.

use crate::sources::Glowing;
use enfilade_geometry::Bvh;
use enfilade_math::{Ray, Rgb, Rng, Vec2, Vec3, offset_origin, warp};
use enfilade_scene::{Environment, Light, Scene, WorldMesh, uv_from_direction};
use std::f32::consts::PI;

/// Points, and rays from each.
const POINTS: usize = 256;
const RAYS: u32 = 32;
/// Least height of what is above a point, metres: more than a table is above the floor.
const ABOVE_M: f32 = 0.3;
/// Seed of the points: the same room is always surveyed alike.
const SEED: u64 = 0x5ee;

/// Mean luminance of the irradiance of a room's surfaces, in the units of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Survey {
    /// By the surroundings, the sun, and surfaces in place of daylight.
    pub daylight: f32,
    /// By lamps.
    pub lamps: f32,
    /// Share of the rays that leave the scene.
    pub open_share: f32,
    /// Level direction out of the openings that most rays leave by; `None` where none does.
    pub outward: Option<Vec2>,
}

impl Survey {
    /// Surveys a scene.
    pub fn of(scene: &Scene, glow: &[Glowing]) -> Self {
        let world = WorldMesh::new(scene);
        let bvh = Bvh::new(&world.corners, &|_| false);
        let room = Room { scene, world: &world, bvh: &bvh, kinds: glow };
        let mut rng = Rng::new(SEED);
        let points = room.points(&mut rng);
        let (mut sum, mut out) = (Self::default(), Vec2::ZERO);
        for &(p, n) in &points {
            room.gather(p, n, &mut rng, &mut sum, &mut out);
        }
        let count = points.len().max(1) as f32;
        let rays = count * RAYS as f32;
        Self {
            daylight: sum.daylight / count,
            lamps: sum.lamps / count,
            open_share: sum.open_share / rays,
            outward: (out.length() > 1e-3 * rays).then(|| out.normalize()),
        }
    }
}

struct Room<'a> {
    scene: &'a Scene,
    world: &'a WorldMesh,
    bvh: &'a Bvh,
    kinds: &'a [Glowing],
}

impl Room<'_> {
    /// The first surface along a ray that is no clear pane.
    fn closest(&self, ray: &Ray) -> Option<enfilade_geometry::Hit> {
        self.bvh.closest_filtered(ray, |hit| {
            let part = self.world.sources[hit.triangle as usize].part;
            !self.scene.materials[self.scene.parts[part as usize].material as usize].bsdf.transmits()
        })
    }

    /// Points and normals; all that face upward where nothing is above any.
    fn points(&self, rng: &mut Rng) -> Vec<(Vec3, Vec3)> {
        let mut ends = Vec::new();
        let mut area = 0.0f64;
        for (index, [a, b, c]) in self.world.corners.iter().enumerate() {
            let n = (*b - *a).cross(*c - *a);
            if n.z.abs() > 0.9 * n.length() && n.length() > 0.0 {
                area += f64::from(n.length());
                ends.push((area, index));
            }
        }
        let (mut covered, mut all) = (Vec::new(), Vec::new());
        if ends.is_empty() {
            return all;
        }
        for _ in 0..8 * POINTS {
            let at = rng.next_f64() * area;
            let (_, index) = ends[ends.partition_point(|(end, _)| *end <= at).min(ends.len() - 1)];
            let (mut u, mut v) = (rng.next_f32(), rng.next_f32());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = self.world.corners[index];
            let p = offset_origin(a + u * (b - a) + v * (c - a), Vec3::Z);
            let is_below = self.closest(&Ray::new(p, Vec3::Z)).is_some_and(|hit| hit.t > ABOVE_M);
            if all.len() < POINTS {
                all.push((p, Vec3::Z));
            }
            if is_below {
                covered.push((p, Vec3::Z));
            }
            if covered.len() == POINTS {
                break;
            }
        }
        if covered.is_empty() { all } else { covered }
    }

    /// Adds the light that falls on a point.
    fn gather(&self, p: Vec3, n: Vec3, rng: &mut Rng, sum: &mut Survey, out: &mut Vec2) {
        let turn = rng.next_f32();
        for k in 0..RAYS {
            let [x, y] = warp::hammersley(k, RAYS);
            let d = warp::cosine_hemisphere([(x + turn).fract(), y]);
            let weight = PI / RAYS as f32;
            let Some(hit) = self.closest(&Ray::new(p, d)) else {
                sum.open_share += 1.0;
                *out += d.truncate();
                sum.daylight += weight * self.surroundings(d).luminance();
                continue;
            };
            let part = self.world.sources[hit.triangle as usize].part;
            let emission = self.scene.materials[self.scene.parts[part as usize].material as usize].emission.factor.luminance();
            match self.kinds[part as usize] {
                Glowing::Daylight => sum.daylight += weight * emission,
                Glowing::Lamp => sum.lamps += weight * emission,
                Glowing::No | Glowing::Other => {}
            }
        }
        for light in &self.scene.lights {
            let (to, t_max, irradiance) = match light {
                Light::Directional { direction, irradiance, .. } => (-*direction, f32::INFINITY, irradiance.luminance()),
                Light::Point { position, intensity, .. }
                | Light::Spot { position, intensity, .. }
                | Light::Profile { position, intensity, .. } => {
                    let to = *position - p;
                    (to.normalize_or_zero(), to.length(), intensity.luminance() / to.length_squared().max(1e-4))
                }
            };
            let arrives = irradiance * to.dot(n).max(0.0);
            if arrives > 0.0 && self.closest(&Ray { t_max, ..Ray::new(p, to) }).is_none() {
                *(if t_max.is_infinite() { &mut sum.daylight } else { &mut sum.lamps }) += arrives;
            }
        }
    }

    /// Radiance of the surroundings.
    fn surroundings(&self, d: Vec3) -> Rgb {
        match &self.scene.environment {
            None => Rgb::BLACK,
            Some(Environment::Constant { radiance }) => *radiance,
            Some(Environment::Map { image, rows, scale, map_from_world }) => {
                let (image, uv) = (&self.scene.images[*image as usize], uv_from_direction(*map_from_world * d));
                let texel = |share: f32, count: u32| ((share * count as f32) as usize).min(count as usize - 1);
                image.texel(texel(uv.x, image.width), texel(rows.place(uv.y, image.height), image.height)).0 * *scale
            }
        }
    }
}

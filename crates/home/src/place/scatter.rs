//! Scatters small things over the surfaces of larger ones, at random places that do not overlap.

use enfilade_furniture::{Furniture, Surface, on};
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};

/// Distance between small things, metres.
const AIR: f32 = 0.012;
/// Random places that are tried for each thing.
const TRIES: usize = 24;

/// Puts `things` on the surfaces of something in `pose`, each where there is still room; those that find none are left out. Returns the
/// indices of the things and their poses, in order.
pub fn scatter(surfaces: &[Surface], pose: DAffine3, things: &[Box<dyn Furniture>], rng: &mut Rng) -> Vec<(usize, DAffine3)> {
    let mut taken: Vec<(usize, Vec2, f32)> = Vec::new();
    let mut placed = Vec::new();
    for (index, thing) in things.iter().enumerate() {
        let size = thing.size();
        let turn = rng.range(-0.5, 0.5);
        // Between things their bounding circles count; at the edges of the support, their actual extents.
        let radius = 0.5 * size.truncate().length();
        let (sin, cos) = turn.abs().sin_cos();
        let reach = 0.5 * Vec2::new(cos * size.x + sin * size.y, sin * size.x + cos * size.y);
        let tries = (0..TRIES).filter_map(|_| {
            let k = rng.below(surfaces.len().max(1));
            let surface = surfaces.get(k)?;
            let half = 0.5 * (surface.max - surface.min) - reach;
            if half.min_element() < 0.0 || size.z > surface.headroom {
                return None;
            }
            let at = 0.5 * (surface.min + surface.max) + half * Vec2::new(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0));
            Some((k, at))
        });
        let free = |&(k, at): &(usize, Vec2)| taken.iter().all(|&(other, p, r)| other != k || p.distance(at) > r + radius + AIR);
        let found: Vec<(usize, Vec2)> = tries.filter(free).collect();
        if let Some(&(k, at)) = found.first() {
            taken.push((k, at, radius));
            placed.push((index, on(pose, Vec3::new(at.x, at.y, surfaces[k].z), turn)));
        }
    }
    placed
}

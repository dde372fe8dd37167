//! Heights of the rooms of a scene, for any unit.

use super::names::Named;
use crate::intake::seen::Look;
use enfilade_math::{Bounds3, DVec3, Onb, Ray, Vec3, quantile};
use enfilade_parallel::map_up_to;
use enfilade_scene::{Alpha, CEILING, FLOOR, PartId, Scene, is_stuff};
use std::f32::consts::TAU;

/// Plumb lines along each side of the scene, and surfaces looked through along one.
const LINES: usize = 40;
const MAX_SURFACES: usize = 48;
/// Least cosine between the normal of a floor or ceiling and the plumb line.
const LEVEL: f32 = 0.9;
/// Level directions in which walls are looked for, and how many of them have to meet one.
const AROUND: usize = 16;
const WALLED: usize = 12;
/// Least share of the lines that a room has to be on.
const LEAST_SHARE: f64 = 0.04;
/// Least share of named floors that has a room over it, and of a room's heights that named walls, floors or ceilings bound.
const OVER_FLOOR: f64 = 0.3;
const BUILT: f64 = 0.5;
/// Quantile of the free heights within walls that is taken for the room's: furniture below or above makes most smaller.
const MOSTLY: f64 = 0.8;

/// Heights of rooms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Height {
    pub height_m: f64,
    /// Whether it is known to be a room's: floor and ceiling are named so, or a camera of the file is in it.
    pub is_sure: bool,
}

/// A free height between two level surfaces.
struct Gap {
    height_m: f64,
    is_on_floor: bool,
    is_under_ceiling: bool,
    /// Whether walls are around it and something opaque is above: people do not stand in glass.
    is_walled: bool,
    /// Whether what bounds it is named as part of a building.
    is_built: bool,
}

/// The height of rooms: from what is called floor to what is called ceiling, or else within walls.
pub(super) fn height(scene: &Scene, look: &Look, named: &Named, up: DVec3) -> Option<Height> {
    if named.of_file.is_some_and(|class| !is_stuff(class)) {
        return None;
    }
    let bounds = look.bounds_of_building();
    let lines = map_up_to(LINES * LINES, |k| gaps(scene, look, named, &bounds, up.as_vec3(), [k / LINES, k % LINES]));
    let over_floor = lines.iter().filter(|(_, meets_floor)| *meets_floor).count();
    let gaps: Vec<Gap> = lines.into_iter().flat_map(|(gaps, _)| gaps).collect();
    let of = |holds: &dyn Fn(&Gap) -> bool| gaps.iter().filter(|gap| holds(gap)).map(|gap| gap.height_m).collect::<Vec<f64>>();
    let enough = |heights: &Vec<f64>| heights.len() as f64 >= LEAST_SHARE * (LINES * LINES) as f64;
    let between = of(&|gap| gap.is_on_floor && gap.is_under_ceiling);
    if let Some(mut between) = Some(between).filter(enough) {
        return quantile(&mut between, 0.5).map(|height_m| Height { height_m, is_sure: true });
    }
    let mut walled = Some(of(&|gap| gap.is_walled)).filter(enough)?;
    // A closed box on a floor is no room, unless it takes up much of it.
    if (walled.len() as f64) < OVER_FLOOR * over_floor as f64 {
        return None;
    }
    let built = of(&|gap| gap.is_walled && gap.is_built).len();
    let is_built = named.is_building() && built as f64 >= BUILT * walled.len() as f64;
    let height_m = quantile(&mut walled, MOSTLY)?;
    let stands = |p: DVec3| is_walled(look, p.as_vec3(), up.as_vec3()) && covers(look, p.as_vec3(), up.as_vec3());
    let is_sure = is_built || scene.cameras.iter().any(|camera| camera.position.is_finite() && stands(camera.position));
    Some(Height { height_m, is_sure })
}

/// The free heights along one plumb line, and whether it meets what is named floor.
fn gaps(scene: &Scene, look: &Look, named: &Named, bounds: &Bounds3, up: Vec3, line: [usize; 2]) -> (Vec<Gap>, bool) {
    let mut meets_floor = false;
    let mut found = Vec::new();
    let (low, size) = (bounds.min, bounds.extent());
    let onb = Onb::from_z(up);
    let along = |axis: Vec3, i: usize| axis.abs() * ((low + size * ((i as f32 + 0.5) / LINES as f32)).dot(axis.abs()));
    let top = up.abs() * (0.5 * (2.0 * low + size)).dot(up.abs()) + up * (0.6 * size.dot(up.abs()));
    let mut from = along(onb.x, line[0]) + along(onb.y, line[1]) + top;
    let step = 1e-4 * size.dot(up.abs());
    let mut above: Option<(Vec3, Option<i16>, PartId)> = None;
    for _ in 0..MAX_SURFACES {
        let Some(hit) = look.bvh.closest(&Ray::new(from, -up)) else { break };
        let at = from - up * hit.t;
        let [a, b, c] = look.world.corners[hit.triangle as usize];
        let is_level = (b - a).cross(c - a).normalize_or_zero().dot(up).abs() >= LEVEL;
        let part = look.world.sources[hit.triangle as usize].part;
        let class = named.classes[part as usize];
        meets_floor |= class == Some(FLOOR);
        if let Some((ceiling, upper, over)) = above.filter(|_| is_level) {
            let height = (ceiling - at).dot(up);
            // A known thing with a hollow is not a room.
            let may_be_room = upper.is_none_or(is_stuff) && height > 0.1 * size.dot(up.abs());
            let is_walled = may_be_room && is_opaque(scene, over) && is_walled(look, 0.5 * (ceiling + at), up);
            let (is_on_floor, is_under_ceiling) = (class == Some(FLOOR), upper == Some(CEILING));
            let is_built = [class, upper].into_iter().flatten().any(is_stuff);
            found.push(Gap { height_m: f64::from(height), is_on_floor, is_under_ceiling, is_walled, is_built });
        }
        above = is_level.then_some((at, class, part));
        from = at - up * step;
    }
    (found, meets_floor)
}

fn is_opaque(scene: &Scene, part: PartId) -> bool {
    let material = &scene.materials[scene.parts[part as usize].material as usize];
    material.alpha == Alpha::Opaque && !material.bsdf.transmits()
}

fn is_walled(look: &Look, p: Vec3, up: Vec3) -> bool {
    let onb = Onb::from_z(up);
    let meets = |k: &usize| {
        let (sin, cos) = (TAU * (*k as f32 + 0.5) / AROUND as f32).sin_cos();
        look.bvh.occluded(&Ray::new(p, onb.x * cos + onb.y * sin))
    };
    (0..AROUND).filter(meets).count() >= WALLED
}

/// Whether something is above a point, and something below.
fn covers(look: &Look, p: Vec3, up: Vec3) -> bool {
    look.bvh.occluded(&Ray::new(p, up)) && look.bvh.occluded(&Ray::new(p, -up))
}

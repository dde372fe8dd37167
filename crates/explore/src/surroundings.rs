//! The surroundings of a point of a scene: how much of them leads out of the building, and how much is closed in.

use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Ray, warp};
use enfilade_parallel::flat_map;
use enfilade_scene::{PartId, WorldMesh};
use std::f64::consts::TAU;

/// The back of a part counts only when at most this share of the rays that meet it from around the starts meets its back: others are
/// thin things with two sides, or were modelled inside out.
const MOSTLY_FRONT: f64 = 0.25;

/// Places around a start from which the parts' sides are looked at, rays from each, and how far away the places are at most.
const PLACES: usize = 32;
const RAYS: usize = 1024;
const PLACE_DISTANCE_M: f64 = 4.0;

/// Level directions around a point.
const LEVEL: usize = 72;

/// Directions all around it, of which those with a greater sine above the horizon than this are upward.
const UPWARD: usize = 128;
const UPWARD_SINE: f64 = 0.4;

/// Number of directions around a closed-in point in which the surfaces that close it in are sought.
const AROUND: usize = 256;

/// A scene seen from points in it. Every surface is solid.
pub struct Surroundings<'a> {
    world: &'a WorldMesh,
    bvh: &'a Bvh,
    /// By part: true if seeing its back is a sign of being on the wrong side of it.
    has_front: Vec<bool>,
}

/// The surface point at which a ray ended.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub p_world: DVec3,
    pub distance_m: f64,
    pub part: PartId,
    /// Unit length, on the side that counter-clockwise corners face.
    pub normal: DVec3,
    /// The ray met the back.
    pub behind: bool,
}

/// The surface point at which the ray along a unit direction ends.
pub(crate) fn meet(world: &WorldMesh, bvh: &Bvh, origin: DVec3, direction: DVec3) -> Option<SurfacePoint> {
    let hit = bvh.closest(&Ray::new(origin.as_vec3(), direction.as_vec3()))?;
    let [a, b, c] = world.corners[hit.triangle as usize].map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or_zero();
    Some(SurfacePoint {
        p_world: origin + f64::from(hit.t) * direction,
        distance_m: f64::from(hit.t),
        part: world.sources[hit.triangle as usize].part,
        normal,
        behind: normal.dot(direction) > 0.0,
    })
}

impl<'a> Surroundings<'a> {
    /// The surroundings in a scene whose `starts` (positions of cameras) are taken to be on the right side of things.
    pub fn new(world: &'a WorldMesh, bvh: &'a Bvh, starts: &[DVec3]) -> Self {
        Self { world, bvh, has_front: fronts(world, bvh, starts) }
    }

    /// By part, whether seeing its back is a sign of being on the wrong side of it: the starts and the places around them see (nearly)
    /// nothing but its front.
    pub fn has_front(&self) -> &[bool] {
        &self.has_front
    }

    pub(crate) fn meet(&self, origin: DVec3, direction: DVec3) -> Option<SurfacePoint> {
        meet(self.world, self.bvh, origin, direction)
    }

    pub(crate) fn is_wrong_side(&self, point: &SurfacePoint) -> bool {
        point.behind && self.has_front[point.part as usize]
    }

    /// Shares of the level and of the upward directions around a point in which there is no surface, or only the back of one whose front is
    /// what one sees from around the starts.
    pub fn open_shares(&self, p: DVec3) -> [f64; 2] {
        let leads_out = |direction: DVec3| self.meet(p, direction).is_none_or(|point| self.is_wrong_side(&point));
        let level = |k: usize| {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / LEVEL as f64).sin_cos();
            leads_out(DVec3::new(cos, sin, 0.0))
        };
        let upward = || (0..UPWARD).map(|k| warp::fibonacci_sphere(k, UPWARD)).filter(|d| d.z > UPWARD_SINE);
        let level = (0..LEVEL).filter(|k| level(*k)).count() as f64 / LEVEL as f64;
        [level, upward().filter(|d| leads_out(*d)).count() as f64 / upward().count() as f64]
    }

    /// Share of all directions around a point in which there is a surface nearer than `near_m`, or the back of one whose front is what one
    /// sees from around the starts: next to all of them within a thing, and few in a room.
    pub fn enclosed_share(&self, p: DVec3, near_m: f64) -> f64 {
        let closes = |point: &SurfacePoint| point.distance_m < near_m || self.is_wrong_side(point);
        let met = (0..AROUND).filter_map(|k| self.meet(p, warp::fibonacci_sphere(k, AROUND)));
        met.filter(closes).count() as f64 / AROUND as f64
    }
}

/// Whether, by part, the starts and the places that they see around them see (nearly) nothing but its front.
fn fronts(world: &WorldMesh, bvh: &Bvh, starts: &[DVec3]) -> Vec<bool> {
    let around = |start: &DVec3| {
        let places = (0..PLACES).map(|k| {
            let direction = warp::fibonacci_sphere(k, PLACES);
            let free = meet(world, bvh, *start, direction).map_or(PLACE_DISTANCE_M, |point| point.distance_m.min(PLACE_DISTANCE_M));
            // Points spread over the way to the surface, without its ends.
            start + direction * free * (0.1 + 0.8 * ((k * 5) % PLACES) as f64 / PLACES as f64)
        });
        std::iter::once(*start).chain(places).collect::<Vec<DVec3>>()
    };
    let places: Vec<DVec3> = starts.iter().flat_map(around).collect();
    let met: Vec<SurfacePoint> =
        flat_map(&places, |&p| (0..RAYS).filter_map(move |k| meet(world, bvh, p, warp::fibonacci_sphere(k, RAYS))));
    let parts = world.sources.iter().map(|source| source.part as usize + 1).max().unwrap_or(0);
    let (mut all, mut behind) = (vec![0u32; parts], vec![0u32; parts]);
    for point in met {
        all[point.part as usize] += 1;
        behind[point.part as usize] += u32::from(point.behind);
    }
    all.iter().zip(&behind).map(|(all, behind)| *all > 0 && f64::from(*behind) <= MOSTLY_FRONT * f64::from(*all)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testroom::{Room, cuboid};

    const START: DVec3 = DVec3::new(3.0, 2.5, 1.5);

    /// A room with a cupboard and a wardrobe of boards 2 cm thick, whose door is closed.
    fn room() -> Room {
        let mut corners = cuboid(DVec3::ZERO, DVec3::new(6.0, 5.0, 2.6), true);
        corners.extend(cuboid(DVec3::new(0.1, 0.1, 0.0), DVec3::new(0.7, 1.1, 2.0), false));
        let (low, high) = (DVec3::new(0.1, 4.0, 0.0), DVec3::new(0.7, 4.5, 2.0));
        for axis in 0..3 {
            let (mut a, mut b) = (high, low);
            a[axis] = low[axis] + 0.02;
            b[axis] = high[axis] - 0.02;
            corners.extend(cuboid(low, a, false));
            corners.extend(cuboid(b, high, false));
        }
        Room::from_corners(corners)
    }

    #[test]
    fn a_point_within_a_thing_is_closed_in_and_one_in_a_corner_is_not() {
        let room = room();
        let around = Surroundings::new(&room.world, &room.bvh, &[START]);
        let cupboard = around.enclosed_share(DVec3::new(0.4, 0.6, 1.0), 0.5);
        assert!(cupboard > 0.9, "{cupboard}");
        let wardrobe = around.enclosed_share(DVec3::new(0.4, 4.25, 1.0), 0.5);
        assert!(wardrobe > 0.8, "{wardrobe}");
        for p in [START, DVec3::new(5.8, 4.8, 0.2), DVec3::new(5.95, 2.0, 1.0)] {
            let share = around.enclosed_share(p, 0.5);
            assert!(share < 0.7, "{share} at {p}");
        }
    }

    #[test]
    fn a_point_outside_stands_in_the_open() {
        let room = room();
        let around = Surroundings::new(&room.world, &room.bvh, &[START]);
        assert_eq!(around.open_shares(START), [0.0, 0.0]);
        let [level, upward] = around.open_shares(DVec3::new(8.0, 2.0, 1.0));
        assert_eq!((level, upward), (1.0, 1.0));
    }
}

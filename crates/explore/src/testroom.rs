//! Analytic rooms for the tests of this crate.

use enfilade_geometry::Bvh;
use enfilade_math::{Bounds3, DVec3, Vec3};
use enfilade_scene::{TriangleSource, WorldMesh};

pub(crate) struct Room {
    pub world: WorldMesh,
    pub bvh: Bvh,
}

impl Room {
    /// A closed box whose faces look inward; no thickness.
    pub fn new(min: DVec3, max: DVec3) -> Self {
        Self::from_corners(cuboid(min, max, true))
    }

    /// A closed box with walls of `thickness_m` around the given interior; all faces look out of the solid walls.
    pub fn with_walls(min: DVec3, max: DVec3, thickness_m: f64) -> Self {
        let t = DVec3::splat(thickness_m);
        Self::from_corners([cuboid(min, max, true), cuboid(min - t, max + t, false)].concat())
    }

    pub fn from_corners(corners: Vec<[Vec3; 3]>) -> Self {
        let sources = (0..corners.len() as u32).map(|triangle| TriangleSource { part: 0, triangle }).collect();
        let bounds = Bounds3::from_points(corners.iter().flatten().copied());
        let bvh = Bvh::new(&corners, &|_| false);
        Self { world: WorldMesh { corners, sources, bounds, contrasts: vec![0.0] }, bvh }
    }

    /// Each list of triangles is one part.
    pub fn from_parts(parts: Vec<Vec<[Vec3; 3]>>) -> Self {
        let part = |(part, corners): (usize, &Vec<[Vec3; 3]>)| vec![part as u32; corners.len()];
        let of: Vec<u32> = parts.iter().enumerate().flat_map(part).collect();
        let mut room = Self::from_corners(parts.concat());
        room.world.contrasts = vec![0.0; parts.len()];
        room.world.sources.iter_mut().zip(of).for_each(|(source, part)| source.part = part);
        room
    }

    pub fn remove_ceiling(&mut self) {
        let top = self.world.bounds.max.z;
        let corners = self.world.corners.iter().copied().filter(|t| t.iter().any(|p| p.z < top)).collect();
        *self = Self::from_corners(corners);
    }

    /// Beyond the slanted plane of [`house_with_thin_wall`].
    pub fn beyond_wall(&self, p: DVec3) -> bool {
        p.x > 2.0 + 0.13 * p.y + 0.08
    }

    /// Distance from `p` to the nearest surface, by brute force.
    pub fn distance_m(&self, p: DVec3) -> f64 {
        self.world.corners.iter().map(|t| distance_to_triangle(p, t.map(|c| c.as_dvec3()))).fold(f64::INFINITY, f64::min)
    }
}

/// A closed box that one slanted wall without thickness divides in two.
pub(crate) fn house_with_thin_wall() -> Room {
    let (min, max) = (DVec3::splat(-0.03), DVec3::new(4.93, 2.93, 2.43));
    let wall = |y: f64, z: f64| Vec3::new((2.0 + 0.13 * y) as f32, y as f32, z as f32);
    let [a, b, c, d] = [wall(min.y, min.z), wall(max.y, min.z), wall(max.y, max.z), wall(min.y, max.z)];
    let mut corners = cuboid(min, max, true);
    corners.extend([[a, b, c], [a, c, d]]);
    Room::from_corners(corners)
}

/// A room with a few boxes to look at, and many small triangles on one of them.
pub(crate) fn furnished_room() -> Room {
    let mut corners = cuboid(DVec3::new(-0.03, -0.03, -0.03), DVec3::new(5.93, 4.93, 2.63), true);
    corners.extend(cuboid(DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.2, 1.6, 0.8), false));
    corners.extend(cuboid(DVec3::new(4.5, 3.0, 0.0), DVec3::new(5.2, 4.6, 1.9), false));
    for k in 0..400 {
        let (x, z) = (f64::from(k % 20) * 0.04, f64::from(k / 20) * 0.04);
        corners.extend(cuboid(DVec3::new(2.5 + x, 4.6, 0.5 + z), DVec3::new(2.53 + x, 4.65, 0.53 + z), false));
    }
    Room::from_corners(corners)
}

pub(crate) fn cuboid(min: DVec3, max: DVec3, inward: bool) -> Vec<[Vec3; 3]> {
    let corner = |i: usize| {
        let pick = |axis: usize| if (i >> axis) & 1 == 1 { max[axis] } else { min[axis] };
        DVec3::new(pick(0), pick(1), pick(2)).as_vec3()
    };
    // Counter-clockwise seen from outside.
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    triangles.map(|t| if inward { [t[2], t[1], t[0]] } else { t }.map(corner)).collect()
}

/// Ericson, "Real-Time Collision Detection", section 5.1.5, by the nearest of the plane's foot point and the three edges.
fn distance_to_triangle(p: DVec3, t: [DVec3; 3]) -> f64 {
    let edge = |a: DVec3, b: DVec3| {
        let s = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a + s * (b - a))
    };
    let n = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
    let foot = p - n * n.dot(p - t[0]);
    let inside = (0..3).all(|i| (t[(i + 1) % 3] - t[i]).cross(foot - t[i]).dot(n) >= 0.0);
    let edges = edge(t[0], t[1]).min(edge(t[1], t[2])).min(edge(t[2], t[0]));
    if inside { edges.min(p.distance(foot)) } else { edges }
}

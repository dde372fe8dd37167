//! A coarse look at a view: where a few hundred of its rays end. That is enough to find views that are not worth taking, and how much of
//! a view was in another one.

use super::rules::Rules;
use crate::surroundings::{SurfacePoint, meet};
use enfilade_geometry::Bvh;
use enfilade_math::{DVec3, Ray};
use enfilade_scene::{Intrinsics, Pose, WorldMesh};

/// Rays along a row; rows follow from the shape of the test images.
const COLUMNS: u32 = 32;

/// A surface point counts as seen when the ray to it is free up to this share of its length.
const REACH: f64 = 0.998;

/// Points are of one plane when their normals differ by less than this (cosine) and their offsets by less than this, metres.
const SAME_NORMAL: f64 = 0.9995;
const SAME_OFFSET_M: f64 = 0.01;

/// The camera of coarse looks.
pub(super) struct Glancer<'a> {
    rules: &'a Rules<'a>,
    world: &'a WorldMesh,
    pinhole: Intrinsics,
    /// Camera space, unit length.
    directions: Vec<DVec3>,
}

/// The surface points of one coarse look.
pub(super) struct Glance {
    /// Rays cast.
    pub rays: usize,
    /// Surface points.
    pub points: Vec<SurfacePoint>,
}

impl<'a> Glancer<'a> {
    pub fn new(rules: &'a Rules<'a>, world: &'a WorldMesh) -> Self {
        let config = rules.config;
        let rows = (f64::from(COLUMNS) * f64::from(config.test_height) / f64::from(config.test_width)).round().clamp(1.0, 4096.0);
        let pinhole = Intrinsics::from_fov_x(COLUMNS, rows as u32, config.fov_x_rad);
        let direction = |x: u32, y: u32| pinhole.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).normalize();
        let directions = (0..pinhole.height).flat_map(|y| (0..COLUMNS).map(move |x| direction(x, y))).collect();
        Self { rules, world, pinhole, directions }
    }

    pub fn look(&self, pose: &Pose) -> Glance {
        let rays = self.directions.iter().map(|d| pose.world_from_camera * *d);
        Glance { rays: self.directions.len(), points: rays.filter_map(|d| self.meet(pose.position, d)).collect() }
    }

    /// The surface point at which the ray along a unit direction ends.
    pub fn meet(&self, origin: DVec3, direction: DVec3) -> Option<SurfacePoint> {
        meet(self.world, self.rules.bvh, origin, direction)
    }

    pub fn bvh(&self) -> &'a Bvh {
        self.rules.bvh
    }

    /// Whether a point of a surface is in the picture of a pose, and nothing before it.
    pub fn sees(&self, pose: &Pose, p_world: DVec3) -> bool {
        self.frames(pose, p_world) && self.reaches(pose.position, p_world)
    }

    /// Whether a point is within the borders of the picture.
    pub fn frames(&self, pose: &Pose, p_world: DVec3) -> bool {
        let p_camera = pose.world_from_camera.transpose() * (p_world - pose.position);
        if p_camera.z >= 0.0 {
            return false;
        }
        let (x, y) = self.pinhole.project(p_camera);
        (0.0..f64::from(self.pinhole.width)).contains(&x) && (0.0..f64::from(self.pinhole.height)).contains(&y)
    }

    /// Where in the picture of a pose a point before the camera is, as shares of its width and height from the upper left corner, and its
    /// planar depth in metres.
    pub fn placed(&self, pose: &Pose, p_world: DVec3) -> ([f64; 2], f64) {
        let p_camera = pose.world_from_camera.transpose() * (p_world - pose.position);
        let (x, y) = self.pinhole.project(p_camera);
        ([x / f64::from(self.pinhole.width), y / f64::from(self.pinhole.height)], -p_camera.z)
    }

    /// Whether nothing is between a point and a point of a surface.
    pub fn reaches(&self, from: DVec3, p_surface: DVec3) -> bool {
        let Some(direction) = (p_surface - from).try_normalize() else { return true };
        let mut ray = Ray::new(from.as_vec3(), direction.as_vec3());
        ray.t_max = (REACH * from.distance(p_surface)) as f32;
        !self.rules.bvh.occluded(&ray)
    }

    /// Share of the surface points of a view that the pose `before` sees too; `None` for views of nothing.
    pub fn overlap(&self, glance: &Glance, before: &Pose) -> Option<f64> {
        let seen = glance.points.iter().filter(|point| self.sees(before, point.p_world)).count();
        (!glance.points.is_empty()).then(|| seen as f64 / glance.points.len() as f64)
    }
}

impl Glance {
    /// Share of the rays whose end `what` is true for.
    pub fn share(&self, what: impl Fn(&SurfacePoint) -> bool) -> f64 {
        self.points.iter().filter(|point| what(point)).count() as f64 / self.rays as f64
    }

    /// Share of the rays that end on the largest plane of a single part.
    pub fn plane_share(&self) -> f64 {
        let mut rest: Vec<&SurfacePoint> = self.points.iter().collect();
        let mut largest = 0;
        while let Some(&of) = rest.first().filter(|_| rest.len() > largest) {
            let before = rest.len();
            rest.retain(|point| !are_coplanar(of, point));
            // A point without a normal is on no plane, not even its own.
            largest = largest.max(before - rest.len());
            if before == rest.len() {
                rest.remove(0);
            }
        }
        largest as f64 / self.rays as f64
    }
}

fn are_coplanar(a: &SurfacePoint, b: &SurfacePoint) -> bool {
    let offset = (a.p_world - b.p_world).dot(a.normal).abs();
    a.part == b.part && a.normal.dot(b.normal).abs() > SAME_NORMAL && offset < SAME_OFFSET_M
}

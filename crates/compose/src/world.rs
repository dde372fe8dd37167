//! The simulation: the parts of a scene do not move, objects do.
//!
//! Time steps are 1/240 s. Friction is 0.6, nothing bounces, and turning is damped, so that round things come to rest as they do on cloth
//! or wood.

use crate::shapes::{ours, placement, point, vector};
use crate::solid::Moments;
use enfilade_math::{DAffine3, DVec3, Vec3};
use enfilade_scene::{PartId, Scene};
use rapier3d_f64::dynamics::{FrictionModel, RigidBodyBuilder, RigidBodyHandle};
use rapier3d_f64::geometry::ColliderBuilder;
use rapier3d_f64::math::{Pose3, Vector};
use rapier3d_f64::parry::bounding_volume::{Aabb, BoundingVolume};
use rapier3d_f64::parry::query::{self, Ray};
use rapier3d_f64::parry::shape::SharedShape;
use rapier3d_f64::pipeline::PhysicsWorld;
use std::collections::BTreeSet;

/// The library that simulates, for the record.
pub const SOLVER: &str = "rapier3d 0.36";
/// Steps per second.
const STEPS: f64 = 240.0;
/// Tolerances of the simulation are for things of about this size, metres.
const LENGTH_UNIT_M: f64 = 0.1;
/// Natural frequency of contacts between objects, Hz; to the scene twice as much. The stiffer, the less things sink into each other, and
/// the longer they tremble.
const STIFFNESS_HZ: f64 = 45.0;
/// Coefficient of friction of everything.
pub const FRICTION: f64 = 0.6;
/// Mass of objects, kg/m³: that of wood.
const DENSITY: f64 = 600.0;
/// Below these speeds something is at rest, m/s and rad/s.
const STILL: [f64; 2] = [0.003, 0.06];
/// It is at rest after being still this long, steps.
const STILL_STEPS: u32 = 48;
/// Surfaces nearer than this touch, metres.
const TOUCH_M: f64 = 0.002;
/// Cosine between the vertical and the direction in which a thing below carries one above.
const CARRIES_COS: f64 = 0.3;

/// A part of the scene, or a piece of it near the surfaces that are used.
#[derive(Clone)]
struct Still {
    part: PartId,
    shape: SharedShape,
    bounds: Aabb,
}

/// An object.
struct Body {
    handle: RigidBodyHandle,
    shape: SharedShape,
}

/// What an object touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Neighbour {
    /// A part of the scene.
    Part(PartId),
    /// Another object, by its number.
    Body(usize),
}

/// The simulation.
pub struct World {
    physics: PhysicsWorld,
    still: Vec<Still>,
    bodies: Vec<Body>,
}

impl World {
    /// The triangles of a scene that meet one of the boxes, at rest.
    pub fn new(scene: &Scene, boxes: &[[DVec3; 2]]) -> Self {
        let mut still = Vec::new();
        for (part, id) in scene.parts.iter().zip(0..) {
            let triangles = (0..scene.meshes[part.mesh as usize].triangles.len()).map(|triangle| scene.world_corners(part, triangle));
            let near: Vec<[Vec3; 3]> = triangles.filter(|corners| meets_one(corners, boxes)).collect();
            let Some(shape) = trimesh(&near) else { continue };
            let bounds = shape.compute_local_aabb();
            still.push(Still { part: id, shape, bounds });
        }
        Self::of(still)
    }

    /// Shapes that are at rest, which are of no part.
    pub fn beside(fixed: impl Iterator<Item = SharedShape>) -> Self {
        Self::of(fixed.map(|shape| Still { part: 0, bounds: shape.compute_local_aabb(), shape }).collect())
    }

    /// A simulation that begins with everything where it is, and knows nothing of what was before.
    pub fn renewed(&self) -> Self {
        let mut new = Self::of(self.still.clone());
        for (body, pose) in self.bodies.iter().zip(self.poses()) {
            new.add(body.shape.clone(), pose);
        }
        new
    }

    fn of(still: Vec<Still>) -> Self {
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::new(0.0, 0.0, -9.81);
        let parameters = &mut physics.integration_parameters;
        parameters.dt = 1.0 / STEPS;
        parameters.length_unit = LENGTH_UNIT_M;
        parameters.num_solver_iterations = 8;
        parameters.contact_softness.natural_frequency = STIFFNESS_HZ;
        parameters.static_contact_softness.natural_frequency = 2.0 * STIFFNESS_HZ;
        // With the short cuts that the library takes unless told otherwise, a can creeps by millimetres a second, turning about itself.
        parameters.friction_model = FrictionModel::Coulomb;
        parameters.friction_in_bias_pass = true;
        parameters.contact_recycling = false;
        parameters.contact_clustering = false;
        let ground = physics.insert_body(RigidBodyBuilder::fixed());
        for Still { shape, .. } in &still {
            physics.insert_collider(ColliderBuilder::new(shape.clone()).friction(FRICTION), Some(ground));
        }
        Self { physics, still, bodies: Vec::new() }
    }

    /// Number of objects.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// The first part above a point, and its distance, metres; `None` within `reach`.
    pub fn above(&self, at: DVec3, reach: f64) -> Option<(PartId, f64)> {
        let ray = Ray::new(vector(at), Vector::new(0.0, 0.0, 1.0));
        let column = Aabb::new(vector(at), vector(at + DVec3::Z * reach));
        let near = self.still.iter().filter(|still| still.bounds.intersects(&column));
        let hits = near.filter_map(|still| Some((still.part, still.shape.cast_local_ray(&ray, reach, true)?)));
        hits.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// True where a shape would meet the scene or an object.
    pub fn is_taken(&self, shape: &SharedShape, pose: &Pose3) -> bool {
        let bounds = shape.compute_aabb(pose);
        let meets =
            |other: &SharedShape, at: &Pose3| query::intersection_test(pose, &**shape, at, &**other).is_ok_and(|test| test.intersecting);
        self.still.iter().any(|still| still.bounds.intersects(&bounds) && meets(&still.shape, &Pose3::IDENTITY))
            || self.bodies.iter().any(|body| {
                let at = self.physics.bodies[body.handle].position();
                body.shape.compute_aabb(at).intersects(&bounds) && meets(&body.shape, at)
            })
    }

    /// Adds an object of wood; gives its number.
    pub fn add(&mut self, shape: SharedShape, pose: Pose3) -> usize {
        self.add_weighed(shape, pose, None)
    }

    /// Adds an object with this mass, distributed as the moments say, else one of wood; gives its number.
    pub fn add_weighed(&mut self, shape: SharedShape, pose: Pose3, moments: Option<Moments>) -> usize {
        let body = RigidBodyBuilder::dynamic().pose(pose).linear_damping(0.1).angular_damping(2.0).ccd_enabled(true);
        let collider = ColliderBuilder::new(shape.clone()).friction(FRICTION);
        let collider = match moments {
            Some(moments) => collider.mass_properties(moments.properties()),
            None => collider.density(DENSITY),
        };
        let (handle, _) = self.physics.insert(body, collider);
        self.bodies.push(Body { handle, shape });
        self.bodies.len() - 1
    }

    /// Takes the last object away.
    pub fn remove_last(&mut self) {
        if let Some(body) = self.bodies.pop() {
            self.physics.remove_body(body.handle);
        }
    }

    /// Takes an object away. Those after it get the number before theirs.
    pub fn remove(&mut self, number: usize) {
        let body = self.bodies.remove(number);
        self.physics.remove_body(body.handle);
    }

    /// Poses of all objects.
    pub fn poses(&self) -> Vec<Pose3> {
        self.bodies.iter().map(|body| *self.physics.bodies[body.handle].position()).collect()
    }

    /// Puts objects back, at rest.
    pub fn restore(&mut self, poses: &[Pose3]) {
        for (body, pose) in self.bodies.iter().zip(poses) {
            let body = &mut self.physics.bodies[body.handle];
            if body.position() != pose {
                body.set_position(*pose, false);
            }
            body.set_linvel(Vector::ZERO, false);
            body.set_angvel(Vector::ZERO, false);
            body.sleep();
        }
    }

    /// Where an object is.
    pub fn placement(&self, number: usize) -> DAffine3 {
        placement(self.physics.bodies[self.bodies[number].handle].position())
    }

    /// Lets time pass until everything is at rest, for this long at most; true when it is.
    pub fn settle(&mut self, seconds: f64) -> bool {
        let mut still = 0;
        for _ in 0..(seconds * STEPS) as usize {
            self.physics.step();
            let moves =
                self.physics.active_bodies().any(|(_, body)| body.linvel().length() > STILL[0] || body.angvel().length() > STILL[1]);
            still = if moves { 0 } else { still + 1 };
            if still >= STILL_STEPS {
                return true;
            }
        }
        false
    }

    /// Lets time pass with nothing asleep.
    pub fn run(&mut self, seconds: f64) {
        let thresholds = |world: &mut Self, threshold: f64| {
            for body in &world.bodies {
                world.physics.bodies[body.handle].activation_mut().normalized_linear_threshold = threshold;
            }
        };
        let usual = self.bodies.first().map_or(0.0, |body| self.physics.bodies[body.handle].activation().normalized_linear_threshold);
        thresholds(self, -1.0);
        self.physics.wake_up_all(true);
        (0..(seconds * STEPS) as usize).for_each(|_| self.physics.step());
        thresholds(self, usual);
    }

    /// What carries an object: what it touches, and how steeply from below, the best carrier first.
    pub fn carriers(&self, number: usize) -> Vec<Neighbour> {
        let mut found: Vec<(Neighbour, f64)> = Vec::new();
        self.contacts(number, TOUCH_M, &mut |neighbour, contact| found.push((neighbour, -ours(contact.normal1).z)));
        found.retain(|(_, up)| *up > CARRIES_COS);
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        found.into_iter().map(|(neighbour, _)| neighbour).collect()
    }

    /// How deep an object is in the scene or in another object, metres; 0 where it is in none.
    pub fn depth(&self, number: usize) -> f64 {
        let mut depth: f64 = 0.0;
        self.contacts(number, 0.0, &mut |_, contact| depth = depth.max(-contact.dist));
        depth
    }

    /// Calls `found` with the nearest contact of an object to each part and object within `reach`.
    fn contacts(&self, number: usize, reach: f64, found: &mut dyn FnMut(Neighbour, query::Contact)) {
        let Body { handle, shape } = &self.bodies[number];
        let pose = self.physics.bodies[*handle].position();
        let bounds = shape.compute_aabb(pose).loosened(reach);
        let contact = |other: &SharedShape, at: &Pose3| query::contact(pose, &**shape, at, &**other, reach).ok().flatten();
        for still in self.still.iter().filter(|still| still.bounds.intersects(&bounds)) {
            if let Some(contact) = contact(&still.shape, &Pose3::IDENTITY) {
                found(Neighbour::Part(still.part), contact);
            }
        }
        for (other, body) in self.bodies.iter().enumerate().filter(|(other, _)| *other != number) {
            let at = self.physics.bodies[body.handle].position();
            if body.shape.compute_aabb(at).intersects(&bounds)
                && let Some(contact) = contact(&body.shape, at)
            {
                found(Neighbour::Body(other), contact);
            }
        }
    }

    /// Objects that rest on one of `carried`, or on others that do.
    pub fn supported(&self, carries: &dyn Fn(usize, PartId) -> bool) -> BTreeSet<usize> {
        let carriers: Vec<Vec<Neighbour>> = (0..self.len()).map(|number| self.carriers(number)).collect();
        let mut supported = BTreeSet::new();
        loop {
            let before = supported.len();
            for (number, below) in carriers.iter().enumerate() {
                let holds = |neighbour: &Neighbour| match neighbour {
                    Neighbour::Part(part) => carries(number, *part),
                    Neighbour::Body(other) => supported.contains(other),
                };
                if below.iter().any(holds) {
                    supported.insert(number);
                }
            }
            if supported.len() == before {
                return supported;
            }
        }
    }
}

/// True where a triangle's box meets one of the boxes.
fn meets_one(corners: &[Vec3; 3], boxes: &[[DVec3; 2]]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    boxes.iter().any(|[least, most]| low.cmple(*most).all() && high.cmpge(*least).all())
}

/// Triangles as a shape; `None` without any that has an area.
fn trimesh(triangles: &[[Vec3; 3]]) -> Option<SharedShape> {
    let has_area = |[a, b, c]: &&[Vec3; 3]| (*b - *a).cross(*c - *a).length() > 0.0;
    let points: Vec<Vector> = triangles.iter().filter(has_area).flatten().map(|corner| point(*corner)).collect();
    let indices = (0..points.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    SharedShape::trimesh(points, indices).ok()
}

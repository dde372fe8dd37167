//! Start cameras: the places from which a photographer would take each room.
//!
//! From every free place, rays are cast all around. Their hits tell how much each view shows: the things that the room is for, whole and
//! from their fronts, and nothing in the way. The best views are taken, one after another, each from another place or in another direction.
//! All are level, so that verticals stay vertical (two-point perspective).

use crate::plan::FloorPlan;
use crate::room::{Room, kind};
use enfilade_furniture::{Class, RoomKind};
use enfilade_geometry::Bvh;
use enfilade_math::{Bounds3, DAffine3, DMat3, DVec3, Ray, Vec2, Vec3};
use enfilade_scene::{Labels, Part, Scene, StartCamera, WorldMesh};
use std::collections::BTreeMap;
use std::f32::consts::TAU;

/// Distances that a camera keeps from every part's box, metres; the second where no place has the first.
pub const CLEARANCES: [f32; 2] = [0.4, 0.25];
/// Height of the eye, metres: photographers of interiors stand lower than people look, so that tables and beds are seen whole.
const EYE: f32 = 1.25;
/// Horizontal field of view of a 24 mm lens (74°), and of a 21 mm lens (81°) in small rooms, radians.
const FOV_X_RAD: [f64; 2] = [1.29, 1.41];
/// Rooms with less floor are small, m².
const SMALL: f32 = 8.0;
/// Step of the grid of candidate positions, metres.
const STEP: f32 = 0.3;
/// Width of a view over its height.
const ASPECT: f32 = 4.0 / 3.0;
/// Directions around a place.
const AROUND: usize = 60;
/// Tangent of the lowest ray's elevation. Rays beyond the edges of a view measure how much of a thing is cut off.
const LOWEST: f32 = -1.0;
/// Rays above each other in one direction.
const PITCHES: usize = 14;
/// Step between the tangents of their elevations.
const PITCH_STEP: f32 = 0.125;
/// Things nearer than this are in the way, metres.
const NEAR: f32 = 1.05;
/// Share of a view above which windows spoil it by day, since the brightest tenth of a picture decides how bright all of it is shown.
/// It counts at any hour: the light must not move cameras.
const GLARE: f32 = 0.1;
/// Score of a metre of depth, relative to the score of things.
const SPACE: f32 = 0.35;
/// Share of a view above which a thing counts for no more.
const ENOUGH: f32 = 0.2;

/// Up to four views of each room, named after it: `living_1` is the best of the living room.
pub fn cameras(scene: &Scene, labels: &Labels, plan: &FloorPlan) -> Vec<StartCamera> {
    let world = WorldMesh::new(scene);
    let bvh = Bvh::new(&world.corners, &|_| false);
    let boxes = Obstacle::all(scene, plan);
    let home = Surroundings { scene, labels, world: &world, bvh: &bvh };
    let mut cameras = Vec::new();
    let mut names = BTreeMap::new();
    for room in &plan.rooms {
        let count = kind::row(room.kind).views;
        let fov = FOV_X_RAD[usize::from(room.area < SMALL)];
        let eyes = places(&boxes, room);
        let mut views: Vec<View> = enfilade_parallel::flat_map(&eyes, |&eye| home.look_around(room, eye, fov as f32));
        views.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        let mut chosen: Vec<View> = Vec::new();
        for view in views {
            let other = |c: &View| c.eye.distance(view.eye) > 1.2 || c.toward.angle_to(view.toward).abs() > 1.2;
            if chosen.len() < count && chosen.iter().all(other) {
                chosen.push(view);
            }
        }
        for view in chosen {
            let number = names.entry(room.kind).and_modify(|n| *n += 1).or_insert(1);
            cameras.push(camera(format!("{}_{number}", room.kind.name()), &view, fov));
        }
    }
    cameras
}

struct View {
    eye: Vec3,
    /// Unit.
    toward: Vec2,
    worth: f32,
}

fn camera(name: String, view: &View, fov_x_rad: f64) -> StartCamera {
    let z = -view.toward.extend(0.0).as_dvec3().normalize();
    let x = DVec3::Z.cross(z);
    let aspect = f64::from(ASPECT);
    StartCamera { name, position: view.eye.as_dvec3(), world_from_camera: DMat3::from_cols(x, DVec3::Z, z), fov_x_rad, aspect }
}

/// Weight of a thing of this class in a view of a room of this kind.
fn interest(class: i16, kind: RoomKind) -> f32 {
    const TABLE: [(Class, f32); 27] = [
        (Class::Bed, 3.0),
        (Class::Sofa, 3.0),
        (Class::Desk, 2.5),
        (Class::Table, 2.0),
        (Class::Chair, 1.6),
        (Class::Bathtub, 2.0),
        (Class::Sink, 2.0),
        (Class::Toilet, 0.8),
        (Class::Cabinet, 1.2),
        (Class::Counter, 1.5),
        (Class::Bookshelf, 1.5),
        (Class::Shelves, 1.0),
        (Class::Dresser, 1.2),
        (Class::NightStand, 1.2),
        (Class::Refrigerator, 0.8),
        (Class::Television, 0.8),
        (Class::Lamp, 1.2),
        (Class::Picture, 1.2),
        (Class::Mirror, 0.8),
        (Class::FloorMat, 1.0),
        (Class::Window, 0.8),
        (Class::Curtain, 0.7),
        (Class::Blinds, 0.3),
        (Class::Door, 0.15),
        (Class::OtherStructure, 0.4),
        (Class::Ceiling, 0.0),
        (Class::Floor, 0.0),
    ];
    let named = TABLE.iter().find(|(c, _)| *c as i16 == class).map_or(0.7, |(_, worth)| *worth);
    kind::row(kind).prized.filter(|(prized, _)| *prized as i16 == class).map_or(named, |(_, worth)| worth)
}

/// The surfaces that rays can hit.
struct Surroundings<'a> {
    scene: &'a Scene,
    labels: &'a Labels,
    world: &'a WorldMesh,
    bvh: &'a Bvh,
}

/// The hit of a ray.
#[derive(Clone, Copy)]
struct Sight {
    /// Metres.
    distance: f32,
    /// Number of the thing among those that the place sees; `None` for walls and what is in other rooms.
    thing: Option<usize>,
    /// Ends beyond a door or passage.
    beyond: bool,
}

/// A thing that a place sees.
struct Thing {
    instance: i16,
    glares: bool,
    interest: f32,
    /// Solid angle of all of it, in rays.
    all: f32,
}

impl Surroundings<'_> {
    /// The views from one place with what each is worth.
    fn look_around(&self, room: &Room, eye: Vec3, fov: f32) -> Vec<View> {
        let mut things: Vec<Thing> = Vec::new();
        let rays = (0..AROUND * PITCHES).map(|i| self.sight(room, eye, direction(i / PITCHES, i % PITCHES), &mut things));
        let sights: Vec<Option<Sight>> = rays.collect();
        (0..AROUND).map(|k| view(eye, k, fov, &sights, &things)).collect()
    }

    fn sight(&self, room: &Room, eye: Vec3, toward: Vec3, things: &mut Vec<Thing>) -> Option<Sight> {
        let ray = Ray::new(eye, toward.normalize());
        let hit = self.bvh.closest(&ray)?;
        let part = self.world.sources[hit.triangle as usize].part as usize;
        let label = self.labels.parts[part];
        let at = ray.at(hit.t);
        let within = |margin: f32| room.contains(at.truncate(), margin);
        let glazed = label.semantic == Class::Window as i16;
        let here = within(if glazed { REVEAL } else { 0.05 });
        let thing = (here && label.instance >= 0).then(|| {
            let known = things.iter().position(|t| t.instance == label.instance).unwrap_or_else(|| {
                let front = self.scene.parts[part].world_from_mesh.matrix3.y_axis.as_vec3().truncate();
                let behind = front.dot(eye.truncate() - at.truncate()) < 0.0;
                let interest = interest(label.semantic, room.kind) * if behind { BEHIND } else { 1.0 };
                things.push(Thing { instance: label.instance, glares: glazed, interest, all: 0.0 });
                things.len() - 1
            });
            things[known].all += 1.0;
            known
        });
        Some(Sight { distance: hit.t, thing, beyond: !within(REVEAL) })
    }
}

/// Walls are not thicker than this, metres.
const REVEAL: f32 = 0.5;
/// Share of its interest that a thing keeps from behind.
const BEHIND: f32 = 0.5;

/// Direction of a ray, not normalized: its level part is a unit vector.
fn direction(around: usize, pitch: usize) -> Vec3 {
    Vec2::from_angle(TAU * around as f32 / AROUND as f32).extend(LOWEST + PITCH_STEP * pitch as f32)
}

/// The view at `eye` in direction `k`, with its score: high for many different things that are not cut off, at some distance, and nothing
/// in the way.
fn view(eye: Vec3, k: usize, fov: f32, sights: &[Option<Sight>], things: &[Thing]) -> View {
    let (right, up) = ((0.5 * fov).tan(), (0.5 * fov).tan() / ASPECT);
    let mut rays = vec![0.0f32; things.len()];
    let mut areas = vec![0.0f32; things.len()];
    let (mut area, mut depth, mut near, mut beyond, mut glare) = (0.0f32, 0.0f32, 0.0f32, 0.0f32, 0.0f32);
    let reach = (0.5 * fov / TAU * AROUND as f32) as usize;
    for i in 0..=2 * reach {
        let around = (k + AROUND + i - reach) % AROUND;
        let aside = TAU * (i as f32 - reach as f32) / AROUND as f32;
        let cos = aside.cos();
        for pitch in 0..PITCHES {
            let height = (LOWEST + PITCH_STEP * pitch as f32) / cos;
            let Some(sight) = sights[around * PITCHES + pitch].filter(|_| height.abs() <= up && aside.tan().abs() <= right) else {
                continue;
            };
            // The picture's area of a step of azimuth and of tangent.
            let share = cos.powi(-3);
            area += share;
            depth += share * sight.distance.min(5.0);
            near += if sight.distance < NEAR { share } else { 0.0 };
            beyond += if sight.beyond { share } else { 0.0 };
            if let Some(thing) = sight.thing {
                rays[thing] += 1.0;
                areas[thing] += share;
                glare += if things[thing].glares { share } else { 0.0 };
            }
        }
    }
    let area = area.max(1e-6);
    let shown = things.iter().zip(&rays).zip(&areas).map(|((thing, rays), own)| {
        let whole = rays / thing.all.max(1.0);
        thing.interest * (own / area).min(ENOUGH).sqrt() * whole
    });
    let lost = 6.0 * (near / area - 0.02).max(0.0) + 4.0 * (beyond / area - 0.03).max(0.0) + 12.0 * (glare / area - GLARE).max(0.0);
    let worth = shown.sum::<f32>() + SPACE * depth / area - lost;
    View { eye, toward: Vec2::from_angle(TAU * k as f32 / AROUND as f32), worth }
}

/// A box around a part that cameras keep away from.
pub struct Obstacle {
    /// Along the axes of the home.
    around: Bounds3,
    /// The part's own box and its space, where that is turned from the axes.
    own: Option<(Bounds3, DAffine3)>,
}

impl Obstacle {
    /// The boxes of all parts: along the axes of the home, or, where it has walls that are not along them, along those of each part.
    pub fn all(scene: &Scene, plan: &FloorPlan) -> Vec<Self> {
        let is_turned = plan.rooms.iter().any(|room| !room.rectangular);
        let of = |part: &Part| {
            let around = Bounds3::from_points(scene.world_positions(part));
            let mesh = &scene.meshes[part.mesh as usize];
            let own = || (Bounds3::from_points(mesh.positions.iter().copied()), part.world_from_mesh.inverse());
            Self { around, own: is_turned.then(own) }
        };
        scene.parts.iter().map(of).collect()
    }

    /// Distance of a point from the box, metres.
    pub fn distance(&self, p: Vec3) -> f32 {
        match &self.own {
            None => p.distance(p.clamp(self.around.min, self.around.max)),
            Some((own, mesh_from_world)) => {
                let p = mesh_from_world.transform_point3(p.as_dvec3()).as_vec3();
                p.distance(p.clamp(own.min, own.max))
            }
        }
    }
}

/// Places of a room's eye that are free of every part's box.
fn places(boxes: &[Obstacle], room: &Room) -> Vec<Vec3> {
    let half = 0.5 * room.size.truncate();
    for clearance in CLEARANCES {
        let (low, high) = ((room.box_center - half - clearance).extend(0.0), (room.box_center + half + clearance).extend(room.size.z));
        let near: Vec<&Obstacle> = boxes.iter().filter(|b| b.around.min.cmplt(high).all() && b.around.max.cmpgt(low).all()).collect();
        let inside = |p: &Vec3| room.rectangular || room.contains(p.truncate(), -clearance);
        let free = |p: &Vec3| inside(p) && near.iter().all(|b| b.distance(*p) >= clearance);
        let reach = (half - clearance - 0.01).max(Vec2::ZERO);
        let steps = (2.0 * reach / STEP).floor();
        let place = |k: usize| {
            let (i, j) = (k % (steps.x as usize + 1), k / (steps.x as usize + 1));
            (room.box_center - 0.5 * steps * STEP + STEP * Vec2::new(i as f32, j as f32)).extend(EYE)
        };
        let found: Vec<Vec3> = (0..(steps.x as usize + 1) * (steps.y as usize + 1)).map(place).filter(free).collect();
        if !found.is_empty() {
            return found;
        }
    }
    Vec::new()
}

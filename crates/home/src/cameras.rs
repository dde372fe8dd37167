//! Where a photographer would stand to look at each room.
//!
//! From every free place rays go around; what they meet says how much each view shows. The best views are taken, one after another,
//! each from another place or in another direction. All are level, so that verticals stay vertical (two-point perspective).

use crate::plan::{FloorPlan, RoomKind};
use crate::room::Room;
use enfilade_geometry::Bvh;
use enfilade_math::{Bounds3, DMat3, DVec3, Ray, Vec2, Vec3};
use enfilade_scene::{Labels, Scene, StartCamera, WorldMesh};
use std::collections::{BTreeMap, BTreeSet};
use std::f32::consts::TAU;

/// Distances that a camera keeps from every part's box: where there is no place with the first, the second must do.
pub const CLEARANCES: [f32; 2] = [0.4, 0.25];
/// Height of the eye: photographers of interiors stand a little lower than people look.
const EYE: f32 = 1.38;
/// Horizontal field of view, radians: that of a 28 mm lens (65°), and of a 24 mm lens (74°) in small rooms.
const FOV_X_RAD: [f64; 2] = [1.14, 1.29];
/// Rooms with less floor are small, m².
const SMALL: f32 = 8.0;
/// Candidates stand on a grid of this step.
const STEP: f32 = 0.25;
/// Directions around a place.
const AROUND: usize = 48;
/// Tangents of the rays' heights: below, level, above.
const PITCHES: [f32; 4] = [-0.45, -0.25, -0.08, 0.12];
/// What is nearer than this is in the way.
const NEAR: f32 = 0.85;

/// Up to three views of each room, named after it: `living_1` is the best of the living room.
pub fn cameras(scene: &Scene, labels: &Labels, plan: &FloorPlan) -> Vec<StartCamera> {
    let world = WorldMesh::new(scene);
    let bvh = Bvh::new(&world.corners, &|_| false);
    let instance = |triangle: u32| labels.parts[world.sources[triangle as usize].part as usize].instance;
    let boxes = part_boxes(scene, &world);
    let mut cameras = Vec::new();
    let mut names = BTreeMap::new();
    for room in &plan.rooms {
        let most = match room.kind {
            RoomKind::Living => 4,
            RoomKind::Toilet | RoomKind::Laundry => 1,
            RoomKind::Bathroom | RoomKind::Hall => 2,
            _ => 3,
        };
        let fov = FOV_X_RAD[usize::from(room.size.x * room.size.y < SMALL)];
        let views = places(&boxes, room).into_iter().flat_map(|eye| look_around(&bvh, &instance, room, eye, fov as f32));
        let mut views: Vec<View> = views.collect();
        views.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        let mut chosen: Vec<View> = Vec::new();
        for view in views {
            let other = |c: &View| c.eye.distance(view.eye) > 1.2 || c.toward.angle_to(view.toward).abs() > 1.2;
            if chosen.len() < most && chosen.iter().all(other) {
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
    StartCamera { name, position: view.eye.as_dvec3(), world_from_camera: DMat3::from_cols(x, DVec3::Z, z), fov_x_rad, aspect: 4.0 / 3.0 }
}

/// World boxes of all parts.
fn part_boxes(scene: &Scene, world: &WorldMesh) -> Vec<Bounds3> {
    let mut boxes = vec![Bounds3::EMPTY; scene.parts.len()];
    for (corners, source) in world.corners.iter().zip(&world.sources) {
        let part = &mut boxes[source.part as usize];
        *part = corners.iter().fold(*part, |b, &p| b.include(p));
    }
    boxes
}

/// Places of a room's eye that are free of every part's box.
fn places(boxes: &[Bounds3], room: &Room) -> Vec<Vec3> {
    let half = 0.5 * room.size.truncate();
    for clearance in CLEARANCES {
        let (low, high) = ((room.center - half - clearance).extend(0.0), (room.center + half + clearance).extend(room.size.z));
        let near: Vec<&Bounds3> = boxes.iter().filter(|b| b.min.cmplt(high).all() && b.max.cmpgt(low).all()).collect();
        let free = |p: &Vec3| near.iter().all(|b| p.distance(p.clamp(b.min, b.max)) >= clearance);
        let reach = (half - clearance - 0.01).max(Vec2::ZERO);
        let steps = (2.0 * reach / STEP).floor();
        let place = |k: usize| {
            let (i, j) = (k % (steps.x as usize + 1), k / (steps.x as usize + 1));
            (room.center - 0.5 * steps * STEP + STEP * Vec2::new(i as f32, j as f32)).extend(EYE)
        };
        let found: Vec<Vec3> = (0..(steps.x as usize + 1) * (steps.y as usize + 1)).map(place).filter(free).collect();
        if !found.is_empty() {
            return found;
        }
    }
    Vec::new()
}

/// What rays in one direction meet.
#[derive(Default)]
struct Column {
    distance: f32,
    near: usize,
    things: Vec<i16>,
}

/// The views from one place, with what each is worth: many different things, at some distance, and nothing in the way.
fn look_around(bvh: &Bvh, instance: &dyn Fn(u32) -> i16, room: &Room, eye: Vec3, fov: f32) -> Vec<View> {
    let inside = 0.5 * room.size.truncate() + 0.05;
    let column = |k: usize| {
        let toward = Vec2::from_angle(TAU * k as f32 / AROUND as f32);
        let mut column = Column::default();
        for pitch in PITCHES {
            let ray = Ray::new(eye, toward.extend(pitch).normalize());
            let Some(hit) = bvh.closest(&ray) else { continue };
            column.distance += hit.t.min(6.0) / PITCHES.len() as f32;
            column.near += usize::from(hit.t < NEAR);
            let here = (ray.at(hit.t).truncate() - room.center).abs().cmple(inside).all();
            column.things.extend((here && instance(hit.triangle) >= 0).then(|| instance(hit.triangle)));
        }
        column
    };
    let columns: Vec<Column> = (0..AROUND).map(column).collect();
    let span = (fov / TAU * AROUND as f32 * 0.5) as usize;
    let view = |k: usize| {
        let seen = || (0..=2 * span).map(|i| &columns[(k + AROUND + i - span) % AROUND]);
        let count = (2 * span + 1) as f32;
        let things: BTreeSet<i16> = seen().flat_map(|c| c.things.iter().copied()).collect();
        let covered = seen().map(|c| c.things.len()).sum::<usize>() as f32 / (count * PITCHES.len() as f32);
        let distance = seen().map(|c| c.distance).sum::<f32>() / count;
        let near = seen().map(|c| c.near).sum::<usize>() as f32 / (count * PITCHES.len() as f32);
        let worth = (things.len() as f32).min(20.0).sqrt() + 1.5 * covered + 0.7 * distance - 12.0 * (near - 0.04).max(0.0);
        View { eye, toward: Vec2::from_angle(TAU * k as f32 / AROUND as f32), worth }
    };
    (0..AROUND).map(view).collect()
}

//! Where marks are: on free pieces of walls, on level floors and tops, on screens.

use super::super::stage::Stage;
use super::super::walls;
use super::place::Place;
use super::soft::on_soft;
use super::table::{On, Row};
use crate::room::{Footprint, Room};
use crate::shell::is_shell;
use enfilade_furniture::meet::Body;
use enfilade_furniture::{family_of, object_of, pose};
use enfilade_math::{DAffine3, DVec3, Rng, Vec2, Vec3, hash_text};
use enfilade_textures::Mark;
use std::f32::consts::{FRAC_PI_2, TAU};
use std::f64::consts::FRAC_PI_2 as FRAC_PI_2_F64;

/// Distance of a film from its surface, metres.
const FILM: f64 = 0.0003;
/// Places that are tried for each mark.
const TRIES: usize = 8;
/// Greatest unevenness below a mark, metres.
const EVEN: f32 = 0.0008;
/// Width of the flat wood between the edge of a door's leaf and its panels, metres.
const STILE: f32 = 0.13;
/// Walls keep this much free beside openings, metres.
const CASING: f32 = 0.12;

/// The places of the marks of a row, each with a part of the object that it is on.
pub(super) fn places(stage: &mut Stage, row: &Row, rate: f32, rng: &Rng) -> Vec<(usize, Place)> {
    let mut found = Vec::new();
    let rooms = stage.home.plan.rooms.clone();
    let count = |expected: f32, rng: &mut Rng| (expected + rng.next_f32()) as usize;
    match row.on {
        On::Walls(_) | On::Doors(_) => {
            for (k, room) in rooms.iter().enumerate() {
                let mut rng = rng.fork(k as u64);
                let doors = room.ways().count() as f32;
                let length: f32 = room.walls().into_iter().map(|wall| room.length(wall)).sum();
                let expected = if matches!(row.on, On::Doors(_)) { rate * doors } else { rate * length / 10.0 };
                for _ in 0..count(expected, &mut rng) {
                    found.extend((0..TRIES).find_map(|_| on_wall(stage, room, row, &mut rng)));
                }
            }
        }
        On::Floor => {
            for (k, room) in rooms.iter().enumerate() {
                let mut rng = rng.fork(k as u64);
                for _ in 0..count(rate * room.area / 10.0, &mut rng) {
                    found.extend((0..TRIES).find_map(|_| on_floor(stage, k, room, row, &mut rng)));
                }
            }
        }
        On::Tops(families) | On::Soft(families) => {
            let hosts = stage.bodies.iter().map(|body| body.name.clone()).filter(|name| families.contains(&family_of(name)));
            for host in hosts.collect::<Vec<_>>() {
                let mut rng = rng.fork(hash_text(&host));
                for _ in 0..count(rate, &mut rng) {
                    found.extend((0..TRIES).find_map(|_| match row.on {
                        On::Soft(_) => on_soft(stage, &host, half_of(row, &mut rng), &mut rng),
                        _ => on_top(stage, &host, row, &mut rng),
                    }));
                }
            }
        }
        On::Fronts(names) | On::Leaves(names) => {
            for part in 0..stage.home.scene.parts.len() {
                let mut rng = rng.fork(hash_text(&stage.home.scene.parts[part].name));
                for _ in 0..count(rate, &mut rng) {
                    found.extend(match row.on {
                        On::Leaves(_) => on_leaf(stage, part, names, row, &mut rng),
                        _ => on_front(stage, part, names, row, &mut rng),
                    });
                }
            }
        }
    }
    found
}

fn half_of(row: &Row, rng: &mut Rng) -> Vec2 {
    0.5 * Vec2::new(rng.range(row.size[0][0], row.size[0][1]), rng.range(row.size[1][0], row.size[1][1]))
}

/// A place on a wall that no opening and no slope meets, in the wall that is there.
fn on_wall(stage: &Stage, room: &Room, row: &Row, rng: &mut Rng) -> Option<(usize, Place)> {
    let half = half_of(row, rng);
    let (wall, x, [low, high]) = match row.on {
        On::Doors(heights) => {
            let ways: Vec<_> = room.ways().collect();
            let way = ways.get(rng.below(ways.len().max(1)))?;
            let side = if rng.below(2) == 0 { way.x[0] - CASING - half.x } else { way.x[1] + CASING + half.x };
            (way.wall, side, heights)
        }
        On::Walls(heights) => {
            let walls = room.walls();
            let wall = walls[rng.below(walls.len())];
            (wall, 0.5 * room.length(wall) * rng.range(-1.0, 1.0), heights)
        }
        _ => return None,
    };
    let z = rng.range(low, high);
    if !walls::piece(room, wall, x, z, half) {
        return None;
    }
    let upright = DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2) * DAffine3::from_rotation_y(std::f64::consts::PI);
    let at = DVec3::new(f64::from(x), FILM, f64::from(z));
    let pose = room.wall_pose(wall) * DAffine3::from_translation(at) * upright;
    // The normal is that of the wall, towards the room.
    let normal = pose.transform_vector3(DVec3::Z);
    let inward = room.inward(wall).extend(0.0).as_dvec3();
    let pose = if normal.dot(inward) < 0.0 { pose * DAffine3::from_rotation_x(std::f64::consts::PI) } else { pose };
    Some((shell_at(stage, pose.translation.as_vec3(), "wall_")?, Place::flat(pose, half)))
}

/// The part of the shell that a point is on: the first of an object whose name begins like this and has a flat triangle there.
fn shell_at(stage: &Stage, p: Vec3, prefix: &str) -> Option<usize> {
    let is_on = |body: &&Body| {
        let (low, high) = (body.bounds.min - 0.002, body.bounds.max + 0.002);
        is_shell(&body.name) && body.name.starts_with(prefix) && p.cmpge(low).all() && p.cmple(high).all()
    };
    let body = stage.bodies.iter().find(is_on)?;
    stage.home.scene.parts.iter().position(|part| object_of(&part.name) == body.name)
}

fn on_floor(stage: &mut Stage, number: usize, room: &Room, row: &Row, rng: &mut Rng) -> Option<(usize, Place)> {
    let half = half_of(row, rng);
    let size = 0.5 * room.size.truncate();
    let at = room.box_center + size * Vec2::new(rng.range(-1.0, 1.0), rng.range(-1.0, 1.0));
    let place = Footprint { center: at, half, yaw: rng.range(0.0, TAU) };
    if !room.holds(&place, 0.02) {
        return None;
    }
    let level = stage.floor(number)?.level(&place, -1.0).filter(|level| level.spread < EVEN)?;
    let part = shell_at(stage, at.extend(level.top), "floor_")?;
    let pose = pose(f64::from(at.x), f64::from(at.y), f64::from(level.top) + FILM, f64::from(place.yaw));
    Some((part, Place::flat(pose, half)))
}

fn on_top(stage: &mut Stage, host: &str, row: &Row, rng: &mut Rng) -> Option<(usize, Place)> {
    let half = half_of(row, rng);
    let ground = stage.over(host, false)?;
    let [min, max] = ground.window();
    let at = min + (max - min) * Vec2::new(rng.next_f32(), rng.next_f32());
    let wide = max.x - min.x > max.y - min.y;
    let yaw = if row.kind == Mark::Dust { if wide { 0.0 } else { FRAC_PI_2 } } else { rng.range(0.0, TAU) };
    let place = Footprint { center: at, half, yaw };
    let level = ground.level(&place, -1.0).filter(|level| level.spread < EVEN && level.top > 0.3)?;
    let part = stage.home.scene.parts.iter().position(|part| object_of(&part.name) == host)?;
    let pose = pose(f64::from(at.x), f64::from(at.y), f64::from(level.top) + FILM, f64::from(yaw));
    Some((part, Place::flat(pose, half)))
}

/// The last word of a part's name, without a number or a side behind it, is one of these.
fn is_named(part: &str, names: &[&str]) -> bool {
    let last = part.rsplit('/').next().unwrap_or(part);
    names.iter().any(|name| last.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('_')))
}

/// A place on an upright screen or pane: its front is the +y of its part.
fn on_front(stage: &Stage, part: usize, names: &[&str], row: &Row, rng: &mut Rng) -> Option<(usize, Place)> {
    let scene = &stage.home.scene;
    let own = &scene.parts[part];
    let bounds = scene.meshes[own.mesh as usize].bounds();
    let extent = bounds.extent();
    if !is_named(&own.name, names) || extent.y > 0.01 || extent.x < 0.3 || extent.z < 0.2 {
        return None;
    }
    let half = half_of(row, rng).min(0.48 * Vec2::new(extent.x, extent.z));
    let room = 0.5 * Vec2::new(extent.x, extent.z) - half;
    let center = bounds.center();
    let at = Vec3::new(center.x + room.x * rng.range(-1.0, 1.0), bounds.max.y, center.z + room.y * rng.range(-1.0, 1.0));
    let local = DAffine3::from_translation(at.as_dvec3() + DVec3::Y * FILM) * DAffine3::from_rotation_x(-FRAC_PI_2_F64);
    Some((part, Place::flat(own.world_from_mesh * local, half)))
}

/// A place on either face of the leaf of a door, around its handle or at its foot: on the stile, which is flat.
fn on_leaf(stage: &Stage, part: usize, names: &[&str], row: &Row, rng: &mut Rng) -> Option<(usize, Place)> {
    let scene = &stage.home.scene;
    let own = &scene.parts[part];
    if !is_named(&own.name, names) {
        return None;
    }
    let object = object_of(&own.name);
    let handle = scene.parts.iter().find(|other| object_of(&other.name) == object && other.name.ends_with("/handle"))?;
    let [leaf, handle] = [own, handle].map(|part| scene.meshes[part.mesh as usize].bounds());
    let half = half_of(row, rng);
    let side = handle.center().x.signum();
    // From the edge of the leaf beside the lock to the panels.
    let x = side * (leaf.max.x - STILE * rng.range(0.4, 0.6));
    let z = handle.center().z + rng.range(-0.12, 0.2);
    let front = rng.below(2) == 0;
    let (y, turn) = if front { (leaf.max.y, -FRAC_PI_2_F64) } else { (leaf.min.y, FRAC_PI_2_F64) };
    let at = DVec3::new(f64::from(x), f64::from(y) + if front { FILM } else { -FILM }, f64::from(z));
    let local = DAffine3::from_translation(at) * DAffine3::from_rotation_x(turn);
    Some((part, Place::flat(own.world_from_mesh * local, half)))
}

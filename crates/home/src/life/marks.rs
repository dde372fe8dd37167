//! Wear: marks that hands, shoes, cups and dust leave on walls, floors, tables, fronts and screens.
//!
//! A mark is a film that lies 0.3 mm before its surface and covers it partly; it is a part of the object that it is on. The table gives
//! what each kind is like.

use super::stage::Stage;
use super::table::interpolated;
use crate::room::{Footprint, Room};
use crate::shell::is_shell;
use enfilade_furniture::meet::Body;
use enfilade_furniture::{family_of, object_of, pose};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Rng, Vec2, Vec3, hash_text};
use enfilade_scene::{Alpha, Bsdf, ColorParam, Material, Part, ScalarParam, TextureRef, Wrap};
use enfilade_textures::{Mark, mark};
use std::f32::consts::{FRAC_PI_2, TAU};

/// Distance of a film from its surface, metres.
const FILM: f64 = 0.0003;
/// Pictures of each kind, of which marks take one.
const PICTURES: usize = 3;
/// Places that are tried for each mark.
const TRIES: usize = 8;
/// Greatest unevenness below a mark, metres.
const EVEN: f32 = 0.0008;
/// Walls keep this much free beside openings, metres.
const CASING: f32 = 0.12;

/// Where marks are.
#[derive(Clone, Copy, Debug)]
enum On {
    /// On walls between two heights, for each 10 m of wall.
    Walls([f32; 2]),
    /// On walls at a height, beside doors.
    Doors([f32; 2]),
    /// On the floor, for each 10 m².
    Floor,
    /// On top of pieces of these families, for each piece.
    Tops(&'static [&'static str]),
    /// On parts that are screens or panes before something, for each.
    Screens,
}

/// A kind of mark.
struct Row {
    kind: Mark,
    on: On,
    /// Least and greatest width and height, metres.
    size: [[f32; 2]; 2],
    /// Colour, linear reflectance.
    color: Rgb,
    /// Share that it covers where it is strongest: at ½ and at 1.
    strength: [f32; 2],
    /// Expected number at ½ and at 1.
    expected: [f32; 2],
    /// Roughness of a glossy film; a rough diffuse one where it is none.
    gloss: Option<f32>,
}

const TABLES: &[&str] = &[
    "dining_table",
    "long_table",
    "coffee_table",
    "side_table",
    "desk",
    "student_desk",
    "conference_table",
    "bistro_table",
    "nightstand",
    "worktop",
    "counter",
    "workbench",
    "play_table",
];
const SHELVES: &[&str] = &["sideboard", "dresser", "tv_bench", "console", "shoe_cabinet", "cube_shelf", "filing_cabinet", "office_cabinet"];
const DIRT: Rgb = Rgb::new(0.075, 0.06, 0.045);
const RUBBER: Rgb = Rgb::new(0.03, 0.028, 0.027);

static ROWS: [Row; 12] = [
    Row {
        kind: Mark::Scuffs,
        on: On::Walls([0.1, 0.42]),
        size: [[0.12, 0.5], [0.04, 0.14]],
        color: RUBBER,
        strength: [0.28, 0.6],
        expected: [2.2, 7.0],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Walls([0.7, 1.5]),
        size: [[0.08, 0.3], [0.08, 0.3]],
        color: DIRT,
        strength: [0.08, 0.2],
        expected: [1.4, 5.0],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Doors([0.8, 1.3]),
        size: [[0.1, 0.22], [0.15, 0.4]],
        color: DIRT,
        strength: [0.12, 0.28],
        expected: [0.7, 1.7],
        gloss: None,
    },
    Row {
        kind: Mark::Patch,
        on: On::Walls([0.5, 2.0]),
        size: [[0.2, 0.7], [0.15, 0.5]],
        color: Rgb::new(0.8, 0.79, 0.76),
        strength: [0.10, 0.3],
        expected: [0.5, 2.0],
        gloss: None,
    },
    Row {
        kind: Mark::Patch,
        on: On::Walls([0.4, 2.1]),
        size: [[0.3, 0.9], [0.3, 0.9]],
        color: Rgb::new(0.3, 0.27, 0.23),
        strength: [0.03, 0.08],
        expected: [0.8, 2.4],
        gloss: None,
    },
    Row {
        kind: Mark::Grime,
        on: On::Floor,
        size: [[0.3, 1.1], [0.3, 1.1]],
        color: DIRT,
        strength: [0.07, 0.18],
        expected: [1.6, 4.0],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Floor,
        size: [[0.06, 0.22], [0.06, 0.22]],
        color: DIRT,
        strength: [0.14, 0.35],
        expected: [0.5, 2.0],
        gloss: None,
    },
    Row {
        kind: Mark::Scratches,
        on: On::Floor,
        size: [[0.3, 0.8], [0.3, 0.8]],
        color: Rgb::new(0.35, 0.32, 0.28),
        strength: [0.12, 0.35],
        expected: [0.8, 2.4],
        gloss: Some(0.35),
    },
    Row {
        kind: Mark::Rings,
        on: On::Tops(TABLES),
        size: [[0.15, 0.19], [0.15, 0.19]],
        color: Rgb::new(0.12, 0.07, 0.035),
        strength: [0.16, 0.4],
        expected: [0.5, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Spill,
        on: On::Tops(TABLES),
        size: [[0.04, 0.16], [0.04, 0.16]],
        color: DIRT,
        strength: [0.14, 0.35],
        expected: [0.4, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Dust,
        on: On::Tops(SHELVES),
        size: [[0.3, 0.9], [0.15, 0.35]],
        color: Rgb::new(0.42, 0.4, 0.37),
        strength: [0.07, 0.2],
        expected: [0.8, 1.6],
        gloss: None,
    },
    Row {
        kind: Mark::Fingers,
        on: On::Screens,
        size: [[0.2, 0.4], [0.2, 0.4]],
        color: Rgb::new(0.3, 0.3, 0.3),
        strength: [0.03, 0.09],
        expected: [0.6, 1.5],
        gloss: Some(0.3),
    },
];

/// Wears the surfaces of a home.
pub fn wear(stage: &mut Stage, rng: &Rng, lived_in: f32) {
    for (number, row) in ROWS.iter().enumerate() {
        let mut rng = rng.fork(number as u64).fork(hash_text("mark"));
        let materials: Vec<u32> = (0..PICTURES).map(|_| material(stage, row, interpolated(lived_in, row.strength), &mut rng)).collect();
        let rate = interpolated(lived_in, row.expected);
        for (part, place) in places(stage, row, rate, &rng) {
            let mesh = film(place.half);
            let number = stage.home.scene.meshes.len() as u32;
            stage.home.scene.meshes.push(mesh.into());
            let own = &stage.home.scene.parts[part];
            let name = format!("{}/mark_{}", object_of(&own.name), stage.home.scene.parts.len());
            let material = materials[rng.below(materials.len())];
            let added = Part { name, mesh: number, material, world_from_mesh: place.pose, ..own.clone() };
            let label = stage.home.labels.parts[part];
            stage.home.scene.parts.push(added);
            stage.home.labels.parts.push(label);
        }
    }
}

/// Where a mark is: a rectangle whose middle is the origin of the pose, along its x and y.
struct Place {
    pose: DAffine3,
    half: Vec2,
}

/// A rectangle that faces +z, its texture over the unit square.
fn film(half: Vec2) -> Mesh {
    let corners = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0), Vec2::new(0.0, 1.0)];
    let positions = corners.map(|c| ((2.0 * c - 1.0) * half).extend(0.0)).to_vec();
    Mesh { positions, uvs: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

fn material(stage: &mut Stage, row: &Row, strength: f32, rng: &mut Rng) -> u32 {
    let scene = &mut stage.home.scene;
    let name = "mark";
    scene.images.push(mark(name, row.kind, row.color, rng.next_u64() as u32).into());
    let texture = TextureRef { wrap: [Wrap::Clamp; 2], ..TextureRef::new(scene.images.len() as u32 - 1) };
    let color = ColorParam { factor: Rgb::WHITE, texture: Some(texture) };
    let bsdf = match row.gloss {
        Some(alpha) => Bsdf::Plastic { diffuse: color, eta: 1.5, alpha: alpha.into(), specular: Rgb::WHITE.into(), nonlinear: false },
        None => Bsdf::RoughDiffuse { reflectance: color, roughness: 0.4.into() },
    };
    let opacity = ScalarParam { factor: strength, texture: Some((texture, 3)) };
    scene.materials.push(Material { alpha: Alpha::Blend { opacity }, ..Material::new(name, bsdf) });
    scene.materials.len() as u32 - 1
}

/// The places of the marks of a row, each with a part of the object that it is on.
fn places(stage: &mut Stage, row: &Row, rate: f32, rng: &Rng) -> Vec<(usize, Place)> {
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
        On::Tops(families) => {
            let hosts = stage.bodies.iter().map(|body| body.name.clone()).filter(|name| families.contains(&family_of(name)));
            for host in hosts.collect::<Vec<_>>() {
                let mut rng = rng.fork(hash_text(&host));
                for _ in 0..count(rate, &mut rng) {
                    found.extend((0..TRIES).find_map(|_| on_top(stage, &host, row, &mut rng)));
                }
            }
        }
        On::Screens => {
            for part in 0..stage.home.scene.parts.len() {
                let mut rng = rng.fork(hash_text(&stage.home.scene.parts[part].name));
                for _ in 0..count(rate, &mut rng) {
                    found.extend(on_screen(stage, part, row, &mut rng));
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
    let inside = x.abs() + half.x < 0.5 * room.length(wall) - 0.01 && z - half.y > 0.1;
    let opening = room.openings.iter().filter(|opening| opening.wall == wall);
    let clear = opening.clone().all(|o| {
        x + half.x < o.x[0] - CASING || x - half.x > o.x[1] + CASING || z - half.y > o.z[1] + CASING || z + half.y < o.z[0] - CASING
    });
    if !inside || !clear || !room.slopes.is_empty() {
        return None;
    }
    let upright = DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2) * DAffine3::from_rotation_y(std::f64::consts::PI);
    let at = DVec3::new(f64::from(x), FILM, f64::from(z));
    let pose = room.wall_pose(wall) * DAffine3::from_translation(at) * upright;
    // The normal is that of the wall, towards the room.
    let normal = pose.transform_vector3(DVec3::Z);
    let inward = room.inward(wall).extend(0.0).as_dvec3();
    let pose = if normal.dot(inward) < 0.0 { pose * DAffine3::from_rotation_x(std::f64::consts::PI) } else { pose };
    Some((shell_at(stage, pose.translation.as_vec3(), "wall_")?, Place { pose, half }))
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
    Some((part, Place { pose, half }))
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
    Some((part, Place { pose, half }))
}

/// A place on an upright screen: its front is the +y of its part.
fn on_screen(stage: &Stage, part: usize, row: &Row, rng: &mut Rng) -> Option<(usize, Place)> {
    let scene = &stage.home.scene;
    let own = &scene.parts[part];
    if !own.name.ends_with("/screen") {
        return None;
    }
    let bounds = scene.meshes[own.mesh as usize].bounds();
    let extent = bounds.extent();
    if extent.y > 0.01 || extent.x < 0.3 || extent.z < 0.2 {
        return None;
    }
    let half = half_of(row, rng).min(0.45 * Vec2::new(extent.x, extent.z));
    let room = 0.5 * Vec2::new(extent.x, extent.z) - half;
    let center = bounds.center();
    let at = Vec3::new(center.x + room.x * rng.range(-1.0, 1.0), bounds.max.y, center.z + room.y * rng.range(-1.0, 1.0));
    let local = DAffine3::from_translation(at.as_dvec3() + DVec3::Y * FILM) * DAffine3::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    Some((part, Place { pose: own.world_from_mesh * local, half }))
}

//! The contents of one home, and the cost of making it.

use enfilade_furniture::{family_of, object_of};
use enfilade_home::check::faults;
use enfilade_home::{Home, HomeConfig, home};
use enfilade_math::{Bounds3, DVec2, Vec2, Vec3};
use enfilade_scene::{Labels, NYU40, Part, Scene, is_stuff, to_bytes_with_labels};
use enfilade_testkit::process_cpu_s;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Instant;

/// A home in numbers. Lengths are metres, times seconds, sizes of memory and files millions of bytes.
#[derive(Debug, Serialize, Deserialize)]
pub struct Measured {
    pub seed: u64,
    /// Name of the kind of building.
    pub building: String,
    pub wall_s: f64,
    pub cpu_s: f64,
    /// Peak memory of the process when the home was finished, megabytes.
    pub peak_mb: f64,
    pub package_mb: f64,
    /// Triangles that are seen, those of shared meshes once for every part.
    pub triangles: usize,
    /// Triangles of all meshes, each once.
    pub stored_triangles: usize,
    pub parts: usize,
    pub meshes: usize,
    pub unlabelled_parts: usize,
    pub rooms: Vec<Room>,
    pub objects: Vec<Object>,
    /// The faults that [`enfilade_home::check`] finds.
    pub faults: Vec<String>,
}

/// A room of a home.
#[derive(Debug, Serialize, Deserialize)]
pub struct Room {
    pub kind: String,
    pub area_m2: f32,
    /// Level faces of furniture that look up, between [`SHELF_M`].
    pub surface_m2: f32,
}

/// A labelled instance.
#[derive(Debug, Serialize, Deserialize)]
pub struct Object {
    /// `sofa` of `sofa_1`.
    pub family: String,
    /// Class of the object in NYU40.
    pub semantic: i16,
    /// Index of the room that its middle is in.
    pub room: Option<usize>,
    /// Width, depth and height of its box, which is turned as the object is.
    pub size_m: [f32; 3],
}

/// Heights above the floor between which things stand on furniture.
const SHELF_M: [f32; 2] = [0.3, 2.0];
/// Classes of furniture that things stand on: cabinet, table, bookshelf, counter, desk, shelves, dresser, night stand, otherfurniture.
const CARRIES: [i16; 9] = [3, 7, 10, 12, 14, 15, 17, 32, 39];

/// Makes the home and measures it.
pub fn measure(config: &HomeConfig) -> Result<Measured, Box<dyn std::error::Error>> {
    let start = Instant::now();
    let made = home(config);
    let (wall_s, cpu_s, peak_mb) = (start.elapsed().as_secs_f64(), process_cpu_s(), peak_mb()?);
    let scene = &made.scene;
    Ok(Measured {
        seed: config.seed,
        building: config.building.name().into(),
        wall_s,
        cpu_s,
        peak_mb,
        package_mb: to_bytes_with_labels(scene, &made.labels).len() as f64 / 1e6,
        triangles: scene.parts.iter().map(|part| scene.meshes[part.mesh as usize].triangles.len()).sum(),
        stored_triangles: scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum(),
        parts: scene.parts.len(),
        meshes: scene.meshes.len(),
        unlabelled_parts: unlabelled(&made.labels),
        rooms: rooms(&made),
        objects: objects(&made),
        faults: faults(&made).iter().map(ToString::to_string).collect(),
    })
}

fn unlabelled(labels: &Labels) -> usize {
    labels.parts.iter().filter(|label| !(1..=NYU40.len() as i16).contains(&label.semantic)).count()
}

fn rooms(home: &Home) -> Vec<Room> {
    let mut rooms: Vec<Room> =
        home.plan.rooms.iter().map(|room| Room { kind: room.kind.name().into(), area_m2: room.area, surface_m2: 0.0 }).collect();
    let carrying = home.scene.parts.iter().zip(&home.labels.parts).filter(|(_, label)| CARRIES.contains(&label.semantic));
    for (part, _) in carrying {
        for triangle in 0..home.scene.meshes[part.mesh as usize].triangles.len() {
            let [a, b, c] = home.scene.world_corners(part, triangle);
            let twice = (b - a).cross(c - a);
            let level = twice.z > 0.999 * twice.length() && (SHELF_M[0]..SHELF_M[1]).contains(&a.z);
            if let Some(room) = room_at(home, a.truncate()).filter(|_| level) {
                rooms[room].surface_m2 += 0.5 * twice.length();
            }
        }
    }
    rooms
}

fn room_at(home: &Home, place: Vec2) -> Option<usize> {
    home.plan.rooms.iter().position(|room| room.contains(place, 0.0))
}

/// All labelled things, in the order of their names. Walls, floors and ceilings are none.
fn objects(home: &Home) -> Vec<Object> {
    let scene = &home.scene;
    let mut parts: BTreeMap<&str, Vec<&Part>> = BTreeMap::new();
    let mut classes: BTreeMap<&str, i16> = BTreeMap::new();
    for (part, label) in scene.parts.iter().zip(&home.labels.parts).filter(|(_, label)| !is_stuff(label.semantic)) {
        parts.entry(object_of(&part.name)).or_default().push(part);
        classes.insert(object_of(&part.name), label.semantic);
    }
    let of = |(name, parts): (&str, Vec<&Part>)| {
        let (size, middle) = boxed(scene, &parts);
        Object { family: family_of(name).into(), semantic: classes[name], room: room_at(home, middle), size_m: size.to_array() }
    };
    parts.into_iter().map(of).collect()
}

/// Size of the box around parts, turned about the vertical as their first is, and the middle of it seen from above.
fn boxed(scene: &Scene, parts: &[&Part]) -> (Vec3, Vec2) {
    let x = parts[0].world_from_mesh.matrix3.x_axis;
    let along = DVec2::new(x.x, x.y).try_normalize().unwrap_or(DVec2::X).as_vec2();
    let mut bounds = Bounds3::EMPTY;
    for part in parts {
        let turned = scene.world_positions(part).map(|p| Vec3::new(along.dot(p.truncate()), along.perp_dot(p.truncate()), p.z));
        bounds = bounds.union(Bounds3::from_points(turned));
    }
    let middle = 0.5 * (bounds.min + bounds.max).truncate();
    (bounds.max - bounds.min, along.rotate(middle))
}

fn peak_mb() -> Result<f64, Box<dyn std::error::Error>> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no VmHWM in /proc/self/status")?;
    let kib: f64 = line.split_whitespace().next().ok_or("an empty VmHWM in /proc/self/status")?.parse()?;
    Ok(kib * 1024.0 / 1e6)
}

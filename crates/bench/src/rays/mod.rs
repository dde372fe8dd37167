//! How many rays a second does the hierarchy trace, and how many does Embree? `cargo xtask bench rays`
//!
//! On one thread, in CPU time, because wall time on a shared machine is unreliable. All engines trace the same rays in turns; a figure
//! is the median over the turns. The rooms are read from the folder that `ENFILADE_SCENES` names; without it, or with the word
//! `furnished`, a generated room is measured. `ENFILADE_EMBREE` names a `libembree4` to compare with. With both, and without words that
//! choose rooms, the table is also written to `docs/benchmarks/rays.md` and `rays.json`.

mod cases;
#[cfg(unix)]
mod embree;
mod furnished;
mod peers;
mod report;
mod turns;

use cases::Room;
use enfilade_geometry::Bvh;
use enfilade_import::{ImportOptions, load};
use enfilade_scene::{Quiet, WorldMesh};
use peers::{Failure, Peers};
use report::Report;
use std::path::{Path, PathBuf};

/// Name, file below the folder of scenes, metres per unit.
const ROOMS: [(&str, &str, f64); 6] = [
    ("grey-white-room", "grey-white-room/gltf/scene.gltf", 1.0),
    ("modern-hall", "modern-hall/gltf/scene.gltf", 0.4),
    ("bedroom", "bedroom/gltf/scene.gltf", 1.0),
    ("contemporary-bathroom", "contemporary-bathroom/gltf/scene.gltf", 1.0),
    ("japanese-classroom", "japanese-classroom/gltf/scene.gltf", 1.0),
    ("drake-living-room", "drake-furnished-living-room/scene.gltf", 1.0),
];

/// Runs the instrument.
pub fn run() -> Result<(), Failure> {
    let words: Vec<String> = crate::arguments::arguments().collect();
    let scenes = std::env::var_os("ENFILADE_SCENES").map(PathBuf::from);
    let rooms: Vec<Room> = match &scenes {
        Some(folder) if words != ["furnished"] => {
            let chosen = ROOMS.iter().filter(|(name, ..)| words.is_empty() || words.iter().any(|word| word == name));
            chosen.map(|&(name, file, unit)| read(name, &folder.join(file), unit)).collect::<Result<_, _>>()?
        }
        _ => vec![furnished_room()],
    };
    if rooms.is_empty() {
        return Err(format!("no room {words:?}; expected `furnished` or some of {}", ROOMS.map(|(name, ..)| name).join(", ")).into());
    }
    let peers = Peers::load()?;
    let mut report = Report::new(peers.version());
    for room in &rooms {
        report.push(turns::compare(room, &peers)?);
    }
    report.print_summary();
    if scenes.is_some() && words.is_empty() && peers.version().is_some() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/benchmarks");
        report.write(&folder)?;
    }
    Ok(())
}

fn read(name: &str, file: &Path, meters_per_unit: f64) -> Result<Room, Failure> {
    let scene = load(file, &ImportOptions { meters_per_unit, ..ImportOptions::default() }, &Quiet)?.scene;
    let world = WorldMesh::new(&scene);
    let glows = |part: u32| scene.materials[scene.parts[part as usize].material as usize].emission.factor != enfilade_math::Rgb::BLACK;
    let lamps = (0..world.corners.len() as u32).filter(|&i| glows(world.sources[i as usize].part)).collect();
    let camera = scene.cameras.first().ok_or_else(|| format!("{} has no camera", file.display()))?.clone();
    Ok(Room { name: name.into(), triangles: world.corners, camera, lamps })
}

fn furnished_room() -> Room {
    let triangles = furnished::furnished_room();
    let camera = cases::corner_camera(&Bvh::new(&triangles, &|_| false));
    Room { name: "furnished".into(), triangles, camera, lamps: Vec::new() }
}

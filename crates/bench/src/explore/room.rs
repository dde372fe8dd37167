//! A room as Hypersim's programs were given it, and what they made of it. Used by the benchmark and by the tests.

use enfilade_explore::{CarveReport, FreeSpace};
use enfilade_geometry::OccupancyTree;
use enfilade_math::{Bounds3, DMat3, DVec3, Vec3};
use enfilade_scene::{StartCamera, TriangleSource, WorldMesh};
use enfilade_testkit::Npz;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The rooms of the folder that [`folder`] finds.
pub const ROOMS: [&str; 2] = ["aws-house-offgrid", "staircase"];

/// Inputs and results of one room.
pub struct Room {
    pub name: &'static str,
    pub world: WorldMesh,
    pub starts: Vec<StartCamera>,
    pub octomap: Vec<u8>,
    /// Positions carved from, the programs' own.
    pub carve_positions: Vec<DVec3>,
    /// CPU seconds of the program that carves, and of the Python around it.
    pub peer_carve_s: [f64; 2],
    pub walks: Vec<Walk>,
}

/// A trajectory of the programs.
pub struct Walk {
    pub peer_s: f64,
    pub positions: Vec<DVec3>,
    /// Camera to world.
    pub orientations: Vec<DMat3>,
    pub valid_share: Vec<f64>,
    /// Distinct triangles, emptiness counting as one.
    pub triangles: Vec<f64>,
}

/// The folder of the programs' results: what `ENFILADE_GOLDEN` names, or `golden` beside the folder that `ENFILADE_SCENES` names.
pub fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("ENFILADE_GOLDEN").map(PathBuf::from);
    let beside = || std::env::var_os("ENFILADE_SCENES").map(|scenes| Path::new(&scenes).join("../golden"));
    named.or_else(beside).filter(|folder| folder.join(ROOMS[0]).is_dir())
}

impl Room {
    /// # Panics
    /// When a file is missing or is not what it should be.
    pub fn read(folder: &Path, name: &'static str) -> Self {
        let folder = folder.join(name);
        let read = |file: &str| std::fs::read(folder.join(file)).unwrap_or_else(|e| panic!("{}: {e}", folder.join(file).display()));
        let mesh = Npz::new(&read("mesh.npz"));
        let vertices: Vec<Vec3> = mesh.f32("vertices").chunks_exact(3).map(Vec3::from_slice).collect();
        let corners: Vec<[Vec3; 3]> = mesh.i32("faces").chunks_exact(3).map(|f| [0, 1, 2].map(|i| vertices[f[i] as usize])).collect();
        let parts = mesh.i32("oi");
        let sources = (0..).zip(&parts).map(|(triangle, part)| TriangleSource { part: *part as u32, triangle }).collect();
        let contrasts = vec![0.0; parts.iter().max().map_or(0, |last| *last as usize + 1)];
        let bounds = Bounds3::from_points(corners.iter().flatten().copied());
        let stats: Value = serde_json::from_slice(&read("stats.json")).expect("stats.json is JSON");
        let cpu_s = |run: &Value| number(&run["user_s"]) + number(&run["sys_s"]);
        let cameras = stats["cameras"].as_array().expect("cameras are a list");
        let start = |(i, camera): (usize, &Value)| StartCamera {
            name: format!("cam_{i:02}"),
            position: vector(&camera["start_position"]),
            world_from_camera: DMat3::from_cols_array_2d(&[0, 1, 2].map(|row| vector(&camera["start_R_world_from_cam"][row]).to_array()))
                .transpose(),
            fov_x_rad: std::f64::consts::FRAC_PI_3,
            aspect: 4.0 / 3.0,
        };
        let walk = |(i, camera): (usize, &Value)| {
            let trajectory = Npz::new(&read(&format!("cam_{i:02}/trajectory.npz")));
            let rows = |name: &str| trajectory.f64(name);
            Walk {
                peer_s: cpu_s(&camera["run"]),
                positions: rows("positions").chunks_exact(3).map(DVec3::from_slice).collect(),
                orientations: rows("R_world_from_cam").chunks_exact(9).map(|m| DMat3::from_cols_slice(m).transpose()).collect(),
                valid_share: rows("valid_fraction"),
                triangles: trajectory.i64("unique_prims").into_iter().map(|n| n as f64).collect(),
            }
        };
        let python = stats["python"].as_object().expect("times by step");
        Self {
            name,
            world: WorldMesh { corners, sources, bounds, contrasts },
            starts: cameras.iter().enumerate().map(start).collect(),
            octomap: read("octomap.bt"),
            carve_positions: stats["carve_positions"].as_array().expect("a list").iter().flat_map(carved_from).collect(),
            peer_carve_s: [cpu_s(&stats["octomap_run"]), python.values().map(number).sum()],
            walks: cameras.iter().enumerate().map(walk).collect(),
        }
    }

    pub fn start_positions(&self) -> Vec<DVec3> {
        self.starts.iter().map(|start| start.position).collect()
    }

    /// The free space that the programs found.
    pub fn free_space(&self) -> FreeSpace {
        let tree = OccupancyTree::from_bt(&self.octomap).expect("an octree of OctoMap's");
        FreeSpace::new(tree, CarveReport::default()).expect("some of it is free")
    }
}

/// All positions of one start but the last, from which nothing was carved.
fn carved_from(positions: &Value) -> Vec<DVec3> {
    let positions = positions.as_array().expect("a list");
    positions[..positions.len() - 1].iter().map(vector).collect()
}

fn vector(v: &Value) -> DVec3 {
    DVec3::from([0, 1, 2].map(|a| number(&v[a])))
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("expected a number, found {v}"))
}

//! Rooms of boxes, and homes that several scenes share.

use enfilade_dataset::Dataset;
use enfilade_home::{HomeConfig, RoomKind, home};
use enfilade_pipeline::{Config, FlowPairs, FrameChoice, MakeOptions, PairsRequest, Request, Silent, make, run};
use enfilade_scene::{Quiet, to_bytes_with_labels};
use enfilade_verify::{VerifyReport, verify_scene};
use std::fmt::Write;
use std::path::Path;

/// A box that is named as its material.
pub struct Block {
    pub material: &'static str,
    /// Metres, z up.
    pub min: [f64; 3],
    pub max: [f64; 3],
    pub color: [f64; 3],
    /// Radiance.
    pub glow: [f64; 3],
}

/// A closed room of 4 x 3 x 2.5 m.
pub const WALL: Block = block("wall", [-2.0, -1.5, 0.0], [2.0, 1.5, 2.5], [0.7, 0.7, 0.7]);
/// A table in it.
pub const TABLE: Block = block("table", [-0.9, 0.6, 0.0], [0.3, 1.2, 0.7], [0.4, 0.25, 0.1]);
/// A lamp below its ceiling.
pub const LAMP: Block = Block { glow: [12.0, 11.0, 10.0], ..block("lamp", [-0.3, -0.3, 2.3], [0.3, 0.3, 2.4], [0.0; 3]) };

pub const fn block(material: &'static str, min: [f64; 3], max: [f64; 3], color: [f64; 3]) -> Block {
    Block { material, min, max, color, glow: [0.0; 3] }
}

/// Writes `room.obj` and `room.mtl`. The first block is seen from within, the others from without.
pub fn write_blocks(folder: &Path, blocks: &[Block]) {
    let (mut obj, mut mtl) = ("mtllib room.mtl\n".to_string(), String::new());
    for (number, Block { material, min, max, color, glow }) in blocks.iter().enumerate() {
        writeln!(obj, "o {material}\nusemtl {material}").unwrap();
        for i in 0..8 {
            let [x, y, z] = [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { min[axis] } else { max[axis] });
            writeln!(obj, "v {x} {y} {z}").unwrap();
        }
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let mut corners = face.map(|i| (8 * number + i + 1).to_string());
            if number == 0 {
                corners.reverse();
            }
            writeln!(obj, "f {}", corners.join(" ")).unwrap();
        }
        let [color, glow] = [color, glow].map(|rgb| rgb.map(|v| v.to_string()).join(" "));
        writeln!(mtl, "newmtl {material}\nKd {color}\nKe {glow}").unwrap();
    }
    std::fs::write(folder.join("room.obj"), obj).unwrap();
    std::fs::write(folder.join("room.mtl"), mtl).unwrap();
}

/// Writes `home.scene`, a home that is one living room; several scenes of a test take less time to read it than to make it each.
pub fn write_home(folder: &Path, seed: u64) {
    let made = home(&HomeConfig { seed, rooms: vec![RoomKind::Living], ..HomeConfig::default() });
    std::fs::write(folder.join("home.scene"), to_bytes_with_labels(&made.scene, &made.labels)).unwrap();
}

/// Makes a dataset of which no scene fails.
pub fn assert_made(config: &Config, out: &Path) {
    let summary = run(config, out, None, &Silent).unwrap();
    let failures: Vec<_> = summary.scenes.iter().filter_map(|s| s.failure.as_ref().map(|f| (&s.name, &f.message))).collect();
    assert!(summary.ok(), "{failures:?}");
}

/// Makes every relation between the frames of a scene, all of which agree with its stored distances, parts and poses.
pub fn assert_related(dataset: &Dataset, scene: &str) -> VerifyReport {
    let requests = [
        Request::Flow { pairs: FlowPairs::Step(1), cameras: None },
        Request::Flow { pairs: FlowPairs::Step(-1), cameras: None },
        Request::Tracks { points: 64, seed: 0, of: FrameChoice::default() },
        Request::Pairs(PairsRequest::default()),
        Request::Surfaces { layers: 3, of: FrameChoice::default() },
    ];
    make(dataset, &[scene.into()], &requests, MakeOptions::default(), &Quiet).unwrap();
    let report = verify_scene(dataset, scene, &Quiet).unwrap();
    assert_eq!(report.failures().map(|law| format!("{:?} {:?}", law.law, law.worst)).collect::<Vec<_>>(), Vec::<String>::new());
    report
}

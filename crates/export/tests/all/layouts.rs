//! The structure of buildings, exported and read back: Structured3D's files by our importer, which is made from its own description.

use crate::common::write;
use enfilade_dataset::Dataset;
use enfilade_export::{Existing, ExportConfig, Format, export};
use enfilade_home::{FloorPlan, RoomKind};
use enfilade_import::{ImportOptions, load};
use enfilade_math::{Rng, Vec3};
use enfilade_scene::{Part, Quiet, Scene, Structure};
use std::path::{Path, PathBuf};

fn home(seed: u64) -> Structure {
    FloorPlan::new(&[RoomKind::Living, RoomKind::Kitchen, RoomKind::Hall, RoomKind::Bathroom], &Rng::new(seed)).structure()
}

fn exported(folder: &Path, format: Format, structure: Option<&Structure>) -> Result<PathBuf, String> {
    let dataset: Dataset = write(&folder.join("dataset"), &crate::common::pinhole());
    let layout = dataset.layout();
    match structure {
        Some(structure) => dataset.write_structure("room", structure).unwrap(),
        None => std::fs::remove_file(layout.structure("room")).unwrap(),
    }
    let out = folder.join("out");
    let config = ExportConfig::new(format, vec!["room".into()]);
    export(&dataset, &config, &out, Existing::Refuse, &Quiet).map(|_| out).map_err(|error| error.to_string())
}

/// Area of the floors, and of the walls without what opens in them.
fn areas(structure: &Structure) -> [f64; 2] {
    let holes: f64 = structure.openings.iter().map(|o| o.walls.len() as f64 * o.size_m().iter().product::<f64>()).sum();
    let walls: f64 = structure.walls.iter().map(|wall| wall.length_m() * (wall.ceiling_z_m - wall.floor_z_m)).sum();
    [structure.rooms.iter().map(|room| room.area_m2()).sum(), walls - holes]
}

fn area(scene: &Scene, part: &Part) -> f64 {
    let corners: Vec<Vec3> = scene.world_positions(part).collect();
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| corners[i as usize].as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    };
    scene.meshes[part.mesh as usize].triangles.iter().map(of).sum()
}

#[test]
fn structured3ds_planes_have_the_areas_of_the_home_and_face_into_its_rooms() {
    for seed in [3, 4] {
        let structure = home(seed);
        let folder = tempfile::tempdir().unwrap();
        let out = exported(folder.path(), Format::Structured3d, Some(&structure)).unwrap();
        let imported = load(&out.join("room/annotation_3d.json"), &ImportOptions::default(), &Quiet).unwrap();
        let mut found = [0.0; 2];
        for label in imported.labels.iter().flatten() {
            let part = &imported.scene.parts[label.part as usize];
            let place = match label.label.semantic {
                2 => 0,
                1 => 1,
                _ => continue, // reveals
            };
            found[place] += area(&imported.scene, part);
        }
        let expected = areas(&structure);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3 * expected, "seed {seed}: {found} m2, expected {expected}");
        }
    }
}

#[test]
fn a_scene_without_a_layout_is_refused_by_name() {
    for format in [Format::Spatiallm, Format::Structured3d] {
        let folder = tempfile::tempdir().unwrap();
        let message = exported(folder.path(), format, None).unwrap_err();
        assert!(message.contains("room") && message.contains("_detail/layout.json"), "{message}");
    }
}

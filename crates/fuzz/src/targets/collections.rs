//! Scenes of collections, in a folder that has what they refer to, and the files that those scenes are made of.

use crate::{Run, seeds};
use enfilade_import::{ImportOptions, load};
use enfilade_scene::Quiet;
use std::path::Path;

const MODEL: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
/// A scene of Habitat that has something of everything.
const SCENE: &str = include_str!("../../seeds/collections/habitat.json");
const DATASET: &str = include_str!("../../seeds/collections/dataset.json");
const HOUSE: &str = include_str!("../../seeds/collections/scan.house");
const TEXT: &str = include_str!("../../seeds/collections/scan.txt");
const MESH: &str = include_str!("../../seeds/collections/mesh.ply");
const URDF: &str = include_str!("../../seeds/collections/cabinet.urdf");

/// The valid files of a collection; one of them is replaced by the input.
const COMPANIONS: [(&str, &str); 13] = [
    ("all.scene_dataset_config.json", DATASET),
    ("model.object_config.json", r#"{"render_asset": "model.obj", "semantic_id": 1, "COM": [0, 1, 0]}"#),
    ("model.obj", MODEL),
    ("day.lighting_config.json", r#"{"lights": {"a": {"type": "spot", "position": [1, 2, 3], "spot": {"outerConeAngle": 1}}}}"#),
    ("lexicon.json", r#"{"classes": [{"id": 1, "name": "chair"}]}"#),
    ("cabinet.urdf", URDF),
    ("scan.house", HOUSE),
    ("scan.semantic.txt", TEXT),
    ("scan_semantic.ply", MESH),
    ("3D-FUTURE-model/model/raw_model.obj", MODEL),
    ("models/model.obj", MODEL),
    ("asset-database.json", r#"{"Sofa": [{"assetId": "boxed", "boundingBox": {"x": 1, "y": 1, "z": 1}, "objectType": "Sofa"}]}"#),
    ("scene.scene_instance.json", SCENE),
];

/// The file that bytes are, and the scene to import then, by how they begin.
fn of(bytes: &[u8]) -> (&'static str, &'static str) {
    let begins = |start: &str| bytes.starts_with(start.as_bytes());
    match () {
        () if begins("ASCII") || begins("H ") => ("scan.house", "scan.house"),
        () if begins("HM3D") => ("scan.semantic.txt", "scan.semantic.txt"),
        () if begins("ply") => ("scan_semantic.ply", "scan.house"),
        () if begins("<") => ("cabinet.urdf", "scene.scene_instance.json"),
        () if bytes.windows(20).take(64).any(|w| w == b"scene_dataset_config") => {
            ("all.scene_dataset_config.json", "scene.scene_instance.json")
        }
        () => ("given.json", "given.json"),
    }
}

/// Imports what the bytes are, or the scene that they are part of.
pub fn scene(folder: &Path) -> Run {
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().expect("a parent")).expect("a folder that can be written");
        std::fs::write(path, bytes).expect("a folder that can be written");
    };
    COMPANIONS.iter().for_each(|(name, text)| write(name, text.as_bytes()));
    write("scan.semantic.glb", &seeds::gltf().swap_remove(1).bytes);
    write("mesh_semantic.ply", MESH.as_bytes());
    let folder = folder.to_path_buf();
    let options = ImportOptions { allow_missing_textures: true, allow_missing_meshes: true, ..ImportOptions::default() };
    Box::new(move |bytes| {
        let (file, scene) = of(bytes);
        std::fs::write(folder.join(file), bytes).expect("a folder that can be written");
        if let Ok(imported) = load(&folder.join(scene), &options, &Quiet) {
            imported.scene.validate().expect("an imported scene is valid");
        }
        let right = COMPANIONS.iter().find(|(name, _)| *name == file);
        right.into_iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).expect("a folder that can be written"));
    })
}

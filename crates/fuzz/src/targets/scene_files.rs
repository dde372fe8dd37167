//! Scene files, imported from a folder that has all that they may refer to.

use crate::{Run, seeds};
use enfilade_import::{ImportOptions, load};
use enfilade_scene::Quiet;
use std::path::Path;

/// The files beside a scene file: each is small and valid.
fn companions() -> Vec<(&'static str, Vec<u8>)> {
    let text = |text: &str| text.as_bytes().to_vec();
    let first = |of: fn() -> Vec<crate::Seed>| of().swap_remove(0).bytes;
    vec![
        ("scene.mtl", text("newmtl wood\nKd 0.5 0.4 0.3\nmap_Kd texture.png\n")),
        ("texture.png", first(seeds::pictures)),
        ("mesh.ply", first(seeds::ply)),
        ("mesh.serialized", first(seeds::serialized)),
        ("mesh.obj", text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
        ("lamp.ies", text(include_str!("../../seeds/ies/lamp.ies"))),
        ("with_mtl.obj", text("mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl wood\nf 1/1 2/1 3/1\nusemtl glass\nf 1 3 2\n")),
        ("with_picture.obj", text("mtllib with_picture.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n")),
        ("with_picture.mtl", text("newmtl a\nmap_Kd picture.tga\n")),
        ("with_ply.xml", text("<scene><shape type=\"ply\"><string name=\"filename\" value=\"mesh.ply\"/></shape></scene>")),
        ("with_serialized.xml", text(SERIALIZED)),
        ("with_ies.gltf", seeds::with_profile()),
    ]
}

const SERIALIZED: &str = "<scene><shape type=\"serialized\"><string name=\"filename\" value=\"mesh.serialized\"/>\
    <integer name=\"shapeIndex\" value=\"1\"/></shape></scene>";

/// Imports `scene` with `file` made of the bytes.
pub fn prepare(folder: &Path, file: &str, scene: &str) -> Run {
    for (name, bytes) in companions() {
        std::fs::write(folder.join(name), bytes).expect("a folder that can be written");
    }
    let (file, scene) = (folder.join(file), folder.join(scene));
    let options = ImportOptions { allow_missing_textures: true, allow_missing_meshes: true, ..ImportOptions::default() };
    Box::new(move |bytes| {
        std::fs::write(&file, bytes).expect("a folder that can be written");
        if let Ok(imported) = load(&scene, &options, &Quiet) {
            imported.scene.validate().expect("an imported scene is valid");
        }
    })
}

/// A model whose joints the runs move.
const JOINTED: &str = "<mujoco><worldbody><body name=\"a\"><freejoint name=\"f\"/><geom size=\"1\"/><body name=\"b\"><joint name=\"h\"/>\
    <geom size=\"1\"/></body></body><body name=\"m\" mocap=\"true\"><geom size=\"1\"/></body></worldbody></mujoco>";

/// Imports a model that moves by the bytes: an archive of arrays, or else a table.
pub fn states(folder: &Path) -> Run {
    let scene = folder.join("scene.mjcf");
    std::fs::write(&scene, JOINTED).expect("a folder that can be written");
    let [archive, table] = ["run.npz", "run.csv"].map(|name| folder.join(name));
    Box::new(move |bytes| {
        let file = if bytes.starts_with(b"PK") { &archive } else { &table };
        std::fs::write(file, bytes).expect("a folder that can be written");
        let options = ImportOptions { states: Some(file.clone()), ..ImportOptions::default() };
        if let Ok(imported) = load(&scene, &options, &Quiet) {
            imported.scene.validate().expect("an imported scene is valid");
        }
    })
}

/// Imports an archive; other bytes as the glTF within one that is right, since searching would never find an archive's checksums.
pub fn archive(folder: &Path) -> Run {
    let file = folder.join("scene.zip");
    let options = ImportOptions { allow_missing_textures: true, allow_missing_meshes: true, ..ImportOptions::default() };
    Box::new(move |bytes| {
        let archive = match bytes.starts_with(b"PK") {
            true => bytes.to_vec(),
            false => seeds::zip(&[("pack/scene.gltf", bytes), ("pack/textures/a.png", b"")]),
        };
        std::fs::write(&file, archive).expect("a folder that can be written");
        if let Ok(imported) = load(&file, &options, &Quiet) {
            imported.scene.validate().expect("an imported scene is valid");
        }
    })
}

/// The line that a package begins with.
const MAGIC: &[u8] = b"enfilade scene 4\n";

/// Reads packages. Bytes that do not begin like one are the body of one whose checksum is right, which searching would never find.
pub fn package(_: &Path) -> Run {
    Box::new(|bytes| {
        let whole = match bytes.starts_with(MAGIC) {
            true => bytes.to_vec(),
            false => [MAGIC, blake3::hash(bytes).as_bytes(), bytes].concat(),
        };
        if let Ok((scene, labels)) = enfilade_scene::from_bytes_with_labels(&whole) {
            scene.validate().expect("a scene of a package is valid");
            assert!(labels.is_none_or(|labels| labels.parts.len() == scene.parts.len()), "as many labels as parts");
        }
    })
}

//! Skeletons, blend shapes and sampled points of USD, against what Pixar's own library makes of them (`usd/make.py`).

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::Vec3;
use enfilade_scene::{BodyStates, Scene};
use serde_json::Value;
use std::path::Path;

fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/usd").join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn load(file: &str) -> Imported {
    let folder = Folder::new();
    folder.write(file, fixture(file));
    folder.load(file).unwrap_or_else(|e| panic!("{e}"))
}

fn vectors(values: &Value) -> Vec<Vec3> {
    let vector = |v: &Value| Vec3::from_array(std::array::from_fn(|i| v[i].as_f64().unwrap() as f32));
    values.as_array().unwrap().iter().map(vector).collect()
}

/// The vertices and unit normals of a part at a moment.
fn shape(scene: &Scene, name: &str, time_s: f64) -> (Vec<Vec3>, Vec<Vec3>) {
    let there = scene.at(time_s);
    let part = there.parts.iter().find(|part| part.name == name).unwrap_or_else(|| panic!("no {name}"));
    let turned = part.world_from_mesh.matrix3.inverse().transpose();
    let normals = there.meshes[part.mesh as usize].normals.iter().map(|n| (turned * n.as_dvec3()).normalize().as_vec3());
    (there.world_positions(part).collect(), normals.collect())
}

/// Each of these is near one of those.
fn assert_among(found: &[Vec3], expected: &[Vec3], what: &str) {
    for v in found {
        let off = expected.iter().map(|e| e.distance(*v)).fold(f32::INFINITY, f32::min);
        assert!(off < 2e-4, "{what}: {v} is {off} from the nearest of {expected:?}");
    }
    assert!(found.len() >= expected.len(), "{what}");
}

#[test]
fn meshes_bend_as_pixars_library_has_them() {
    let expected: Value = serde_json::from_slice(&fixture("bending.json")).unwrap();
    for file in ["bending.usda", "bending.usdc"] {
        let imported = load(file);
        let scene = &imported.scene;
        let told = warnings(&imported);
        assert!(told.contains("2 things move by them, 1 s from time code 0 on") && !told.contains("changes with time"), "{told}");
        assert!(scene.bodies.iter().all(|body| matches!(body.motion.states, BodyStates::Deform { .. })));
        for (name, moments) in expected.as_object().unwrap() {
            for moment in moments.as_array().unwrap() {
                let code = moment["code"].as_f64().unwrap();
                let (positions, normals) = shape(scene, name, code / 24.0);
                let what = format!("{file} {name} at {code}");
                assert_among(&positions, &vectors(&moment["points"]), &what);
                let stated = vectors(&moment["normals"]);
                if !stated.is_empty() {
                    assert_among(&normals, &stated, &what);
                }
            }
        }
    }
}

/// The cloth of the fixture with other text in it.
fn changed(from: &str, to: &str) -> Imported {
    let text = String::from_utf8(fixture("bending.usda")).unwrap();
    assert!(text.contains(from), "{from}");
    let folder = Folder::new();
    folder.write("a.usda", text.replace(from, to));
    folder.load("a.usda").unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn what_makes_no_sense_rests_and_is_told() {
    for (from, to, expected) in [
        ("int[] primvars:skel:jointIndices = [0, 1,", "int[] primvars:skel:jointIndices = [7, 1,", "found joint 7"),
        ("float[] primvars:skel:jointWeights = [1, 0,", "float[] primvars:skel:jointWeights = [1,", "36 jointIndices, but 35 jointWeights"),
        ("def Skeleton \"Bones\"", "def Scope \"Bones\"", "its skeleton </World/Person/Rig/Bones> is not there"),
        ("quatf[] rotations.timeSamples", "quatf[] turns.timeSamples", "not one translation, rotation and scale for each of its joints"),
        ("pointIndices = [6, 7, 8]", "pointIndices = [6, 7, 99]", "its offsets do not fit the 18 points"),
    ] {
        let imported = changed(from, to);
        let told = warnings(&imported);
        assert!(told.contains(expected), "{told}");
        assert_eq!(imported.scene.parts.len(), 2, "{told}");
    }
    // Faces that change cannot be followed.
    let imported = changed(
        "int[] faceVertexCounts = [4, 4, 4, 4]\n",
        "int[] faceVertexCounts.timeSamples = { 0: [4, 4, 4, 4], 8: [4, 4, 4, 4, 4] }\n",
    );
    assert!(warnings(&imported).contains("</World/Cloth>.faceVertexCounts") || warnings(&imported).contains("changes with time"));
    assert_eq!(imported.scene.bodies.len(), 1, "{}", warnings(&imported));
}

//! Compressed glTF by the encoders of other programs (`tests/gltf/make.mjs`): every vertex is at the position that its texture coordinates
//! encode.

use crate::common::{Folder, Gltf, principled, warnings};
use enfilade_geometry::Mesh;
use enfilade_import::Imported;
use enfilade_math::{DVec3, Rgb, Vec2, Vec3};
use serde_json::{Value, json};
use std::f32::consts::TAU;

/// Quads around and across the ring.
const QUADS: usize = 24 * 11;

fn load(bytes: &[u8]) -> Imported {
    Folder::new().write("a.glb", bytes).load("a.glb").unwrap_or_else(|e| panic!("{e}"))
}

/// Place and normal of the ring, as `make.mjs` has them; v of the scene points up.
fn at(uv: Vec2) -> (Vec3, Vec3) {
    let (a, b) = (TAU * uv.x, TAU * (1.0 - uv.y));
    let normal = Vec3::new(a.cos() * b.cos(), a.sin() * b.cos(), b.sin());
    (2.0 * Vec3::new(a.cos(), a.sin(), 0.0) + 0.5 * normal, normal)
}

/// Largest distance of a vertex, and largest difference of a normal, from the ring's own.
fn errors(imported: &Imported) -> (f64, f32) {
    let (scene, mesh) = (&imported.scene, &imported.scene.meshes[0]);
    let mut worst = (0.0f64, 0.0f32);
    for ((p, n), uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs) {
        let (place, normal) = at(*uv);
        // The file's y is up, the scene's z.
        let up = |v: Vec3| Vec3::new(v.x, -v.z, v.y);
        let world = scene.parts[0].world_from_mesh.transform_point3(p.as_dvec3());
        worst.0 = worst.0.max(world.distance(up(place).as_dvec3()));
        let world = (scene.parts[0].world_from_mesh.matrix3 * n.as_dvec3()).normalize().as_vec3();
        worst.1 = worst.1.max(world.distance(up(normal)));
    }
    worst
}

/// True when each triangle's front is where its normals point.
fn is_wound(mesh: &Mesh) -> bool {
    mesh.triangles.iter().all(|t| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).dot(mesh.normals[t[0] as usize]) > 0.0
    })
}

#[test]
fn compressed_meshes_are_the_ring_they_were_made_from() {
    let uv_step = |bits: i32| TAU * 2.5 / 2f32.powi(bits);
    for (name, bytes, place_m, normal) in [
        // Quantized: positions to 14 bits of 5 units, coordinates to 12 bits, normals to 10 bits.
        ("edgebreaker", &include_bytes!("../gltf/draco_edgebreaker.glb")[..], uv_step(12), 0.01),
        ("valence", include_bytes!("../gltf/draco_valence.glb"), uv_step(12), 0.01),
        ("sequential", include_bytes!("../gltf/draco_sequential.glb"), uv_step(12), 0.01),
        // Coordinates to 16 bits, normals to 8 bits.
        ("meshopt 0", include_bytes!("../gltf/meshopt_ext.glb"), uv_step(16), 0.02),
        // Positions to 15 bits, normals to 12 bits.
        ("meshopt 1", include_bytes!("../gltf/meshopt_khr.glb"), 3e-4, 2e-3),
    ] {
        let imported = load(bytes);
        let (mesh, told) = (&imported.scene.meshes[0], warnings(&imported));
        assert_eq!(mesh.triangles.len(), 2 * QUADS, "{name}");
        assert!((12 * 25..12 * 25 + 60).contains(&mesh.positions.len()), "{name} {}", mesh.positions.len());
        let (far, bent) = errors(&imported);
        assert!(far < f64::from(place_m) && bent < normal, "{name}: {far} m, {bent}");
        assert!(is_wound(mesh), "{name}");
        assert_eq!(told, "", "{name}");
        let color = principled(&imported.scene.materials[0].bsdf).base_color.factor;
        let expected = Rgb::new(0.2, 0.4, 0.8);
        // One step of eight bits.
        assert!((color - expected).to_array().iter().all(|d| d.abs() < 0.004), "{name} {color:?}");
    }
}

#[test]
fn filtered_rotations_place_instances() {
    let imported = load(include_bytes!("../gltf/meshopt_khr.glb"));
    let fronts: Vec<DVec3> = imported.scene.parts.iter().map(|p| p.world_from_mesh.matrix3 * DVec3::Z).collect();
    // The second is turned by a quarter around the file's y: its z points along x.
    assert!(fronts.len() == 2 && fronts[0].distance(-DVec3::Y) < 1e-3 && fronts[1].distance(DVec3::X) < 1e-3, "{fronts:?}");
}

/// The JSON and the binary chunk of a `.glb`.
fn split(glb: &[u8]) -> (Value, &[u8]) {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    (serde_json::from_slice(&glb[20..20 + length]).unwrap(), &glb[28 + length..])
}

/// A `.gltf` of this JSON, its first buffer in a file beside it.
fn with_buffer(mut json: Value, binary: &[u8]) -> Folder {
    let folder = Folder::new();
    json["buffers"][0]["uri"] = json!("a.bin");
    folder.write("a.gltf", json.to_string()).write("a.bin", binary);
    folder
}

#[test]
fn damaged_packed_data_are_errors_that_name_their_place() {
    for (glb, place) in [
        (
            &include_bytes!("../gltf/draco_edgebreaker.glb")[..],
            "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: it cannot be",
        ),
        (include_bytes!("../gltf/meshopt_ext.glb"), "accessors[0]: bufferViews[0].extensions.EXT_meshopt_compression begins with"),
    ] {
        let (json, binary) = split(glb);
        let mut damaged = binary.to_vec();
        damaged[..5].fill(b'x');
        let error = with_buffer(json, &damaged).error("a.gltf");
        assert!(error.contains(place) && error.contains("export"), "{error}");
    }
    let (mut json, binary) = split(include_bytes!("../gltf/meshopt_ext.glb"));
    json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = json!(1u64 << 40);
    let error = with_buffer(json.clone(), binary).error("a.gltf");
    assert!(error.contains("would unpack") && error.contains("expected at most"), "{error}");
    json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteStride"] = json!(6);
    let error = with_buffer(json, binary).error("a.gltf");
    assert!(error.contains("has a byteStride of 6, expected a multiple of 4 up to 256 for Attributes"), "{error}");
}

#[test]
fn plain_data_stand_in_for_damaged_packed_ones() {
    let mut g = Gltf::triangle();
    g.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    g.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    let plain = Folder::new().write("a.gltf", Gltf::triangle().text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene, plain.scene);
    let told = warnings(&imported);
    assert!(told.contains("primitives[0].extensions.KHR_draco_mesh_compression: it cannot be decoded"), "{told}");
    assert!(told.contains("the plain data of the file were used"), "{told}");

    let mut g = Gltf::triangle();
    let packed = json!({"buffer": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"});
    g.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": packed});
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene, plain.scene);
    assert!(warnings(&imported).contains("begins with Some(00), expected a0 or a1 for attributes"), "{}", warnings(&imported));
}

#[test]
fn plain_twins_in_missing_files_are_not_asked_for() {
    let (mut json, binary) = split(include_bytes!("../gltf/meshopt_ext.glb"));
    json["buffers"][1]["uri"] = json!("not there.bin");
    let imported = with_buffer(json, binary).load("a.gltf").unwrap();
    assert!(errors(&imported).0 < 1e-3);
}

/// A cloud of points has no triangles: those of the file are used, and as points it has no surface.
#[test]
fn primitives_of_points_are_left_out_whatever_packs_them() {
    let (mut json, binary) = split(include_bytes!("../gltf/draco_edgebreaker.glb"));
    json["meshes"][0]["primitives"][0]["mode"] = json!(0);
    let mut more = Gltf::triangle().json["meshes"][0]["primitives"][0].clone();
    more["attributes"] = json!({"POSITION": 5});
    more.as_object_mut().unwrap().remove("indices");
    json["accessors"].as_array_mut().unwrap().push(json!({"componentType": 5126, "type": "VEC3", "count": 3,
        "sparse": {"count": 2, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}}));
    let values = [1.0f32, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    let start = binary.len();
    for (at, length) in [(start, 2), (start + 4, 24)] {
        json["bufferViews"].as_array_mut().unwrap().push(json!({"buffer": 0, "byteOffset": at, "byteLength": length}));
    }
    json["meshes"][0]["primitives"].as_array_mut().unwrap().push(more);
    let folder = with_buffer(json, &[binary, &[1, 2, 0, 0], &values].concat());
    let imported = folder.load("a.gltf").unwrap();
    assert_eq!((imported.scene.meshes.len(), imported.scene.meshes[0].triangles.len()), (1, 1));
    assert!(warnings(&imported).contains("points and lines have no surface"), "{}", warnings(&imported));
}

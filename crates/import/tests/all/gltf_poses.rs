//! Skins and morph targets in the pose that the file states.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::Imported;
use enfilade_math::{DVec3, Vec3};
use serde_json::{Value, json};

fn floats(g: &mut Gltf, values: &[f32], kind: &str, count: usize) -> usize {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    g.accessor(&bytes, 5126, kind, count)
}

fn attribute(g: &mut Gltf, name: &str, accessor: usize) {
    g.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
}

/// The triangle bound to two nodes by joints and weights, four of each a vertex; its node is elsewhere.
fn skinned(joints: [[u8; 4]; 3], weights: [[f32; 4]; 3], nodes: [Value; 2]) -> Gltf {
    let mut g = Gltf::triangle();
    let accessor = g.accessor(joints.as_flattened(), 5121, "VEC4", 3);
    attribute(&mut g, "JOINTS_0", accessor);
    let accessor = floats(&mut g, weights.as_flattened(), "VEC4", 3);
    attribute(&mut g, "WEIGHTS_0", accessor);
    let [first, second] = nodes;
    g.json["nodes"] = json!([{"name": "Coat", "mesh": 0, "skin": 0, "translation": [100, 0, 0], "scale": [-1, 1, 1]}, first, second]);
    g.json["scenes"] = json!([{"nodes": [0, 1]}]);
    g.json["skins"] = json!([{"joints": [1, 2]}]);
    g
}

/// Two joints, of which the second is a child of the first and twice as large.
fn two_joints() -> Gltf {
    let weights = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.25, 0.25, 0.0, 0.0]];
    let nodes = [json!({"translation": [1, 0, 0], "children": [2]}), json!({"scale": [2, 2, 2]})];
    // A joint of weight zero need not exist.
    let mut g = skinned([[0, 1, 9, 9]; 3], weights, nodes);
    let mut inverse_binds = [0.0f32; 32];
    (0..4).for_each(|i| (inverse_binds[5 * i], inverse_binds[16 + 5 * i]) = (1.0, 1.0));
    inverse_binds[16 + 13] = -1.0;
    let accessor = floats(&mut g, &inverse_binds, "MAT4", 2);
    g.json["skins"][0]["inverseBindMatrices"] = json!(accessor);
    g
}

fn load(g: &Gltf) -> Imported {
    Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap()
}

fn error(g: &Gltf) -> String {
    Folder::new().write("a.gltf", g.text()).error("a.gltf")
}

#[test]
fn skins_stand_where_their_joints_take_them_whatever_their_own_node_does() {
    let imported = load(&two_joints());
    assert_eq!(warnings(&imported), "");
    let mesh = &imported.scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::new(1.0, 0.0, 0.0), Vec3::new(3.0, -2.0, 0.0), Vec3::new(1.0, 0.5, 0.0)]);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(imported.scene.parts[0].world_from_mesh.transform_point3(DVec3::Y), DVec3::Z);
}

#[test]
fn normals_follow_the_inverse_transpose_and_mirrored_faces_keep_their_fronts() {
    let mut g = skinned([[0; 4]; 3], [[1.0, 0.0, 0.0, 0.0]; 3], [json!({"scale": [2, 1, -1]}), json!({})]);
    let normal = Vec3::new(1.0, 1.0, 1.0).normalize().to_array();
    let accessor = floats(&mut g, &normal.repeat(3), "VEC3", 3);
    attribute(&mut g, "NORMAL", accessor);
    let imported = load(&g);
    let mesh = &imported.scene.meshes[0];
    let expected = Vec3::new(0.5, 1.0, -1.0).normalize();
    assert!(mesh.normals.iter().all(|n| (*n - expected).length() < 1e-6), "{:?}", mesh.normals);
    assert_eq!((mesh.positions[1], mesh.triangles[0]), (Vec3::new(2.0, 0.0, 0.0), [0, 2, 1]));
}

#[test]
fn eight_joints_come_in_two_sets_and_small_numbers() {
    let mut g = skinned([[0; 4]; 3], [[0.5, 0.0, 0.0, 0.0]; 3], [json!({}), json!({"translation": [0, 0, 4]})]);
    let joints = g.accessor(&[1u16, 0, 0, 0].repeat(3).into_iter().flat_map(u16::to_le_bytes).collect::<Vec<u8>>(), 5123, "VEC4", 3);
    attribute(&mut g, "JOINTS_1", joints);
    let weights = g.accessor(&[255u8, 0, 0, 0].repeat(3), 5121, "VEC4", 3);
    g.json["accessors"][weights]["normalized"] = json!(true);
    attribute(&mut g, "WEIGHTS_1", weights);
    let z = load(&g).scene.meshes[0].positions[0].z;
    assert!((z - 4.0 / 1.5).abs() < 1e-6, "{z}");
}

#[test]
fn one_mesh_may_have_several_skins_or_none() {
    let mut g = two_joints();
    g.json["skins"].as_array_mut().unwrap().push(json!({"joints": [2, 1]}));
    let nodes = g.json["nodes"].as_array_mut().unwrap();
    nodes.extend([json!({"mesh": 0, "skin": 1}), json!({"mesh": 0}), json!({"mesh": 0, "skin": 0})]);
    g.json["scenes"] = json!([{"nodes": [0, 1, 3, 4, 5]}]);
    let scene = load(&g).scene;
    let meshes: Vec<u32> = scene.parts.iter().map(|part| part.mesh).collect();
    assert_eq!(meshes, [0, 1, 2, 0]);
    assert_eq!(scene.meshes[2].positions[1], Vec3::X);
}

#[test]
fn what_is_unbound_is_told() {
    let mut g = skinned([[1; 4]; 3], [[0.0; 4]; 3], [json!({}), json!({"translation": [0, 0, 4]})]);
    let imported = load(&g);
    assert_eq!(imported.scene.meshes[0].positions[1], Vec3::new(1.0, 0.0, 4.0));
    assert!(warnings(&imported).contains("3 vertices have no weights; they follow the first joint they name"));
    let attributes = g.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap();
    attributes.retain(|name, _| !name.ends_with("S_0"));
    let imported = load(&g);
    assert!(warnings(&imported).contains("neither joints nor weights; it is placed by the node"));
    assert_eq!(imported.scene.parts[0].world_from_mesh.translation.x, 100.0);
}

#[test]
fn damaged_skins_are_errors() {
    let change = |change: &dyn Fn(&mut Gltf)| {
        let mut g = two_joints();
        change(&mut g);
        error(&g)
    };
    let expect = |found: String, expected: &str| assert!(found.contains(expected), "{found}");
    expect(change(&|g| g.json["nodes"][0]["skin"] = json!(3)), "nodes[0]: it refers to skin 3, but there are only 1");
    expect(change(&|g| g.json["skins"][0]["joints"] = json!([1, 7])), "skins[0].joints: it refers to node 7, but there are only 3");
    let one = change(&|g| g.json["skins"][0]["joints"] = json!([1]));
    expect(one, "primitives[0].attributes.JOINTS_0: found joint 1 at vertex 1, expected one of the 1 of the skin");
    expect(change(&|g| g.json["skins"][0]["joints"] = json!([1, 2, 1])), "skins[0].inverseBindMatrices: found 2 matrices, expected 3");
    let kind = change(&|g| g.json["skins"][0]["inverseBindMatrices"] = json!(0));
    expect(kind, "accessors[0] holds 3 components an element, expected 16");
    let missing = change(&|g| drop(g.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("WEIGHTS_0")));
    expect(missing, "attributes: expected both JOINTS_0 and WEIGHTS_0");
    expect(change(&|g| g.json["accessors"][3]["count"] = json!(2)), "attributes.JOINTS_0: found 2 of them, expected 3, one a vertex");
    expect(change(&|g| g.json["accessors"][4]["count"] = json!(1u64 << 60)), "the file is damaged");
    expect(change(&|g| attribute(g, "JOINTS_0", 4)), "attributes.JOINTS_0: found joint 0.25 at vertex 2");
    expect(change(&|g| g.json["nodes"][2]["children"] = json!([1])), "node 1 is its own ancestor");

    for bad in [f32::NAN, f32::INFINITY, -0.5] {
        let g = skinned([[0; 4]; 3], [[bad, 1.0, 0.0, 0.0]; 3], [json!({}), json!({})]);
        expect(error(&g), &format!("attributes.WEIGHTS_0: found {bad} at vertex 0, expected 0 to 1"));
    }
    let nodes = [json!({"scale": [1e38, 1, 1], "children": [2]}), json!({"scale": [1e38, 1, 1]})];
    let far = skinned([[1; 4]; 3], [[1.0, 0.0, 0.0, 0.0]; 3], nodes);
    expect(error(&far), "position");
}

/// The triangle with two targets: one lifts it by its weight and turns its normals, the other cannot be read.
fn morphed(mesh: &Value, node: &Value) -> Gltf {
    let mut g = Gltf::triangle();
    let normals = floats(&mut g, &[0.0, 0.0, 1.0].repeat(3), "VEC3", 3);
    attribute(&mut g, "NORMAL", normals);
    let lift = floats(&mut g, &[0.0, 0.0, 2.0].repeat(3), "VEC3", 3);
    let turn = floats(&mut g, &[1.0, 0.0, -1.0].repeat(3), "VEC3", 3);
    g.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": lift, "NORMAL": turn, "TANGENT": turn}, {"POSITION": 99}]);
    g.json["meshes"][0]["weights"] = mesh.clone();
    g.json["nodes"][0]["weights"] = node.clone();
    g
}

#[test]
fn morph_targets_count_by_the_weights_of_the_node_or_else_of_the_mesh() {
    for (mesh, node, weight) in [
        (json!(null), json!(null), 0.0),
        (json!([0, 0]), json!(null), 0.0),
        (json!([0.5, 0]), json!(null), 0.5),
        (json!([0.5, 0.5]), json!([1, 0]), 1.0),
        (json!([0.5, 0.5]), json!([0, 0]), 0.0),
    ] {
        let imported = load(&morphed(&mesh, &node));
        let scene_mesh = &imported.scene.meshes[0];
        assert_eq!(scene_mesh.positions[1], Vec3::new(1.0, 0.0, 2.0 * weight), "{mesh} {node}");
        let normal = Vec3::new(weight, 0.0, 1.0 - weight).normalize();
        assert!((scene_mesh.normals[0] - normal).length() < 1e-6, "{mesh} {node}");
        assert_eq!(warnings(&imported), "");
    }
}

#[test]
fn nodes_share_a_mesh_where_their_weights_agree() {
    let mut g = morphed(&json!([0.5, 0]), &json!(null));
    g.json["nodes"].as_array_mut().unwrap().extend([json!({"mesh": 0, "weights": [0.5]}), json!({"mesh": 0, "weights": [1, 0]})]);
    g.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    let scene = load(&g).scene;
    assert_eq!(scene.parts.iter().map(|part| part.mesh).collect::<Vec<u32>>(), [0, 0, 1]);
}

#[test]
fn morphs_come_before_skins() {
    let mut g = two_joints();
    let lift = floats(&mut g, &[0.0, 0.0, 1.0].repeat(3), "VEC3", 3);
    g.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": lift}]);
    g.json["meshes"][0]["weights"] = json!([1]);
    let z: Vec<f32> = load(&g).scene.meshes[0].positions.iter().map(|p| p.z).collect();
    assert_eq!(z, [1.0, 2.0, 1.5]);
}

#[test]
fn damaged_morph_targets_are_errors() {
    let found = error(&morphed(&json!([0, 1]), &json!(null)));
    assert!(found.contains("primitives[0].targets[1].POSITION: refers to accessor 99, but there are only 6"), "{found}");
    let found = error(&morphed(&json!([0, 0, 0.25]), &json!(null)));
    assert!(found.contains("primitives[0].targets: found 2 targets, but target 2 has the weight 0.25"), "{found}");
    let mut g = morphed(&json!([1, 0]), &json!(null));
    g.json["accessors"][4]["count"] = json!(2);
    let found = error(&g);
    assert!(found.contains("targets[0].POSITION: found 2 displacements, expected 3, one a vertex"), "{found}");
}

#[test]
fn changed_bytes_never_panic() {
    let mut g = two_joints();
    let lift = floats(&mut g, &[0.0, 0.0, 1.0].repeat(3), "VEC3", 3);
    let primitive = &mut g.json["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{"POSITION": lift}]);
    primitive["attributes"]["COLOR_0"] = json!(lift);
    g.json["meshes"][0]["weights"] = json!([1]);
    let gloss = json!({"diffuseFactor": [1, 0, 0, 1], "specularFactor": [0.5, 0.5, 0], "glossinessFactor": 0.2});
    g.json["materials"][0]["extensions"] = json!({"KHR_materials_pbrSpecularGlossiness": gloss});
    let (folder, whole) = (Folder::new(), g.binary());
    for at in (0..whole.len()).step_by(3) {
        for value in [0xff, b'9'] {
            let mut bytes = whole.clone();
            bytes[at] = value;
            drop(folder.write("a.glb", &bytes).load("a.glb"));
        }
    }
}

//! Animations of glTF: what moves, against where its nodes are at moments.

use crate::common::{Folder, Gltf, warnings};
use enfilade_math::{DAffine3, DVec3};
use serde_json::{Value, json};

/// A triangle below two nodes: the outer one moves by `channels`, with accessors from 0 on as given.
fn animated(accessors: &[(&str, &[f32])], samplers: Value, channels: Value) -> Gltf {
    let mut g = Gltf::triangle();
    let first = g.json["accessors"].as_array().unwrap().len();
    for (kind, values) in accessors {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        let width = if *kind == "SCALAR" { 1 } else { kind[3..].parse().unwrap() };
        g.accessor(&bytes, 5126, kind, values.len() / width);
    }
    let shifted = |mut list: Value, keys: &[&str]| {
        for entry in list.as_array_mut().unwrap() {
            for key in keys {
                entry[*key] = json!(entry[*key].as_u64().unwrap() + first as u64);
            }
        }
        list
    };
    let part = g.json["nodes"][0].clone();
    g.json["nodes"] = json!([{"name": "arm", "translation": [1.0, 0.0, 0.0], "children": [1]}, part]);
    g.json["scenes"] = json!([{"nodes": [0]}]);
    g.json["animations"] = json!([{"samplers": shifted(samplers, &["input", "output"]), "channels": channels}]);
    g
}

fn channel(sampler: u32, path: &str) -> Value {
    json!({"sampler": sampler, "target": {"node": 0, "path": path}})
}

/// Where the triangle is at a moment, in the file's axes.
fn placed(scene: &enfilade_scene::Scene, time_s: f64) -> DAffine3 {
    let file_from_world = DAffine3::from_mat3(enfilade_math::DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y));
    file_from_world * scene.at(time_s).parts[0].world_from_mesh
}

#[test]
fn nodes_move_what_is_below_them() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let accessors: [(&str, &[f32]); 4] = [
        ("SCALAR", &[0.0, 2.0]),
        ("VEC3", &[1.0, 0.0, 0.0, 1.0, 4.0, 0.0]),
        ("SCALAR", &[0.0, 1.0]),
        ("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]),
    ];
    let samplers = json!([{"input": 0, "output": 1}, {"input": 2, "output": 3}]);
    let g = animated(&accessors, samplers, json!([channel(0, "translation"), channel(1, "rotation")]));
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert!(warnings(&imported).contains("1 things move by 1 animations"), "{}", warnings(&imported));
    let scene = &imported.scene;
    assert_eq!((scene.bodies.len(), scene.bodies[0].name.as_str(), scene.bodies[0].parts.as_slice()), (1, "arm", &[0][..]));
    for time_s in [0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 9.0f64] {
        let angle = std::f64::consts::FRAC_PI_2 * time_s.min(1.0);
        let expected = DAffine3::from_translation(DVec3::new(1.0, 2.0 * time_s.min(2.0), 0.0)) * DAffine3::from_rotation_z(angle);
        assert!(placed(scene, time_s).abs_diff_eq(expected, 1e-6), "{time_s} s: {:?}", placed(scene, time_s));
    }
}

#[test]
fn cameras_below_a_node_that_moves_ride_on_it() {
    let accessors: [(&str, &[f32]); 2] = [("SCALAR", &[0.0, 2.0]), ("VEC3", &[1.0, 0.0, 0.0, 1.0, 4.0, 0.0])];
    let mut g = animated(&accessors, json!([{"input": 0, "output": 1}]), json!([channel(0, "translation")]));
    g.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.8, "aspectRatio": 1.5, "znear": 0.1}}]);
    g.json["nodes"].as_array_mut().unwrap().push(json!({"name": "eye", "camera": 0, "translation": [0.0, 0.0, 2.0]}));
    g.json["nodes"][0]["children"] = json!([2]);
    g.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    // Only the camera moves: y of the file is z of the world.
    let scene = &imported.scene;
    assert_eq!((scene.is_still(), scene.bodies.len(), scene.bodies[0].cameras.as_slice()), (true, 1, &[0][..]));
    for time_s in [0.0, 0.5, 2.0] {
        let found = scene.cameras_at(time_s)[0].position;
        assert!(found.distance(DVec3::new(1.0, -2.0, 2.0 * time_s)) < 1e-6, "{found}");
    }
}

#[test]
fn steps_jump_and_splines_follow_their_tangents() {
    let accessors: [(&str, &[f32]); 3] = [
        ("SCALAR", &[0.0, 1.0]),
        ("VEC3", &[1.0, 0.0, 0.0, 5.0, 0.0, 0.0]),
        // In-tangent, value, out-tangent of both moments: x(s) = 1 + 3 s² − 2 s³.
        ("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ];
    let moved = |interpolation: &str, output: u32, time_s: f64| {
        let samplers = json!([{"input": 0, "output": output, "interpolation": interpolation}]);
        let g = animated(&accessors, samplers, json!([channel(0, "translation")]));
        placed(&Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap().scene, time_s).translation.x
    };
    assert_eq!(["0.0", "0.99", "1.0", "3.0"].map(|t| moved("STEP", 1, t.parse().unwrap())), [1.0, 1.0, 5.0, 5.0]);
    for s in [0.1, 0.5, 0.77f64] {
        let expected = 1.0 + 3.0 * s * s - 2.0 * s.powi(3);
        assert!((moved("CUBICSPLINE", 2, s) - expected).abs() < 2e-4, "{s}");
    }
}

#[test]
fn channels_that_cannot_be_used_are_told_and_the_rest_moves() {
    let accessors: [(&str, &[f32]); 4] = [
        ("SCALAR", &[0.0, 1.0]),
        ("VEC3", &[1.0, 0.0, 0.0, 2.0, 0.0, 0.0]),
        ("SCALAR", &[1.0, 0.5]),
        ("VEC3", &[1.0, f32::NAN, 0.0, 2.0, 0.0, 0.0]),
    ];
    for (input, output, path, told) in [
        (2, 1, "translation", "moment 1 (0.5 s) does not come after the one ahead of it (1 s)"),
        (0, 3, "translation", "value 0 is not finite"),
        (0, 0, "translation", "left out"),
    ] {
        let g = animated(&accessors, json!([{"input": input, "output": output}]), json!([channel(0, path)]));
        let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
        let text = warnings(&imported);
        assert!(text.contains(told) && text.contains("1 animations dropped") && imported.scene.is_still(), "{text}");
    }
}

//! Skins, morph targets and scales of glTF over time, against formulas.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::Imported;
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{BodyStates, DEFORM, Scene, from_bytes, to_bytes};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, TAU};

const SIDES: usize = 12;
const RINGS: usize = 21;

fn floats(g: &mut Gltf, values: &[f32], kind: &str) -> usize {
    let width = match kind {
        "SCALAR" => 1,
        "MAT4" => 16,
        other => other[3..].parse().unwrap(),
    };
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    g.accessor(&bytes, 5126, kind, values.len() / width)
}

fn load(g: &Gltf) -> Imported {
    Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap()
}

/// The vertices of a part at a moment, in the file's axes.
fn vertices(scene: &Scene, part: usize, time_s: f64) -> Vec<Vec3> {
    let there = scene.at(time_s);
    there.world_positions(&there.parts[part]).map(|p| Vec3::new(p.x, p.z, -p.y)).collect()
}

fn assert_near(found: &[Vec3], expected: impl Iterator<Item = DVec3>, most: f32, what: &str) {
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.distance(expected.as_vec3()) <= most, "{what}: {found} for {expected}");
    }
}

/// Points of a cylinder of radius 0.1 m and height 1 m about the y axis, ring by ring.
fn cylinder() -> Vec<DVec3> {
    let point = |i: usize| {
        let (ring, angle) = (i / SIDES, TAU * (i % SIDES) as f64 / SIDES as f64);
        DVec3::new(0.1 * angle.cos(), ring as f64 / (RINGS - 1) as f64, 0.1 * angle.sin())
    };
    (0..RINGS * SIDES).map(point).collect()
}

/// How much the upper joint holds a point.
fn held(p: DVec3) -> f64 {
    p.y
}

/// The cylinder with two joints, the upper one in the middle; it turns a quarter about z in two seconds.
fn bent() -> Gltf {
    let mut g = Gltf::triangle();
    let points = cylinder();
    let positions: Vec<f32> = points.iter().flat_map(|p| p.as_vec3().to_array()).collect();
    let weights: Vec<f32> = points.iter().flat_map(|p| [1.0 - held(*p) as f32, held(*p) as f32, 0.0, 0.0]).collect();
    let corner = |ring: usize, side: usize| (ring * SIDES + side % SIDES) as u32;
    let square = |i: usize| {
        let (ring, side) = (i / SIDES, i % SIDES);
        let [a, b, c, d] = [corner(ring, side), corner(ring, side + 1), corner(ring + 1, side + 1), corner(ring + 1, side)];
        [a, c, b, a, d, c]
    };
    let indices: Vec<u8> = (0..(RINGS - 1) * SIDES).flat_map(square).flat_map(u32::to_le_bytes).collect();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mut lower_from_bind = [0.0f32; 32];
    (0..4).for_each(|i| (lower_from_bind[5 * i], lower_from_bind[16 + 5 * i]) = (1.0, 1.0));
    lower_from_bind[16 + 13] = -0.5;
    let [position, weight] = [floats(&mut g, &positions, "VEC3"), floats(&mut g, &weights, "VEC4")];
    let joint = g.accessor(&[0u8, 1, 0, 0].repeat(points.len()), 5121, "VEC4", points.len());
    let index = g.accessor(&indices, 5125, "SCALAR", indices.len() / 4);
    let bind = floats(&mut g, &lower_from_bind, "MAT4");
    let [input, output] = [floats(&mut g, &[0.0, 2.0], "SCALAR"), floats(&mut g, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half], "VEC4")];
    g.json["meshes"] = json!([{"primitives": [{
        "attributes": {"POSITION": position, "WEIGHTS_0": weight, "JOINTS_0": joint}, "indices": index, "material": 0
    }]}]);
    // The node of a skin does not place it.
    g.json["nodes"] = json!([
        {"name": "Tube", "mesh": 0, "skin": 0, "translation": [50, 0, 0]}, {"children": [2]}, {"name": "joint", "translation": [0, 0.5, 0]}
    ]);
    g.json["scenes"] = json!([{"nodes": [0, 1]}]);
    g.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": bind}]);
    g.json["animations"] = json!([{
        "samplers": [{"input": input, "output": output}], "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]
    }]);
    g
}

#[test]
fn a_skinned_cylinder_bends_by_its_formula() {
    let imported = load(&bent());
    let scene = &imported.scene;
    assert!(warnings(&imported).contains("1 things move by 1 animations"), "{}", warnings(&imported));
    let [body] = &scene.bodies[..] else { panic!("{:?}", scene.bodies.len()) };
    assert_eq!((body.name.as_str(), body.motion.states.joint(), body.parts.as_slice()), ("Tube", DEFORM, &[0][..]));
    let middle = DVec3::Y * 0.5;
    for time_s in [0.0, 0.3, 1.0, 1.77, 2.0, 9.0f64] {
        let turn = enfilade_math::DQuat::from_rotation_z(FRAC_PI_2 * 0.5 * time_s.min(2.0));
        let at = |p: DVec3| p.lerp(middle + turn * (p - middle), held(p));
        assert_near(&vertices(scene, 0, time_s), cylinder().into_iter().map(at), 1.1e-4, &format!("{time_s} s"));
    }
    assert_eq!(from_bytes(&to_bytes(scene)).unwrap(), *scene);
    assert!(to_bytes(scene).starts_with(b"enfilade scene 10\n"));
    let mut still = scene.clone();
    still.hold_still();
    assert!(still.is_still() && still.bodies.is_empty());
    assert_near(&vertices(&still, 0, 1.0), cylinder().into_iter(), 1e-6, "still");
    let bent = scene.still_at(1.0);
    assert_eq!((bent.validate(), bent.meshes.len(), vertices(&bent, 0, 0.0)), (Ok(()), 1, vertices(scene, 0, 1.0)));
}

/// The triangle of corners 0, x and y with a target that lifts the last corner by one along z; `channels` of the node 0.
fn lifted(weights: &[f32], interpolation: &str) -> Gltf {
    let mut g = Gltf::triangle();
    let target = floats(&mut g, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], "VEC3");
    g.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": target}]);
    let [input, output] = [floats(&mut g, &[0.0, 1.0], "SCALAR"), floats(&mut g, weights, "SCALAR")];
    let [moved, turned] =
        [floats(&mut g, &[0.0, 0.0, 0.0, 0.0, 4.0, 0.0], "VEC3"), floats(&mut g, &[1.0, 1.0, 1.0, 1.0, 3.0, 1.0], "VEC3")];
    g.json["animations"] = json!([{
        "samplers": [{"input": input, "output": output, "interpolation": interpolation}, {"input": input, "output": moved},
            {"input": input, "output": turned}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]
    }]);
    g
}

fn channel(g: &mut Gltf, sampler: u32, path: &str) {
    let channels: &mut Vec<Value> = g.json["animations"][0]["channels"].as_array_mut().unwrap();
    channels.push(json!({"sampler": sampler, "target": {"node": 0, "path": path}}));
}

#[test]
fn morphs_follow_their_weights_and_ride_on_their_node() {
    let mut g = lifted(&[0.0, 2.0], "LINEAR");
    channel(&mut g, 1, "translation");
    let scene = load(&g).scene;
    assert_eq!(
        scene.bodies.iter().map(|body| (body.motion.states.joint(), body.parent)).collect::<Vec<_>>(),
        [("free", None), (DEFORM, Some(0))]
    );
    for time_s in [0.0, 0.25, 0.9, 3.0f64] {
        let t = time_s.min(1.0);
        let expected = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1.0, 2.0 * t)].map(|p| p + DVec3::Y * 4.0 * t);
        assert_near(&vertices(&scene, 0, time_s), expected.into_iter(), 1e-6, &format!("{time_s} s"));
    }
    // Jumps, and the spline 3 s² − 2 s³.
    let steps = load(&lifted(&[0.0, 2.0], "STEP")).scene;
    assert_eq!([0.99, 1.0].map(|t| vertices(&steps, 0, t)[2].z), [0.0, 2.0]);
    let spline = load(&lifted(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0], "CUBICSPLINE")).scene;
    for s in [0.1, 0.5, 0.8f64] {
        assert!((f64::from(vertices(&spline, 0, s)[2].z) - (3.0 * s * s - 2.0 * s.powi(3))).abs() < 3e-4, "{s}");
    }
}

#[test]
fn what_is_in_a_node_whose_scale_changes_is_stretched() {
    let mut g = lifted(&[0.0, 0.0], "LINEAR");
    channel(&mut g, 1, "translation");
    channel(&mut g, 2, "scale");
    let scene = load(&g).scene;
    for time_s in [0.0, 0.5, 1.0f64] {
        let expected = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p * DVec3::new(1.0, 1.0 + 2.0 * time_s, 1.0) + DVec3::Y * 4.0 * time_s);
        assert_near(&vertices(&scene, 0, time_s), expected.into_iter(), 1e-5, &format!("{time_s} s"));
    }
}

#[test]
fn shapes_that_cannot_be_followed_stay_at_rest_with_a_warning() {
    // A scale through zero mirrors.
    let mut g = lifted(&[0.0, 0.0], "LINEAR");
    let through = floats(&mut g, &[1.0, 1.0, 1.0, -1.0, 1.0, 1.0], "VEC3");
    g.json["animations"][0]["samplers"][2]["output"] = json!(through);
    channel(&mut g, 2, "scale");
    let imported = load(&g);
    assert!(
        warnings(&imported).contains("its shape changes, but its triangles are others then: it is mirrored"),
        "{}",
        warnings(&imported)
    );
    assert!(imported.scene.is_still());
    let odd = load(&lifted(&[0.0, 1.0, 2.0], "LINEAR"));
    assert!(warnings(&odd).contains("3 weights for 2 moments, expected as many for each; the channel was left out"), "{}", warnings(&odd));
}

#[test]
fn states_of_a_bend_are_no_more_than_straight_ways_need() {
    let BodyStates::Deform { shapes } = load(&bent()).scene.bodies.remove(0).motion.states else { panic!() };
    // Half a metre turns by a quarter: a chord that is a tenth of a millimetre off its arc spans 0.04 rad.
    assert!((30..80).contains(&shapes.len()), "{} shapes", shapes.len());
}

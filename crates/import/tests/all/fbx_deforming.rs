//! Skins and blend shapes of FBX over time, against formulas.

use crate::common::fbx::*;
use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::BodyStates;
use std::f64::consts::FRAC_PI_2;

const MESH: i64 = 10;
const NODE: i64 = 20;
const BONE: i64 = 80;

fn list(name: &'static str, values: Value) -> Record {
    record(name, vec![values], vec![])
}

/// A triangle at x, y and the origin in a node that is 5 cm along x, with what bends it from the first second to the third.
fn load(bent_by: (Vec<Record>, Vec<Record>)) -> Imported {
    let corners = vec![
        list("Vertices", Value::Reals(vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])),
        list("PolygonVertexIndex", Value::Ints(vec![0, 1, -3])),
    ];
    let triangle = object("Geometry", MESH, "\0\x01Geometry", "Mesh", corners);
    let along = reals("Lcl Translation", "Vector3D", &[5.0, 0.0, 0.0]);
    let node = object("Model", NODE, "Flag\0\x01Model", "Mesh", vec![properties(vec![along])]);
    let (objects, links) = animation([1.0, 3.0]);
    let objects = [vec![triangle, node], objects, bent_by.0].concat();
    let links = [vec![belongs(NODE, 0), belongs(MESH, NODE)], links, bent_by.1].concat();
    let folder = Folder::new();
    folder.write("a.fbx", binary(&document(7400, vec![], objects, links), 7400));
    folder.load("a.fbx").unwrap_or_else(|e| panic!("{e}"))
}

/// A skin of two bones at the file's origin: the first has the corners at the origin and along x, both have half of the third. The second
/// bone turns a quarter about z in two seconds.
fn skin() -> (Vec<Record>, Vec<Record>) {
    let one = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let bone = |id, name| object("Model", id, name, "LimbNode", vec![]);
    let cluster = |id, name, corners: &[i32], weights: &[f64]| {
        let children = vec![
            list("Indexes", Value::Ints(corners.to_vec())),
            list("Weights", Value::Reals(weights.to_vec())),
            list("Transform", Value::Reals(one.to_vec())),
            list("TransformLink", Value::Reals(one.to_vec())),
        ];
        object("Deformer", id, name, "Cluster", children)
    };
    let (curves, of_curves) = curve(50, (BONE + 1, "Lcl Rotation"), "d|Z", [0.0; 3], &[(1.0, 0.0), (3.0, 90.0)]);
    let objects = vec![
        bone(BONE, "Root\0\x01Model"),
        bone(BONE + 1, "Tip\0\x01Model"),
        object("Deformer", 70, "\0\x01Deformer", "Skin", vec![]),
        cluster(71, "A\0\x01SubDeformer", &[0, 1, 2], &[1.0, 1.0, 0.5]),
        cluster(72, "B\0\x01SubDeformer", &[2], &[0.5]),
    ];
    let links = [(BONE, 0), (BONE + 1, 0), (70, MESH), (71, 70), (72, 70), (BONE, 71), (BONE + 1, 72)].map(|(a, b)| belongs(a, b));
    ([objects, curves].concat(), [links.to_vec(), of_curves].concat())
}

/// A blend shape that puts the third corner 2 cm towards z at its full weight, which it has after two seconds.
fn blend_shape() -> (Vec<Record>, Vec<Record>) {
    let moved = vec![
        list("Indexes", Value::Ints(vec![2])),
        list("Vertices", Value::Reals(vec![0.0, 0.0, 2.0])),
        list("Normals", Value::Reals(vec![0.0; 3])),
    ];
    let percent = properties(vec![reals("DeformPercent", "Number", &[0.0])]);
    let channel = vec![list("FullWeights", Value::Reals(vec![100.0])), percent];
    let objects = vec![
        object("Geometry", 90, "Up\0\x01Geometry", "Shape", moved),
        object("Deformer", 91, "\0\x01Deformer", "BlendShape", vec![]),
        object("Deformer", 92, "Up\0\x01SubDeformer", "BlendShapeChannel", channel),
    ];
    let (curves, of_curves) = curve(50, (92, "DeformPercent"), "d|DeformPercent", [0.0; 3], &[(1.0, 0.0), (3.0, 100.0)]);
    let links = [(91, MESH), (92, 91), (90, 92)].map(|(a, b)| belongs(a, b));
    ([objects, curves].concat(), [links.to_vec(), of_curves].concat())
}

/// The third corner at moments, in the file's axes and centimetres, against `expected`.
fn assert_corner(imported: &Imported, expected: impl Fn(f64) -> DVec3) {
    let scene = &imported.scene;
    let [body] = scene.bodies.as_slice() else { panic!("{}", warnings(imported)) };
    assert!(matches!(body.motion.states, BodyStates::Deform { .. }) && body.parts == [0], "{body:?}");
    for time_s in [0.0, 0.31, 0.7, 1.0, 1.77, 2.0, 5.0] {
        let there = scene.at(time_s);
        let p = 100.0 * there.world_corners(&there.parts[0], 0)[2];
        let found = Vec3::new(p.x, p.z, -p.y);
        let expected = expected(f64::min(time_s, 2.0)).as_vec3();
        assert!(found.distance(expected) < 2e-3, "{found} for {expected} at {time_s} s");
    }
}

#[test]
fn skins_bend_by_their_bones_over_time() {
    let imported = load(skin());
    assert_corner(&imported, |time_s| {
        let (sin, cos) = (FRAC_PI_2 * time_s / 2.0).sin_cos();
        0.5 * DVec3::Y + 0.5 * DVec3::new(-sin, cos, 0.0)
    });
    let told = warnings(&imported);
    assert!(told.contains("1 things move by the first animation") && !told.contains("bones"), "{told}");
}

#[test]
fn blend_shapes_change_by_their_weights_over_time() {
    assert_corner(&load(blend_shape()), |time_s| DVec3::new(5.0, 1.0, time_s));
}

#[test]
fn what_deforms_in_a_node_that_moves_moves_with_it() {
    let (mut objects, mut links) = blend_shape();
    let (curves, of_curves) = curve(60, (NODE, "Lcl Translation"), "d|Y", [5.0, 0.0, 0.0], &[(1.0, 0.0), (3.0, 8.0)]);
    objects.extend(curves);
    links.extend(of_curves);
    assert_corner(&load((objects, links)), |time_s| DVec3::new(5.0, 1.0 + 4.0 * time_s, time_s));
}

#[test]
fn without_an_animation_skins_rest() {
    let (objects, links) = skin();
    let still = load((objects[..5].to_vec(), links[..7].to_vec()));
    assert_eq!(still.scene.bodies, []);
    assert!(warnings(&still).contains("the skin was bent to one pose"), "{}", warnings(&still));
}

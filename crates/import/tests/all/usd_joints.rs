//! Joints of `UsdPhysics`, against places by formula. Stages are in centimetres with z up.

use crate::common::{Folder, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{BodyStates, Scene};
use std::f64::consts::FRAC_PI_2;

/// A door of 1 m whose hinge is at (100, 0) cm, and which stands open by 30 degrees as the stage has it; a drawer in it.
const DOOR: &str = r#"
    def Xform "frame" { double3 xformOp:translate = (100, 0, 0)  uniform token[] xformOpOrder = ["xformOp:translate"]
        def Cube "post" { double size = 10 } }
    def Xform "door" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {
        double3 xformOp:translate = (100, 0, 0)
        float xformOp:rotateZ = 30
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]
        def Cube "leaf" { double size = 2  double3 xformOp:translate = (50, 0, 100)  float3 xformOp:scale = (50, 5, 100)
            uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"] }
        def Xform "drawer" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {
            double3 xformOp:translate = (50, 0, 50)
            uniform token[] xformOpOrder = ["xformOp:translate"]
            def Cube "box" { double size = 20 } }
        def Cube "knob" { double size = 10  double3 xformOp:translate = (90, 10, 100)  uniform token[] xformOpOrder = ["xformOp:translate"] }
    }
    def PhysicsRevoluteJoint "hinge" { rel physics:body0 = </World/frame>  rel physics:body1 = </World/door>
        uniform token physics:axis = "Z"  float physics:lowerLimit = 0  float physics:upperLimit = 120 }
    def PhysicsPrismaticJoint "rail" { rel physics:body0 = </World/door>  rel physics:body1 = </World/door/drawer>
        uniform token physics:axis = "X"  point3f physics:localPos0 = (50, 0, 50)  quatf physics:localRot0 = (0.70710677, 0, 0, -0.70710677)
        quatf physics:localRot1 = (0.70710677, 0, 0, -0.70710677)  float physics:lowerLimit = 0  float physics:upperLimit = 40 }
"#;

fn load(world: &str, states: Option<&str>) -> Result<Imported, String> {
    let folder = Folder::new();
    // Each statement has a line of its own in USD.
    let world = world.replace("  ", "\n").replace(" }", "\n}\n");
    folder.write("a.usda", format!("#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = \"Z\"\n)\ndef Xform \"World\"\n{{{world}}}\n"));
    let states = states.map(|table| folder.write("run.csv", table).path("run.csv"));
    folder.load_with("a.usda", &ImportOptions { states, ..ImportOptions::default() }).map_err(|error| error.to_string())
}

/// The middle of a part.
fn middle(scene: &Scene, name: &str) -> Vec3 {
    let part = scene.parts.iter().find(|part| part.name.ends_with(name)).unwrap_or_else(|| panic!("no part {name}"));
    let points: Vec<Vec3> = scene.world_positions(part).collect();
    let ends = points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    0.5 * (ends.0 + ends.1)
}

#[test]
fn joints_are_bodies_whose_limits_count_from_the_stages_own_poses() {
    let imported = load(DOOR, None).unwrap();
    let scene = &imported.scene;
    assert!(scene.is_still() && warnings(&imported).lines().all(|line| !line.contains("joint")), "{}", warnings(&imported));
    let bodies: Vec<_> = scene.bodies.iter().map(|body| (body.name.as_str(), body.parent, body.parts.len())).collect();
    assert_eq!(bodies, [("door", None, 2), ("drawer", Some(0), 1)]);
    let near = |limits: Option<[f64; 2]>, expected: [f64; 2]| limits.unwrap().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
    // 30 of 120 degrees are open.
    assert!(near(scene.bodies[0].limits, [-30f64.to_radians(), 90f64.to_radians()]), "{:?}", scene.bodies[0].limits);
    assert!(near(scene.bodies[1].limits, [0.0, 0.4]), "{:?}", scene.bodies[1].limits);
    let BodyStates::Hinge { point, axis, .. } = &scene.bodies[0].motion.states else { panic!() };
    assert!(point.distance(DVec3::X) < 1e-9 && axis.distance(DVec3::Z) < 1e-9);
    // The x axis of its frame is −y of the door, which is turned by 30 degrees.
    let BodyStates::Slide { axis, .. } = &scene.bodies[1].motion.states else { panic!() };
    assert!(axis.distance(DVec3::new(0.5, -0.75f64.sqrt(), 0.0)) < 1e-6, "{axis}");
}

#[test]
fn a_table_of_states_turns_the_door_with_what_it_bears() {
    let scene = load(DOOR, Some(&format!("time,hinge,rail\n0,{},0\n1,{FRAC_PI_2},0.4\n", 30f64.to_radians()))).unwrap().scene;
    let rest = scene.at(0.0);
    assert!(middle(&rest, "leaf").distance(Vec3::new(1.0 + 0.5 * 0.75f32.sqrt(), 0.25, 1.0)) < 1e-5, "{}", middle(&rest, "leaf"));
    // Open by 90 degrees: along y from the hinge. The drawer has slid by 0.4 m along the door's −y, which is x now.
    let open = scene.at(1.0);
    for (name, expected) in [("leaf", [1.0, 0.5, 1.0]), ("knob", [0.9, 0.9, 1.0]), ("box", [1.4, 0.5, 0.5]), ("post", [1.0, 0.0, 0.0])] {
        assert!(middle(&open, name).distance(Vec3::from_array(expected)) < 1e-5, "{name}: {}", middle(&open, name));
    }
    let error = load(DOOR, Some("time,hing\n0,0\n")).unwrap_err();
    assert!(error.contains("there is no joint of this name among \"hinge\", \"rail\""), "{error}");
}

/// Cubes that are rigid bodies, and joints.
fn cubes(joints: &str) -> Result<Imported, String> {
    let cube = |name: &str| format!("def Cube \"{name}\" (prepend apiSchemas = [\"PhysicsRigidBodyAPI\"]) {{ double size = 10 }}\n");
    load(&format!("{}{}{}{joints}", cube("a"), cube("b"), cube("c")), None)
}

fn joint(name: &str, [first, second]: [&str; 2], more: &str) -> String {
    let rel = |end: u32, body: &str| if body.is_empty() { String::new() } else { format!("rel physics:body{end} = </World/{body}>") };
    format!("def PhysicsRevoluteJoint \"{name}\" {{ {}  {}  {more} }}\n", rel(0, first), rel(1, second))
}

#[test]
fn joints_in_a_circle_or_without_bodies_name_their_prim() {
    let ring = [joint("one", ["a", "b"], ""), joint("two", ["b", "c"], "")].concat();
    for (joints, place, expected) in [
        (ring.clone() + &joint("three", ["c", "a"], ""), "/World/three", "it closes a circle of joints"),
        (joint("loose", ["", ""], ""), "/World/loose", "found none as physics:body0 and none as physics:body1"),
        (joint("gone", ["a", "d"], ""), "/World/gone", "its body </World/d> is not there"),
        (joint("odd", ["a", "b"], "uniform token physics:axis = \"W\""), "/World/odd", "found \"W\" as physics:axis, expected X, Y or Z"),
    ] {
        let error = cubes(&joints).unwrap_err();
        assert!(error.contains(place) && error.contains(expected), "{error}\nexpected {place}: {expected}");
    }
    let open = cubes(&(ring + &joint("three", ["c", "a"], "bool physics:excludeFromArticulation = 1"))).unwrap();
    assert!(open.scene.bodies.len() == 2 && warnings(&open).contains("three: it closes a circle"), "{}", warnings(&open));
    let off = cubes(&joint("off", ["a", "b"], "bool physics:jointEnabled = 0")).unwrap();
    assert!(off.scene.bodies.is_empty());
}

#[test]
fn a_joint_to_the_world_may_have_its_body_at_either_end() {
    for (ends, axis) in [(["", "a"], DVec3::Z), (["a", ""], DVec3::NEG_Z)] {
        let scene = cubes(&joint("j", ends, "uniform token physics:axis = \"Z\"")).unwrap().scene;
        let BodyStates::Hinge { axis: found, .. } = &scene.bodies[0].motion.states else { panic!() };
        assert!(found.distance(axis) < 1e-12 && scene.bodies[0].limits.is_none(), "{found}");
    }
}

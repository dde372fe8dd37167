//! Time samples of placements, against what Pixar's own library makes of them (`usd/make.py`) and against formulas.

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::{DAffine3, DMat3, DVec3};
use enfilade_scene::{BodyStates, Scene};
use serde_json::Value;
use std::path::Path;

fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/usd").join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn load(body: &str) -> Imported {
    let folder = Folder::new();
    folder.write("a.usda", format!("#usda 1.0\n( metersPerUnit = 1 upAxis = \"Z\" timeCodesPerSecond = 10 )\n{body}"));
    folder.load("a.usda").unwrap_or_else(|e| panic!("{e}"))
}

/// Where a part is at a moment.
fn placed(scene: &Scene, name: &str, time_s: f64) -> DAffine3 {
    let there = scene.at(time_s);
    there.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name}")).world_from_mesh
}

#[test]
fn prims_are_where_pixars_library_has_them_at_all_times() {
    let folder = Folder::new();
    for name in ["moving.usda", "moving.usdc", "moving_part.usda", "moving_over.usda"] {
        folder.write(name, fixture(name));
    }
    let text = folder.load("moving.usda").unwrap();
    let scene = folder.load("moving.usdc").unwrap().scene;
    let times = |scene: &Scene| scene.bodies.iter().map(|body| (body.name.clone(), body.motion.times_s.clone())).collect::<Vec<_>>();
    assert!(times(&text.scene) == times(&scene), "the numbers of text and binary files differ by rounding alone");
    assert!(warnings(&text).contains("7 things move by them, 2 s from time code 10 on"), "{}", warnings(&text));
    let names: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["World/Sled", "World/Arm", "World/Arm/Hand", "World/Arm/Free", "World/Lid", "World/Door", "World/Part"]);
    assert_eq!(scene.bodies.iter().map(|body| body.parent).collect::<Vec<_>>(), [None, None, Some(1), None, None, None, None]);
    let expected: Value = serde_json::from_slice(&fixture("moving.json")).unwrap();
    for (name, places) in expected.as_object().unwrap() {
        for place in places.as_array().unwrap() {
            let code = place["code"].as_f64().unwrap();
            // Between the samples of matrices, the library's placements are no rigid ones.
            if name == "World/Door" && ![0.0, 10.0, 40.0, 70.0, 80.0].contains(&code) {
                continue;
            }
            let row = |i: usize| DVec3::from_array(std::array::from_fn(|k| place["matrix"][i][k].as_f64().unwrap()));
            let expected =
                DAffine3::from_scale(DVec3::splat(0.5)) * DAffine3::from_mat3_translation(DMat3::from_cols(row(0), row(1), row(2)), row(3));
            let found = placed(&scene, name, (code - 10.0) / 30.0);
            assert!(found.abs_diff_eq(expected, 3e-4), "{name} at {code}: {found:?} for {expected:?}");
        }
    }
    // A matrix turns evenly between two samples.
    let quarter = placed(&scene, "World/Door", 0.5).transform_vector3(DVec3::X) - DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0);
    assert!(quarter.length() < 1e-9, "{quarter}");
    let mut still = scene.clone();
    still.hold_still();
    assert!(still.is_still() && still.bodies.is_empty() && still.parts == scene.parts);
}

#[test]
fn dozens_of_links_with_thousands_of_samples_follow_their_formula() {
    let (links, samples) = (24, 2000);
    let mut body = String::new();
    for link in 0..links {
        let angles: String = (0..samples).map(|i| format!("{i}: {}, ", 30.0 * (f64::from(i) * 0.01 + f64::from(link)).sin())).collect();
        let open = format!(
            "def Cube \"L{link}\" {{ double xformOp:rotateZ.timeSamples = {{ {angles} }}\ndouble3 xformOp:translate = (0.2, 0, 0)\n\
             uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateZ\"]\n"
        );
        body += &open;
    }
    let imported = load(&(body + &"}".repeat(links as usize)));
    let scene = &imported.scene;
    assert_eq!((scene.bodies.len(), scene.bodies[23].parent), (24, Some(22)));
    for code in [0.0, 17.5, 777.0, 1999.0f64] {
        let mut expected = DAffine3::IDENTITY;
        let mut name = String::new();
        for link in 0..links {
            // Between two samples, the angle is linear.
            let at = |i: f64| 30.0 * (i * 0.01 + f64::from(link)).sin();
            let angle = at(code.floor()) + (at(code.floor() + 1.0) - at(code.floor())) * code.fract();
            expected *= DAffine3::from_translation(DVec3::X * 0.2) * DAffine3::from_rotation_z(angle.to_radians());
            name = format!("{name}{}L{link}", if link > 0 { "/" } else { "" });
            let found = placed(scene, &name, code / 10.0);
            assert!(found.abs_diff_eq(expected, 1e-9), "{name} at {code}");
        }
    }
    let BodyStates::Free { poses, .. } = &scene.bodies[5].motion.states else { panic!() };
    assert_eq!(poses.len(), 2000, "even turns need no more states than samples");
}

/// The vertices of a part at a moment.
fn vertices(scene: &Scene, name: &str, time_s: f64) -> Vec<DVec3> {
    let there = scene.at(time_s);
    let part = there.parts.iter().find(|part| part.name == name).unwrap_or_else(|| panic!("no {name}"));
    there.world_positions(part).map(|p| p.as_dvec3()).collect()
}

#[test]
fn meshes_follow_scales_that_change_and_turns_within_what_is_squeezed() {
    let imported = load(
        r#"def Xform "Carried" { double3 xformOp:translate.timeSamples = { 4: (0, 0, 0), 14: (2, 0, 0) }
            uniform token[] xformOpOrder = ["xformOp:translate"]
            def Xform "Grows" { float3 xformOp:scale.timeSamples = { 4: (1, 1, 1), 9: (1, 1, 2) }
                double3 xformOp:translate = (0, 3, 0)
                uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
                def Cube "Turns" { double xformOp:rotateX.timeSamples = { 4: 0, 14: 50 }
                    uniform token[] xformOpOrder = ["xformOp:rotateX"]
                }
            }
        }
        def Xform "Squeezed" { float3 xformOp:scale = (1, 2, 1)
            uniform token[] xformOpOrder = ["xformOp:scale"]
            def Cube "In" {
                double xformOp:rotateZ.timeSamples = { 4: 0, 9: 40 }
                uniform token[] xformOpOrder = ["xformOp:rotateZ"]
            }
        }"#,
    );
    assert!(!warnings(&imported).contains("scale or shear"), "{}", warnings(&imported));
    let scene = &imported.scene;
    for time_s in [0.0, 0.13, 0.5, 1.0f64] {
        let code = 10.0 * time_s;
        let grown = DAffine3::from_scale(DVec3::new(1.0, 1.0, 1.0 + (0.2 * code).min(1.0)));
        let turned = DAffine3::from_rotation_x((5.0 * code).to_radians());
        let carried = DAffine3::from_translation(DVec3::new(0.2 * code, 3.0, 0.0)) * grown * turned;
        let squeezed = DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0)) * DAffine3::from_rotation_z((8.0 * code).min(40.0).to_radians());
        for (name, placed) in [("Carried/Grows/Turns", carried), ("Squeezed/In", squeezed)] {
            for v in vertices(scene, name, time_s) {
                let own = placed.inverse().transform_point3(v);
                assert!((own.abs() - 1.0).abs().max_element() < 2.5e-4, "{name} at {time_s} s: {v} is {own} of the cube");
            }
        }
    }
    // What grows rides on what carries it.
    let body = scene.bodies.iter().find(|body| body.name == "Carried/Grows/Turns").unwrap();
    assert!(matches!(body.motion.states, BodyStates::Deform { .. }) && scene.bodies[body.parent.unwrap() as usize].name == "Carried");
}

#[test]
fn what_no_rigid_motion_does_is_told_by_prim_and_attribute() {
    let imported = load(
        r#"def Cube "Grows" {
            double3 xformOp:translate.timeSamples = { 4: (0, 0, 0), 14: (1, 0, 0) }
            float3 xformOp:scale.timeSamples = { 4: (1, 1, 1), 9: (1, 1, 1.5) }
            uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
            def Camera "Above" {}
        }
        def Camera "Eye" { double3 xformOp:translate.timeSamples = { 4: (0, 0, 0), 14: (1, 0, 0) }
            uniform token[] xformOpOrder = ["xformOp:translate"]
        }
        def Cube "Blinks" { token visibility.timeSamples = { 0: "inherited", 5: "invisible" } }
        def Cube "Curve" {
            double xformOp:rotateZ.spline = { bezier, 1: 5, 2: 7, }
            uniform token[] xformOpOrder = ["xformOp:rotateZ"]
        }
        def Xform "Squeezed" { float3 xformOp:scale = (1, 2, 1)
            uniform token[] xformOpOrder = ["xformOp:scale"]
            def Camera "In" {
                double xformOp:rotateZ.timeSamples = { 0: 0, 5: 40 }
                uniform token[] xformOpOrder = ["xformOp:rotateZ"]
            }
        }"#,
    );
    let told = warnings(&imported);
    for expected in [
        "Grows: its meshes follow it, but no light or camera in it does: it changes its scale or shear, which no rigid motion does, and keeps those of rest; for the first time at time code 9",
        "Blinks.visibility: its value changes with time; that of the first moment was taken",
        "Curve: xformOp:rotateZ is a spline",
        "it moves within something that is stretched or mirrored",
        // Nothing says where the stage begins.
        "things move by them, 1 s from time code 4 on",
    ] {
        assert!(told.contains(expected), "{told}\nexpected {expected}");
    }
    // The camera rides.
    let [rest, moved] = [0.0, 0.5].map(|time_s| imported.scene.cameras_at(time_s)[0].position);
    assert!((moved - rest).abs_diff_eq(DVec3::X * 0.5, 1e-12));
}

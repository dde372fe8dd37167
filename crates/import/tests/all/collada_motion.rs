//! Animations of COLLADA, against formulas.

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::Scene;

const TRIANGLE: &str = "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"p-a\" count=\"9\">0 0 0 1 0 0 0 1 0\
    </float_array><technique_common><accessor source=\"#p-a\" count=\"3\" stride=\"3\"/></technique_common></source><vertices id=\"v\"><input \
    semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p>\
    </triangles></mesh></geometry></library_geometries>";

/// A channel with the numbers of its sampler: inputs by semantic.
fn animation(id: &str, target: &str, inputs: &[(&str, &str)]) -> String {
    let source = |(semantic, values): &(&str, &str)| {
        let (name, array) = (format!("{id}-{semantic}"), if *semantic == "INTERPOLATION" { "Name_array" } else { "float_array" });
        format!(
            "<source id=\"{name}\"><{array} id=\"{name}-a\">{values}</{array}><technique_common><accessor source=\"#{name}-a\"/>\
             </technique_common></source>"
        )
    };
    let input = |(semantic, _): &(&str, &str)| format!("<input semantic=\"{semantic}\" source=\"#{id}-{semantic}\"/>");
    let (sources, inputs): (String, String) = (inputs.iter().map(source).collect(), inputs.iter().map(input).collect());
    format!("<animation>{sources}<sampler id=\"{id}\">{inputs}</sampler><channel source=\"#{id}\" target=\"{target}\"/></animation>")
}

/// A scene in metres with z up.
fn load(animations: &str, nodes: &str) -> Imported {
    let text = format!(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset><unit meter=\"1\"/>\
         <up_axis>Z_UP</up_axis></asset>{TRIANGLE}<library_animations>{animations}</library_animations><library_visual_scenes><visual_scene \
         id=\"s\">{nodes}</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"
    );
    Folder::new().write("a.dae", text).load("a.dae").unwrap_or_else(|e| panic!("{e}"))
}

fn placed(scene: &Scene, name: &str, time_s: f64) -> DAffine3 {
    let there = scene.at(time_s);
    there.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name}")).world_from_mesh
}

#[test]
fn transforms_move_whole_by_numbers_and_by_elements_of_matrices() {
    let nodes = "<node id=\"arm\"><translate sid=\"t\">1 0 0</translate><rotate sid=\"r\">0 0 1 10</rotate><scale>2 2 2</scale><node id=\"hand\">\
        <matrix sid=\"m\">1 0 0 0  0 1 0 1  0 0 1 0  0 0 0 1</matrix><instance_geometry url=\"#g\"/></node></node>\
        <node id=\"door\"><matrix sid=\"whole\">1 0 0 0 0 1 0 0 0 0 3 0 0 0 0 1</matrix><instance_geometry url=\"#g\"/></node>";
    let animations = animation("a", "arm/t", &[("INPUT", "0 2"), ("OUTPUT", "1 0 0  1 4 0")])
        + &animation("b", "arm/r.ANGLE", &[("INPUT", "0 1 2"), ("OUTPUT", "10 370 370"), ("INTERPOLATION", "LINEAR STEP LINEAR")])
        // Column 3, row 2: along z.
        + &format!("<animation>{}</animation>", animation("c", "hand/m(3)(2)", &[("INPUT", "1 2"), ("OUTPUT", "0 5")]))
        + &animation("d", "door/whole", &[("INPUT", "0 1"), ("OUTPUT", "1 0 0 0 0 1 0 0 0 0 3 0 0 0 0 1  0 -1 0 6 1 0 0 0 0 0 3 0 0 0 0 1")]);
    let imported = load(&animations, nodes);
    assert!(warnings(&imported).contains("3 things move by 4 channels"), "{}", warnings(&imported));
    for time_s in [0.0, 0.3, 0.5, 0.77, 1.0, 1.5, 2.0, 5.0f64] {
        let t = time_s.min(2.0);
        let angle = (10.0 + 360.0 * t.min(1.0)).to_radians();
        let arm = DAffine3::from_translation(DVec3::new(1.0, 2.0 * t, 0.0)) * DAffine3::from_rotation_z(angle);
        let hand = DAffine3::from_translation(DVec3::new(0.0, 1.0, 5.0 * (t - 1.0).max(0.0)));
        let expected = arm * DAffine3::from_scale(DVec3::splat(2.0)) * hand;
        let found = placed(&imported.scene, "hand", time_s);
        assert!(found.abs_diff_eq(expected, 1e-9), "{time_s} s: {found:?} for {expected:?}");
        let share = time_s.min(1.0);
        let expected = DAffine3::from_translation(DVec3::X * 6.0 * share)
            * DAffine3::from_rotation_z(share * std::f64::consts::FRAC_PI_2)
            * DAffine3::from_scale(DVec3::new(1.0, 1.0, 3.0));
        assert!(placed(&imported.scene, "door", time_s).abs_diff_eq(expected, 1e-9), "{time_s} s");
    }
}

#[test]
fn curves_of_bezier_and_hermite_follow_their_tangents() {
    // x(s) = 3 s² − 2 s³ with even times: flat at both ends.
    let bezier = [("INPUT", "0 1"), ("OUTPUT", "0 1"), ("INTERPOLATION", "BEZIER BEZIER")];
    let even = [("OUT_TANGENT", "0.3333333 0 1.3 1"), ("IN_TANGENT", "-0.3 0 0.6666667 1")];
    let values_alone = [("OUT_TANGENT", "0 1"), ("IN_TANGENT", "0 1")];
    let hermite =
        [("INPUT", "0 1"), ("OUTPUT", "0 1"), ("INTERPOLATION", "HERMITE HERMITE"), ("OUT_TANGENT", "1 0 1 0"), ("IN_TANGENT", "1 0 1 0")];
    let node = "<node id=\"n\"><translate sid=\"t\">0 0 0</translate><instance_geometry url=\"#g\"/></node>";
    for inputs in [[&bezier[..], &even].concat(), [&bezier[..], &values_alone].concat(), hermite.to_vec()] {
        let imported = load(&animation("a", "n/t.X", &inputs), node);
        for s in [0.0, 0.1, 0.33, 0.5, 0.8, 1.0f64] {
            let found = placed(&imported.scene, "n", s).translation;
            assert!(found.distance(DVec3::X * (3.0 * s * s - 2.0 * s.powi(3))) < 2e-4, "{s}: {found}");
        }
    }
}

#[test]
fn channels_that_cannot_be_used_are_told_and_the_rest_moves() {
    let node = "<node id=\"n\"><translate sid=\"t\">0 0 0</translate><scale sid=\"s\">1 1 1</scale><instance_geometry url=\"#g\"/></node>";
    let straight = [("INPUT", "0 1"), ("OUTPUT", "0 1")];
    for (target, inputs, told) in [
        ("n/t.Y", &[("INPUT", "1 0"), ("OUTPUT", "0 1")][..], "moment 1 (0 s) comes before the one ahead of it (1 s)"),
        ("n/t.Y", &[("INPUT", "0 1"), ("OUTPUT", "0 x")], "1 of the numbers of its OUTPUT are not finite"),
        ("n/t.Y", &[("INPUT", "0 1"), ("OUTPUT", "0")], "found 1 numbers for 2 moments, expected 1 each"),
        ("n/t.Y", &[("INPUT", "0 1"), ("OUTPUT", "0 1"), ("INTERPOLATION", "BEZIER BEZIER")], "its tangents are not 1 pairs a moment"),
        ("n/t.ANGLE", &straight, "found \".ANGLE\", expected .X, .Y, .Z, .ANGLE or a number of the 3 in brackets"),
        ("g/color", &straight, "it moves no transform of a node"),
        ("n/t.X", &straight, "another one moves the same numbers"),
    ] {
        let imported = load(&(animation("ok", "n/t.X", &straight) + &animation("odd", target, inputs)), node);
        let text = warnings(&imported);
        assert!(text.contains(told) && text.contains("1 things move"), "{text}\nexpected {told}");
        assert!(placed(&imported.scene, "n", 0.5).abs_diff_eq(DAffine3::from_translation(DVec3::X * 0.5), 1e-12), "{target}");
    }
}

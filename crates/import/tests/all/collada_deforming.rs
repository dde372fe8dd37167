//! Skins and morphs of COLLADA at rest and over time, against formulas.

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::{DAffine3, DVec3};
use enfilade_scene::{BodyStates, Scene};

const ONE: &str = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
/// Vertices of a strip that stands: two at the foot, two at the middle, one at the top.
const STRIP: [[f64; 3]; 5] = [[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.0, 1.0], [0.0, 0.0, 2.0]];

fn source(id: &str, tag: &str, values: &str, stride: usize) -> String {
    format!(
        "<source id=\"{id}\"><{tag} id=\"{id}-a\">{values}</{tag}><technique_common><accessor source=\"#{id}-a\" stride=\"{stride}\"/>\
         </technique_common></source>"
    )
}

/// A geometry of these vertices, whose triangles go through them in turn.
fn geometry(id: &str, points: &[[f64; 3]]) -> String {
    let numbers: Vec<String> = points.iter().flatten().map(f64::to_string).collect();
    format!(
        "<geometry id=\"{id}\"><mesh>{}<vertices id=\"{id}-v\"><input semantic=\"POSITION\" source=\"#{id}-p\"/></vertices><triangles>\
         <input semantic=\"VERTEX\" source=\"#{id}-v\" offset=\"0\"/><p>0 1 2 1 3 2 2 3 4</p></triangles></mesh></geometry>",
        source(&format!("{id}-p"), "float_array", &numbers.join(" "), 3)
    )
}

/// A skin of two joints that share the middle; the weights of the foot do not add up to one, and are taken as shares.
fn skin(of: &str, joints: (&str, &str), bind_shape: &str) -> String {
    let (tag, names) = joints;
    format!(
        "<controller id=\"skin\"><skin source=\"#{of}\"><bind_shape_matrix>{bind_shape}</bind_shape_matrix>{}{}{}<joints><input \
         semantic=\"JOINT\" source=\"#j\"/><input semantic=\"INV_BIND_MATRIX\" source=\"#b\"/></joints><vertex_weights count=\"5\"><input \
         semantic=\"JOINT\" source=\"#j\" offset=\"0\"/><input semantic=\"WEIGHT\" source=\"#w\" offset=\"1\"/><vcount>1 1 2 2 1</vcount>\
         <v>0 0  0 0  0 1 1 1  0 1 1 1  1 2</v></vertex_weights></skin></controller>",
        source("j", tag, names, 1),
        source("b", "float_array", &format!("{ONE} 1 0 0 0 0 1 0 0 0 0 1 -1 0 0 0 1"), 16),
        source("w", "float_array", "0.7 0.5 1", 1)
    )
}

/// A foot that is 5 m along x and, within it 1 m higher, a tip that is turned about x by 30 degrees.
const JOINTS: &str = "<node id=\"foot-id\" sid=\"foot\"><translate>5 0 0</translate><node id=\"tip-id\" sid=\"tip\"><translate>0 0 1</translate>\
    <rotate sid=\"r\">1 0 0 30</rotate></node></node>";

fn file(libraries: &str, nodes: &str) -> String {
    format!(
        "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset><unit meter=\"1\"/><up_axis>Z_UP</up_axis>\
         </asset>{libraries}<library_visual_scenes><visual_scene id=\"s\">{nodes}</visual_scene></library_visual_scenes>\
         <scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"
    )
}

fn load(libraries: &str, nodes: &str) -> Imported {
    Folder::new().write("a.dae", file(libraries, nodes)).load("a.dae").unwrap_or_else(|e| panic!("{e}"))
}

/// An animation of these numbers, linear from moment to moment.
fn animation(target: &str, times_s: &str, values: &str) -> String {
    format!(
        "<library_animations><animation>{}{}<sampler id=\"a\"><input semantic=\"INPUT\" source=\"#i\"/><input semantic=\"OUTPUT\" source=\"#o\"/>\
         </sampler><channel source=\"#a\" target=\"{target}\"/></animation></library_animations>",
        source("i", "float_array", times_s, 1),
        source("o", "float_array", values, 1)
    )
}

fn points(scene: &Scene, time_s: f64) -> Vec<DVec3> {
    let there = scene.at(time_s);
    there.world_positions(&there.parts[0]).map(|p| p.as_dvec3()).collect()
}

/// Where the strip is, with its tip turned by an angle.
fn expected(degrees: f64, bind_shape: DAffine3) -> Vec<DVec3> {
    let foot = DAffine3::from_translation(DVec3::X * 5.0);
    let up = DAffine3::from_translation(DVec3::Z);
    let tip = foot * up * DAffine3::from_rotation_x(degrees.to_radians()) * up.inverse();
    let weights = [0.0, 0.0, 0.5, 0.5, 1.0];
    let point = |(p, weight): (&[f64; 3], f64)| {
        let p = bind_shape.transform_point3(DVec3::from_array(*p));
        foot.transform_point3(p).lerp(tip.transform_point3(p), weight)
    };
    STRIP.iter().zip(weights).map(point).collect()
}

fn assert_near(found: &[DVec3], expected: &[DVec3], at: &str) {
    assert_eq!(found.len(), expected.len());
    // Between moments vertices go straight, within a tenth of a millimetre.
    assert!(found.iter().zip(expected).all(|(a, b)| a.distance(*b) < 3e-4), "{at}: {found:?} for {expected:?}");
}

#[test]
fn skins_stand_in_the_pose_of_their_joints_and_follow_them() {
    let bind_shape = DAffine3::from_translation(DVec3::Y * 3.0);
    let bound = "1 0 0 0 0 1 0 3 0 0 1 0 0 0 0 1";
    let node = "<node id=\"body\"><translate>99 0 0</translate><instance_controller url=\"#skin\"><skeleton>#foot-id</skeleton></instance_controller></node>";
    for joints in [("Name_array", "foot tip"), ("IDREF_array", "foot-id tip-id")] {
        let geometries = format!("<library_geometries>{}</library_geometries>", geometry("g", &STRIP));
        let controllers = format!("<library_controllers>{}</library_controllers>", skin("g", joints, bound));
        let still = load(&(geometries.clone() + &controllers), &format!("{JOINTS}{node}"));
        assert!(still.scene.bodies.is_empty(), "{}", warnings(&still));
        assert_near(&points(&still.scene, 0.0), &expected(30.0, bind_shape), "rest");
        let moving = load(&(geometries + &controllers + &animation("tip-id/r.ANGLE", "0 2", "30 150")), &format!("{node}{JOINTS}"));
        assert!(warnings(&moving).contains("1 things move by 1 channels"), "{}", warnings(&moving));
        assert!(matches!(moving.scene.bodies[0].motion.states, BodyStates::Deform { .. }));
        for time_s in [0.0, 0.4, 0.77, 1.5, 2.0, 5.0f64] {
            assert_near(&points(&moving.scene, time_s), &expected(30.0 + 60.0 * time_s.min(2.0), bind_shape), &format!("{time_s} s"));
        }
    }
}

#[test]
fn morphs_have_their_weights_at_rest_and_over_time_and_are_bent_by_skins() {
    let wide = STRIP.map(|[x, y, z]| [x + 1.0, y, 2.0 * z]);
    let morph = |method: &str| {
        format!(
            "<controller id=\"morph\"><morph source=\"#g\" method=\"{method}\">{}{}<targets><input semantic=\"MORPH_TARGET\" source=\"#t\"/>\
             <input semantic=\"MORPH_WEIGHT\" source=\"#mw\"/></targets></morph></controller>",
            source("t", "IDREF_array", "wide", 1),
            source("mw", "float_array", "0.25", 1)
        )
    };
    let geometries = format!("<library_geometries>{}{}</library_geometries>", geometry("g", &STRIP), geometry("wide", &wide));
    let node = "<node id=\"body\"><translate>0 7 0</translate><instance_controller url=\"#morph\"/></node>";
    let at = |weight: f64, is_relative: bool| {
        let point = |(p, q): (&[f64; 3], &[f64; 3])| {
            let (p, q) = (DVec3::from_array(*p), DVec3::from_array(*q));
            p + weight * if is_relative { q } else { q - p } + DVec3::Y * 7.0
        };
        STRIP.iter().zip(&wide).map(point).collect::<Vec<_>>()
    };
    for (method, is_relative) in [("NORMALIZED", false), ("RELATIVE", true)] {
        let controllers = format!("<library_controllers>{}</library_controllers>", morph(method));
        let still = load(&(geometries.clone() + &controllers), node);
        assert_near(&points(&still.scene, 0.0), &at(0.25, is_relative), method);
        for target in ["mw(0)", "mw-a(0)"] {
            let moving = load(&(geometries.clone() + &controllers + &animation(target, "0 1 2", "0 1 0.5")), node);
            assert!(warnings(&moving).contains("1 things move"), "{}", warnings(&moving));
            for (time_s, weight) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (1.5, 0.75), (3.0, 0.5)] {
                assert_near(&points(&moving.scene, time_s), &at(weight, is_relative), &format!("{method} {time_s} s"));
            }
        }
    }
    // A skin of the morph.
    let controllers =
        format!("<library_controllers>{}{}</library_controllers>", skin("morph", ("Name_array", "foot tip"), ONE), morph("NORMALIZED"));
    let both = load(&(geometries + &controllers), &format!("{JOINTS}<node><instance_controller url=\"#skin\"/></node>"));
    let top = points(&both.scene, 0.0)[4];
    let foot = DAffine3::from_translation(DVec3::new(5.0, 0.0, 1.0)) * DAffine3::from_rotation_x(30f64.to_radians());
    assert!(top.distance(foot.transform_point3(DVec3::new(0.25, 0.0, 2.5 - 1.0))) < 1e-5, "{top}");
}

#[test]
fn skins_that_make_no_sense_stay_as_they_were_bound_and_are_told() {
    let geometries = format!("<library_geometries>{}</library_geometries>", geometry("g", &STRIP));
    let whole = skin("g", ("Name_array", "foot tip"), ONE);
    for (from, to, told) in [
        ("foot tip", "foot hand", "its joint \"hand\" is no node of the scene"),
        ("foot tip", "foot", "it has 1 joints, but 32 finite numbers of their inverse bind matrices"),
        ("0 1 1 1  1 2", "0 1 1 1  7 2", "it names joint 7 of 2"),
        ("0 1 1 1  1 2", "0 1 1 1  1 9", "it names weight 9 of 3"),
        ("0 1 1 1  1 2", "0 1 1 1", "its weights tell of more joints than there are"),
        ("0 1 1 1  1 2", "0 1 1 1  x 2", "the v of its weights are no whole numbers"),
        ("semantic=\"WEIGHT\"", "semantic=\"HEAVY\"", "its weights have no input of WEIGHT"),
    ] {
        let controllers = format!("<library_controllers>{}</library_controllers>", whole.replacen(from, to, 1));
        let node = "<node><instance_controller url=\"#skin\"/></node>";
        let imported = load(&(geometries.clone() + &controllers), &format!("{JOINTS}{node}"));
        let text = warnings(&imported);
        assert!(text.contains(told) && text.contains("it stays as it was bound"), "{text}\nexpected {told}");
        assert_near(&points(&imported.scene, 0.0), &STRIP.map(DVec3::from_array), told);
    }
}

#[test]
fn what_is_in_nodes_whose_scale_changes_deforms_and_moves_within_them() {
    let geometries = format!("<library_geometries>{}</library_geometries>", geometry("g", &STRIP));
    let nodes = "<node id=\"n\"><translate>1 0 0</translate><rotate>0 0 1 90</rotate><scale sid=\"s\">1 1 1</scale><node id=\"m\"><rotate \
        sid=\"r\">0 1 0 0</rotate><instance_geometry url=\"#g\"/></node></node>";
    let two = animation("n/s.Z", "0 2", "1 3").replace("</library_animations>", "");
    let other =
        animation("m/r.ANGLE", "0 1", "0 90").replace("<library_animations>", "").replace("#a", "#a2").replace("id=\"a\"", "id=\"a2\"");
    let other = ["i", "o"]
        .iter()
        .fold(other, |text, id| text.replace(&format!("\"{id}"), &format!("\"{id}2")).replace(&format!("#{id}"), &format!("#{id}2")));
    let moving = load(&(geometries + &two + &other), nodes);
    let text = warnings(&moving);
    assert!(text.contains("1 things move by 2 channels"), "{text}");
    for time_s in [0.0, 0.3, 1.0, 1.6, 2.0, 4.0f64] {
        let stretch = DAffine3::from_scale(DVec3::new(1.0, 1.0, 1.0 + time_s.min(2.0)));
        let turn = DAffine3::from_rotation_y(90f64.to_radians() * time_s.min(1.0));
        let outer = DAffine3::from_translation(DVec3::X) * DAffine3::from_rotation_z(90f64.to_radians());
        let expected = STRIP.map(|p| (outer * stretch * turn).transform_point3(DVec3::from_array(p)));
        assert_near(&points(&moving.scene, time_s), &expected, &format!("{time_s} s"));
    }
}

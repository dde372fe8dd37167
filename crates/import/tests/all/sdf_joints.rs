//! Joints of SDF, against places by formula.

use crate::common::{Folder, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{BodyStates, Scene};
use std::f64::consts::FRAC_PI_2;

/// A cupboard at (1, 0, 0) with a door of a metre that turns about z at (1, 1), a knob on it, and a drawer that follows by half.
const CUPBOARD: &str = r#"<sdf version="1.11"><world name="w"><model name="cupboard"><pose>1 0 0 0 0 0</pose>
  <frame name="front"><pose>0 1 0 0 0 0</pose></frame>
  <link name="case"><visual name="v"><geometry><box><size>.1 .1 .1</size></box></geometry></visual></link>
  <link name="door"><pose relative_to="front">0 0 0 0 0 0</pose>
    <visual name="v"><pose>.5 0 1 0 0 0</pose><geometry><box><size>1 .1 2</size></box></geometry></visual></link>
  <link name="knob"><pose relative_to="door">.9 -.1 1 0 0 0</pose>
    <visual name="v"><geometry><box><size>.1 .1 .1</size></box></geometry></visual></link>
  <link name="drawer"><pose degrees="true">0 0 .5 0 0 90</pose>
    <visual name="v"><geometry><box><size>.2 .2 .2</size></box></geometry></visual></link>
  <joint name="ground" type="fixed"><parent>world</parent><child>case</child></joint>
  <joint name="hinge" type="revolute"><parent>case</parent><child>door</child>
    <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>1.6</upper></limit></axis></joint>
  <joint name="glue" type="fixed"><parent>door</parent><child>knob</child></joint>
  <joint name="rail" type="prismatic"><parent>case</parent><child>drawer</child>
    <axis><xyz expressed_in="__model__">0 -1 0</xyz><limit><lower>0</lower><upper>.5</upper></limit>
      <mimic joint="hinge" axis="axis"><multiplier>.5</multiplier><offset>.1</offset><reference>.2</reference></mimic></axis></joint>
</model></world></sdf>"#;

fn load(text: &str, states: Option<&str>) -> Result<Imported, String> {
    let folder = Folder::new();
    folder.write("a.sdf", text);
    let states = states.map(|table| folder.write("run.csv", table).path("run.csv"));
    folder.load_with("a.sdf", &ImportOptions { states, ..ImportOptions::default() }).map_err(|error| error.to_string())
}

fn assert_box(scene: &Scene, name: &str, low: [f32; 3], high: [f32; 3]) {
    let part = scene.parts.iter().find(|part| part.name == name).unwrap_or_else(|| panic!("no part {name}"));
    let found = scene.world_positions(part).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let expected = (Vec3::from_array(low), Vec3::from_array(high));
    assert!(found.0.distance(expected.0) < 1e-5 && found.1.distance(expected.1) < 1e-5, "{name}: {found:?}, expected {expected:?}");
}

#[test]
fn joints_are_bodies_with_axes_and_limits_at_rest() {
    let imported = load(CUPBOARD, None).unwrap();
    let scene = &imported.scene;
    assert!(scene.is_still(), "{}", warnings(&imported));
    let bodies: Vec<_> = scene.bodies.iter().map(|body| (body.name.as_str(), body.parent, body.limits, body.parts.len())).collect();
    assert_eq!(bodies, [("door", None, Some([0.0, 1.6]), 2), ("drawer", None, Some([0.0, 0.5]), 1)]);
    let BodyStates::Hinge { point, axis, .. } = &scene.bodies[0].motion.states else { panic!() };
    assert!(point.distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-12 && axis.distance(DVec3::Z) < 1e-12);
    let BodyStates::Slide { axis, .. } = &scene.bodies[1].motion.states else { panic!() };
    assert!(axis.distance(DVec3::NEG_Y) < 1e-12, "{axis}");
    assert_box(scene, "cupboard.door", [1.0, 0.95, 0.0], [2.0, 1.05, 2.0]);
    assert_box(scene, "cupboard.knob", [1.85, 0.85, 0.95], [1.95, 0.95, 1.05]);
}

#[test]
fn a_table_of_states_opens_the_door_and_what_follows_it() {
    let scene = load(CUPBOARD, Some(&format!("time,hinge\n0,0\n2,{FRAC_PI_2}\n"))).unwrap().scene;
    let end = scene.at(2.0);
    assert_box(&end, "cupboard.door", [0.95, 1.0, 0.0], [1.05, 2.0, 2.0]);
    assert_box(&end, "cupboard.knob", [1.05, 1.85, 0.95], [1.15, 1.95, 1.05]);
    let slid = (0.5 * (FRAC_PI_2 - 0.2) + 0.1) as f32;
    assert_box(&end, "cupboard.drawer", [0.9, -slid - 0.1, 0.4], [1.1, -slid + 0.1, 0.6]);
    let error = load(CUPBOARD, Some("time,hing\n0,0\n")).unwrap_err();
    assert!(error.contains("there is no joint of this name among \"hinge\", \"rail\""), "{error}");
}

#[test]
fn axes_of_old_versions_are_the_models_and_joints_turn_round_towards_the_world() {
    // The child of the hinge stands fixed, so its parent moves: the other way about the same axis.
    let text = |version: &str| {
        format!(
            r#"<sdf version="{version}"><model name="m">
             <link name="a"><pose>0 0 0 0 0 0</pose><visual name="v"><pose>1 0 0 0 0 0</pose><geometry><box><size>.2 .2 .2</size></box></geometry></visual></link>
             <link name="b"><pose>0 0 0 0 1.5707963267948966 0</pose></link>
             <joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis></joint>
             <joint name="k" type="fixed"><parent>world</parent><child>b</child></joint></model></sdf>"#
        )
    };
    for (version, axis) in [("1.4", DVec3::NEG_X), ("1.7", DVec3::Z)] {
        let scene = load(&text(version), None).unwrap().scene;
        let BodyStates::Hinge { axis: found, .. } = &scene.bodies[0].motion.states else { panic!() };
        assert!(found.distance(axis) < 1e-12 && scene.bodies[0].limits == Some([-1.0, 2.0]), "{version}: {found}");
    }
}

#[test]
fn circles_unknown_links_and_kinds_that_are_not_read_are_said() {
    let link = |name: &str| {
        format!(r#"<link name="{name}"><visual name="v"><geometry><box><size>.1 .1 .1</size></box></geometry></visual></link>"#)
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str| {
        format!(
            r#"<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child><axis><xyz>0 0 1</xyz></axis></joint>"#
        )
    };
    let model =
        |joints: &str| format!(r#"<sdf version="1.8"><model name="m">{}{}{}{joints}</model></sdf>"#, link("a"), link("b"), link("c"));
    let ring = [joint("1", "revolute", "a", "b"), joint("2", "revolute", "b", "c"), joint("3", "continuous", "c", "a")].concat();
    let imported = load(&model(&ring), None).unwrap();
    assert_eq!(imported.scene.bodies.len(), 2);
    assert!(warnings(&imported).contains("joint \"3\": it closes a circle"), "{}", warnings(&imported));
    let odd = [joint("1", "screw", "a", "b"), joint("2", "revolute", "a", "gone"), joint("3", "ball", "world", "c")].concat();
    let imported = load(&model(&odd), None).unwrap();
    assert_eq!(imported.scene.bodies.iter().map(|body| body.motion.states.joint()).collect::<Vec<_>>(), ["free"]);
    for expected in ["joints of the type \"screw\" are not read", "there is no link \"gone\" in its model"] {
        assert!(warnings(&imported).contains(expected), "{}", warnings(&imported));
    }
    let told = r#"<sdf version="1.8"><model name="m"><link name="a"><pose relative_to="b"/></link><link name="b"><pose relative_to="a"/></link></model></sdf>"#;
    let error = load(told, None).unwrap_err();
    assert!(error.contains("in a circle; take out one relative_to"), "{error}");
}

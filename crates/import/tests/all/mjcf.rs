//! Models of MuJoCo and stored runs, made on the spot. Boxes of `ODD` are those that MuJoCo 4.0.0 gives (`geom_xpos`, `geom_xmat`, `mesh_vert`).

use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::{Bsdf, Light, Scene};
use std::io::{Cursor, Write};

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

const ODD: &str = r#"<mujoco model="odd"><compiler angle="radian" eulerseq="XyZ" meshdir="."/>
<default><geom type="box" size=".1 .2 .3"/><default class="a"><geom rgba="1 0 0 1" euler=".1 .2 .3"/><joint ref=".3"/></default></default>
<asset><mesh name="m" file="t.obj" refpos=".1 .2 .3" refquat=".9 .1 .2 .3" scale="1 2 -.5"/></asset>
<worldbody>
 <replicate count="4" offset=".3 .1 0" euler=".2 .1 .5"><geom pos="1 0 0" size=".05"/>
  <body name="r" pos="0 2 0"><freejoint/><geom size=".03" euler=".3 .2 .1"/></body></replicate>
 <body name="b" pos="1 2 3" axisangle="1 1 0 .7" childclass="a">
  <joint name="s" type="slide" axis="1 1 0" range="-1 .5"/><joint name="h" axis="0 1 1" pos=".2 0 .1"/><joint name="q" type="ball" pos="0 .1 0"/>
  <geom/><frame pos=".5 0 0" zaxis="1 1 1"><geom quat="1 .5 0 0"/>
   <body name="c" pos="0 0 .5" xyaxes="0 1 0 -1 .2 0"><joint name="j" pos=".1 .1 0" axis="1 0 0"/><geom type="mesh" mesh="m" pos=".1 .2 .3"/>
    <geom type="capsule" fromto="0 0 0 1 1 1" size=".1"/><geom type="box" fromto="0 0 0 1 1 1" size=".1"/>
    <geom type="cylinder" size=".1 .5"/><geom type="ellipsoid" size=".1 .5 .3"/></body></frame></body>
</worldbody></mujoco>"#;

/// Boxes at rest, and with the states of `MOVED`, by part.
const BOXES: [(&str, [f32; 6], [f32; 6]); 8] = [
    ("r0", [-0.11613, 1.72469, -0.34569, 0.11613, 2.27531, 0.34569], [0.72469, 1.65431, 2.88387, 1.27531, 2.34569, 3.11613]),
    ("r3", [-1.42066, 0.59312, 0.77687, -0.72452, 0.92851, 1.43082], [-1.42066, 0.59312, 0.77687, -0.72452, 0.92851, 1.43082]),
    ("b", [0.71289, 1.66632, 2.63877, 1.28711, 2.33368, 3.36123], [0.7616, 1.8234, 2.76623, 1.44632, 2.54902, 3.29556]),
    ("b_2", [1.07187, 1.71188, 2.53406, 1.81055, 2.4057, 3.01041], [0.74303, 2.2491, 3.0624, 1.30401, 2.88399, 3.62829]),
    ("c.m", [0.90859, 0.35921, 2.10773, 2.25159, 3.39293, 6.08124], [0.64875, 0.71454, 1.29546, 2.2275, 3.09931, 5.01238]),
    ("c", [1.76139, 2.11596, 2.89303, 2.03689, 3.39516, 4.44567], [1.34089, 1.61017, 3.20451, 2.79281, 2.97888, 3.66301]),
    ("c_3", [1.41806, 1.87199, 2.70024, 2.30471, 2.55994, 3.28581], [0.93424, 2.74744, 3.43533, 1.94754, 3.01032, 3.69068]),
    ("c_4", [1.60605, 1.95032, 2.53017, 2.11672, 2.48161, 3.45588], [1.1396, 2.67475, 3.09658, 1.74218, 3.083, 4.02943]),
];

/// Two steps of `qpos`, of which the second has MuJoCo's quaternions (w, x, y, z) at rest but for the first free body, and moved joints.
fn qpos() -> Vec<f64> {
    let free = [
        [0.0, 2.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [
            -0.6397378938990306,
            1.8201786764100945,
            0.39733866159012243,
            0.961632611936709,
            0.08430567974214892,
            0.07285182744658007,
            0.2506948010244541,
        ],
        [
            -1.0379722612922455,
            1.3296425631152888,
            0.7693505991946306,
            0.8462836255229672,
            0.12656910044749425,
            0.18063696915133992,
            0.4849273897806066,
        ],
        [
            -1.0725915171444496,
            0.7608183078058531,
            1.103844724208269,
            0.6610574340971673,
            0.11648755688210406,
            0.30363470609034626,
            0.6761950038072868,
        ],
    ];
    let rest = [&free.concat()[..], &[0.3, 0.3, 1.0, 0.0, 0.0, 0.0, 0.3]].concat();
    let moved = [&[1.0, 2.0, 3.0, 0.5, 0.5, -0.5, 0.5][..], &free[1..].concat(), &[0.55, 0.8, 0.5, 0.5, 0.5, 0.5, -0.4]].concat();
    [rest, moved].concat()
}

/// An archive of arrays of float64, as `numpy.savez` writes it.
fn npz(arrays: &[(&str, &[usize], &[f64])]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, shape, values) in arrays {
        let axes = shape.iter().map(|axis| format!("{axis},")).collect::<String>();
        let header = format!("{:<117}\n", format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({axes}), }}"));
        archive.start_file(format!("{name}.npy"), zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(b"\x93NUMPY\x01\x00").unwrap();
        archive.write_all(&(header.len() as u16).to_le_bytes()).unwrap();
        archive.write_all(header.as_bytes()).unwrap();
        archive.write_all(&values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

fn assert_box(scene: &Scene, name: &str, expected: [f32; 6]) {
    let part = scene.parts.iter().find(|part| part.name == name).unwrap_or_else(|| panic!("no part {name}"));
    let (low, high) = scene.world_positions(part).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let expected = [Vec3::from_slice(&expected), Vec3::from_slice(&expected[3..])];
    // Round things are polygons of 96 sides.
    assert!(low.distance(expected[0]) < 1e-3 && high.distance(expected[1]) < 1e-3, "{name}: {low} to {high}, expected {expected:?}");
}

fn odd() -> Folder {
    let folder = Folder::new();
    folder.write("odd.xml", ODD).write("t.obj", TETRAHEDRON);
    folder
}

fn with_states(folder: &Folder, name: &str, states: &str) -> Result<Imported, String> {
    let options = ImportOptions { states: Some(folder.path(states)), ..ImportOptions::default() };
    folder.load_with(name, &options).map_err(|error| error.to_string())
}

#[test]
fn geoms_stand_where_mujoco_has_them() {
    let imported = odd().load("odd.xml").unwrap();
    assert_eq!((imported.report.format, imported.scene.is_still()), ("mjcf", true));
    BOXES.iter().for_each(|(name, rest, _)| assert_box(&imported.scene, name, *rest));
}

#[test]
fn joints_are_bodies_with_limits_several_of_one_body_a_chain() {
    let scene = odd().load("odd.xml").unwrap().scene;
    let bodies: Vec<(&str, Option<u32>, &str, usize)> =
        scene.bodies.iter().map(|body| (body.name.as_str(), body.parent, body.motion.states.joint(), body.parts.len())).collect();
    assert_eq!(
        bodies[3..],
        [
            ("r3", None, "free", 1),
            ("b.s", None, "slide", 0),
            ("b.h", Some(4), "hinge", 0),
            ("b", Some(5), "free", 2),
            ("c", Some(6), "hinge", 5)
        ]
    );
    // The state at rest is 0.3.
    let [low, high] = scene.bodies[4].limits.unwrap();
    assert!((low + 1.3).abs() < 1e-12 && (high - 0.2).abs() < 1e-12);
    assert_eq!(scene.bodies[5].limits, None);
}

#[test]
fn bodies_follow_the_joints_of_a_run() {
    let folder = odd();
    folder.write("run.npz", npz(&[("qpos", &[2, 35], &qpos()), ("time", &[2], &[0.0, 0.5])]));
    let imported = with_states(&folder, "odd.xml", "run.npz").unwrap();
    assert!(imported.inputs.contains(&folder.path("run.npz")));
    for (name, rest, moved) in BOXES {
        assert_box(&imported.scene.at(0.0), name, rest);
        assert_box(&imported.scene.at(0.5), name, moved);
        assert_box(&imported.scene.at(9.0), name, moved);
    }
}

#[test]
fn bodies_follow_their_poses_in_the_world() {
    let model = r#"<mujoco><worldbody><body name="arm" pos="0 0 1"><joint axis="0 0 1"/><geom type="box" size=".5 .1 .1" pos=".5 0 0"/>
        <body name="plate" pos="1 0 0"><geom type="box" size=".1 .1 .1"/></body>
        <body name="hand" pos="1 0 .5"><joint type="slide" axis="1 0 0"/><geom type="box" size=".1 .1 .1"/></body></body>
        <body name="block" mocap="true" pos="3 0 0"><geom type="box" size=".1 .2 .3"/></body></worldbody></mujoco>"#;
    let folder = Folder::new();
    folder.write("a.xml", model);
    let half = 0.5f64.sqrt();
    // A quarter turn of the arm, whose hand slid 0.2 m; the block went up.
    let xpos = [
        [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 1.5], [3.0, 0.0, 0.0]],
        [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, 1.2, 1.5], [3.0, 0.0, 2.0]],
    ];
    let turned = [half, 0.0, 0.0, half];
    let none = [1.0, 0.0, 0.0, 0.0];
    let xquat = [[none; 5], [none, turned, turned, turned, none]];
    let (xpos, xquat) = (xpos.as_flattened().as_flattened(), xquat.as_flattened().as_flattened());
    folder.write("run.npz", npz(&[("xpos", &[2, 5, 3], xpos), ("xquat", &[2, 5, 4], xquat), ("time", &[2], &[0.0, 1.0])]));
    let scene = with_states(&folder, "a.xml", "run.npz").unwrap().scene;
    let at = scene.at(1.0);
    assert_box(&at, "plate", [-0.1, 0.9, 0.9, 0.1, 1.1, 1.1]);
    assert_box(&at, "hand", [-0.1, 1.1, 1.4, 0.1, 1.3, 1.6]);
    assert_box(&at, "block", [2.9, -0.2, 1.7, 3.1, 0.2, 2.3]);
    // Half way the hand rides on the arm that turns: it does not take the chord.
    let half_way = scene.at(0.5);
    let hand = half_way.parts.iter().find(|part| part.name == "hand").unwrap().world_from_mesh.translation;
    assert!(hand.distance(DVec3::new(1.1 * half, 1.1 * half, 1.5)) < 1e-9, "{hand}");

    let mut other = xpos.to_vec();
    other[6] = 1.3;
    folder.write("other.npz", npz(&[("xpos", &[2, 5, 3], &other), ("xquat", &[2, 5, 4], xquat), ("time", &[2], &[0.0, 1.0])]));
    let error = with_states(&folder, "a.xml", "other.npz").unwrap_err();
    assert!(error.contains("\"plate\" is at [1.3, 0, 1] in step 0") && error.contains("another model"), "{error}");
}

#[test]
fn states_that_do_not_fit_name_file_body_and_step() {
    let folder = odd();
    let good = qpos();
    let nan = [&good[..64], &[f64::NAN], &good[65..]].concat();
    let zero = [&good[..35 + 3], &[0.0; 4], &good[35 + 7..]].concat();
    let times: (&str, &[usize], &[f64]) = ("time", &[2], &[0.0, 0.5]);
    let long = vec![0.0; 200_001];
    for (arrays, expected) in [
        (vec![("qpos", &[2, 35][..], &nan[..]), times], "array \"qpos\": joint \"h\" is [NaN] in step 1 (0.5 s)"),
        (vec![("qpos", &[2, 35], &zero), times], "joint \"r0\" is [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0] in step 1"),
        (
            vec![("qpos", &[2, 34], &good[..68]), times],
            "found [34] values by step, expected [35]: qpos of the model's 8 joints; are these states of another",
        ),
        (vec![("qpos", &[2, 35], &good), ("time", &[3], &[0.0, 1.0, 2.0])], "array \"qpos\": it has 2 steps, but time has 3"),
        (vec![("qpos", &[2, 35], &good), ("time", &[2], &[1.0, 0.5])], "step 1 (0.5 s) comes before the one ahead of it (1 s)"),
        (vec![("qpos", &[2, 35], &good), ("time", &[2], &[1.0, f64::INFINITY])], "array \"time\": step 1 is inf"),
        (vec![("wheel", &[2], &[0.0, 1.0]), times], "array \"wheel\": there is no joint of this name among \"r0\", \"r1\""),
        (vec![("qpos", &[200_001], &long), ("time", &[200_001], &long)], "200001 steps, more than 200000; save every n-th (qpos[::2])"),
        (vec![("qpos", &[2, 35], &good[..69]), times], "69 elements for a shape of (2,35,); it is cut short"),
    ] {
        folder.write("run.npz", npz(&arrays));
        let error = with_states(&folder, "odd.xml", "run.npz").unwrap_err();
        assert!(error.contains("run.npz: ") && error.contains(expected), "{error}\nexpected {expected}");
    }
    folder.write("run.npz", "text");
    assert!(with_states(&folder, "odd.xml", "run.npz").unwrap_err().contains("not an archive that can be read"));
    assert!(with_states(&folder, "t.obj", "run.npz").unwrap_err().contains("import option states: found"));
    // Without moments, a step takes the model's time.
    folder.write("run.npz", npz(&[("qpos", &[2, 35], &good)]));
    let imported = with_states(&folder, "odd.xml", "run.npz").unwrap();
    assert!(warnings(&imported).contains("a step was taken for 0.002 s"));
    assert_eq!(imported.scene.bodies[0].motion.times_s, [0.0, 0.002]);
}

#[test]
fn includes_materials_textures_cameras_and_lights() {
    let folder = Folder::new();
    folder.write("pictures/oak.png", png(2, 2, [10, 20, 30, 255]));
    folder.write(
        "parts/assets.xml",
        r#"<mujocoinclude><asset><texture name="oak" type="2d" file="oak.png"/><texture name="tiles" type="2d" builtin="checker" rgb1="1 0 0"
          rgb2="0 0 1" width="8" height="8"/><texture name="dusk" type="cube" builtin="gradient" rgb1="1 1 1" rgb2="0 0 0" width="4" height="4"/>
        <material name="oak" texture="oak" rgba=".5 .5 .5 .5"/><material name="tiles" texture="tiles" texrepeat="4 2" texuniform="true"/>
        <material name="dusk" texture="dusk" emission="2" metallic="1" roughness=".2"/></asset></mujocoinclude>"#,
    );
    folder.write(
        "a.xml",
        r#"<mujoco><compiler texturedir="pictures"/><include file="parts/assets.xml"/><statistic center="0 0 1"/><worldbody>
        <geom name="floor" type="plane" size="3 0 .1" material="tiles"/><geom name="ball" size=".2" material="oak" rgba="0 1 0 1"/>
        <geom name="cube" type="box" size=".1 .1 .1" material="dusk"/><geom name="shell" type="box" size="1 1 1" group="3"/>
        <geom name="ghost" size="1" rgba="1 1 1 0"/>
        <camera name="eye" pos="0 -2 1" xyaxes="1 0 0 0 0 1" fovy="90" resolution="200 100"/>
        <camera name="aim" mode="targetbody" target="post" pos="0 -1 0"/>
        <light name="sun" type="directional" dir="0 0 -2" diffuse="1 1 1"/><light name="lamp" pos="0 0 3" dir="0 0 -1" diffuse="1 1 1" cutoff="30"/>
        <body name="post" pos="0 1 0"><geom size=".1"/></body></worldbody></mujoco>"#,
    );
    let imported = folder.load("a.xml").unwrap();
    let scene = &imported.scene;
    assert_eq!(scene.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["floor", "ball", "cube", "post"]);
    assert_box(scene, "floor", [-3.0, -10.0, 0.0, 3.0, 10.0, 0.0]);
    let surface = |part: usize| {
        let material = &scene.materials[scene.parts[part].material as usize];
        let Bsdf::Principled(principled) = &material.bsdf else { panic!("{:?}", material.bsdf) };
        (material, principled)
    };
    let (_, tiles) = surface(0);
    // Four tiles by two metres across 6 m, which begin at the edge.
    assert_eq!(tiles.base_color.texture.unwrap().uv_transform, [[6.0, 0.0, 6.0], [0.0, 10.0, 10.0]]);
    let (_, ball) = surface(1);
    assert_eq!((ball.base_color.factor.to_array(), ball.base_color.texture.is_some()), ([0.0, 1.0, 0.0], true));
    let (dusk, metal) = surface(2);
    assert_eq!((dusk.emission.factor.to_array(), metal.metallic.factor, metal.roughness.factor), ([2.0; 3], 1.0, 0.2));
    let eye = &scene.cameras[0];
    assert!((eye.fov_x_rad - 2.0 * 2.0f64.atan()).abs() < 1e-12 && eye.aspect == 2.0);
    assert!(scene.cameras[1].world_from_camera.z_axis.distance(DVec3::NEG_Y) < 1e-12);
    let Light::Directional { irradiance, .. } = &scene.lights[0] else { panic!("{:?}", scene.lights[0]) };
    assert!((irradiance.g - std::f32::consts::PI).abs() < 1e-6);
    // Two metres from the middle.
    let Light::Spot { intensity, outer_rad, .. } = &scene.lights[1] else { panic!("{:?}", scene.lights[1]) };
    assert!((intensity.g - 4.0 * std::f32::consts::PI).abs() < 1e-5 && (outer_rad.to_degrees() - 30.0).abs() < 1e-4);
    let told = warnings(&imported);
    for expected in
        ["1 geoms of other groups were left out", "1 geoms have an opacity of zero", "1 planes have no end", "MuJoCo's lights have no unit"]
    {
        assert!(told.contains(expected), "{told}");
    }
    let shells = folder.load_with("a.xml", &ImportOptions { geom_groups: vec![3], ..ImportOptions::default() }).unwrap();
    assert_eq!(shells.scene.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["shell"]);
}

const ARM: &str = r#"<mujoco><compiler angle="radian"/><worldbody>
  <camera name="wall" pos="0 -3 1" xyaxes="1 0 0 0 0 1"/><camera name="watch" mode="targetbody" target="arm" pos="0 -1 0"/>
  <body name="arm" pos="0 0 1"><joint name="turn" axis="0 0 1" range="-2 2"/><geom type="box" size=".1 .1 .1"/>
   <camera name="chase" mode="track" pos="0 -1 1"/>
   <body name="hand" pos=".5 0 0"><joint name="reach" type="slide" axis="1 0 0"/>
    <camera name="wrist" pos=".1 0 .2" xyaxes="0 -1 0 0 0 1"/></body></body></worldbody></mujoco>"#;

#[test]
fn cameras_ride_on_the_bodies_that_they_are_in() {
    let folder = Folder::new();
    let (angle, way) = (|t: f64| 0.9 * t.sin(), |t: f64| 0.2 * t);
    let rows: String = (0..=10).map(|step| f64::from(step) * 0.1).map(|t| format!("{t},{},{}\n", angle(t), way(t))).collect();
    folder.write("arm.xml", ARM).write("run.csv", format!("time,turn,reach\n{rows}"));
    let imported = with_states(&folder, "arm.xml", "run.csv").unwrap();
    let scene = &imported.scene;
    let number = |name: &str| scene.cameras.iter().position(|camera| camera.name == name).unwrap();
    // The hand has nothing but a camera, and is there for its sake.
    let riding: Vec<(&str, &[u32])> = scene.bodies.iter().map(|body| (body.name.as_str(), body.cameras.as_slice())).collect();
    assert_eq!(riding, [("arm", &[][..]), ("hand", &[number("wrist") as u32][..])]);
    for step in 0..=10 {
        let t = f64::from(step) * 0.1;
        let cameras = scene.cameras_at(t);
        let (sin, cos) = angle(t).sin_cos();
        let (wrist, reach) = (&cameras[number("wrist")], 0.6 + way(t));
        assert!(wrist.position.distance(DVec3::new(reach * cos, reach * sin, 1.2)) < 1e-5, "{t} s: {}", wrist.position);
        let axes = wrist.world_from_camera;
        assert!(axes.z_axis.distance(-DVec3::new(cos, sin, 0.0)) < 1e-9 && axes.y_axis.distance(DVec3::Z) < 1e-9, "{axes}");
        for still in ["wall", "watch", "chase"] {
            assert_eq!(cameras[number(still)], scene.cameras[number(still)]);
        }
    }
    let told = warnings(&imported);
    assert!(
        told.contains("(mode track)") && told.contains("(mode targetbody)") && told.matches("it stays as it is at rest").count() == 2,
        "{told}"
    );
}

#[test]
fn models_that_are_wrong_name_file_line_and_element() {
    let folder = Folder::new();
    let within = |world: &str| format!("<mujoco>\n<worldbody>{world}</worldbody></mujoco>");
    for (text, expected) in [
        (within("<geom size='0'/>"), "a.xml: line 2 <geom>: found [0.0] as size, expected lengths above zero for a sphere"),
        (within("<geom name='g' size='nan'/>"), "line 2 <geom> \"g\": found \"nan\" as size, expected 1 to 3 finite numbers"),
        (within("<geom type='mesh' mesh='m'/>"), "there is no mesh \"m\" among the assets"),
        (within("<geom size='1' material='m'/>"), "there is no material \"m\" among the assets"),
        (within("<geom size='1' class='c'/>"), "there is no default class \"c\""),
        (within("<body quat='0 0 0 0'/>"), "quat has no direction"),
        (within("<body><joint axis='0 0 0'/></body>"), "axis has no direction"),
        (within("<attach model='m' body='b' prefix='p'/>"), "models within models (attach) are not read; save the whole model in one file"),
        ("<mujoco><include file='a.xml'/></mujoco>".into(), "files include each other more than 16 deep"),
        ("<mujoco><include file='b.xml'/></mujoco>".into(), "b.xml: cannot be read"),
        ("<mujoco><compiler coordinate='global'/></mujoco>".into(), "coordinates are global"),
        (
            "<mujoco><asset><mesh name='m' file='m.stl'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>".into(),
            "needs the mesh",
        ),
    ] {
        let error = folder.write("a.xml", &text).error("a.xml");
        assert!(error.contains(expected), "{error}\nexpected {expected}");
    }
}

const DOOR: &str = r#"<robot name="cupboard"><link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="door"><visual><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 1"/></geometry></visual></link>
  <link name="knob"><visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>
  <link name="drawer"><visual><geometry><box size="0.2 0.2 0.2"/></geometry></visual></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="door"/><origin xyz="0 1 0"/><axis xyz="0 0 1"/><limit lower="0" upper="1.6"/></joint>
  <joint name="glue" type="fixed"><parent link="door"/><child link="knob"/><origin xyz="1 0 0"/></joint>
  <joint name="rail" type="prismatic"><parent link="base"/><child link="drawer"/><origin xyz="0 0 2"/><axis xyz="0 -1 0"/>
    <mimic joint="hinge" multiplier="0.5" offset="0.1"/></joint></robot>"#;

#[test]
fn joints_of_urdf_are_bodies_that_follow_a_table() {
    let folder = Folder::new();
    folder.write("a.urdf", DOOR).write("run.csv", "time, hinge\n0, 0\n2, 1.5707963267948966\n");
    let rest = folder.load("a.urdf").unwrap();
    let bodies: Vec<_> = rest.scene.bodies.iter().map(|body| (body.name.as_str(), body.motion.states.joint(), body.limits)).collect();
    assert_eq!(bodies, [("drawer", "slide", None), ("door", "hinge", Some([0.0, 1.6]))]);
    assert!(rest.scene.is_still() && warnings(&rest).contains("it has no limits"));

    let scene = with_states(&folder, "a.urdf", "run.csv").unwrap().scene;
    // As spreadsheets of countries with decimal commas write it.
    folder.write("comma.csv", "\u{feff}time;hinge\r\n0,0;0\r\n2,0;1,5707963267948966\r\n");
    assert_eq!(with_states(&folder, "a.urdf", "comma.csv").unwrap().scene, scene);
    let end = scene.at(2.0);
    assert_box(&end, "door", [-0.05, 1.0, -0.5, 0.05, 2.0, 0.5]);
    assert_box(&end, "knob", [-0.05, 1.95, -0.05, 0.05, 2.05, 0.05]);
    let slid = -(0.5 * std::f32::consts::FRAC_PI_2 + 0.1);
    assert_box(&end, "drawer", [-0.1, slid - 0.1, 1.9, 0.1, slid + 0.1, 2.1]);

    for (table, expected) in [
        ("time,hing\n0,0\n", "array \"hing\": there is no joint of this name among \"rail\", \"hinge\""),
        ("time,hinge\n0,x\n", "column \"hinge\": row 2 has \"x\", expected a number"),
        ("hinge\n0\n", "array \"time\": it is missing"),
        ("time,hinge\n0,NaN\n", "is [NaN] in step 0"),
    ] {
        let error = with_states(folder.write("run.csv", table), "a.urdf", "run.csv").unwrap_err();
        assert!(error.contains(expected), "{error}\nexpected {expected}");
    }
}

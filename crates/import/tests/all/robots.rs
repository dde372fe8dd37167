//! STL, URDF and SDF, made on the spot.

use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::{Rgb, Vec3, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, Light};

fn bounds(imported: &Imported, name: &str) -> (Vec3, Vec3) {
    let scene = &imported.scene;
    let parts = scene.parts.iter().filter(|p| p.name == name || p.name.starts_with(&format!("{name}_")));
    let points: Vec<Vec3> = parts.flat_map(|part| scene.world_positions(part).collect::<Vec<_>>()).collect();
    assert!(!points.is_empty(), "no {name} in {:?}", scene.parts.iter().map(|p| &p.name).collect::<Vec<_>>());
    points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)))
}

fn assert_bounds(imported: &Imported, name: &str, min: [f32; 3], max: [f32; 3]) {
    let (low, high) = bounds(imported, name);
    assert!((low - Vec3::from(min)).length() < 1e-3 && (high - Vec3::from(max)).length() < 1e-3, "{name}: {low} to {high}");
}

/// Two facets of a square of 2 m, as text.
const TEXT: &str = "solid Plate\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 1\n   vertex 2 0 1\n   vertex 2 2 1\n  endloop\n endfacet\n \
    facet normal 0 0 1\n  outer loop\n   vertex 0 0 1\n   vertex 2 2 1\n   vertex 0 2 1\n  endloop\n endfacet\nendsolid Plate\n";

/// An STL file in binary, behind a head of 80 bytes.
fn binary(head: &str) -> Vec<u8> {
    let mut bytes = head.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(2u32.to_le_bytes());
    for corners in [[[0.0f32, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 2.0, 1.0]], [[0.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 2.0, 1.0]]] {
        bytes.extend([0.0f32, 0.0, 1.0].map(f32::to_le_bytes).concat());
        corners.iter().for_each(|p| bytes.extend(p.map(f32::to_le_bytes).concat()));
        bytes.extend([0, 0]);
    }
    bytes
}

#[test]
fn stl_of_both_kinds_is_one_closed_square_with_z_up() {
    let folder = Folder::new();
    let upper = TEXT.replace("vertex", "VERTEX").replace("solid Plate", "SOLID Plate").replace('\n', "\r\n");
    let kinds: [(&[u8], &str); 6] = [
        (TEXT.as_bytes(), "Plate"),
        (upper.as_bytes(), "Plate"),
        (&binary("made by CAD"), "a"),
        // Some programs begin binary files with this word too.
        (&binary("solid made by CAD"), "a"),
        (&[binary("x"), vec![0; 7]].concat(), "a"),
        (&format!("\u{feff}{TEXT}").into_bytes(), "Plate"),
    ];
    for (i, (bytes, name)) in kinds.into_iter().enumerate() {
        let imported = folder.write("a.STL", bytes).load("a.STL").unwrap_or_else(|e| panic!("{i}: {e}"));
        assert_eq!((imported.report.format, imported.scene.parts[0].name.as_str()), ("stl", name), "{i}");
        assert_eq!((imported.scene.meshes[0].positions.len(), imported.scene.meshes[0].triangles.len()), (4, 2), "{i}");
        assert_bounds(&imported, name, [0.0, 0.0, 1.0], [2.0, 2.0, 1.0]);
    }
    assert!(folder.write("a.stl", "nothing\n").error("a.stl").contains("found neither `solid`"));
    assert!(folder.write("a.stl", TEXT.replace("2 2 1", "2 two 1")).error("a.stl").contains("line 6"));
    assert!(folder.write("a.stl", "").load("a.stl").is_err());
}

const COUNTER: &str = r#"<?xml version="1.0"?>
<robot name="cupboard">
  <material name="oak"><color rgba="0.5 0.25 0 1"/></material>
  <link name="base"><visual><origin xyz="0 0 0.5"/><geometry><box size="2, 1, 1"/></geometry><material name="oak"/></visual></link>
  <link name="knob"><visual><geometry><sphere radius="0.1"/></geometry><material name="red"><color rgba="1 0 0 0.5"/></material></visual></link>
  <link name="leg"><visual name="tube"><origin rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.2" length="2"/></geometry></visual></link>
  <link name="plate"><visual><geometry><mesh filename="package://furniture/meshes/plate.stl" scale="0.5"/></geometry><material name="oak"/></visual></link>
  <joint name="a" type="revolute"><parent link="base"/><child link="knob"/><origin xyz="1 0 0.5" rpy="0 0 1.5707963267948966"/></joint>
  <joint name="b" type="fixed"><parent link="knob"/><child link="leg"/><origin xyz="1 0 0"/></joint>
  <joint name="c" type="fixed"><parent link="base"/><child link="plate"/></joint>
</robot>"#;

#[test]
fn urdf_stands_at_rest_with_its_shapes_and_materials() {
    let folder = Folder::new();
    folder.write("furniture/urdf/cupboard.urdf", COUNTER).write("furniture/meshes/plate.stl", TEXT);
    let imported = folder.load("furniture/urdf/cupboard.urdf").unwrap_or_else(|e| panic!("{e}"));
    assert_bounds(&imported, "base", [-1.0, -0.5, 0.0], [1.0, 0.5, 1.0]);
    assert_bounds(&imported, "knob", [0.9, -0.1, 0.4], [1.1, 0.1, 0.6]);
    // The joint turns x to y: the leg's x of 1 is y, and its tube, along x of the knob, is along y.
    assert_bounds(&imported, "leg.tube", [0.8, 0.0, 0.3], [1.2, 2.0, 0.7]);
    assert_bounds(&imported, "plate", [0.0, 0.0, 0.5], [1.0, 1.0, 0.5]);
    let of = |name: &str| &imported.scene.materials[imported.scene.parts.iter().find(|p| p.name == name).unwrap().material as usize];
    let oak = Rgb::new(linear_from_srgb(0.5), linear_from_srgb(0.25), 0.0);
    for name in ["base", "plate"] {
        assert_eq!(of(name).bsdf, Bsdf::Diffuse { reflectance: oak.into() }, "{name}");
    }
    assert!(matches!(&of("knob").alpha, Alpha::Blend { opacity } if opacity.factor == 0.5));
    let lineage = imported.scene.lineage(&imported.scene.parts[0]);
    assert_eq!(lineage, ["cupboard", "base"]);
    // The tube's area: 2π·0.2·2 and two ends.
    let scene = &imported.scene;
    let tube: f32 = scene
        .parts
        .iter()
        .filter(|p| p.name.starts_with("leg.tube"))
        .flat_map(|p| (0..scene.meshes[p.mesh as usize].triangles.len()).map(move |t| scene.world_corners(p, t)))
        .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
        .sum();
    let expected = std::f32::consts::TAU * 0.2 * 2.0 + 2.0 * std::f32::consts::PI * 0.04;
    assert!((tube / expected - 1.0).abs() < 2e-3, "{tube} instead of {expected}");
}

#[test]
fn meshes_of_a_robot_that_are_missing_are_an_error_or_left_out() {
    let folder = Folder::new();
    let error = folder.write("cupboard.urdf", COUNTER).error("cupboard.urdf");
    assert!(error.contains("plate needs the mesh") && error.contains("--allow-missing-meshes"), "{error}");
    let options = ImportOptions { allow_missing_meshes: true, ..ImportOptions::default() };
    let imported = folder.load_with("cupboard.urdf", &options).unwrap();
    assert!(!imported.scene.parts.iter().any(|p| p.name == "plate"));
    assert!(warnings(&imported).contains("it was left out"));
    let bad = COUNTER.replace("2, 1, 1", "2 1");
    assert!(folder.write("a.urdf", bad).error("a.urdf").contains("line 4: found \"2 1\" as size of <box>, expected 3 numbers"));
    assert!(folder.write("a.urdf", "<scene/>").error("a.urdf").contains("not a robot in URDF"));
}

const WORLD: &str = r#"<?xml version="1.0"?>
<sdf version="1.9"><world name="flat">
  <light type="directional" name="sun"><diffuse>1 1 1 1</diffuse><direction>0 0 -1</direction></light>
  <include><uri>model://table</uri><name>desk</name><pose>5 0 0 0 0 0</pose></include>
  <include><uri>model://nowhere</uri></include>
  <model name="crate"><pose degrees="true">0 2 0 0 0 90</pose><link name="body"><pose>1 0 0.5 0 0 0</pose>
    <visual name="v"><geometry><box><size>2 1 1</size></box></geometry><material><diffuse>1 0 0 1</diffuse></material></visual></link>
    <model name="lid"><pose>0 0 2 0 0 0</pose><link name="l"><visual name="v"><geometry><plane><normal>0 0 1</normal><size>4 2</size></plane></geometry></visual></link></model>
  </model></world></sdf>"#;

#[test]
fn sdf_has_models_where_their_poses_say_and_includes_from_folders() {
    let folder = Folder::new();
    let table = "<sdf version=\"1.6\"><model name=\"table\"><pose>9 9 9 0 0 0</pose><link name=\"top\"><visual name=\"v\"><geometry><mesh>\
                 <uri>model://table/meshes/plate.stl</uri><scale>1 1 1</scale></mesh></geometry></visual></link></model></sdf>";
    folder.write("worlds/flat.world", WORLD).write("models/table/model.sdf", table).write("models/table/meshes/plate.stl", TEXT);
    let imported = folder.load("worlds/flat.world").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(imported.report.format, "sdf");
    // The pose of the include replaces the model's own.
    assert_bounds(&imported, "table.top", [5.0, 0.0, 1.0], [7.0, 2.0, 1.0]);
    // A quarter turn takes the link's x of 1 to y, and the box's long side with it.
    assert_bounds(&imported, "crate.body", [-0.5, 2.0, 0.0], [0.5, 4.0, 1.0]);
    assert_bounds(&imported, "lid.l", [-1.0, 0.0, 2.0], [1.0, 4.0, 2.0]);
    assert!(matches!(&imported.scene.lights[..], [Light::Directional { direction, .. }] if (*direction - Vec3::NEG_Z).length() < 1e-6));
    let told = warnings(&imported);
    assert!(told.contains("\"model://nowhere\" is neither beside the scene"), "{told}");
    let mut lineages: Vec<String> = imported.scene.parts.iter().map(|p| imported.scene.lineage(p).join("/")).collect();
    lineages.sort();
    assert_eq!(lineages, ["crate/body", "crate/lid/l", "desk/top"]);
}

#[test]
fn pictures_of_urdf_are_found_by_their_package() {
    let folder = Folder::new();
    let urdf = COUNTER.replace("<color rgba=\"0.5 0.25 0 1\"/>", "<texture filename=\"package://furniture/oak.png\"/>");
    folder
        .write("furniture/urdf/a.urdf", urdf)
        .write("furniture/meshes/plate.stl", TEXT)
        .write("furniture/oak.png", png(1, 1, [9, 9, 9, 255]));
    let imported = folder.load("furniture/urdf/a.urdf").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(imported.report.counts.images, 1);
}

#[test]
fn meshes_of_robots_are_found_in_other_case_and_reported() {
    let folder = Folder::new();
    let urdf = "<robot name=\"a\"><link name=\"l\"><visual><geometry><mesh filename=\"package://a/meshes/handle.stl\"/></geometry></visual>\
        </link></robot>";
    let imported = folder.write("meshes/Handle.STL", TEXT).write("a.urdf", urdf).load("a.urdf").unwrap();
    assert_bounds(&imported, "l", [0.0, 0.0, 1.0], [2.0, 2.0, 1.0]);
    assert!(warnings(&imported).contains("\"Handle.STL\", which differs in case"), "{}", warnings(&imported));
}

#[test]
fn semantics_of_partnet_name_the_links_and_meta_the_class_of_the_whole() {
    let folder = Folder::new();
    let link = |name: &str| format!(r#"<link name="{name}"><visual name="v-1"><geometry><box size="1 1 1"/></geometry></visual></link>"#);
    let joint = r#"<joint name="joint_0" type="revolute"><parent link="base"/><child link="link_0"/><axis xyz="0 0 1"/><limit lower="0" upper="1.5"/></joint>"#;
    folder.write("7/mobility.urdf", format!("<robot name=\"p\">{}{}{joint}</robot>", link("base"), link("link_0")));
    folder.write("7/semantics.txt", "link_0 hinge door\n\n").write("7/meta.json", r#"{"model_cat": "StorageFurniture", "anno_id": "7"}"#);
    let imported = folder.load("7").unwrap();
    assert_eq!(imported.scene.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>(), ["door_link_0"]);
    assert_eq!(imported.scene.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["base.v-1", "door_link_0.v-1"]);
    // A cabinet, which is one instance with its door.
    let labels: Vec<_> = imported.labels.iter().flatten().map(|l| (l.label.semantic, l.label.instance)).collect();
    assert_eq!(labels, [(3, 1), (3, 1)]);
    assert!(warnings(&imported).contains("have no unit"), "{}", warnings(&imported));
    assert!(
        folder
            .write("7/semantics.txt", "link_0 door\n")
            .error("7")
            .contains("semantics.txt: line 1: found \"link_0 door\", expected a link")
    );
}

/// A box of a metre.
fn cube(name: &str) -> String {
    format!("<link name=\"{name}\"><visual><geometry><box size=\"1 1 1\"/></geometry></visual></link>")
}

#[test]
fn joints_of_unknown_parents_hold_what_they_hold_in_the_world() {
    let joint = |name: &str, parent: &str, child: &str, xyz: &str| {
        format!("<joint name=\"{name}\" type=\"fixed\"><parent link=\"{parent}\"/><child link=\"{child}\"/><origin xyz=\"{xyz}\"/></joint>")
    };
    // `world` is often meant without being a link; comments and prefixes are as ROS (TinyXML-2) reads them.
    let text = format!(
        "<robot name=\"r\"><!-- ---- -->{}{}{}<gazebo:plugin/>{}{}{}</robot>",
        cube("a"),
        cube("b"),
        cube("c"),
        joint("j", "world", "a", "0 0 5"),
        joint("k", "a", "b", "0 2 0"),
        joint("l", "gone", "c", "7 0 0")
    );
    let imported = Folder::new().write("a.urdf", text).load("a.urdf").unwrap_or_else(|e| panic!("{e}"));
    assert_bounds(&imported, "a", [-0.5, -0.5, 4.5], [0.5, 0.5, 5.5]);
    assert_bounds(&imported, "b", [-0.5, 1.5, 4.5], [0.5, 2.5, 5.5]);
    assert_bounds(&imported, "c", [6.5, -0.5, -0.5], [7.5, 0.5, 0.5]);
    let told = warnings(&imported);
    assert!(told.contains("joint \"l\": its parent \"gone\" is no link of the file; \"c\" hangs on the world"), "{told}");
    assert!(!told.contains("\"world\""), "{told}");
}

#[test]
fn what_is_still_written_for_xacro_is_told_with_what_to_do() {
    let folder = Folder::new();
    let link = |size: &str| format!("<link name=\"l\"><visual><geometry><box size=\"{size}\"/></geometry></visual></link>");
    let advice = "make URDF of it with ROS (xacro FILE > robot.urdf)";
    for size in ["${w} 1 1", "$(arg w) 1 1"] {
        let error = folder.write("a.urdf", format!("<robot name=\"r\">{}</robot>", link(size))).error("a.urdf");
        assert!(error.contains("as size of <box>, expected 3 numbers: ") && error.contains(advice), "{error}");
    }
    let error = folder.write("a.urdf", format!("<robot name=\"r\">{}</robot>", link("1 1"))).error("a.urdf");
    assert!(!error.contains("xacro"), "{error}");
    // Parts of other files, with the prefix declared or not.
    for head in ["<robot name=\"r\">", "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">"] {
        let text = format!("{head}<xacro:include filename=\"b.xacro\"/><xacro:leg at=\"1\"/>{}</robot>", link("1 1 1"));
        let told = warnings(&folder.write("a.urdf", text).load("a.urdf").unwrap_or_else(|e| panic!("{e}")));
        assert!(told.contains("<xacro:include> and 1 more elements of xacro were left out") && told.contains(advice), "{told}");
    }
}

#[test]
fn worlds_stand_as_their_first_state_has_them() {
    // Gazebo loads the world and then sets its first state (World::Load): poses of models, and of links, are those in the world.
    let model = |name: &str, link: &str, pose: &str| {
        let visual = "<visual name=\"v\"><geometry><box><size>1 1 1</size></box></geometry></visual>";
        format!("<model name=\"{name}\"><pose>{pose}</pose><link name=\"{link}\"><pose>0 0 1 0 0 0</pose>{visual}</link></model>")
    };
    let state = |name: &str, x: f64, link: &str| format!("<model name=\"{name}\"><pose>{x} 5 0 0 0 0</pose>{link}</model>");
    let text = format!(
        "<sdf version=\"1.6\"><world name=\"w\">{}{}{}<light name=\"l\" type=\"point\"><pose>0 0 2 0 0 0</pose></light>\
         <state world_name=\"w\"><sim_time>9 0</sim_time>{}{}<light name=\"l\"><pose>0 0 3 0 0 0</pose></light></state>\
         <state world_name=\"w\">{}</state></world></sdf>",
        model("kept", "p", "1 0 0 0 0 0"),
        model("moved", "q", "1 0 0 0 0 0"),
        model("lifted", "r", "1 0 0 0 0 0"),
        state("moved", 4.0, ""),
        state("lifted", 8.0, "<link name=\"r\"><pose>8 5 3 0 0 0</pose></link>"),
        state("kept", 99.0, ""),
    );
    let imported = Folder::new().write("a.world", text).load("a.world").unwrap_or_else(|e| panic!("{e}"));
    assert_bounds(&imported, "kept.p", [0.5, -0.5, 0.5], [1.5, 0.5, 1.5]);
    assert_bounds(&imported, "moved.q", [3.5, 4.5, 0.5], [4.5, 5.5, 1.5]);
    assert_bounds(&imported, "lifted.r", [7.5, 4.5, 2.5], [8.5, 5.5, 3.5]);
    assert!(matches!(&imported.scene.lights[0], Light::Point { position, .. } if *position == Vec3::new(0.0, 0.0, 3.0)));
    assert!(warnings(&imported).contains("stand where the world's state has them"));
}

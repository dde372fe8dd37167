//! Scenes of Habitat, made on the spot in the layouts of HSSD-200 and ReplicaCAD.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::{Imported, load, scene_in_folder};
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::{Light, Quiet};
use serde_json::{Value, json};

const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A dataset like HSSD's: models in `objects/<first letter>/`, parts of others in `objects/decomposed/<model>/`, openings, a table of
/// categories. The models are the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0).
fn dataset() -> Folder {
    let folder = Folder::new();
    let config = json!({
        "stages": {"paths": {".json": ["stages"]}},
        "objects": {"paths": {".json": ["objects/*", "objects/decomposed/*"]}},
        "articulated_objects": {"paths": {".urdf": ["urdf/*"]}},
        "light_setups": {"paths": {".json": ["lighting"]}},
        "scene_instances": {"paths": {".json": ["scenes"]}},
        "semantic_scene_descriptor_instances": {"map": "semantics/lexicon.json"}
    });
    folder.write("hssd.scene_dataset_config.json", config.to_string());
    folder.write("semantics/objects.csv", "id,name,main_category,super_category,wnsynsetkey\nab12,\"A, b\",chair,x,\nof00,,,,sofa.n.01\n");
    folder.write("semantics/lexicon.json", r#"{"classes": [{"id": 0, "name": "unknown"}, {"id": 7, "name": "bed"}]}"#);
    let glb = Gltf::triangle().binary();
    for (model, attributes) in [
        ("objects/a/ab12", json!({})),
        ("objects/b/bed1", json!({"semantic_id": 7})),
        ("objects/b/odd9", json!({"up": [0, 0, 1], "front": [0, 1, 0], "scale": [2, 2, 2], "units_to_meters": 0.5})),
        ("objects/c/com1", json!({"COM": [1, 0, 0], "scale": [2, 1, 1]})),
        ("objects/openings/door7", json!({})),
        ("objects/decomposed/of00/of00_part_1", json!({})),
    ] {
        let name = model.rsplit('/').next().unwrap();
        let mut all = attributes;
        all["render_asset"] = json!(format!("{name}.glb"));
        folder.write(&format!("{model}.object_config.json"), all.to_string()).write(&format!("{model}.glb"), &glb);
    }
    folder.write("stages/house.stage_config.json", r#"{"render_asset": "house.glb", "up": [0, 1, 0], "front": [0, 0, -1]}"#);
    let mut stage = Gltf::triangle();
    stage.json["nodes"] = json!([{"name": "geometry_wallTop.124", "mesh": 0}, {"name": "floor_1", "mesh": 0}, {"name": "Tree", "mesh": 0}]);
    stage.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
    folder.write("stages/house.glb", stage.binary());
    folder
}

/// A scene of `objects` in the dataset, all by their own origins unless one overrides it.
fn imported(folder: &Folder, objects: Value, more: Value) -> Imported {
    let mut scene = json!({"stage_instance": {"template_name": "stages/house"}, "translation_origin": "asset_local",
        "default_lighting": "no_lights", "object_instances": objects});
    for (key, value) in more.as_object().unwrap() {
        scene[key] = value.clone();
    }
    folder.write("scenes/1.scene_instance.json", scene.to_string());
    folder.load("scenes/1.scene_instance.json").unwrap_or_else(|e| panic!("{e}"))
}

fn names(imported: &Imported) -> Vec<&str> {
    imported.scene.parts.iter().map(|p| p.name.as_str()).collect()
}

fn points(imported: &Imported, name: &str) -> Vec<Vec3> {
    let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} in {:?}", names(imported)));
    imported.scene.world_positions(part).collect()
}

/// Class and instance of a part.
fn label(imported: &Imported, name: &str) -> (i16, i16) {
    let part = names(imported).iter().position(|n| *n == name).unwrap_or_else(|| panic!("no {name} in {:?}", names(imported)));
    let labels = imported.labels.iter().flatten();
    labels.filter(|l| l.part as usize == part).map(|l| (l.label.semantic, l.label.instance)).next().unwrap_or((-1, -1))
}

fn assert_near(found: &[Vec3], expected: [[f32; 3]; 3]) {
    let near = found.len() == 3 && found.iter().zip(expected).all(|(p, e)| (*p - Vec3::from(e)).length() < 1e-5);
    assert!(near, "{found:?} instead of {expected:?}");
}

#[test]
fn objects_are_scaled_turned_and_moved_from_their_own_origin() {
    let objects =
        json!([{"template_name": "ab12", "translation": [1, 2, 3], "rotation": [HALF, 0, HALF, 0], "non_uniform_scale": [2, 3, 1]}]);
    // A quarter about y takes x to −z; y of Habitat is z here, z is −y.
    assert_near(&points(&imported(&dataset(), objects, json!({})), "chair (ab12)"), [[1.0, -3.0, 2.0], [1.0, -1.0, 2.0], [1.0, -3.0, 5.0]]);
}

#[test]
fn translations_are_of_the_middle_unless_they_are_of_the_origin() {
    let objects = json!([
        {"template_name": "ab12", "translation": [1, 2, 3], "translation_origin": "COM", "uniform_scale": 2.0},
        {"template_name": "com1", "translation": [1, 2, 3], "translation_origin": "com"},
        {"template_name": "com1", "translation": [1, 2, 3]}
    ]);
    let imported = imported(&dataset(), objects, json!({}));
    // The box of the doubled triangle has its middle at (1, 1, 0).
    assert_near(&points(&imported, "chair (ab12)"), [[0.0, -3.0, 1.0], [2.0, -3.0, 1.0], [0.0, -3.0, 3.0]]);
    // The stated centre is scaled like the model.
    assert_near(&points(&imported, "com1"), [[-1.0, -3.0, 2.0], [1.0, -3.0, 2.0], [-1.0, -3.0, 3.0]]);
    assert_near(&points(&imported, "com1_2"), [[1.0, -3.0, 2.0], [3.0, -3.0, 2.0], [1.0, -3.0, 3.0]]);
}

#[test]
fn frames_turn_models_before_they_are_scaled_and_units_are_not_used_but_told() {
    let objects = json!([{"template_name": "odd9", "non_uniform_scale": [1, 1, 5]}]);
    let imported = imported(&dataset(), objects, json!({}));
    // The model's y is Habitat's −z, which the scale 2 × 5 stretches, and y here.
    assert_near(&points(&imported, "odd9"), [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 10.0, 0.0]]);
    assert!(warnings(&imported).contains("units_to_meters 0.5, which was not used"), "{}", warnings(&imported));
}

#[test]
fn categories_of_the_tables_become_classes_and_objects_instances() {
    let objects = json!([
        {"template_name": "ab12"}, {"template_name": "bed1"}, {"template_name": "ab12", "translation": [5, 0, 0]},
        {"template_name": "of00_part_1"}, {"template_name": "objects/openings/door7"}
    ]);
    let imported = imported(&dataset(), objects, json!({}));
    let expected =
        ["geometry_wallTop.124", "floor_1", "Tree", "chair (ab12)", "bed (bed1)", "chair_2 (ab12)", "sofa (of00_part_1)", "door7"];
    assert_eq!(names(&imported), expected);
    let labels: Vec<_> = expected.iter().map(|name| label(&imported, name)).collect();
    assert_eq!(labels, [(1, -1), (2, -1), (-1, -1), (5, 1), (4, 2), (5, 3), (6, 4), (-1, -1)]);
    // Each model once, though one is placed twice.
    assert_eq!(imported.report.counts.meshes, 5);
    assert!(warnings(&imported).contains("of 1 objects the collection has no category"), "{}", warnings(&imported));
    assert!(imported.inputs.iter().any(|p| p.ends_with("semantics/objects.csv")));
}

#[test]
fn mirrored_objects_and_mirrored_nodes_of_models_keep_their_fronts() {
    let folder = dataset();
    let mut mirrored = Gltf::triangle();
    mirrored.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    folder.write("objects/b/bed1.glb", mirrored.binary());
    let objects = json!([
        {"template_name": "ab12"}, {"template_name": "ab12", "non_uniform_scale": [-1, 1, 1]},
        {"template_name": "bed1"}, {"template_name": "bed1", "non_uniform_scale": [-1, 1, 1]}
    ]);
    let imported = imported(&folder, objects, json!({}));
    for name in ["chair (ab12)", "chair_2 (ab12)", "bed (bed1)", "bed_2 (bed1)"] {
        let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap();
        let [a, b, c] = imported.scene.world_corners(part, 0);
        // The triangle faces +z of Habitat, which is −y.
        assert!((b - a).cross(c - a).normalize().dot(Vec3::NEG_Y) > 0.999, "{name}");
    }
    assert_near(&points(&imported, "bed_2 (bed1)"), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[test]
fn stages_from_glb_files_have_z_up_unless_they_say_otherwise() {
    let folder = dataset();
    folder.write("stages/house.stage_config.json", r#"{"render_asset": "house.glb", "scale": [1, 1, 3]}"#);
    let imported = imported(&folder, json!([]), json!({"stage_instance": {"template_name": "stages/house", "translation": [9, 0, 0]}}));
    assert_near(&points(&imported, "Tree"), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0]]);
    assert!(warnings(&imported).contains("its translation and rotation were not used"));
}

#[test]
fn lights_shine_from_where_the_layout_has_them() {
    let folder = dataset();
    let layout = json!({"positive_intensity_scale": 2.0, "lights": {
        "a": {"type": "point", "position": [1, 2, 3], "intensity": 4, "color": [1, 0.5, 0]},
        "b": {"type": "directional", "direction": [0, -2, 0], "intensity": 1},
        "c": {"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "intensity": 1, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}},
        "d": {"type": "point", "intensity": -1}, "e": {"type": "point", "position_model": "camera"}
    }});
    folder.write("lighting/day.lighting_config.json", layout.to_string());
    let imported = imported(&folder, json!([]), json!({"default_lighting": "lighting/day"}));
    let [Light::Point { position, intensity, .. }, Light::Directional { direction, irradiance, .. }, Light::Spot { outer_rad, .. }] =
        &imported.scene.lights[..]
    else {
        panic!("{:?}", imported.scene.lights)
    };
    assert_eq!((*position, *intensity), (Vec3::new(1.0, -3.0, 2.0), Rgb::new(8.0, 4.0, 0.0)));
    assert_eq!((*direction, *irradiance, *outer_rad), (Vec3::NEG_Z, Rgb::splat(2.0), 0.4));
    let told = warnings(&imported);
    assert!(told.contains("1 lights take light away") && told.contains("1 lights move with the camera"), "{told}");
}

#[test]
fn articulated_objects_are_drawn_at_rest() {
    let folder = dataset();
    let urdf = r#"<robot name="fridge">
        <link name="base"><inertial><origin xyz="0 1 0"/></inertial>
            <visual><geometry><mesh filename="../objects/a/ab12.glb" scale="2 1 1"/></geometry></visual>
            <visual><geometry><box size="1 1 1"/></geometry></visual></link>
        <link name="door"><visual><origin xyz="0 0 1"/><geometry><mesh filename="../objects/a/ab12.glb"/></geometry></visual></link>
        <joint name="hinge" type="revolute"><parent link="base"/><child link="door"/><origin xyz="1 0 0" rpy="0 1.5707963267948966 0"/></joint>
    </robot>"#;
    folder.write("urdf/fridge/fridge.urdf", urdf.replace("../objects", "../../objects"));
    let objects = json!({"articulated_object_instances": [
        {"template_name": "fridge", "translation": [0, 0, 0], "translation_origin": "asset_local"},
        {"template_name": "fridge", "translation": [0, 0, 0], "translation_origin": "COM"},
        {"template_name": "freezer"}
    ]});
    let imported = imported(&folder, json!([]), objects);
    assert_near(&points(&imported, "fridge/base.Chair"), [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    // The door's z is the base's x, its x the base's −z.
    assert_near(&points(&imported, "fridge/door.Chair"), [[2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 1.0]]);
    assert_near(&points(&imported, "fridge_2/base.Chair"), [[0.0, 0.0, -1.0], [2.0, 0.0, -1.0], [0.0, 0.0, 0.0]]);
    let told = warnings(&imported);
    assert!(told.contains("1 visual shapes") && told.contains("1 of 3 objects were left out"), "{told}");
}

#[test]
fn joints_of_articulated_objects_have_limits_and_the_states_of_their_instances() {
    let folder = dataset();
    let visual = r#"<visual><geometry><mesh filename="../../objects/a/ab12.glb"/></geometry></visual>"#;
    let urdf = format!(
        r#"<robot name="fridge"><link name="base">{visual}</link><link name="door">{visual}</link><link name="shelf">{visual}</link>
        <joint name="hinge" type="revolute"><parent link="base"/><child link="door"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>
          <limit lower="0" upper="2"/></joint>
        <joint name="rail" type="prismatic"><parent link="base"/><child link="shelf"/><axis xyz="0 0 1"/><limit lower="0" upper="0.5"/></joint></robot>"#
    );
    folder.write("urdf/fridge/fridge.urdf", urdf);
    let all = json!({"articulated_object_instances": [
        {"template_name": "fridge"},
        {"template_name": "fridge", "uniform_scale": 2, "initial_joint_pose": [std::f64::consts::FRAC_PI_2, 0.1]},
        {"template_name": "fridge", "initial_joint_pose": [1.0]}
    ]});
    let imported = imported(&folder, json!([]), all);
    let scene = &imported.scene;
    assert!(scene.is_still());
    let near = |limits: Option<[f64; 2]>, expected: [f64; 2]| limits.unwrap().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    let body = |name: &str| scene.bodies.iter().find(|body| body.name == name).unwrap_or_else(|| panic!("no body {name}"));
    assert!(near(body("fridge/door").limits, [0.0, 2.0]) && near(body("fridge_3/shelf").limits, [0.0, 0.5]));
    let open = std::f64::consts::FRAC_PI_2;
    // Twice as large, slides go twice as far.
    assert!(near(body("fridge_2/door").limits, [-open, 2.0 - open]) && near(body("fridge_2/shelf").limits, [-0.2, 0.8]));
    assert_near(&points(&imported, "fridge/door.Chair"), [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 0.0, 1.0]]);
    assert_near(&points(&imported, "fridge_2/door.Chair"), [[2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 2.0]]);
    assert_near(&points(&imported, "fridge_2/shelf.Chair"), [[0.0, -0.2, 0.0], [2.0, -0.2, 0.0], [0.0, -0.2, 2.0]]);
    let told = warnings(&imported);
    assert!(told.contains("initial_joint_pose of \"fridge_3\" is [1.0], expected a list of 2 numbers"), "{told}");
}

#[test]
fn vectors_of_urdf_may_have_commas_and_an_odd_model_is_left_out_alone() {
    let folder = dataset();
    // As ReplicaCAD's cabinets are written.
    let urdf = |scale: &str| {
        format!(
            r#"<?xml version="1.0"?><robot name="counter"><link name="root"/><link name="body"><visual><origin rpy="0, 0, 0" xyz="0.5,0, 0"/>
            <geometry><mesh filename="../../objects/a/ab12.glb" scale="{scale}"/></geometry></visual></link>
            <joint name="j" type="fixed"><origin rpy="0 0 0" xyz="0 0 0"/><parent link="root"/><child link="body"/></joint></robot>"#
        )
    };
    folder.write("urdf/counter/counter.urdf", urdf("1, 1, 2")).write("urdf/odd/odd.urdf", urdf("one")).write("urdf/cut/cut.urdf", "<robot");
    folder.write("objects/a/broken.object_config.json", "{");
    let named = |name: &str| json!({"template_name": name, "translation": [0, 0, 0], "rotation": "1, 0, 0, 0"});
    let all: Vec<Value> = ["counter", "odd", "cut"].map(named).to_vec();
    let imported = imported(&folder, json!([named("ab12"), named("broken"), 7]), json!({"articulated_object_instances": all}));
    let counter: Vec<&str> = names(&imported).into_iter().filter(|name| name.starts_with("counter")).collect();
    assert_eq!(counter.len(), 1, "{:?}", names(&imported));
    assert_near(&points(&imported, counter[0]), [[0.5, 0.0, 0.0], [1.5, 0.0, 0.0], [0.5, 0.0, 1.0]]);
    let told = warnings(&imported);
    for part in [
        "a model cannot be used and is left out",
        "found \"one\" as scale of <mesh>, expected three numbers",
        "cut.urdf: URDF:",
        "a template cannot be used and is left out",
        "3 of 5 objects were left out",
        "1 of 3 entries are not what they should be",
    ] {
        assert!(told.contains(part), "{part} is not in {told}");
    }
}

#[test]
fn templates_of_the_configuration_itself_change_those_of_files() {
    let folder = dataset();
    let mut config: Value = serde_json::from_slice(&std::fs::read(folder.path("hssd.scene_dataset_config.json")).unwrap()).unwrap();
    config["objects"]["default_attributes"] = json!({"scale": [3, 3, 3]});
    config["objects"]["configs"] = json!([
        {"original_file": "objects/a/ab12.object_config.json", "template_handle": "wide", "attributes": {"scale": [5, 1, 1]}},
        {"template_handle": "bare", "attributes": {"render_asset": "objects/a/ab12.glb"}}
    ]);
    // The first configuration does not list the scene.
    folder.write("a.scene_dataset_config.json", r#"{"scene_instances": {"paths": {".json": ["elsewhere/*"]}}}"#);
    folder.write("hssd.scene_dataset_config.json", config.to_string());
    let imported = imported(&folder, json!([{"template_name": "wide"}, {"template_name": "bare"}, {"template_name": "ab12"}]), json!({}));
    assert_near(&points(&imported, "wide"), [[0.0; 3], [5.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_near(&points(&imported, "bare"), [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
    assert_near(&points(&imported, "chair (ab12)"), [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
}

#[test]
fn what_is_missing_is_told_and_counted() {
    let folder = dataset();
    std::fs::remove_file(folder.path("objects/b/bed1.glb")).unwrap();
    let objects = json!([{"template_name": "gone"}, {"template_name": "gone"}, {"template_name": "bed1"}, {"template_name": "ab12"}]);
    let imported = imported(&folder, objects, json!({}));
    let told = warnings(&imported);
    assert!(
        told.contains("3 of 4 objects were left out, because 2 templates or their models are not in the dataset, such as bed1, gone"),
        "{told}"
    );
    assert!(imported.missing.iter().any(|p| p.ends_with("objects/b/bed1.glb")), "{:?}", imported.missing);
}

#[test]
fn files_and_folders_that_are_no_scenes_say_what_to_give() {
    let folder = dataset();
    let config = folder.write("scenes/1.scene_instance.json", "{}").error("hssd.scene_dataset_config.json");
    assert!(config.contains("the configuration of a Habitat dataset, not a scene; give one of its scene instances"), "{config}");
    assert!(config.contains("scenes/1.scene_instance.json"), "{config}");
    assert!(folder.error("objects/a/ab12.object_config.json").contains("an object of Habitat scenes"));
    let message = folder.error("scenes/1.scene_instance.json");
    assert!(message.contains("no known layout") && message.contains("a Habitat scene instance (stage_instance)"), "{message}");
    let broken = folder.write("b.json", "{\"stage_instance\": 3,\n]").error("b.json");
    assert!(broken.starts_with("b.json: line 2, column 1:"), "{broken}");
    let alone = Folder::new();
    let message = alone.write("a.scene_instance.json", r#"{"stage_instance": {"template_name": "x"}}"#).error("a.scene_instance.json");
    assert!(message.contains("found no *.scene_dataset_config.json in its folder or the 4 above"), "{message}");
}

#[test]
fn a_folder_stands_for_the_one_scene_in_it() {
    let folder = dataset();
    imported(&folder, json!([]), json!({}));
    let scene = scene_in_folder(&folder.path("")).unwrap().unwrap();
    assert!(scene.ends_with("scenes/1.scene_instance.json"), "{}", scene.display());
    assert_eq!(load(&folder.path(""), &Default::default(), &Quiet).unwrap().report.counts.parts, 3);
    let message = folder.write("scenes/2.scene_instance.json", "{}").error("scenes");
    assert!(message.contains("it holds 2 scenes (1.scene_instance.json, 2.scene_instance.json): give one of them"), "{message}");
    assert!(folder.error("stages/..").contains("it holds 2 scenes"));
    assert!(Folder::new().error("").contains("found no scene in the folder"));
}

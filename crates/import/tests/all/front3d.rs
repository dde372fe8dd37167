//! Houses of 3D-FRONT, made on the spot, with models in the layout of 3D-FUTURE.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::Bsdf;
use serde_json::{Value, json};

const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A room with a floor, a wall and two chairs, of which one model is available.
fn house() -> Value {
    let quad = |y: f64| json!([0, y, 0, 4, y, 0, 4, y, 3, 0, y, 3]);
    json!({
        "uid": "h", "furniture": [
            {"uid": "1/model", "jid": "chair-jid", "valid": true}, {"uid": "2/model", "jid": "gone-jid", "valid": true},
            {"uid": "3/model", "jid": "chair-jid", "valid": false}
        ],
        "mesh": [
            {"uid": "f", "type": "Floor", "material": "oak", "xyz": quad(0.0), "normal": [0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0],
                "uv": [0, 0, 4, 0, 4, 3, 0, 3], "faces": [0, 2, 1, 0, 3, 2]},
            {"uid": "w", "type": "WallInner", "material": "paint", "xyz": [0, 0, 0, 4, 0, 0, 4, 2.5, 0], "faces": [0, 1, 2]},
            {"uid": "d", "type": "Door", "material": null, "uv": null, "xyz": [1, 0, 0, 2, 0, 0, 2, 2, 0], "faces": [0, 1, 2]},
            {"uid": "b", "type": "Back", "xyz": [0, 0, 3, 4, 0, 3, 4, 2.5, 3], "faces": [0, 1, 2]}
        ],
        "material": [
            {"uid": "oak", "jid": "oak-jid", "texture": "http://x/oak.png", "color": [255, 255, 255, 255], "UVTransform": [2, 0, 9, 0, 0.5, 9, 0, 0, 1]},
            {"uid": "paint", "jid": "", "texture": "", "color": [255, 0, 0, 255]}
        ],
        "scene": {"room": [{"type": "LivingRoom", "instanceid": "LivingRoom-1", "children": [
            {"ref": "f", "pos": [0, 0, 0], "rot": [0, 0, 0, 1], "scale": [1, 1, 1]}, {"ref": "w"}, {"ref": "d"}, {"ref": "b"},
            {"ref": "1/model", "pos": [1, 0, 2], "rot": [0, HALF, 0, HALF], "scale": [2, 1, 1]},
            {"ref": "1/model", "pos": [3, 0, 2], "rot": [0, 0, 0, 1], "scale": [1, 1, 1]},
            {"ref": "2/model"}, {"ref": "3/model"}, {"ref": "nothing"}
        ]}]}
    })
}

/// The house in `3D-FRONT/`, with its models and pictures beside that folder.
fn imported() -> Imported {
    let folder = Folder::new();
    folder.write("3D-FRONT/house.json", house().to_string());
    folder
        .write("3D-FUTURE-model/model_info.json", r#"[{"model_id": "chair-jid", "super-category": "Chair", "category": "Dining Chair"}]"#);
    folder
        .write("3D-FUTURE-model/chair-jid/raw_model.obj", "mtllib model.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    folder.write("3D-FUTURE-model/chair-jid/model.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ./texture.png\n");
    folder.write("3D-FUTURE-model/chair-jid/texture.png", png(1, 1, [9, 9, 9, 255]));
    folder.write("3D-FRONT-texture/oak-jid/texture.png", png(1, 1, [90, 60, 30, 255]));
    folder.load("3D-FRONT/house.json").unwrap_or_else(|e| panic!("{e}"))
}

fn points(imported: &Imported, name: &str) -> Vec<Vec3> {
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} in {names:?}"));
    imported.scene.world_positions(part).collect()
}

#[test]
fn furniture_and_walls_stand_where_the_house_has_them_with_their_classes() {
    let imported = imported();
    let labels: Vec<(&str, i16, i16)> = imported
        .labels
        .iter()
        .flatten()
        .map(|l| (imported.scene.parts[l.part as usize].name.as_str(), l.label.semantic, l.label.instance))
        .collect();
    let expected = [
        ("Floor (LivingRoom-1)", 2, -1),
        ("WallInner (LivingRoom-1)", 1, -1),
        ("Door (LivingRoom-1)", 8, 1),
        ("Dining Chair (chair-jid)", 5, 2),
        ("Dining Chair_2 (chair-jid)", 5, 3),
    ];
    assert_eq!(labels, expected);
    // y is up, and a quarter about it takes x to −z, which is y here.
    let chair = points(&imported, "Dining Chair (chair-jid)");
    let near = chair.iter().zip([[1.0, -2.0, 0.0], [1.0, 0.0, 0.0], [1.0, -2.0, 1.0]]).all(|(p, e)| (*p - Vec3::from(e)).length() < 1e-5);
    assert!(near, "{chair:?}");
    assert_eq!(points(&imported, "Floor (LivingRoom-1)")[2], Vec3::new(4.0, -3.0, 0.0));
    // The chair is one mesh in two places.
    assert_eq!(imported.report.counts.meshes, 5);
}

#[test]
fn materials_have_pictures_turned_as_in_the_toolbox_or_colours() {
    let imported = imported();
    let of = |name: &str| {
        let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap();
        &imported.scene.materials[part.material as usize].bsdf
    };
    let Bsdf::Diffuse { reflectance } = of("Floor (LivingRoom-1)") else { panic!("not diffuse") };
    assert_eq!(reflectance.texture.unwrap().uv_transform, [[2.0, 0.0, 0.0], [0.0, 0.5, 0.0]]);
    assert_eq!(of("WallInner (LivingRoom-1)"), &Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() });
}

#[test]
fn models_that_are_not_at_hand_are_told_and_counted() {
    let told = warnings(&imported());
    assert!(told.contains("1 of 3 pieces of furniture were left out, because 1 models are not in"), "{told}");
    assert!(told.contains("such as gone-jid") && told.contains("1 children of rooms refer to nothing"), "{told}");
    let folder = Folder::new();
    let imported = folder.write("house.json", house().to_string()).load("house.json").unwrap();
    let told = warnings(&imported);
    assert!(told.contains("no folder 3D-FUTURE-model is beside the house or in the 3 folders above; its 3 pieces"), "{told}");
    assert!(told.contains("pictures such as that of \"oak-jid\" are not in a folder 3D-FRONT-texture"), "{told}");
}

#[test]
fn one_odd_mesh_is_left_out_and_the_rest_stays() {
    let folder = Folder::new();
    for (odd, told) in [
        (json!({"faces": [0, 1]}), "mesh \"w\": found 2 numbers in faces, expected a multiple of 3"),
        (json!({"faces": [0, 1, 7]}), "a mesh cannot be used and is left out"),
        (json!({"xyz": "here"}), "1 of 4 entries are not what they should be and were left out, the first: "),
        (json!({"uid": null}), "1 of 4 entries are not what they should be and were left out, the first: "),
    ] {
        let mut house = house();
        for (key, value) in odd.as_object().unwrap() {
            house["mesh"][1][key] = value.clone();
        }
        let imported = folder.write("house.json", house.to_string()).load("house.json").unwrap();
        assert_eq!(imported.report.counts.parts, 3, "{odd}");
        assert!(warnings(&imported).contains(told), "{}", warnings(&imported));
    }
    // Python's library writes NaN for what is no number, which JSON has not.
    let text = house().to_string();
    let nan = text.replacen("2.5", "NaN", 1);
    assert!(nan != text);
    let imported = folder.write("house.json", nan).load("house.json").unwrap();
    assert_eq!(imported.report.counts.parts, 3);
    let told = warnings(&imported);
    assert!(told.contains("1 of 4 entries are not what they should be and were left out, the first: "), "{told}");
    let mut house = house();
    house["mesh"] = json!({"a": 1});
    assert!(folder.write("house.json", house.to_string()).error("house.json").contains("expected a list"));
}

#[test]
fn numbers_may_be_text() {
    let plain = imported();
    let folder = Folder::new();
    let text = |list: &Value| -> Value { list.as_array().unwrap().iter().map(|v| json!(format!("{:.5}", v.as_f64().unwrap()))).collect() };
    let mut house = house();
    for key in ["xyz", "normal", "uv"] {
        house["mesh"][0][key] = text(&house["mesh"][0][key]);
    }
    house["mesh"][1]["faces"] = json!(["0", "1.0", 2.0]);
    house["mesh"][2]["xyz"] = json!("1, 0, 0, 2, 0, 0, 2, 2, 0");
    house["material"][1]["color"] = json!(["255", "0", "0", "255"]);
    house["furniture"][0]["valid"] = json!("true");
    house["scene"]["room"][0]["children"][0]["rot"] = json!(["0", "0", "0", "1"]);
    house["scene"]["room"][0]["children"][0]["pos"] = json!("0 0 0");
    house["scene"]["room"][0]["children"][0]["scale"] = json!(["1.0", "1.0", "1.0"]);
    let odd = folder.write("house.json", format!("\u{feff}{house}")).load("house.json").unwrap();
    let bare = |imported: &Imported, name: &str| points(imported, name);
    for name in ["Floor (LivingRoom-1)", "WallInner (LivingRoom-1)", "Door (LivingRoom-1)", "Back (LivingRoom-1)"] {
        assert_eq!(bare(&odd, name), bare(&plain, name), "{name}");
    }
    let paint = odd.scene.materials.iter().find(|m| m.name == "paint").map(|m| m.bsdf.clone());
    assert_eq!(paint, Some(Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() }));
}

#[test]
fn lamps_and_suns_of_a_house_shine_as_strong_and_as_white_as_it_says() {
    let pi = std::f32::consts::PI;
    let folder = Folder::new();
    let mut house = house();
    // The form of a program that writes such houses: a panel of 1500 lm on the ceiling, a portal, a dome, and a sun at 45 degrees.
    house["lights"] = json!([
        {"uid": "0/model", "nodeType": "VRayLight", "type": 0, "enabled": true, "DoubleSided": false, "color_temperature": 4000,
            "direction": [0, -1, 0], "up_vector": [-1, 0, 0], "multiplier": 1500, "units": 1, "roomId": "LivingRoom-1", "size0": "1.5", "size1": 0.5,
            "skylightPortal": false, "src_position": [2, 2.4, 1]},
        {"uid": "1/model", "nodeType": "VRayLight", "type": 0, "skylightPortal": true, "size0": 1, "size1": 1, "src_position": [0, 1, 0]},
        {"uid": "2/model", "nodeType": "VRayLight", "type": 0, "enabled": false, "size0": 1, "size1": 1, "src_position": [0, 1, 0]},
        {"uid": "3/model", "nodeType": "VrayLightDome", "multiplier": 0.1, "units": 0},
        {"uid": "4/model", "nodeType": "VraySun", "enabled": true, "intensity_multiplier": 0.1, "size_multiplier": 6, "turbidity": 4,
            "src_position": [10, 10, 0], "target_position": [0, 0, 0], "filter_Color": [1, 1, 1]}
    ]);
    folder.write("3D-FRONT/house.json", house.to_string());
    let imported = folder.load("3D-FRONT/house.json").unwrap_or_else(|e| panic!("{e}"));
    let scene = &imported.scene;
    // Centred below the ceiling, 1.5 m along z (across `up`) and 0.5 m along x, facing down; z is up here and the file's z is minus y.
    let panel = points(&imported, "light (LivingRoom-1)");
    let corner = |x: f32, y: f32| panel.iter().any(|p| p.distance(Vec3::new(x, y, 2.4)) < 1e-5);
    assert!(corner(1.75, -0.25) && corner(2.25, -1.75) && panel.len() == 4, "{panel:?}");
    let part = scene.parts.iter().find(|p| p.name == "light (LivingRoom-1)").unwrap();
    let [a, b, c] = scene.world_corners(part, 0);
    assert!((b - a).cross(c - a).z < 0.0);
    // V-Ray: lumens over pi times the area, times the photometric scale.
    let radiance = scene.materials[part.material as usize].emission.factor;
    assert!((radiance.luminance() / (1500.0 / (pi * 0.75) * 0.002) - 1.0).abs() < 1e-4, "{radiance:?}");
    assert!(radiance.r > 1.5 * radiance.b, "4000 K is warmer than white: {radiance:?}");
    let [enfilade_scene::Light::Directional { direction, angular_radius_rad, irradiance, .. }] = scene.lights.as_slice() else {
        panic!("{:?}", scene.lights)
    };
    assert!(direction.distance(Vec3::new(-1.0, 0.0, -1.0).normalize()) < 1e-6, "{direction}");
    assert!((angular_radius_rad / (6.0 * 0.2665_f32.to_radians()) - 1.0).abs() < 0.01, "{angular_radius_rad}");
    // A clear sun of some 60 to 100 klx, a tenth of it, in units of 1/500 lx.
    assert!((0.1 * 120.0..0.1 * 200.0).contains(&irradiance.luminance()), "{irradiance:?}");
    assert!(scene.environment.is_some());
    let told = warnings(&imported);
    for expected in [
        "1 lights are portals, which give no light of their own, such as 1/model",
        "1 lights are of a kind that is not read, such as 3/model",
        "that their sizes are whole sides is guessed",
        "its sky is guessed",
    ] {
        assert!(told.contains(expected), "{expected}: {told}");
    }
}

#[test]
fn null_in_the_place_of_a_list_or_table_is_told_with_its_place() {
    let error = |place: &str| {
        let mut house = house();
        *house.pointer_mut(place).unwrap() = Value::Null;
        Folder::new().write("house.json", house.to_string()).error("house.json")
    };
    for (place, told) in [
        ("/mesh", "the scene has no visible parts"),
        ("/mesh", "mesh: found null, expected a list"),
        ("/scene/room", "scene.room: found null, expected a list"),
        (
            "/scene/room/0",
            "scene.room: 1 of 1 entries are not what they should be and were left out, the first: found null, expected a table",
        ),
        ("/scene/room/0/children", "scene.room \"LivingRoom-1\": found null, expected a list"),
        ("/scene", "line 1, column "),
        ("/scene", "found null, expected a table; it is not what a house of 3D-FRONT has there"),
    ] {
        let message = error(place);
        assert!(message.contains("house.json") && message.contains(told), "{place}: {message}");
    }
    let mut house = house();
    house["mesh"][1]["xyz"] = Value::Null;
    let folder = Folder::new();
    let told = warnings(&folder.write("house.json", house.to_string()).load("house.json").unwrap());
    assert!(
        told.contains("mesh: 1 of 4 entries are not what they should be and were left out, the first: found null, expected a list in"),
        "{told}"
    );
}

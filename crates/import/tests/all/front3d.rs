//! Houses of 3D-FRONT, made on the spot, with models in the layout of 3D-FUTURE.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::Bsdf;
use serde_json::{Value, json};

const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A room with a floor, a wall and two chairs, of which one model is at hand.
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
fn lists_of_wrong_lengths_are_refused_with_their_mesh() {
    let mut house = house();
    house["mesh"][1]["faces"] = json!([0, 1]);
    let folder = Folder::new();
    let message = folder.write("house.json", house.to_string()).error("house.json");
    assert!(message.contains("mesh \"w\": found 2 numbers in faces, expected a multiple of 3"), "{message}");
    house["mesh"][1]["faces"] = json!([0, 1, 7]);
    let message = folder.write("house.json", house.to_string()).error("house.json");
    assert!(message.contains("mesh \"w\"") && message.contains('7'), "{message}");
}

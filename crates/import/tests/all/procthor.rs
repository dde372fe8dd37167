//! Houses of ProcTHOR, made on the spot.

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::Light;
use serde_json::{Value, json};

fn wall(id: &str, room: &str, from: [f64; 2], to: [f64; 2]) -> Value {
    let at = |p: [f64; 2], y: f64| json!({"x": p[0], "y": y, "z": p[1]});
    json!({"id": id, "roomId": room, "material": {"name": "Plaster", "color": {"r": 1, "g": 0, "b": 0}},
        "polygon": [at(from, 0.0), at(to, 0.0), at(to, 2.5), at(from, 2.5)]})
}

/// A kitchen from z = 0 to 3 and a bedroom from −3 to 0, with a door between them.
fn house() -> Value {
    let outline = |low: f64, high: f64| json!([{"x": 0, "y": 0, "z": low}, {"x": 0, "y": 0, "z": high}, {"x": 4, "y": 0, "z": high}, {"x": 4, "y": 0, "z": low}]);
    json!({
        "rooms": [
            {"id": "room|2", "roomType": "Kitchen", "floorPolygon": outline(0.0, 3.0), "floorMaterial": {"name": "Oak"}},
            {"id": "room|3", "roomType": "Bedroom", "floorPolygon": outline(-3.0, 0.0), "floorMaterial": "Carpet"}
        ],
        "walls": [
            wall("w0", "room|2", [0.0, 0.0], [4.0, 0.0]), wall("w1", "room|3", [4.0, 0.0], [0.0, 0.0]),
            {"id": "e", "roomId": "room|2", "polygon": [], "empty": true}
        ],
        "doors": [{"id": "door|2|3", "assetId": "Doorway_1", "wall0": "w0", "wall1": "w1", "assetPosition": {"x": 1.5, "y": 1, "z": 0},
            "holePolygon": [{"x": 1, "y": 0, "z": 0}, {"x": 2, "y": 2, "z": 0}]}],
        "windows": [],
        "objects": [
            {"id": "Chair|2|0", "assetId": "Chair_1", "position": {"x": 1, "y": 0.5, "z": 2}, "rotation": {"x": 0, "y": 90, "z": 0},
                "children": [{"id": "Apple|surface|2|1", "assetId": "Apple_1", "position": {"x": 1, "y": 1, "z": 2}}]},
            {"id": "Sofa|3|0", "assetId": "Sofa_9", "position": {"x": 2, "y": 0.4, "z": -1}, "rotation": {"x": 0, "y": 0, "z": 0}}
        ],
        "proceduralParameters": {"lights": [
            {"id": "lamp", "type": "point", "position": {"x": 2, "y": 2.3, "z": 1}, "intensity": 2, "rgb": {"r": 1, "g": 0.5, "b": 0}},
            {"id": "sun", "type": "directional", "position": {"x": 0, "y": 9, "z": 0}, "rotation": {"x": 90, "y": 0, "z": 0}, "intensity": 1}
        ]},
        "metadata": {"schema": "1.0.0"}
    })
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("houses/1.json", house().to_string());
    folder.write("models/Chair_1/Chair_1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let table = json!({"Sofa": [{"assetId": "Sofa_9", "objectType": "Sofa", "boundingBox": {"x": 2, "y": 0.8, "z": 1}}]});
    folder.write("asset-database.json", table.to_string());
    folder
}

fn imported() -> Imported {
    folder().load("houses/1.json").unwrap_or_else(|e| panic!("{e}"))
}

fn points(imported: &Imported, name: &str) -> Vec<Vec3> {
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} in {names:?}"));
    imported.scene.world_positions(part).collect()
}

/// The area of a part's faces along a direction.
fn area(imported: &Imported, name: &str, toward: Vec3) -> f32 {
    let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap();
    let triangles = imported.scene.meshes[part.mesh as usize].triangles.len();
    (0..triangles).map(|t| imported.scene.world_corners(part, t)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(toward)).sum()
}

#[test]
fn unitys_left_handed_space_is_mirrored_and_objects_stand_by_the_middle_of_their_box() {
    let imported = imported();
    // Unity's (x, y, z) is (−x, −z, y) here, and the exported model's x is Unity's −x.
    let chair = points(&imported, "Chair (Chair_1)");
    let expected = [[-1.0, -1.5, 0.0], [-1.0, -2.5, 0.0], [-1.0, -1.5, 1.0]].map(Vec3::from);
    assert!(chair.iter().zip(expected).all(|(p, e)| (*p - e).length() < 1e-5), "{chair:?}");
    let [Light::Point { position, intensity, .. }, Light::Directional { direction, .. }] = &imported.scene.lights[..] else {
        panic!("{:?}", imported.scene.lights)
    };
    assert!((*position - Vec3::new(-2.0, -1.0, 2.3)).length() < 1e-5 && *intensity == Rgb::new(2.0, 1.0, 0.0));
    // Unity's lights shine along their z, which a quarter about x turns down.
    assert!((*direction - Vec3::NEG_Z).length() < 1e-5, "{direction}");
}

#[test]
fn both_sheets_of_a_wall_have_the_hole_of_its_door_and_face_their_rooms() {
    let imported = imported();
    for (wall, inward, y) in [("wall (w0)", Vec3::NEG_Y, -0.005), ("wall (w1)", Vec3::Y, 0.005)] {
        assert!((area(&imported, wall, inward) - 8.0).abs() < 1e-4, "{wall}: {}", area(&imported, wall, inward));
        let corners = points(&imported, wall);
        assert!(corners.iter().all(|p| (p.y - y).abs() < 1e-6), "{corners:?}");
        // The hole is 1 to 2 m from the start of the first, at x = −1 to −2.
        assert!(corners.iter().any(|p| (p.x + 1.0).abs() < 1e-5 && (p.z - 2.0).abs() < 1e-5), "{corners:?}");
    }
    assert!((area(&imported, "Kitchen floor (room|2)", Vec3::Z) - 12.0).abs() < 1e-4);
    assert!((area(&imported, "Bedroom ceiling (room|3)", Vec3::NEG_Z) - 12.0).abs() < 1e-4);
    assert_eq!(points(&imported, "Bedroom ceiling (room|3)")[0].z, 2.5);
}

#[test]
fn object_types_become_classes_and_what_has_no_model_is_a_box_or_told() {
    let imported = imported();
    let labels: Vec<(&str, i16, i16)> = imported
        .labels
        .iter()
        .flatten()
        .map(|l| (imported.scene.parts[l.part as usize].name.as_str(), l.label.semantic, l.label.instance))
        .collect();
    assert_eq!(labels[4..], [("wall (w0)", 1, -1), ("wall (w1)", 1, -1), ("Chair (Chair_1)", 5, 1), ("Sofa (Sofa_9)", 6, 2)]);
    let sofa = points(&imported, "Sofa (Sofa_9)");
    let (min, max) = sofa.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    assert!((min - Vec3::new(-3.0, 0.5, 0.0)).length() < 1e-5 && (max - Vec3::new(-1.0, 1.5, 0.8)).length() < 1e-5, "{min} {max}");
    let told = warnings(&imported);
    assert!(told.contains("1 objects are boxes") && told.contains("such as Sofa_9"), "{told}");
    assert!(told.contains("1 objects were left out") && told.contains("such as Apple_1"), "{told}");
    assert!(told.contains("1 openings are bare holes"), "{told}");
}

#[test]
fn openings_of_the_older_schema_are_cut_too() {
    let mut old = house();
    let door = &mut old["doors"][0];
    door["boundingBox"] = json!({"min": {"x": 1, "y": 0, "z": 0}, "max": {"x": 2, "y": 2, "z": 0}});
    door.as_object_mut().unwrap().remove("holePolygon");
    let folder = folder();
    let imported = folder.write("houses/1.json", old.to_string()).load("houses/1.json").unwrap();
    assert!((area(&imported, "wall (w1)", Vec3::Y) - 8.0).abs() < 1e-4);
}

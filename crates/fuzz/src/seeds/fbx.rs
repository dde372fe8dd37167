//! FBX documents, by the builders of the importer's tests.

use super::import::fbx::{Record, Value, belongs, binary, document, feeds, int, object, properties, reals, record, text};
use super::seed;
use crate::Seed;

/// A document with everything in it, as text and as binary of both widths.
pub fn fbx() -> Vec<Seed> {
    let room = room();
    vec![seed("room_text.fbx", text(&room, 7400)), seed("room_7400.fbx", binary(&room, 7400)), seed("room_7700.fbx", binary(&room, 7700))]
}

fn room() -> Vec<Record> {
    let color = |name, v: [f64; 3]| reals(name, "Color", &v);
    let vector = |name, v: [f64; 3]| reals(name, "Vector3D", &v);
    let place =
        vec![vector("Lcl Translation", [10.0, 20.0, 30.0]), vector("Lcl Rotation", [0.0, 0.0, 90.0]), int("RotationOrder", "enum", 2)];
    let shading = record("ShadingModel", vec![Value::Text("phong")], vec![]);
    let wood = vec![color("DiffuseColor", [0.5; 3]), color("SpecularColor", [1.0; 3]), reals("ShininessExponent", "Number", &[20.0])];
    let picture = vec![record("RelativeFilename", vec![Value::Text("texture.png")], vec![])];
    let lamp = vec![int("LightType", "enum", 2), reals("Intensity", "Number", &[100.0]), reals("OuterAngle", "Number", &[40.0])];
    let camera = vec![reals("FocalLength", "Number", &[35.0]), int("AspectWidth", "Number", 64), int("AspectHeight", "Number", 48)];
    let attribute = |id, class, list| object("NodeAttribute", id, "Attribute\0\x01NodeAttribute", class, vec![properties(list)]);
    let node = |id, class, list| object("Model", id, "Thing\0\x01Model", class, vec![properties(list)]);
    let objects = vec![
        mesh(10),
        node(20, "Mesh", place),
        object("Material", 30, "Wood\0\x01Material", "", vec![shading, properties(wood)]),
        object("Texture", 40, "Picture\0\x01Texture", "", picture.clone()),
        object(
            "Video",
            41,
            "Picture\0\x01Video",
            "Clip",
            [picture, vec![record("Content", vec![Value::Bytes(vec![1, 2, 3])], vec![])]].concat(),
        ),
        node(50, "Light", vec![]),
        attribute(51, "Light", lamp),
        node(60, "Camera", vec![vector("Lcl Translation", [0.0, 100.0, 300.0])]),
        attribute(61, "Camera", camera),
    ];
    let links =
        [(20, 0), (10, 20), (30, 20), (41, 40), (50, 0), (51, 50), (60, 20), (61, 60)].map(|(child, parent)| belongs(child, parent));
    let links = [links.to_vec(), vec![feeds(40, 30, "DiffuseColor")]].concat();
    document(7400, vec![reals("UnitScaleFactor", "double", &[2.54])], objects, links)
}

/// A triangle and a square with normals, texture coordinates and materials.
fn mesh(id: i64) -> Record {
    let layer = |name, what, mapping, values| {
        let children = vec![
            record("MappingInformationType", vec![Value::Text(mapping)], vec![]),
            record("ReferenceInformationType", vec![Value::Text("Direct")], vec![]),
            record(what, vec![values], vec![]),
        ];
        record(name, vec![Value::Int(0)], children)
    };
    let points = vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let children = vec![
        record("Vertices", vec![Value::Reals(points)], vec![]),
        record("PolygonVertexIndex", vec![Value::Ints(vec![0, 1, 2, -4, 0, 1, -5])], vec![]),
        layer("LayerElementNormal", "Normals", "ByPolygonVertex", Value::Reals([0.0, 0.0, 1.0].repeat(7))),
        layer("LayerElementUV", "UV", "ByPolygonVertex", Value::Reals([0.0, 0.5].repeat(7))),
        layer("LayerElementMaterial", "Materials", "ByPolygon", Value::Ints(vec![0, 0])),
    ];
    object("Geometry", id, "\0\x01Geometry", "Mesh", children)
}

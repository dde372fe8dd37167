//! Scenes in the coordinates of maps, hundreds of kilometres from their origin: moved near, and nothing lost on the way.

use crate::common::fbx::*;
use crate::common::{Folder, Gltf, warnings};
use enfilade_import::{ImportOptions, Imported, UpAxis};
use enfilade_math::{DVec3, Vec3};
use enfilade_scene::Light;
use serde_json::json;

/// A corner in UTM, metres: east, north, up. Single precision knows it to half a metre.
const CORNER: DVec3 = DVec3::new(445_123.4, 5_411_234.6, 31.2);
/// Corners of a triangle, seen from the first one, metres.
const EDGES: [DVec3; 2] = [DVec3::new(0.25, 0.0, 0.0), DVec3::new(0.0, 0.125, 0.5)];

/// Numbers of a point, as files have them.
fn words(p: DVec3) -> String {
    format!("{} {} {}", p.x, p.y, p.z)
}

fn corners() -> [DVec3; 3] {
    [CORNER, CORNER + EDGES[0], CORNER + EDGES[1]]
}

/// A point in axes with y up.
fn y_up(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, -p.y)
}

/// Asserts that the first part is the triangle, near the origin, and that the report leads back to the file's coordinates.
fn holds(imported: &Imported, format: &str) {
    let scene = &imported.scene;
    let offset = DVec3::from_array(imported.report.offset_m.unwrap_or_else(|| panic!("{format}: no offset")));
    assert_eq!((offset.fract(), offset.z), (DVec3::ZERO, 0.0), "{format}");
    for (found, expected) in scene.world_corners(&scene.parts[0], 0).into_iter().zip(corners()) {
        assert!(found.truncate().abs().max_element() < 10.0, "{format}: {found} is not near");
        let back = found.as_dvec3() + offset;
        // Single precision at 40 m, where heights are, knows 4 µm.
        assert!((back - expected).length() < 1e-5, "{format}: {back} is not {expected}");
    }
    let told = warnings(imported);
    assert!(told.contains("coordinates: the scene stands 5411 km from the origin") && told.contains("steps of 500 mm"), "{format}: {told}");
}

#[test]
fn triangles_in_utm_keep_their_shape_and_the_report_leads_back() {
    let folder = Folder::new();
    let [a, b, c] = corners();
    let points = [a, b, c].map(words).join("\n");
    let ply = |kind: &str| {
        format!(
            "element vertex 3\nproperty {kind} x\nproperty {kind} y\nproperty {kind} z\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n"
        )
    };
    let mut binary = format!("ply\nformat binary_little_endian 1.0\n{}", ply("double")).into_bytes();
    [a, b, c].iter().for_each(|p| binary.extend(p.to_array().iter().flat_map(|v| v.to_le_bytes())));
    binary.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    let tuples = |points: &[DVec3]| points.iter().map(|p| format!("({}, {}, {})", p.x, p.y, p.z)).collect::<Vec<_>>().join(", ");
    let usd = |points: &[DVec3], place: &str| {
        format!(
            "#usda 1.0\n( metersPerUnit = 1 upAxis = \"Z\" )\ndef Mesh \"M\" {{ int[] faceVertexCounts = [3]\n\
             int[] faceVertexIndices = [0, 1, 2]\npoint3d[] points = [{}]\nuniform token subdivisionScheme = \"none\"\n{place} }}",
            tuples(points)
        )
    };
    let translate = format!("double3 xformOp:translate = {}\nuniform token[] xformOpOrder = [\"xformOp:translate\"]", tuples(&[a]));
    let local = [DVec3::ZERO, EDGES[0], EDGES[1]];
    let mitsuba = format!(
        "<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" value=\"local.obj\"/><transform name=\"to_world\">\
         <translate x=\"{}\" y=\"{}\" z=\"{}\"/></transform></shape></scene>",
        a.x, a.y, a.z
    );
    let mesh_of_mitsuba = "<scene version=\"3.0.0\"><shape type=\"ply\"><string name=\"filename\" value=\"ascii.ply\"/></shape></scene>";
    let pbrt = |place: &str, points: &[DVec3]| {
        let numbers = points.iter().map(|p| words(*p)).collect::<Vec<_>>().join(" ");
        format!(
            "Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n{place}\n\
             Shape \"trianglemesh\" \"point3 P\" [{numbers}] \"integer indices\" [0 1 2]\n"
        )
    };
    folder.write("local.obj", format!("v {}\nf 1 2 3\n", local.map(words).join("\nv ")));
    let files: [(&str, Vec<u8>); 9] = [
        ("a.obj", format!("v {}\nf 1 2 3\n", [a, b, c].map(words).join("\nv ")).into()),
        ("ascii.ply", format!("ply\nformat ascii 1.0\n{}{points}\n3 0 1 2\n", ply("float")).into()),
        ("double.ply", binary),
        ("points.usda", usd(&[a, b, c], "").into()),
        ("placed.usda", usd(&local, &translate).into()),
        ("placed.xml", mitsuba.into()),
        ("mesh.xml", mesh_of_mitsuba.into()),
        ("placed.pbrt", pbrt(&format!("Translate {}", words(a)), &local).into()),
        ("mesh.pbrt", pbrt("", &[a, b, c]).into()),
    ];
    let options = ImportOptions { up_axis: Some(UpAxis::Z), ..ImportOptions::default() };
    for (name, bytes) in files {
        let imported = folder.write(name, bytes).load_with(name, &options).unwrap_or_else(|e| panic!("{name}: {e}"));
        holds(&imported, name);
    }
}

#[test]
fn nodes_of_gltf_and_fbx_in_utm_keep_their_places() {
    let folder = Folder::new();
    let mut g = Gltf::triangle();
    let local = [DVec3::ZERO, y_up(EDGES[0]), y_up(EDGES[1])];
    let at =
        g.accessor(&local.iter().flat_map(|p| p.as_vec3().to_array()).flat_map(f32::to_le_bytes).collect::<Vec<u8>>(), 5126, "VEC3", 3);
    g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(at);
    g.json["nodes"][0]["translation"] = json!(y_up(CORNER).to_array());
    g.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    let lamp = json!({"name": "Lamp", "translation": [0.25, 0.5, 0.0], "extensions": {"KHR_lights_punctual": {"light": 0}}});
    g.json["nodes"].as_array_mut().unwrap().push(lamp);
    g.json["nodes"][0]["children"] = json!([1]);
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    holds(&imported, "gltf");
    let [first, ..] = imported.scene.world_corners(&imported.scene.parts[0], 0);
    let Light::Point { position, .. } = &imported.scene.lights[0] else { panic!("no point light") };
    assert!((*position - first - Vec3::new(0.25, 0.0, 0.5)).length() < 1e-5, "{position} {first}");
    let mut m = g.json["nodes"][0].clone();
    let [x, y, z] = m["translation"].as_array().unwrap().clone().try_into().unwrap();
    m.as_object_mut().unwrap().remove("translation");
    m["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1]);
    g.json["nodes"][0] = m;
    holds(&folder.write("m.gltf", g.text()).load("m.gltf").unwrap(), "gltf by matrix");

    // In centimetres, the unit of FBX.
    let triangle = |points: [DVec3; 3]| {
        let numbers = points.iter().flat_map(|p| (*p * 100.0).to_array()).collect();
        let children = vec![
            record("Vertices", vec![Value::Reals(numbers)], vec![]),
            record("PolygonVertexIndex", vec![Value::Ints(vec![0, 1, -3])], vec![]),
        ];
        object("Geometry", 10, "\0\x01Geometry", "Mesh", children)
    };
    let placed = |points: [DVec3; 3], at: DVec3| {
        let place = reals("Lcl Translation", "Vector3D", &(at * 100.0).to_array());
        let node = object("Model", 20, "Chair\0\x01Model", "Mesh", vec![properties(vec![place])]);
        document(7400, vec![], vec![triangle(points), node], vec![belongs(20, 0), belongs(10, 20)])
    };
    for (name, document) in [("vertices.fbx", placed(corners().map(y_up), DVec3::ZERO)), ("node.fbx", placed(local, y_up(CORNER)))] {
        let imported = folder.write(name, binary(&document, 7400)).load(name).unwrap_or_else(|e| panic!("{name}: {e}"));
        holds(&imported, name);
    }
}

#[test]
fn scenes_that_are_near_or_large_stay_where_they_are() {
    let folder = Folder::new();
    let cases = [
        // A site plan some kilometres from its origin, and a plain around it.
        ("near", "v 7000 0 0\nv 7001 0 0\nv 7000 1 0\nf 1 2 3\n"),
        ("large", "v -90000 0 -90000\nv 90000 0 -90000\nv 0 0 90000\nf 1 2 3\n"),
    ];
    for (name, text) in cases {
        let imported = folder.write("a.obj", text).load("a.obj").unwrap();
        assert_eq!(imported.report.offset_m, None, "{name}");
        assert_eq!(imported.scene.parts[0].world_from_mesh.translation, DVec3::ZERO, "{name}");
    }
    // Cameras go along.
    let mut g = Gltf::triangle();
    g.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    g.json["nodes"] = json!([{"mesh": 0, "camera": 0, "translation": [20_000.3, 0.0, 0.0]}]);
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.report.offset_m.map(|o| o[0].round()), Some(20_001.0));
    assert!((imported.scene.cameras[0].position - DVec3::new(-0.7, 0.0, 0.0)).length() < 1e-9);
}

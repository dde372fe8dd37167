//! Annotated scans in the layouts of Replica, Matterport3D and HM3D, and houses of Structured3D, made on the spot.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec3};
use enfilade_scene::Bsdf;
use serde_json::{Value, json};

/// Name, class and instance of every part.
fn parts(imported: &Imported) -> Vec<(&str, i16, i16)> {
    let of = |i: usize| {
        imported.labels.iter().flatten().find(|l| l.part as usize == i).map_or((-1, -1), |l| (l.label.semantic, l.label.instance))
    };
    imported.scene.parts.iter().enumerate().map(|(i, p)| (p.name.as_str(), of(i).0, of(i).1)).collect()
}

fn points(imported: &Imported, name: &str) -> Vec<Vec3> {
    let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} in {:?}", parts(imported)));
    imported.scene.world_positions(part).collect()
}

/// Two squares beside one another and a triangle over them, of objects 3, 7 and 3; the left vertices red.
fn ply(property: &str) -> String {
    let header = format!(
        "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n\
         property uchar blue\nelement face 3\nproperty list uchar int vertex_indices\nproperty int {property}\nend_header\n"
    );
    header
        + "0 0 0 255 0 0\n1 0 0 0 0 0\n1 1 0 0 0 0\n0 1 0 255 0 0\n2 0 0 0 0 255\n2 1 0 0 0 255\n0 0 2 255 0 0\n4 0 1 2 3 3\n4 1 4 5 2 7\n3 0 1 6 3\n"
}

#[test]
fn faces_of_replica_become_objects_with_their_classes_and_mean_colours() {
    let folder = Folder::new();
    folder.write("apartment_0/habitat/mesh_semantic.ply", ply("object_id"));
    let info = json!({"classes": [{"id": 20, "name": "chair"}, {"id": 40, "name": "floor"}],
        "objects": [{"id": 3, "class_id": 40}, {"id": 7, "class_id": 20, "class_name": "chair"}]});
    folder.write("apartment_0/habitat/info_semantic.json", info.to_string());
    let imported = folder.load("apartment_0/habitat/info_semantic.json").unwrap();
    assert_eq!(parts(&imported), [("floor (3)", 2, -1), ("chair (7)", 5, 1)]);
    // z is up already.
    assert!(points(&imported, "floor (3)").contains(&Vec3::new(0.0, 0.0, 2.0)));
    assert_eq!(points(&imported, "chair (7)").len(), 4);
    let Bsdf::Diffuse { reflectance } = &imported.scene.materials[1].bsdf else { panic!("not diffuse") };
    assert_eq!(reflectance.factor, Rgb::new(0.0, 0.0, 0.5));
    assert!(warnings(&imported).contains("colours of vertices are not supported"));
    // Its folder can be given in its place.
    assert_eq!(folder.load("apartment_0").unwrap().report.counts.parts, 2);
}

#[test]
fn a_mesh_that_tells_no_objects_is_refused() {
    let folder = Folder::new();
    folder.write("mesh_semantic.ply", ply("other")).write("info_semantic.json", r#"{"classes": [], "objects": []}"#);
    let message = folder.error("info_semantic.json");
    assert!(message.contains("mesh_semantic.ply: face 0: neither faces nor vertices have a number object_id or objectId"), "{message}");
}

#[test]
fn objects_of_matterport_are_found_through_segments_and_categories() {
    let folder = Folder::new();
    let house = "ASCII 1.1\nH house label 0 0 0 0 2 2 2 1 0 1 0 0 0 0 0 0 0 0 1 1 1 0 0 0 0 0\n\
        C 0 12 kitchen#chair 3 chair 0 0 0 0 0\nC 1 5 odd#thing 39 objects 0 0 0 0 0\nO 4 0 0 0 0 0 1 0 0 0 1 0 1 1 1 0 0 0 0 0 0 0 0\n\
        O 5 0 1 0 0 0 1 0 0 0 1 0 1 1 1 0 0 0 0 0 0 0 0\nE 0 4 3 1 0 0 0 0 0 0 1 1 1 0 0 0 0 0\nE 1 5 7 1 0 0 0 0 0 0 1 1 1 0 0 0 0 0\n";
    folder.write("abc.house", house).write("abc_semantic.ply", ply("object_id"));
    let imported = folder.load("abc.house").unwrap();
    assert_eq!(parts(&imported), [("chair (4)", 5, 1), ("odd thing (5)", -1, -1)]);
    assert!(warnings(&imported).contains("odd thing (1)"));
    assert!(folder.write("b.house", "H b\n").error("b.house").contains("found neither b_semantic.ply nor b.ply beside it"));
    assert!(folder.write("c.house", "x").error("c.house").contains("line 1: found no house of Matterport3D"));
    assert!(folder.write("abc.house", "ASCII 1.1\nO x 0 0\n").error("abc.house").contains("line 2: found \"x\" as word 1"));
}

/// Two triangles side by side, each with texture coordinates in one half of the picture.
fn halves(picture: &[u8]) -> Vec<u8> {
    let mut gltf = Gltf::triangle();
    let uv = |gltf: &mut Gltf, u: f32| gltf.accessor(&[u, 0.5, u, 0.5, u, 0.5].map(f32::to_le_bytes).concat(), 5126, "VEC2", 3);
    let (left, right) = (uv(&mut gltf, 0.25), uv(&mut gltf, 0.75));
    let view = gltf.view(picture);
    gltf.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
    gltf.json["textures"] = json!([{"source": 0}]);
    gltf.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}, "metallicFactor": 0});
    let primitive = |uv: usize| json!({"attributes": {"POSITION": 0, "TEXCOORD_0": uv}, "indices": 2, "material": 0});
    gltf.json["meshes"] = json!([{"primitives": [primitive(left)]}, {"primitives": [primitive(right)]}]);
    gltf.json["nodes"] = json!([{"name": "a", "mesh": 0}, {"name": "b", "mesh": 1, "translation": [2, 0, 0]}]);
    gltf.json["scenes"] = json!([{"nodes": [0, 1]}]);
    gltf.binary()
}

/// A picture of two texels beside one another.
fn two_texels(left: [u8; 4], right: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let pixel = |x: u32, _| image::Rgba(if x == 0 { left } else { right });
    image::RgbaImage::from_fn(2, 1, pixel).write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

#[test]
fn colours_of_hm3d_tell_objects_of_the_scan_with_its_own_pictures() {
    let folder = Folder::new();
    folder.write("x/s.semantic.txt", "HM3D Semantic Annotations\n1,FF0000,\"wall\",0\n2,00FF80,\"chair, old\",0\n3,0000FF,\"bed\",1\n");
    folder.write("x/s.semantic.glb", halves(&two_texels([255, 0, 0, 255], [0, 0, 255, 255])));
    folder.write("x/s.basis.glb", halves(&two_texels([90, 90, 90, 255], [9, 9, 9, 255])));
    let imported = folder.load("x/s.semantic.txt").unwrap();
    assert_eq!(parts(&imported), [("wall (1)", 1, -1), ("bed (3)", 4, 1)]);
    // z is up: the second triangle is 2 m along x.
    assert_eq!(points(&imported, "bed (3)"), [[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 1.0, 0.0]].map(Vec3::from));
    let texels = imported.scene.images.iter().map(|image| image.width).collect::<Vec<_>>();
    assert_eq!(texels, [2], "the scan's picture alone");
    assert!(imported.inputs.iter().any(|p| p.ends_with("s.semantic.glb")));
    assert_eq!(folder.load("x").unwrap().report.counts.parts, 2);

    // Another scan, or none: the annotated triangles in grey.
    let scan = Gltf::triangle().binary();
    let other = folder.write("x/s.basis.glb", scan).load("x/s.semantic.txt").unwrap();
    assert!(warnings(&other).contains("are not those of the semantic model"), "{}", warnings(&other));
    assert_eq!((parts(&other).len(), other.scene.images.len()), (2, 0));
    let message = folder.write("x/s.semantic.txt", "HM3D Semantic Annotations\n1,FF0000\n").error("x/s.semantic.txt");
    assert!(message.contains("line 2: found \"1,FF0000\", expected number, colour"), "{message}");
}

/// A room of 4 × 3 × 2.5 m with a door of 1 × 2 m through a wall 10 cm thick: loops of planes, by numbers of junctions.
fn structured() -> Value {
    let mut junctions = Vec::new();
    for z in [0, 2500] {
        junctions.extend([[0, 0, z], [4000, 0, z], [4000, 3000, z], [0, 3000, z]]);
    }
    for y in [0, -100] {
        junctions.extend([[1000, y, 0], [2000, y, 0], [2000, y, 2000], [1000, y, 2000]]);
    }
    let planes = [
        ("floor", [0, 0, 1], vec![vec![0, 1, 2, 3]]),
        ("ceiling", [0, 0, -1], vec![vec![4, 5, 6, 7]]),
        ("wall", [0, 1, 0], vec![vec![0, 1, 5, 4], vec![8, 9, 10, 11]]),
        ("wall", [-1, 0, 0], vec![vec![1, 2, 6, 5]]),
        // The door: its face on the wall, its sides and its head.
        ("wall", [0, 1, 0], vec![vec![8, 9, 10, 11]]),
        ("wall", [1, 0, 0], vec![vec![8, 12, 15, 11]]),
        ("ceiling", [0, 0, -1], vec![vec![10, 11, 15, 14]]),
        ("wall", [0, 1, 0], vec![vec![0, 1]]),
    ];
    let mut lines: Vec<[usize; 2]> = Vec::new();
    let mut of_planes = Vec::new();
    for (_, _, loops) in &planes {
        let mut own = Vec::new();
        for corners in loops {
            for (i, &p) in corners.iter().enumerate() {
                let q = corners[(i + 1) % corners.len()];
                let line = [p.min(q), p.max(q)];
                let known = lines.iter().position(|l| *l == line);
                own.push(known.unwrap_or_else(|| {
                    lines.push(line);
                    lines.len() - 1
                }));
            }
        }
        of_planes.push(own);
    }
    let row = |on: &[usize], length: usize| (0..length).map(|i| u8::from(on.contains(&i))).collect::<Vec<_>>();
    json!({
        "junctions": junctions.iter().enumerate().map(|(i, c)| json!({"ID": i, "coordinate": c})).collect::<Vec<_>>(),
        "lines": [], "cuboids": [], "manhattan": [],
        "planes": planes.iter().enumerate().map(|(i, (kind, normal, _))| json!({"ID": i, "type": kind, "normal": normal, "offset": 0})).collect::<Vec<_>>(),
        "semantics": [{"ID": 0, "type": "kitchen", "planeID": [0, 1, 2, 3, 7]}, {"ID": 1, "type": "door", "planeID": [4, 5, 6]}],
        "planeLineMatrix": of_planes.iter().map(|own| row(own, lines.len())).collect::<Vec<_>>(),
        "lineJunctionMatrix": lines.iter().map(|ends| row(ends, junctions.len())).collect::<Vec<_>>()
    })
}

#[test]
fn planes_of_structured3d_are_metres_with_holes_and_reveals() {
    let folder = Folder::new();
    let imported = folder.write("scene_00000/annotation_3d.json", structured().to_string()).load("scene_00000").unwrap();
    let expected = [
        ("kitchen floor (0)", 2, -1),
        ("kitchen ceiling (1)", 22, -1),
        ("kitchen wall (2)", 1, -1),
        ("kitchen wall (3)", 1, -1),
        ("door/wall (5)", 8, 1),
        ("door/ceiling (6)", 8, 1),
    ];
    assert_eq!(parts(&imported), expected);
    let area = |name: &str, toward: Vec3| -> f32 {
        let part = imported.scene.parts.iter().find(|p| p.name == name).unwrap();
        let triangles = 0..imported.scene.meshes[part.mesh as usize].triangles.len();
        triangles.map(|t| imported.scene.world_corners(part, t)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).dot(toward)).sum()
    };
    for (name, toward, expected) in [
        ("kitchen floor (0)", Vec3::Z, 12.0),
        ("kitchen ceiling (1)", Vec3::NEG_Z, 12.0),
        ("kitchen wall (2)", Vec3::Y, 8.0),
        ("kitchen wall (3)", Vec3::NEG_X, 7.5),
        ("door/wall (5)", Vec3::X, 0.2),
        ("door/ceiling (6)", Vec3::NEG_Z, 0.1),
    ] {
        assert!((area(name, toward) - expected).abs() < 1e-4, "{name}: {}", area(name, toward));
    }
    assert!(points(&imported, "kitchen wall (3)").contains(&Vec3::new(4.0, 3.0, 2.5)));
    assert!(warnings(&imported).contains("1 planes have no closed outline"), "{}", warnings(&imported));
    let mut broken = structured();
    broken["semantics"][0]["planeID"] = json!([99]);
    let message = folder.write("b.json", broken.to_string()).error("b.json");
    assert!(message.contains("semantics: it refers to plane 99, but there are only 8"), "{message}");
}

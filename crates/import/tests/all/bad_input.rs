//! Files that are wrong: each gets one clear message with file, place and what to do; none panics.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::{EnvironmentOverride, EnvironmentSource, Format, ImportOptions};
use serde_json::json;

fn gltf_error(change: impl FnOnce(&mut Gltf)) -> String {
    let (folder, mut g) = (Folder::new(), Gltf::triangle());
    change(&mut g);
    folder.write("a.gltf", g.text()).error("a.gltf")
}

#[test]
fn truncations_of_a_binary_gltf_are_errors() {
    let folder = Folder::new();
    let whole = Gltf::triangle().binary();
    // The last three bytes may be padding, which some programs count and do not write.
    for length in (0..whole.len() - 3).step_by(5) {
        let message = folder.write("a.glb", &whole[..length]).error("a.glb");
        assert!(message.starts_with("a.glb: "), "{message}");
    }
    let message = folder.write("a.glb", &whole[..whole.len() - 5]).error("a.glb");
    assert!(message.contains("cut short, so copy or export it again"), "{message}");
}

#[test]
fn changed_bytes_of_a_binary_gltf_never_panic() {
    let folder = Folder::new();
    let whole = Gltf::triangle().binary();
    for at in (0..whole.len()).step_by(3) {
        for value in [0xff, b'9'] {
            let mut bytes = whole.clone();
            bytes[at] = value;
            drop(folder.write("a.glb", &bytes).load("a.glb"));
        }
    }
}

#[test]
fn indices_out_of_range_name_their_place() {
    let message = gltf_error(|g| {
        let bad = g.accessor(&[0u16, 1, 9].map(u16::to_le_bytes).concat(), 5123, "SCALAR", 3);
        g.json["meshes"][0]["primitives"][0]["indices"] = json!(bad);
    });
    assert!(message.starts_with("a.gltf: meshes[0].primitives[0]: triangle 0 refers to vertex 9, but there are 3 vertices"), "{message}");
    let cases = [
        ("/nodes/0/mesh", "nodes[0]: it refers to mesh 7, but there are only 1"),
        ("/scenes/0/nodes/0", "there is a reference to node 7, but there are only 1"),
        ("/meshes/0/primitives/0/material", "it refers to material 7, but there are only 1"),
        ("/meshes/0/primitives/0/indices", "refers to accessor 7, but there are only 3"),
        ("/accessors/0/bufferView", "refers to bufferView 7, but there are only 3"),
        ("/accessors/0/count", "has 7 elements of 12 bytes"),
        ("/accessors/0/byteOffset", "from byte 7"),
        ("/bufferViews/0/buffer", "refers to buffer 7, but there are only 1"),
        ("/bufferViews/0/byteStride", "a stride of 7 bytes for elements of 12"),
    ];
    for (pointer, expected) in cases {
        let message = gltf_error(|g| {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let parent = g.json.pointer_mut(parent).unwrap();
            match key.parse::<usize>() {
                Ok(i) if parent.is_array() => parent[i] = json!(7),
                _ => parent[key] = json!(7),
            }
        });
        assert!(message.contains(expected), "{pointer}: {message}");
    }
}

#[test]
fn sizes_that_overflow_are_errors() {
    for pointer in ["/accessors/0/count", "/accessors/0/byteOffset", "/bufferViews/0/byteOffset", "/bufferViews/0/byteLength"] {
        let message = gltf_error(|g| {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            g.json.pointer_mut(parent).unwrap()[key] = json!(u64::MAX);
        });
        assert!(message.contains("damaged"), "{pointer}: {message}");
    }
    let message = gltf_error(|g| {
        g.json["accessors"][0] = json!({"componentType": 5126, "type": "VEC3", "count": u64::MAX});
    });
    assert!(message.contains("no bufferView"), "{message}");
}

#[test]
fn positions_that_are_not_numbers_name_their_vertex() {
    let message = gltf_error(|g| {
        let nan = [0.0, 0.0, 0.0, 1.0, f32::NAN, 0.0, 0.0, 1.0, 0.0f32].map(f32::to_le_bytes).concat();
        let bad = g.accessor(&nan, 5126, "VEC3", 3);
        g.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(bad);
    });
    assert!(message.starts_with("a.gltf: meshes[0].primitives[0]: vertex 1 has a position that is not finite"), "{message}");
}

#[test]
fn empty_meshes_are_left_out_and_nothing_but_them_is_an_error() {
    let (folder, mut g) = (Folder::new(), Gltf::triangle());
    let none = g.accessor(&[], 5123, "SCALAR", 0);
    let mut empty = g.json["meshes"][0].clone();
    empty["primitives"][0]["indices"] = json!(none);
    g.json["meshes"].as_array_mut().unwrap().push(empty);
    g.json["nodes"].as_array_mut().unwrap().push(json!({"name": "Nothing", "mesh": 1}));
    g.json["scenes"][0]["nodes"] = json!([0, 1]);
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene.parts.len(), 1);
    assert!(warnings(&imported).contains("no triangles"));
    g.json["scenes"][0]["nodes"] = json!([1]);
    let message = folder.write("a.gltf", g.text()).error("a.gltf");
    assert!(message.contains("the scene has no visible parts"), "{message}");
}

#[test]
fn missing_textures_are_an_error_unless_allowed() {
    let (folder, mut g) = (Folder::new(), Gltf::triangle());
    g.json["images"] = json!([{"uri": "textures/wood.png"}]);
    g.json["textures"] = json!([{"source": 0}]);
    g.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}, "metallicFactor": 0.0});
    let message = folder.write("a.gltf", g.text()).error("a.gltf");
    for expected in ["a.gltf: material \"Wood\" needs the texture textures/wood.png", "No such file", "allow_missing_textures = true"] {
        assert!(message.contains(expected), "{message}");
    }
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    let imported = folder.load_with("a.gltf", &options).unwrap();
    assert!(warnings(&imported).contains("a plain grey stands in"));
    let enfilade_scene::Bsdf::Principled(p) = &imported.scene.materials[0].bsdf else { panic!("not principled") };
    assert_eq!((p.base_color.factor, p.base_color.texture), (enfilade_math::Rgb::splat(0.5), None));

    let message = folder.write("textures/wood.png", b"\x89PNG\r\n\x1a\nbroken").error("a.gltf");
    assert!(message.contains("wood.png, which cannot be decoded"), "{message}");
}

#[test]
fn pointers_of_git_lfs_are_named_in_every_format_and_for_every_file() {
    const POINTER: &str = "version https://git-lfs.github.com/spec/v1\noid sha256:00112233\nsize 28200\n";
    let folder = Folder::new();
    let expected = "this is a Git LFS pointer to a file that was not fetched: run `git lfs pull`";
    for extension in Format::ALL.iter().flat_map(|(_, extensions)| *extensions) {
        let name = format!("a.{extension}");
        let message = folder.write(&name, POINTER).error(&name);
        assert!(message.starts_with(&format!("{name}: {expected}")), "{message}");
    }
    let (mut picture, mut buffer) = (Gltf::triangle().json, Gltf::triangle().json);
    picture["images"] = json!([{"uri": "lfs.png"}]);
    picture["textures"] = json!([{"source": 0}]);
    picture["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
    let mut textured = Gltf::triangle();
    textured.json = picture;
    buffer["buffers"] = json!([{"byteLength": 100, "uri": "lfs.bin"}]);
    let shape = |kind: &str| {
        format!("<scene version=\"3.0.0\"><shape type=\"{kind}\"><string name=\"filename\" value=\"lfs.{kind}\"/></shape></scene>")
    };
    let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    for name in ["lfs.png", "lfs.bin", "lfs.ply", "lfs.obj", "lfs.mtl", "lfs.usd", "lfs.serialized"] {
        folder.write(name, POINTER);
    }
    let scenes = [
        ("buffer.gltf", buffer.to_string(), "lfs.bin"),
        ("ply.xml", shape("ply"), "lfs.ply"),
        ("obj.xml", shape("obj"), "lfs.obj"),
        ("serialized.xml", shape("serialized"), "lfs.serialized"),
        ("mesh.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"lfs.ply\"\n".into(), "lfs.ply"),
        ("library.obj", format!("mtllib lfs.mtl\n{faces}"), "lfs.mtl"),
        ("layer.usda", "#usda 1.0\ndef \"A\" ( references = @lfs.usd@ ) { }\n".into(), "lfs.usd"),
    ];
    for (name, text, file) in scenes {
        let message = folder.write(name, text).error(name);
        assert!(message.starts_with(&format!("{file}: {expected}")), "{name}: {message}");
    }
    // A picture is a texture before it is a file: it may be missing.
    let message = folder.write("picture.gltf", textured.text()).error("picture.gltf");
    assert!(message.contains("needs the texture lfs.png, which is a Git LFS pointer"), "{message}");
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    assert!(warnings(&folder.load_with("picture.gltf", &options).unwrap()).contains("run `git lfs pull`"));
    let environment = EnvironmentOverride::from(EnvironmentSource::Picture(folder.path("lfs.png")));
    folder.write("plain.gltf", Gltf::triangle().text());
    let options = ImportOptions { environment: Some(environment), ..ImportOptions::default() };
    let message = folder.load_with("plain.gltf", &options).unwrap_err().to_string();
    assert!(message.contains("lfs.png: this is a Git LFS pointer"), "{message}");
}

#[test]
fn missing_and_short_buffers_name_the_file() {
    let (folder, g) = (Folder::new(), Gltf::triangle());
    let mut json = g.json.clone();
    json["buffers"] = json!([{"byteLength": 100, "uri": "room.bin"}]);
    let message = folder.write("a.gltf", json.to_string()).error("a.gltf");
    assert!(message.starts_with("room.bin: cannot be read") && message.contains("a.gltf refers to it"), "{message}");
    let message = folder.write("room.bin", [0; 50]).error("a.gltf");
    assert!(message.contains("buffers[0]: it should have 100 bytes, but only 50 are there"), "{message}");
}

#[test]
fn unreadable_files_and_unknown_formats_say_so() {
    let folder = Folder::new();
    assert!(folder.error("nowhere.gltf").contains("nowhere.gltf: cannot be read (No such file"));
    std::fs::create_dir(folder.path("folder.glb")).unwrap();
    assert!(folder.error("folder.glb").contains("folder.glb: cannot be read"));
    assert!(
        folder
            .write("a.blend", "BLENDER")
            .error("a.blend")
            .contains("no importer for .blend files: open it in Blender and export glTF 2.0 (.glb); expected one of .gltf")
    );
    assert!(folder.write("a.gltf", "{\"asset\": ").error("a.gltf").contains("a.gltf: line 1 column 10: not valid glTF JSON"));
    assert!(folder.write("a.gltf", "").error("a.gltf").contains("it is empty, not a glTF"));
    assert!(folder.write("a.scene", "x").error("a.scene").contains("not a scene package"));
}

#[test]
fn compressed_and_unknown_required_extensions_say_what_to_do() {
    let draco = gltf_error(|g| {
        let extension = json!({"KHR_draco_mesh_compression": {"bufferView": 9, "attributes": {}}});
        g.json["meshes"][0]["primitives"][0]["extensions"] = extension;
        g.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    });
    let expected = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: it refers to bufferView 9, which is not there";
    assert!(draco.contains(expected), "{draco}");
    let meshopt = gltf_error(|g| {
        g.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": {"buffer": 0}});
        g.json["bufferViews"][0]["buffer"] = json!(7);
    });
    assert!(meshopt.contains("bufferViews[0].extensions.EXT_meshopt_compression is malformed (missing field"), "{meshopt}");
    assert!(gltf_error(|g| g.json["extensionsRequired"] = json!(["ACME_x"])).contains("requires ACME_x"));
    assert!(gltf_error(|g| g.json["asset"]["version"] = json!("1.0")).contains("found glTF version \"1.0\", expected 2.0"));
}

#[test]
fn deep_and_cyclic_node_trees_do_not_overflow_the_stack() {
    let (folder, mut g) = (Folder::new(), Gltf::triangle());
    let depth = 100_000;
    let mut nodes: Vec<_> = (1..depth).map(|i| json!({"children": [i]})).collect();
    nodes.push(json!({"name": "Bottom", "mesh": 0}));
    g.json["nodes"] = json!(nodes);
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene.parts[0].name, "Bottom");
    g.json["nodes"] = json!([{"name": "A", "mesh": 0, "children": [1]}, {"children": [0, 1]}]);
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene.parts.len(), 1);
    assert!(warnings(&imported).contains("reached twice"));
}

#[test]
fn flattened_parts_are_left_out_with_a_warning() {
    let (folder, mut g) = (Folder::new(), Gltf::triangle());
    g.json["nodes"] = json!([{"name": "A", "mesh": 0}, {"name": "Flat", "mesh": 0, "scale": [1, 0, 1]}]);
    g.json["scenes"][0]["nodes"] = json!([0, 1]);
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene.parts.len(), 1);
    assert!(warnings(&imported).contains("part \"Flat\": its placement flattens it"), "{}", warnings(&imported));
}

#[test]
fn nonsensical_options_are_named() {
    let folder = Folder::new();
    folder.write("a.gltf", Gltf::triangle().text());
    for meters_per_unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = ImportOptions { meters_per_unit, ..ImportOptions::default() };
        let message = folder.load_with("a.gltf", &options).unwrap_err().to_string();
        assert!(message.contains("import option meters_per_unit: found"), "{message}");
    }
}

#[test]
fn xml_mistakes_have_line_and_column() {
    let folder = Folder::new();
    let error = |text: &str| folder.write("a.xml", text).error("a.xml");
    assert!(error("<scene>\n  <shape>\n</scene>").starts_with("a.xml: line 3:1: not well-formed XML"));
    assert!(error("<rooms/>").contains("XML of another program, with <rooms> around all, not a scene of Mitsuba"));
    assert!(
        error("<scene>\n <shape type=\"sphere\"><float name=\"radius\" value=\"one\"/></shape></scene>")
            .contains("a.xml line 2:23 <float name=\"radius\">: \"one\" in the attribute value is not a finite number")
    );
    assert!(error("<scene><shape type=\"sphere\"><ref id=\"Gold\"/></shape></scene>").contains("nothing in the scene has the id \"Gold\""));
    assert!(error("<scene><shape type=\"obj\"/></scene>").contains("the shape has no filename"));
    assert!(error("<scene><include filename=\"a.xml\"/></scene>").contains("nested more than"));
    assert!(
        error("<scene><shape type=\"obj\"><string name=\"filename\" value=\"gone.obj\"/></shape></scene>")
            .contains("needs the mesh gone.obj, which cannot be read")
    );
    assert!(error("").contains("it is empty"));
    let cycle = "<scene><bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf><bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>\
                 <shape type=\"sphere\"><ref id=\"a\"/></shape></scene>";
    assert!(error(cycle).contains("bsdfs go in a circle"));
    let deep = format!("<scene>{}{}</scene>", "<bsdf type=\"twosided\">".repeat(5000), "</bsdf>".repeat(5000));
    assert!(error(&deep).contains("nested more than"));
}

/// Texts with one byte changed or dropped.
fn mangled(text: &str) -> impl Iterator<Item = Vec<u8>> {
    let bytes = text.as_bytes();
    (0..bytes.len()).flat_map(move |at| {
        let (before, after) = (&bytes[..at], &bytes[at + 1..]);
        [&b"9"[..], b"-", b""].map(|with| [before, with, after].concat())
    })
}

#[test]
fn mangled_texts_never_panic() {
    let folder = Folder::new();
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng a\nusemtl b\nf 1/1/1 2//1 3 -1\n";
    let mtl = "newmtl b\nKd 1 0 0\nmap_Kd -s 1 1 1 x.png\nPr 0.5\nd 0.5\n";
    let xml = "<scene version=\"0.5.0\"><shape type=\"ply\"><string name=\"filename\" value=\"a.ply\"/><transform name=\"toWorld\">\
               <lookAt origin=\"0 0 1\" target=\"0 0 0\"/><rotate x=\"1\" angle=\"9\"/></transform></shape></scene>";
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    folder.write("a.obj", obj).write("a.mtl", mtl).write("a.xml", xml).write("a.ply", ply);
    assert!(folder.load("a.xml").is_ok());
    for (scene, file, text) in [("a.obj", "a.obj", obj), ("a.obj", "a.mtl", mtl), ("a.xml", "a.xml", xml), ("a.xml", "a.ply", ply)] {
        for bytes in mangled(text) {
            drop(folder.write(file, bytes).load(scene));
        }
        folder.write(file, text);
    }
}

#[test]
fn obj_mistakes_have_a_line() {
    let folder = Folder::new();
    assert_eq!(
        folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").error("a.obj"),
        "a.obj: line 4: the face refers to vertex 9, but there are only 3; export the file again"
    );
    assert!(folder.write("a.obj", "v 0 0 0\n").error("a.obj").contains("no visible parts"));
    assert!(folder.write("a.obj", b"\xff\xfe\x00\x01").error("a.obj").contains("no visible parts"));
}

#[test]
fn meshes_that_are_not_there_end_the_import_unless_that_is_allowed() {
    let folder = Folder::new();
    folder.write("cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    let here = "<shape type=\"rectangle\"/>";
    let xml = |shapes: &str| format!("<scene version=\"0.6.0\">{here}{shapes}</scene>");
    let of = |kind: &str, file: &str| format!("<shape type=\"{kind}\"><string name=\"filename\" value=\"{file}\"/></shape>");
    let gone = ["obj", "ply", "serialized"].map(|kind| of(kind, &format!("gone.{kind}")));
    let pbrt = |file: &str| format!("WorldBegin\nShape \"sphere\"\nShape \"plymesh\" \"string filename\" \"{file}\"\n");
    folder.write("a.xml", xml(&gone[0])).write("b.xml", xml(&gone[1])).write("c.xml", xml(&gone[2])).write("a.pbrt", pbrt("gone.ply"));
    folder.write("d.xml", xml(&of("ply", "cut.ply"))).write("b.pbrt", pbrt("cut.ply"));
    let options = ImportOptions { allow_missing_meshes: true, ..ImportOptions::default() };
    for name in ["a.xml", "b.xml", "c.xml", "a.pbrt", "d.xml", "b.pbrt"] {
        let error = folder.error(name);
        let says = if error.contains("cut.ply") { "the header does not end" } else { "or go on without it: --allow-missing-meshes" };
        assert!(error.contains(says), "{error}");
        let imported = folder.load_with(name, &options).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(imported.report.counts.parts, 1, "{name}");
        assert!(warnings(&imported).contains("; it was left out"), "{}", warnings(&imported));
    }
    // All shapes missing leaves nothing to see.
    folder.write("e.xml", xml(&gone[0]).replace(here, ""));
    assert!(folder.load_with("e.xml", &options).is_err());
}

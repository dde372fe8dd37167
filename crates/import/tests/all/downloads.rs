//! Scenes as people download them: in ZIP archives and in folders.

use crate::common::{Folder, Gltf, png, warnings};
use enfilade_import::{ImportOptions, Imported, scene_in_folder};
use serde_json::json;
use std::io::{Cursor, Write};
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, ZipWriter};

/// Names and bytes of the files of an archive.
type Files<'f> = &'f [(&'f str, &'f [u8])];

fn zip(files: Files<'_>) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        zip.start_file(*name, SimpleFileOptions::default().compression_method(CompressionMethod::Deflated)).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// A triangle whose material has the picture `uri`.
fn gltf(uri: &str) -> String {
    let mut g = Gltf::triangle();
    g.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
    g.json["textures"] = json!([{"source": 0}]);
    g.json["images"] = json!([{"uri": uri}]);
    g.text()
}

const OBJ: &[u8] = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
const MTL: &[u8] = b"newmtl m\nmap_Kd C:\\Users\\me\\wood.png\n";

fn load(bytes: &[u8]) -> Imported {
    Folder::new().write("pack.zip", bytes).load("pack.zip").unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn archives_of_every_shape_hold_the_scene_and_its_pictures() {
    let (picture, text) = (png(1, 1, [9, 9, 9, 255]), gltf("textures/wood.png"));
    let glb = Gltf::triangle().binary();
    let inner = zip(&[("model/a.obj", OBJ), ("model/a.mtl", MTL)]);
    let stl = b"solid s\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    let pbrt = b"WorldBegin\nInclude \"parts/geometry.pbrt\"\n";
    let shape = b"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n";
    let urdf = br#"<robot name="r"><link name="l"><visual><geometry><mesh filename="meshes/a.stl"/></geometry></visual></link></robot>"#;
    let usda = b"#usda 1.0\ndef \"A\" (references = @./parts/b.usda@</B>) {}\n";
    let layer = b"#usda 1.0\ndef Mesh \"B\" { point3f[] points = [(0,0,0),(1,0,0),(0,1,0)] int[] faceVertexCounts = [3] int[] faceVertexIndices = [0,1,2] }\n";
    let cases: [(&str, usize, Files<'_>); 9] = [
        ("gltf", 1, &[("scene.gltf", text.as_bytes()), ("textures/wood.png", &picture), ("license.txt", b"CC")]),
        (
            "gltf",
            1,
            &[
                ("pack/", b""),
                ("pack/scene.gltf", text.as_bytes()),
                ("pack\\textures\\wood.png", &picture),
                ("__MACOSX/pack/._scene.gltf", b"x"),
            ],
        ),
        ("gltf", 0, &[("Chair.glb", &glb), ("Chair.blend", b"BLENDER")]),
        ("obj", 1, &[("source/a.obj", OBJ), ("source/a.mtl", MTL), ("textures/wood.png", &picture)]),
        ("obj", 1, &[("source/model.zip", &inner), ("textures/wood.png", &picture)]),
        ("pbrt", 0, &[("room/scene.pbrt", pbrt), ("room/parts/geometry.pbrt", shape)]),
        ("urdf", 0, &[("r/robot.urdf", urdf), ("r/meshes/a.stl", stl)]),
        ("stl", 0, &[("part.STL", stl)]),
        ("usd", 0, &[("a.usda", usda), ("parts/b.usda", layer)]),
    ];
    for (format, pictures, files) in cases {
        let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
        let imported = load(&zip(files));
        assert_eq!(
            (imported.report.format, imported.report.counts.triangles, imported.report.counts.images),
            (format, 1, pictures),
            "{names:?}"
        );
        assert_eq!(imported.inputs.len(), 1, "{names:?}: {:?}", imported.inputs);
        assert!(!warnings(&imported).contains("was read, not"), "{names:?}: nothing was left out: {}", warnings(&imported));
    }
}

#[test]
fn what_was_chosen_among_several_is_told_and_what_cannot_be_chosen_refused() {
    let glb = Gltf::triangle().binary();
    let imported = load(&zip(&[("sofa.glb", &glb), ("sofa.obj", OBJ), ("parts/leg.glb", &glb)]));
    assert!(warnings(&imported).contains("of 3 scene files sofa.glb was read, not sofa.obj, parts/leg.glb"), "{}", warnings(&imported));
    let folder = Folder::new();
    let error = folder.write("pack.zip", zip(&[("a.glb", &glb), ("b.glb", &glb)])).error("pack.zip");
    assert!(error.contains("found 2 scene files (a.glb, b.glb); unpack it and give the scene file"), "{error}");
    let error = folder.write("unpacked/source/sofa.zip", OBJ).write("unpacked/textures/a.png", b"").error("unpacked");
    assert!(error.contains("found no scene file but source/sofa.zip: give it, or unpack it there"), "{error}");
    let error = folder.write("pack.zip", zip(&[("a.blend", b"BLENDER"), ("textures/a.png", b"")])).error("pack.zip");
    assert!(error.contains("found a.blend") && error.contains("export glTF"), "{error}");
    assert!(folder.write("pack.zip", b"PK\x03\x04cut").error("pack.zip").contains("not an archive that can be read"));
    // A picture that is not in the archive is looked for nowhere else.
    folder.write("wood.png", png(1, 1, [9, 9, 9, 255])).write("pack.zip", zip(&[("scene.gltf", gltf("../wood.png").as_bytes())]));
    assert!(folder.error("pack.zip").contains("needs the texture"));
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    assert!(folder.load_with("pack.zip", &options).is_ok());
}

#[test]
fn scenes_of_one_name_in_several_folders_are_told_wherever_one_was_left_out() {
    let glb = Gltf::triangle().binary();
    let said = "of 2 scene files b/room.glb was read, not a/room.obj";
    let files: Files<'_> = &[("a/room.obj", OBJ), ("b/room.glb", &glb)];
    let imported = load(&zip(files));
    assert!(imported.report.format == "gltf" && warnings(&imported).contains(said), "{}", warnings(&imported));
    let folder = Folder::new();
    for (name, bytes) in files {
        folder.write(&format!("pack/{name}"), bytes);
    }
    let imported = folder.load("pack").unwrap();
    assert!(warnings(&imported).contains(said), "{}", warnings(&imported));
    // Meshes are parts of a scene that is put together of them, except for those that are the scene in another format.
    let mesh = b"<scene version=\"3.0.0\"><shape type=\"obj\"><string name=\"filename\" value=\"../parts/a.obj\"/></shape></scene>";
    let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let parts: Files<'_> = &[("s/room.xml", mesh), ("parts/a.obj", triangle), ("parts/b.obj", triangle), ("other/room.ply", b"ply\n")];
    let said = "of 2 scene files s/room.xml was read, not other/room.ply";
    assert!(warnings(&load(&zip(parts))).contains(said), "{}", warnings(&load(&zip(parts))));
    for (name, bytes) in parts {
        folder.write(&format!("parts/{name}"), bytes);
    }
    assert!(warnings(&folder.load("parts").unwrap()).contains(said));
    // Layers of the scene are no other scenes.
    folder.write("usd/usd.usda", "#usda 1.0\ndef \"A\" (references = @./b.usda@</B>) {}\n");
    folder.write("usd/b.usda", "#usda 1.0\ndef Cube \"B\" { }\n").write("usd/c.usda", "#usda 1.0\ndef Cube \"C\" { }\n");
    let imported = folder.load("usd").unwrap();
    assert!(warnings(&imported).contains("of 2 scene files usd.usda was read, not c.usda"), "{}", warnings(&imported));
}

#[test]
fn scenes_in_archives_and_folders_are_refused_as_they_are_alone() {
    let folder = Folder::new();
    folder.write("list/scene.gltf", "[1,2,3]").write("list.zip", zip(&[("scene.gltf", b"[1,2,3]")]));
    for name in ["list", "list.zip"] {
        let error = folder.error(name);
        assert!(error.contains("scene.gltf: whole file: it is a list in JSON, not a glTF"), "{error}");
    }
}

#[test]
fn scenes_of_other_programs_are_named_with_what_to_export() {
    let blend: Files<'_> = &[("room/textures/a.png", b"x"), ("room/room.blend", b"BLENDER-v300"), ("__MACOSX/room/._b.blend", b"x")];
    let told = "found room/room.blend, which is not read: open it in Blender and export glTF 2.0 (.glb), and give what you exported";
    let folder = Folder::new();
    let message = folder.write("pack.zip", zip(blend)).error("pack.zip");
    assert!(message.contains("pack.zip: archive: ") && message.contains(told), "{message}");
    for (name, bytes) in blend {
        folder.write(&format!("unpacked/{name}"), bytes);
    }
    let message = folder.error("unpacked");
    assert!(message.contains("unpacked: folder: ") && message.contains(told), "{message}");
    let message = folder.write("max.zip", zip(&[("Scene.MAX", b"x")])).error("max.zip");
    assert!(message.contains("found Scene.MAX, which is not read: open it in 3ds Max and export FBX or USD"), "{message}");
    let message = folder.write("none.zip", zip(&[("a.png", b"x")])).error("none.zip");
    assert!(message.contains("found no scene file; expected one of .gltf"), "{message}");
}

#[test]
fn archives_that_unpack_to_more_than_they_may_are_refused() {
    // Nothing of it is unpacked before it is asked for: a picture of zeros is an error of that picture.
    let zeros = vec![0; 64 << 20];
    let bytes = zip(&[("scene.gltf", gltf("a.png").as_bytes()), ("a.png", &zeros), ("unused.bin", &zeros)]);
    assert!(bytes.len() < 1 << 20);
    assert!(Folder::new().write("pack.zip", bytes).error("pack.zip").contains("needs the texture"));
}

#[test]
fn folders_with_one_scene_file_are_scenes() {
    let folder = Folder::new();
    folder
        .write("chair/source/Chair.obj", OBJ)
        .write("chair/source/a.mtl", MTL)
        .write("chair/textures/wood.png", png(1, 1, [9, 9, 9, 255]));
    let imported = folder.load("chair").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((imported.report.format, imported.report.counts.images), ("obj", 1));
    assert_eq!(scene_in_folder(&folder.path("chair")).unwrap(), Some(folder.path("chair/source/Chair.obj")));
    folder.write("two/a.glb", Gltf::triangle().binary()).write("two/b.glb", Gltf::triangle().binary());
    assert!(folder.error("two").contains("found 2 scene files (a.glb, b.glb); give one of them"));
    folder.write("none/a.txt", "");
    let error = folder.error("none");
    assert!(error.contains("found no scene in the folder; expected one scene file (.gltf, .glb"), "{error}");
    assert_eq!(scene_in_folder(&folder.path("none")).unwrap(), None);
}

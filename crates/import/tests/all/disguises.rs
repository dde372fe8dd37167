//! Files that do not match their names, and statements that other programs accept.

use crate::common::{Folder, Gltf, warnings};
use enfilade_import::ImportOptions;

const PAGE: &str = "<!DOCTYPE html>\n<html><head><title>404\n Not Found</title></head></html>";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n";

#[test]
fn a_web_page_in_the_place_of_any_scene_is_named_with_its_title() {
    let folder = Folder::new();
    for end in ["glb", "gltf", "obj", "xml", "pbrt", "ply", "usda", "usdz", "fbx", "vrscene", "json", "sh3d", "scene"] {
        let message = folder.write(&format!("a.{end}"), PAGE).error(&format!("a.{end}"));
        assert!(
            message.contains("it is a web page (\"404 Not Found\")") && message.contains("download or copy the file again"),
            "{message}"
        );
    }
}

#[test]
fn scenes_pictures_and_archives_under_wrong_names_are_named() {
    let folder = Folder::new();
    let glb = Gltf::triangle().binary();
    for end in ["obj", "xml", "ply", "usda", "fbx", "pbrt"] {
        let message = folder.write(&format!("a.{end}"), &glb).error(&format!("a.{end}"));
        assert!(message.contains("it is a binary glTF, not") && message.contains("let its name end with .glb"), "{message}");
    }
    // It is read under the other name of its own format.
    folder.write("a.gltf", &glb).load("a.gltf").unwrap();
    for (name, bytes, expected) in [
        ("a.obj", &b""[..], "it is empty, not an OBJ"),
        ("a.glb", &[0; 64], "it is nothing but zeros"),
        ("a.obj", b"\x89PNG\r\n\x1a\n", "it is a PNG picture, not an OBJ"),
        ("a.obj", b"\x1f\x8b\x08\0", "it is packed by gzip, not an OBJ; unpack it"),
        ("a.json", b"[{\"id\": 1}]", "it is a list in JSON, not a scene of a collection"),
        ("a.gltf", b"[1,2,3]", "it is a list in JSON, not a glTF; give the scene file that belongs to it"),
        ("a.glb", b"\xef\xbb\xbf[ -1.5 ]", "it is a list in JSON, not a glTF"),
        ("a.json", b"[1, 2]", "it is a list in JSON, not a scene of a collection"),
        ("a.json", b"3", "it is a single value (3), not a scene of a collection; give the scene file that belongs to it"),
        ("a.json", b" null\n", "it is a single value (null), not a scene of a collection"),
        ("a.gltf", b"\"scene\"", "it is a single value (\"scene\"), not a glTF"),
        ("a.usdz", b"#usda 1.0\n", "it is USD as text, not an archive (usdz); if it is the scene, let its name end with .usda"),
        ("a.USDZ", b"PXR-USDC\0", "it is binary USD, not an archive (usdz); if it is the scene, let its name end with .usdc"),
        ("a.gltf", b"{\"metadata\": {\"type\": \"Object\"}, \"geometries\": []}", "it has no \"asset\", so it is JSON of another program"),
        (
            "a.urdf",
            b"<mujoco model=\"kitchen\"><worldbody/></mujoco>",
            "it is a model of MuJoCo, not a robot in URDF; if it is the scene, let its name end with .mjcf",
        ),
        ("a.xml", b"<?xml version='1.0'?><Error><Code>AccessDenied</Code></Error>", "it is the error message of a server"),
        ("a.xml", b"<scene><camera type=\"perspective\"/><mesh type=\"obj\"/></scene>", "it is a scene of Nori, not a scene of Mitsuba"),
    ] {
        let message = folder.write(name, bytes).error(name);
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn a_web_page_in_the_place_of_a_picture_or_a_library_is_named() {
    let folder = Folder::new();
    folder.write("wood.png", PAGE).write("a.mtl", "newmtl m\nmap_Kd wood.png\n").write("page.mtl", PAGE);
    let message = folder.write("a.obj", format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}")).error("a.obj");
    assert!(message.contains("which is a web page (\"404 Not Found\"), not a picture; download or copy the picture again"), "{message}");
    let imported = folder.write("b.obj", format!("mtllib page.mtl\nusemtl m\n{TRIANGLE}")).load("b.obj").unwrap();
    let said = warnings(&imported);
    assert!(said.contains("page.mtl is a web page (\"404 Not Found\"); grey stands in for its materials"), "{said}");
}

#[test]
fn a_parameter_that_nothing_defines_is_named() {
    let folder = Folder::new();
    let scene = |more: &str| {
        format!(
            "<scene version=\"3.0.0\">{more}<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"$size\"/></transform></shape></scene>"
        )
    };
    let message = folder.write("a.xml", scene("")).error("a.xml");
    assert!(message.contains("the parameter $size, which nothing before it defines; add <default name=\"size\""), "{message}");
    folder.write("a.xml", scene("<default name=\"size\" value=\"2\"/>")).load("a.xml").unwrap();
}

#[test]
fn comments_among_the_rows_of_a_ply_file_are_passed_over() {
    let folder = Folder::new();
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                  property list uchar int vertex_indices\nend_header\n";
    let rows = "comment the vertices\n0 0 0\ncomment\n1 0 0\n1 1 0\ncomment 3 0 0 0\n3 0 1 2\ncomment the end\n";
    let imported = folder.write("a.ply", format!("{header}{rows}")).load("a.ply").unwrap();
    let corners = imported.scene.world_corners(&imported.scene.parts[0], 0).map(|p| p.to_array());
    assert_eq!(corners, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]);
    assert!(!warnings(&imported).contains("follow the last row"), "{}", warnings(&imported));
}

#[test]
fn a_missing_picture_of_the_surroundings_is_not_said_to_be_grey() {
    let folder = Folder::new();
    let cube = "<shape type=\"cube\"/><emitter type=\"envmap\"><string name=\"filename\" value=\"sky.exr\"/></emitter>";
    folder.write("a.xml", format!("<scene version=\"3.0.0\">{cube}</scene>"));
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    let imported = folder.load_with("a.xml", &options).unwrap();
    assert!(imported.scene.environment.is_none());
    assert!(warnings(&imported).contains("sky.exr cannot be read") && warnings(&imported).contains("the light is left out"));
}

#[test]
fn an_interrupted_archive_is_one_and_not_another_thing() {
    let folder = Folder::new();
    let message = folder.write("a.zip", b"PK\x05\x06\0\0").error("a.zip");
    assert!(message.contains("it is an empty ZIP archive; download or copy the file again"), "{message}");
}

#[test]
fn options_behind_the_name_of_a_picture_are_read_as_three_js_does() {
    let folder = Folder::new();
    folder.write("a.mtl", "newmtl m\nmap_Kd wood.png -s 2 3 1\n").write("a.obj", format!("mtllib a.mtl\nusemtl m\n{TRIANGLE}"));
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    let imported = folder.load_with("a.obj", &options).unwrap();
    assert!(warnings(&imported).contains("wood.png cannot be read"), "{}", warnings(&imported));
}

#[test]
fn a_hundred_materials_with_one_fault_are_one_warning() {
    let folder = Folder::new();
    let materials: String = (0..100).map(|i| format!("newmtl m{i}\nKd 1 1 1\nmap_Ns gloss.png\n")).collect();
    let faces: String = (0..100).map(|i| format!("usemtl m{i}\nf 1 2 3\n")).collect();
    let imported = folder
        .write("a.mtl", materials)
        .write("a.obj", format!("mtllib a.mtl\n{}{faces}", TRIANGLE.replace("f 1 2 3\n", "")))
        .load("a.obj");
    let said = warnings(&imported.unwrap());
    assert_eq!(said.matches("map_ns ignored").count(), 1, "{said}");
    assert!(said.contains("material \"m0\", material \"m1\", material \"m2\" and 97 more"), "{said}");
}

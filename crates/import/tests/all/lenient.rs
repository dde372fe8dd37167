//! Deviations that other readers accept as well: byte order marks, other encodings, whole numbers with a point, paddings, decimal commas.

use crate::common::{Folder, Gltf, png, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::Vec3;
use enfilade_scene::{Bsdf, ColorParam};
use serde_json::{Value, json};

/// The corners of the first triangle.
fn corners(imported: &Imported) -> [Vec3; 3] {
    imported.scene.world_corners(&imported.scene.parts[0], 0)
}

/// A text as it is, with a byte order mark, and in both orders of UTF-16.
fn encodings(text: &str) -> [Vec<u8>; 4] {
    let utf16 = |order: fn(u16) -> [u8; 2]| format!("\u{feff}{text}").encode_utf16().flat_map(order).collect::<Vec<u8>>();
    [text.into(), format!("\u{feff}{text}").into(), utf16(u16::to_le_bytes), utf16(u16::to_be_bytes)]
}

const MITSUBA: &str = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<scene version=\"3.0.0\"><shape type=\"rectangle\" id=\"Tür\"/></scene>";
const PBRT: &str = "WorldBegin\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n";
const USDA: &str = "#usda 1.0\ndef Mesh \"Tuer\" {\n  point3f[] points = [(0,0,0),(1,0,0),(0,1,0)]\n  int[] faceVertexCounts = [3]\n  \
                    int[] faceVertexIndices = [0,1,2]\n}\n";
const OBJ: &str = "mtllib a.mtl\no Tür\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl rot\nf 1 2 3\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3.0\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                   property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3.0 0.0 1.0 2.0\n";

#[test]
fn text_is_read_with_or_without_a_mark_and_in_utf_16() {
    let gltf = Gltf::triangle().text();
    let mtl = "newmtl rot\nKd 1 0 0\n";
    for (name, text) in [("a.xml", MITSUBA), ("a.pbrt", PBRT), ("a.usda", USDA), ("a.obj", OBJ), ("a.gltf", &gltf)] {
        let folder = Folder::new();
        folder.write("a.mtl", mtl);
        let plain = folder.write(name, text).load(name).unwrap();
        for (i, bytes) in encodings(text).into_iter().enumerate() {
            if name == "a.obj" {
                folder.write("a.mtl", &encodings(mtl)[i]);
            }
            let imported = folder.write(name, bytes).load(name).unwrap_or_else(|e| panic!("{name} {i}: {e}"));
            assert_eq!((&imported.scene, imported.report.warnings.len()), (&plain.scene, plain.report.warnings.len()), "{name} {i}");
        }
    }
    let folder = Folder::new();
    let plain = folder.write("a.ply", PLY).load("a.ply").unwrap();
    assert_eq!(folder.write("a.ply", format!("\u{feff}{PLY}")).load("a.ply").unwrap().scene, plain.scene);
}

#[test]
fn western_code_pages_are_read_where_the_text_is_no_utf_8() {
    let folder = Folder::new();
    let latin = |text: &str| text.chars().map(|c| c as u8).collect::<Vec<u8>>();
    folder
        .write("a.mtl", "newmtl rot\nKd 1 0 0\n")
        .write("a.obj", latin(OBJ))
        .write("a.xml", latin(&MITSUBA.replace("utf-8", "ISO-8859-1")));
    for name in ["a.obj", "a.xml"] {
        assert_eq!(folder.load(name).unwrap().scene.parts[0].name, "Tür", "{name}");
    }
}

/// Every whole number of a document as a float, as Lua, JavaScript through other languages, and pandas write it.
fn as_floats(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_u64() => *value = json!(number.as_f64()),
        Value::Array(list) => list.iter_mut().for_each(as_floats),
        Value::Object(table) => table.values_mut().for_each(as_floats),
        _ => (),
    }
}

#[test]
fn gltf_takes_counts_and_indices_with_a_point() {
    let folder = Folder::new();
    let g = Gltf::triangle();
    let plain = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    let mut json: Value = serde_json::from_str(&g.text()).unwrap();
    as_floats(&mut json);
    assert!(json.to_string().contains("\"count\":3.0"));
    assert_eq!(folder.write("b.gltf", json.to_string()).load("b.gltf").unwrap().scene, plain.scene);
    json["asset"]["version"] = json!(2.0);
    json["nodes"][0]["name"] = json!(12);
    json["materials"][0]["normalTexture"] = Value::Null;
    json["meshes"][0]["primitives"][0]["targets"] = Value::Null;
    json["scenes"][0]["name"] = Value::Null;
    assert_eq!(folder.write("c.gltf", json.to_string()).load("c.gltf").unwrap().scene.parts[0].name, "12");
    // As Python's json module writes bounds of no numbers.
    json["accessors"][0]["min"] = json!(["§", 0, 0]);
    json["nodes"][0]["name"] = json!("NaN \\\" NaN");
    let text = json.to_string().replace("\"§\"", "NaN");
    assert_eq!(folder.write("n.gltf", text).load("n.gltf").unwrap().scene.parts[0].name, "NaN \\\" NaN");
    // Text in place of numbers, and colours with or without alpha: the same scene as with numbers and with four channels.
    json["nodes"][0]["translation"] = json!(["1", "2.5", "-3"]);
    json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.25, "0.5", 1.0]);
    json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!("0.75");
    json["materials"][0]["doubleSided"] = json!("true");
    json["materials"][0]["name"] = json!("7");
    json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": "10", "color": [1, 1, 0.5, 1]}]}});
    let texts = folder.write("t.gltf", json.to_string()).load("t.gltf").unwrap_or_else(|e| panic!("{e}"));
    json["nodes"][0]["translation"] = json!([1, 2.5, -3]);
    json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.25, 0.5, 1, 1]);
    json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.75);
    json["materials"][0]["doubleSided"] = json!(true);
    json["extensions"]["KHR_lights_punctual"]["lights"][0] = json!({"type": "point", "intensity": 10, "color": [1, 1, 0.5]});
    assert_eq!(texts.scene, folder.write("u.gltf", json.to_string()).load("u.gltf").unwrap().scene);
    json["accessors"][0]["count"] = json!(2.5);
    let error = folder.write("d.gltf", json.to_string()).error("d.gltf");
    assert!(error.contains("not valid glTF JSON") && error.contains("2.5"), "{error}");
}

#[test]
fn gltf_takes_paddings_that_are_counted_and_not_written_and_zeros_behind_the_text() {
    let folder = Folder::new();
    let g = Gltf::triangle();
    let plain = folder.write("a.gltf", g.text()).load("a.gltf").unwrap().scene;
    assert_eq!(folder.write("b.gltf", format!("{}\n\0\0", g.text())).load("b.gltf").unwrap().scene, plain);
    // Six bytes of indices end the buffer: two more are counted.
    let mut json: Value = serde_json::from_str(&g.text()).unwrap();
    let length = json["buffers"][0]["byteLength"].as_u64().unwrap();
    json["buffers"][0]["byteLength"] = json!(length.next_multiple_of(4));
    json["bufferViews"][2]["byteLength"] = json!(8);
    assert!(!length.is_multiple_of(4));
    assert_eq!(folder.write("c.gltf", json.to_string()).load("c.gltf").unwrap().scene, plain);
    json["buffers"][0]["byteLength"] = json!(length + 4);
    assert!(folder.write("d.gltf", json.to_string()).error("d.gltf").contains("cut short"));
    let mut binary = g.binary();
    while binary.last() == Some(&0) && binary.len() as u64 % 4 != length % 4 {
        binary.pop();
    }
    assert_eq!(folder.write("e.glb", &binary).load("e.glb").unwrap().scene.meshes, plain.meshes);
}

#[test]
fn gltf_goes_on_without_pictures_of_the_web_where_that_is_allowed() {
    let mut g = Gltf::triangle();
    g.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
    g.json["textures"] = json!([{"source": 0}]);
    for (image, problem) in [
        (json!({"uri": "https://example.org/a.png"}), "https addresses are not followed"),
        (json!({"bufferView": 99, "mimeType": "image/png"}), "refers to bufferView 99"),
    ] {
        g.json["images"] = json!([image]);
        let folder = Folder::new();
        let error = folder.write("a.gltf", g.text()).error("a.gltf");
        assert!(error.contains(problem) && error.contains("--allow-missing-textures"), "{error}");
        let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
        let told = warnings(&folder.load_with("a.gltf", &options).unwrap());
        assert!(told.contains(problem) && told.contains("a plain grey stands in"), "{told}");
    }
}

#[test]
fn gltf_goes_on_without_required_extensions_of_looks_and_metadata() {
    let mut g = Gltf::triangle();
    g.json["extensionsRequired"] = json!(["KHR_xmp_json_ld", "EXT_materials_made_up", "KHR_animation_pointer"]);
    g.json["extensionsUsed"] = g.json["extensionsRequired"].clone();
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    let told = warnings(&imported);
    for extension in ["KHR_xmp_json_ld", "EXT_materials_made_up", "KHR_animation_pointer"] {
        assert!(told.contains(&format!("{extension} is not supported and was ignored")), "{told}");
    }
}

#[test]
fn obj_takes_decimal_commas_floats_as_indices_and_any_case() {
    let folder = Folder::new();
    folder.write("a.mtl", "newmtl Rot\nKd 0,5 0,25 0\n");
    let text = "MTLLIB a.mtl\nV 0,0 0,0 0,0\nv 1,5 0 0\nV 0 1e0 0\nUSEMTL rot\nF 1.0 2.000e+00 3\n";
    let imported = folder.write("a.obj", text).load("a.obj").unwrap();
    assert_eq!(corners(&imported)[1], Vec3::new(1.5, 0.0, 0.0));
    let color = |imported: &Imported| match &imported.scene.materials[imported.scene.parts[0].material as usize].bsdf {
        Bsdf::Diffuse { reflectance } => *reflectance,
        other => panic!("{other:?}"),
    };
    assert_eq!(color(&imported), ColorParam::from(enfilade_math::Rgb::new(0.5, 0.25, 0.0)));
    assert!(warnings(&imported).contains("\"Rot\", which differs in case, was used"), "{}", warnings(&imported));
    // Without mtllib the library beside the file is meant.
    let imported = folder.write("a.obj", text.replace("MTLLIB a.mtl\n", "")).load("a.obj").unwrap();
    assert_eq!(color(&imported), ColorParam::from(enfilade_math::Rgb::new(0.5, 0.25, 0.0)));
    assert!(warnings(&imported).contains("the file names no material library; a.mtl"), "{}", warnings(&imported));
}

#[test]
fn mtl_takes_the_option_of_colour_spaces() {
    let folder = Folder::new();
    folder.write("wood.png", png(1, 1, [128, 128, 128, 255]));
    for (option, srgb) in [("sRGB", true), ("linear", false)] {
        folder.write("a.mtl", format!("newmtl rot\nmap_Kd -colorspace {option} wood.png\n"));
        let imported = folder.write("a.obj", OBJ).load("a.obj").unwrap();
        assert!(matches!(imported.scene.images[0].pixels, enfilade_scene::Pixels::Rgba8 { srgb: s, .. } if s == srgb), "{option}");
        assert!(!warnings(&imported).contains("colorspace"), "{}", warnings(&imported));
    }
}

#[test]
fn textures_of_mitsuba_and_pbrt_that_name_no_file_are_grey() {
    let folder = Folder::new();
    let bitmap =
        "<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"\"/></texture></bsdf>";
    folder.write("a.xml", MITSUBA.replace("id=\"Tür\"/>", &format!(">{bitmap}</shape>")));
    folder.write(
        "a.pbrt",
        format!("WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n{}", &PBRT[11..]),
    );
    for name in ["a.xml", "a.pbrt"] {
        let told = warnings(&folder.load(name).unwrap_or_else(|e| panic!("{e}")));
        assert!(told.contains("names no file; a mid grey stands in"), "{told}");
    }
}

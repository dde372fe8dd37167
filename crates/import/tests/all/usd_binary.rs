//! One scene as text, binary and archive, and against what Pixar's own library makes of it (`usd/make.py`); and damaged files.

use crate::common::{Folder, warnings};
use enfilade_import::{ImportOptions, Imported, load};
use enfilade_math::{DVec3, Rgb};
use enfilade_scene::{Bsdf, Quiet};
use serde_json::Value;
use std::path::{Path, PathBuf};

const COLOR: [u8; 4] = [200, 100, 50, 255];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/usd").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(fixture(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The text or binary fixture beside the picture that it names.
fn beside_its_picture(name: &str) -> Imported {
    let folder = Folder::new();
    folder.write("color.png", crate::common::png(2, 2, COLOR)).write(name, bytes(name)).load(name).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn text_binary_and_archive_give_the_same_scene() {
    let text = beside_its_picture("room.usda");
    let binary = beside_its_picture("room.usdc");
    assert_eq!(text.scene.parts, binary.scene.parts);
    assert_eq!(
        (&text.scene.meshes, &text.scene.materials, &text.scene.cameras),
        (&binary.scene.meshes, &binary.scene.materials, &binary.scene.cameras)
    );
    assert_eq!((&text.labels, warnings(&text).replace(".usda", "")), (&binary.labels, warnings(&binary).replace(".usdc", "")));
    let archive = load(&fixture("room.usdz"), &ImportOptions::default(), &Quiet).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((&archive.scene.parts, &archive.scene.meshes), (&binary.scene.parts, &binary.scene.meshes));
    assert_eq!((&archive.scene.materials, archive.scene.images.len()), (&binary.scene.materials, 1));
    assert_eq!(archive.scene.images[0].pixels, binary.scene.images[0].pixels);
    assert_eq!(archive.inputs, [fixture("room.usdz")]);
}

/// Some writers of archives leave out the flag for UTF-8.
#[test]
fn names_in_archives_are_utf8_with_and_without_the_flag() {
    use std::io::Write;
    let scene = r#"#usda 1.0
        def Cube "Box" { rel material:binding = </P> }
        def Material "P" { token outputs:surface.connect = </P/S.outputs:surface>
            def Shader "S" { uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor.connect = </P/T.outputs:rgb> }
            def Shader "T" { uniform token info:id = "UsdUVTexture"
                asset inputs:file = @tex/grün.png@ } }"#;
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in [("a.usda", scene.as_bytes()), ("tex/gruen.png", &crate::common::png(1, 1, COLOR)[..])] {
        let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        zip.start_file(name, stored).unwrap();
        zip.write_all(bytes).unwrap();
    }
    let mut bytes = zip.finish().unwrap().into_inner();
    let folder = Folder::new();
    let error = folder.write("a.usdz", &bytes).error("a.usdz");
    assert!(error.contains("a.usdz[tex/grün.png]") && error.contains("is not in the archive"), "{error}");
    // An ASCII name of the same length had no flag.
    let (plain, umlaut) = (b"tex/gruen.png", "tex/grün.png".as_bytes());
    while let Some(at) = bytes.windows(plain.len()).position(|w| w == plain) {
        bytes[at..at + plain.len()].copy_from_slice(umlaut);
    }
    let imported = folder.write("a.usdz", &bytes).load("a.usdz").unwrap();
    assert_eq!(imported.scene.images.len(), 1);
}

#[test]
fn points_colours_and_cameras_are_those_of_pixars_library() {
    let scene = beside_its_picture("room.usdc").scene;
    let expected: Value = serde_json::from_slice(&bytes("room.json")).unwrap();
    let vector = |v: &Value| DVec3::from_array(std::array::from_fn(|i| v[i].as_f64().unwrap()));
    for (name, points) in expected["meshes"].as_object().unwrap() {
        // A part for each subset: together they have the points.
        let mut found = 0;
        for part in scene.parts.iter().filter(|p| p.name == *name || p.name.starts_with(&format!("{name}."))) {
            found += 1;
            for p in &scene.meshes[part.mesh as usize].positions {
                let p = part.world_from_mesh.transform_point3(p.as_dvec3());
                let nearest = points.as_array().unwrap().iter().map(|e| vector(e).distance(p)).fold(f64::INFINITY, f64::min);
                assert!(nearest < 1e-6, "{name}: {p} is {nearest} m from every point expected");
            }
        }
        assert!(found > 0, "{name} is missing");
    }
    for (name, color) in expected["colors"].as_object().unwrap() {
        let part = scene.parts.iter().find(|p| p.name == *name).unwrap_or_else(|| panic!("no {name}"));
        let Bsdf::Principled(p) = &scene.materials[part.material as usize].bsdf else { panic!("{name} is not principled") };
        assert_eq!(p.base_color.factor, Rgb::from(vector(color).as_vec3().to_array()), "{name}");
    }
    let (camera, e) = (&scene.cameras[0], &expected["cameras"]["World/Camera"]);
    let ahead = (vector(&e["ahead"]) - vector(&e["position"])).normalize();
    assert!(camera.position.distance(vector(&e["position"])) < 1e-6 && (-camera.world_from_camera.z_axis).distance(ahead) < 1e-6);
    assert!((camera.fov_x_rad - e["fov_x"].as_f64().unwrap()).abs() < 1e-6 && (camera.aspect - e["aspect"].as_f64().unwrap()).abs() < 1e-6);
}

#[test]
fn instances_subsets_labels_and_lights_arrive() {
    let imported = beside_its_picture("room.usdc");
    let scene = &imported.scene;
    let part = |name: &str| scene.parts.iter().position(|p| p.name == name).unwrap_or_else(|| panic!("no {name}"));
    let (own, copy) = (&scene.parts[part("World/Proto/Grid")], &scene.parts[part("World/Copy/Grid")]);
    assert_eq!((own.mesh, own.material), (copy.mesh, copy.material));
    // The other variant has another material on the same mesh.
    let light = &scene.parts[part("World/Light/Grid")];
    assert_eq!(light.mesh, own.mesh);
    assert_ne!(light.material, own.material);
    assert_eq!(scene.meshes[own.mesh as usize].triangles.len(), 24);
    assert_eq!(scene.meshes[scene.parts[part("World/Proto/Grid.Edge")].mesh as usize].triangles.len(), 8);
    let labels = imported.labels.as_ref().unwrap();
    assert_eq!((labels.len(), labels[0].label.semantic), (6, 5));
    // The second pot is half-way to the third.
    let pots: Vec<DVec3> = (0..3).map(|i| scene.parts[part(&format!("Pots[{i}]/World/Pots/Pot"))].world_from_mesh.translation).collect();
    assert!((pots[0] + pots[2]).distance(2.0 * pots[1]) < 1e-9 && pots[2] == DVec3::X);
    // 4 · 2² over 200 × 50 square units, downward.
    let panel = &scene.parts[part("World/Panel")];
    let radiance = scene.materials[panel.material as usize].emission.factor;
    assert!((radiance.g - 16.0 / 10_000.0).abs() < 1e-8, "{radiance:?}");
    let [a, b, c] = scene.world_corners(panel, 0);
    assert!((b - a).cross(c - a).z < 0.0);
    assert!(warnings(&imported).contains("1 things move by them"));
}

/// Bytes cut off and flipped at every place: an error or a scene, never a panic.
#[test]
fn damaged_files_end_in_errors() {
    let folder = Folder::new();
    folder.write("color.png", crate::common::png(2, 2, COLOR));
    for name in ["room.usdc", "room.usda", "room.usdz"] {
        let whole = bytes(name);
        let mut noise = enfilade_math::Rng::new(7);
        let mut errors = 0;
        for round in 0..600 {
            let mut damaged = whole.clone();
            let place = noise.next_u64() as usize % whole.len();
            if round % 3 == 0 {
                damaged.truncate(place);
            } else {
                (0..1 + round % 4).for_each(|i| damaged[(place + i) % whole.len()] = noise.next_u64() as u8);
            }
            errors += usize::from(folder.write(name, &damaged).load(name).is_err());
        }
        assert!(errors > 150, "{name}: only {errors} of 600 damaged files were refused");
    }
}

#[test]
fn errors_name_the_file_and_the_place() {
    let folder = Folder::new();
    let whole = bytes("room.usdc");
    for (name, content, expected) in [
        ("a.usd", &b"hello"[..], "a.usd: byte 0: found neither `#usda` nor `PXR-USDC`"),
        ("b.usdc", &whole[..40], "b.usdc: byte"),
        ("c.usdz", &b"PK"[..], "c.usdz: the archive: it is no zip archive"),
        ("d.usda", &b"#usda 1.0\ndef Mesh \"M\" {\n  int x = }\n"[..], "d.usda: line 3: found `}`, expected a value"),
    ] {
        let error = folder.write(name, content).error(name);
        assert!(error.contains(expected), "{error}\nexpected {expected}");
    }
    let mut old = whole.clone();
    old[8..11].copy_from_slice(&[0, 3, 0]);
    assert!(folder.write("e.usdc", &old).error("e.usdc").contains("byte 8: found version 0.3.0 of usdc, expected 0.4 to 0.13"));
}

/// Written tables of paths contain an empty path that the tree leaves out, and empty tables contain not even a first number.
#[test]
fn references_without_a_prim_and_empty_layers_are_read() {
    let folder = Folder::new();
    folder.write("box.usda", "#usda 1.0\n( defaultPrim = \"Box\" )\ndef Cube \"Box\" { }");
    folder.write("empty.usdc", bytes("empty.usdc")).write("reference.usdc", bytes("reference.usdc"));
    let imported = folder.load("reference.usdc").unwrap();
    assert_eq!(imported.scene.parts[0].name, "A");
    assert!(imported.report.warnings.is_empty(), "{}", warnings(&imported));
}

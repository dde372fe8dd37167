//! Processing of a scene file before the stages: light for dark ones, doubled faces, and remarks about the geometry.

use enfilade_pipeline::{EnvironmentOverride, FileSource, Lamps, check_file, import_file};
use enfilade_scene::{Heard, Light, Quiet, Scene, from_bytes, to_bytes};
use std::path::Path;

/// A closed room of 4 m x 3 m x 2.5 m with z up, whose faces look inward, times `scale`.
fn room(scale: f64) -> String {
    let mut text = String::from("o room\n");
    for i in 0..8 {
        let at = |bit: u32, far: f64| if i >> bit & 1 == 1 { scale * far } else { 0.0 };
        text += &format!("v {} {} {}\n", at(0, 4.0), at(1, 3.0), at(2, 2.5));
    }
    text + &faces([[1, 3, 7, 5], [2, 6, 8, 4], [1, 5, 6, 2], [3, 4, 8, 7], [1, 2, 4, 3], [5, 7, 8, 6]])
}

fn faces<const N: usize>(corners: [[u32; 4]; N]) -> String {
    corners.iter().map(|face| format!("f {}\n", face.map(|i| i.to_string()).join(" "))).collect()
}

fn source(folder: &Path, text: &str) -> FileSource {
    let file = folder.join("room.obj");
    std::fs::write(&file, text).unwrap();
    FileSource { up_axis: Some(enfilade_pipeline::UpAxis::Z), ..FileSource::of(file.to_string_lossy()) }
}

/// The warnings from checking a file.
fn told(source: &FileSource) -> String {
    let heard = Heard::default();
    let checked = check_file(source, &heard).unwrap();
    let messages: Vec<String> = checked.warnings.iter().map(ToString::to_string).collect();
    messages.join("\n")
}

fn imported(folder: &Path, source: &FileSource) -> (Scene, serde_json::Value) {
    let output = folder.join("room.scene");
    let made = import_file(source, &output, |scene, _, _| Ok(to_bytes(scene).into()), &Quiet).unwrap();
    let report = serde_json::from_slice(&std::fs::read(made.report).unwrap()).unwrap();
    (from_bytes(&std::fs::read(output).unwrap()).unwrap(), report)
}

#[test]
fn a_dark_room_is_told_and_lit_by_lamps_or_a_sky_that_need_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let dark = source(folder.path(), &room(1.0));
    let text = told(&dark);
    assert!(
        text.contains("nothing in it shines") && text.contains("environment = \"sky\"") && text.contains("lamps = \"ceiling\""),
        "{text}"
    );

    let lamps = FileSource { lamps: Some(Lamps::Ceiling), ..dark.clone() };
    let (scene, report) = imported(folder.path(), &lamps);
    let names: Vec<&str> = scene.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["room", "ceiling_lamp_1", "ceiling_lamp_1_frame"]);
    let panel = scene.world_corners(&scene.parts[1], 0)[0];
    assert!((panel.x - 2.0).abs() < 0.5 && (panel.y - 1.5).abs() < 0.5 && (2.4..2.5).contains(&panel.z), "{panel}");
    // A quarter of a kilo-lumen for each of the 12 m², from a Lambert emitter of 0.52 m × 0.52 m.
    let radiance = scene.materials[scene.parts[1].material as usize].emission.factor.luminance();
    assert!((f64::from(radiance) * std::f64::consts::PI * 0.52 * 0.52 - 3.0).abs() < 0.1, "{radiance}");
    let warnings = report["import"]["warnings"].to_string();
    assert!(warnings.contains("1 lamp of 0.60 m") && !warnings.contains("nothing in it shines"), "{warnings}");
    assert_eq!(report["import"]["counts"]["emissive_materials"], 1);

    let sky = FileSource { environment: Some(EnvironmentOverride::named("sky")), ..dark.clone() };
    let (scene, _) = imported(folder.path(), &sky);
    assert!(matches!(scene.lights[..], [Light::Directional { .. }]) && scene.environment.is_some());
    let overcast = FileSource { environment: Some(EnvironmentOverride::named("overcast")), ..dark };
    let (scene, _) = imported(folder.path(), &overcast);
    assert!(scene.lights.is_empty() && scene.environment.is_some());
}

#[test]
fn doubled_faces_are_told_and_go_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    // The floor once more as a part of its own, and the wall at x = 0 within the room, from the other side.
    let text = room(1.0) + &faces([[7, 3, 1, 5]]) + "o carpet\n" + &faces([[1, 2, 4, 3]]);
    let doubled = source(folder.path(), &text);
    let text = told(&doubled);
    assert!(text.contains("4 faces have the corners of another") && text.contains("drop_doubled_faces = true"), "{text}");
    let (scene, report) = imported(folder.path(), &FileSource { drop_doubled_faces: true, ..doubled });
    assert_eq!((scene.parts.len(), scene.meshes.len(), scene.meshes[0].triangles.len()), (1, 1, 12));
    assert!(report["import"]["warnings"].to_string().contains("4 faces with the corners of another went"), "{report}");
    assert_eq!(report["import"]["counts"]["triangles"], 12);
}

#[test]
fn parts_without_opacity_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let pane = "o pane\nusemtl PANE\nv 1 1 1\nv 2 1 1\nv 2 1 2\nv 1 1 2\nf 9 10 11 12\n";
    for (opacity, expected) in [("0", true), ("0.2", false), ("1", false)] {
        std::fs::write(folder.path().join("room.mtl"), format!("newmtl PANE\nKd 1 1 1\nd {opacity}\n")).unwrap();
        let text = told(&source(folder.path(), &format!("mtllib room.mtl\n{}{pane}", room(1.0))));
        assert_eq!(text.contains("1 part has no opacity and cannot be seen (\"pane\"); if that is glass"), expected, "{opacity}: {text}");
    }
}

#[test]
fn a_wrong_unit_is_told_with_the_ones_that_make_a_room() {
    let folder = tempfile::tempdir().unwrap();
    for (scale, words) in [
        (100.0, "it is 400.00 m long; if it is a room, its unit is another. meters_per_unit = 0.01 (or --meters-per-unit 0.01)"),
        (
            0.01,
            "meters_per_unit = 100 (or --meters-per-unit 100), for a file in metres, if its exporter took centimetres for its unit, makes it 4.0 x 3.0 x 2.5 m",
        ),
        (1e9, "state it by meters_per_unit"),
    ] {
        let text = told(&source(folder.path(), &room(scale)));
        assert!(text.contains(words), "{scale}: {text}");
    }
    // If a unit is stated, the proposed one replaces it.
    let stated = FileSource { meters_per_unit: 10.0, ..source(folder.path(), &room(100.0)) };
    let text = told(&stated);
    assert!(text.contains("it is 4000.00 m long") && text.contains("meters_per_unit = 0.01 "), "{text}");
    assert!(!told(&source(folder.path(), &room(1.0))).contains("unit"));
}

#[test]
fn glass_that_lets_no_light_through_is_told_once_and_becomes_clear_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    // A pane 1 m x 1 m in the middle of the room, in grey glass, as Blender's OBJ has it.
    let pane = "o window\nusemtl Glass.001\nv 1 1 0.5\nv 2 1 0.5\nv 2 1 1.5\nv 1 1 1.5\nf 9 10 11 12\n";
    std::fs::write(folder.path().join("m.mtl"), "newmtl Glass.001\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nillum 2\n").unwrap();
    let glazed = source(folder.path(), &format!("mtllib m.mtl\n{}{pane}", room(1.0)));
    let text = told(&glazed);
    assert_eq!(text.matches("lets no light through").count(), 1, "{text}");
    assert!(text.contains("what is called \"Glass.001\"") && text.contains("panes = [\"Glass.001\"] (or --panes \"Glass.001\")"), "{text}");

    for name in ["glass*", "Window"] {
        let clear = FileSource { panes: vec![name.into(), "vitrail".into()], ..glazed.clone() };
        let text = told(&clear);
        assert!(text.contains("1 part became clear panes (panes); no part or material is called \"vitrail\""), "{name}: {text}");
        assert!(!text.contains("lets no light through"), "{name}: {text}");
        let (scene, report) = imported(folder.path(), &clear);
        let bsdf = |part: usize| &scene.materials[scene.parts[part].material as usize].bsdf;
        let enfilade_scene::Bsdf::ThinDielectric { eta, transmittance } = bsdf(1) else { panic!("{:?}", bsdf(1)) };
        assert_eq!((*eta, transmittance.factor.to_array()), (1.5, [1.0; 3]));
        assert!(!bsdf(0).transmits());
        assert_eq!(report["import"]["counts"]["transmitting_materials"], 1);
    }
}

#[test]
fn missing_ceilings_shells_and_parts_without_area_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let without_ceiling = room(1.0).replace("f 5 7 8 6\n", "") + "o speck\nf 1 1 1\n";
    let text = told(&source(folder.path(), &without_ceiling));
    assert!(text.contains("100 % of its floors") && text.contains("max_open_share"), "{text}");
    let turned: String = room(1.0)
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(face) => format!("f {}\n", face.split(' ').rev().collect::<Vec<_>>().join(" ")),
            None => format!("{line}\n"),
        })
        .collect();
    let text = told(&source(folder.path(), &turned));
    assert!(text.contains("100 % of what is seen in its rooms are backs of faces (\"room\")"), "{text}");
}

#[test]
fn the_report_of_a_sound_room_has_nothing_about_its_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let lit = FileSource { environment: Some(EnvironmentOverride::named("sky")), ..source(folder.path(), &room(1.0)) };
    let checked = check_file(&lit, &Quiet).unwrap();
    // The OBJ files here have no materials, which their reader reports.
    assert!(checked.warnings.iter().all(|warning| warning.message.contains("material")), "{:?}", checked.warnings);
}

/// A file of glTF with one triangle mesh, a ball of eight faces around the origin, and a lamp at a point.
fn globe(folder: &Path, lamp_at: [f32; 3], material: &str) -> FileSource {
    let corners: [[f32; 3]; 6] = [[0.2, 0.0, 0.0], [-0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, -0.2, 0.0], [0.0, 0.0, 0.2], [0.0, 0.0, -0.2]];
    let faces: [[u16; 3]; 8] = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let bytes: Vec<u8> = corners
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .chain(faces.as_flattened().iter().flat_map(|v| v.to_le_bytes()))
        .collect();
    std::fs::write(folder.join("globe.bin"), bytes).unwrap();
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "point", "intensity": 10}}]}}}},
        "nodes": [{{"name": "globe", "mesh": 0}},
            {{"name": "bulb", "translation": {lamp_at:?}, "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
        "materials": [{material}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-0.2, -0.2, -0.2], "max": [0.2, 0.2, 0.2]}},
            {{"bufferView": 1, "componentType": 5123, "count": 24, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 72}}, {{"buffer": 0, "byteOffset": 72, "byteLength": 48}}],
        "buffers": [{{"byteLength": 120, "uri": "globe.bin"}}]}}"#
    );
    let file = folder.join("globe.gltf");
    std::fs::write(&file, text).unwrap();
    FileSource::of(file.to_string_lossy())
}

#[test]
fn a_lamp_whose_light_leads_nowhere_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let opaque = r#"{"name": "white", "pbrMetallicRoughness": {"metallicFactor": 0}}"#;
    let text = told(&globe(folder.path(), [0.0, 0.01, 0.0], opaque));
    assert!(text.contains("1 lamp (\"bulb\" in \"globe\") is inside of an opaque part"), "{text}");
    // Above it, or within glass, it is found.
    assert!(!told(&globe(folder.path(), [0.0, 0.5, 0.0], opaque)).contains("lamp ("));
    let glass = r#"{"name": "glass", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 0.1}}}"#;
    assert!(!told(&globe(folder.path(), [0.0, 0.01, 0.0], glass)).contains("lamp ("));
}

//! Omissions, deviations and additions of programs that write glTF files.

use crate::common::{Folder, Gltf, warnings};
use enfilade_math::Rgb;
use enfilade_scene::Light;
use serde_json::json;

/// Intensity of a bulb that a generator wrote with `intensity`, and the warnings.
fn bulb(generator: &str, intensity: f32) -> (f32, String) {
    let mut g = Gltf::triangle();
    g.json["asset"]["generator"] = json!(generator);
    let lights = json!([{"type": "point", "intensity": intensity}, {"type": "directional", "intensity": 0.5 * intensity}]);
    g.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    g.json["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    let Light::Point { intensity, .. } = &imported.scene.lights[0] else { panic!("not a bulb") };
    assert_eq!(*intensity, Rgb::splat(intensity.g));
    (intensity.g, warnings(&imported))
}

#[test]
fn lights_that_blender_multiplied_by_683_are_divided_again_and_told() {
    let (strength, text) = bulb("Khronos glTF Blender I/O v4.5.32", 54_351.41);
    assert!((strength - 1000.0 / (4.0 * std::f32::consts::PI)).abs() < 1e-3, "{strength}");
    assert_eq!(text.matches("divided by 683").count(), 1, "{text}");
    let others =
        [("Khronos glTF Blender I/O v4.5.32", 79.5), ("Khronos glTF Blender I/O v3.3.14", 1000.0), ("enfilade 1.0.0", 5000.0), ("", 1e6)];
    for (generator, intensity) in others {
        assert_eq!(bulb(generator, intensity), (intensity, String::new()), "{generator:?}");
    }
}

#[test]
fn a_scene_without_nodes_and_channels_without_a_node_do_not_refuse_the_file() {
    let mut g = Gltf::triangle();
    g.json["scenes"].as_array_mut().unwrap().push(json!({"name": "Empty"}));
    let channel = |target| json!({"sampler": 0, "target": target});
    let channels = json!([channel(json!({"path": "pointer"})), channel(json!({"node": 0, "path": "scale"}))]);
    g.json["animations"] = json!([{"channels": channels, "samplers": [{"input": 0, "output": 0}]}]);
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene.parts.len(), 1);
    assert!(warnings(&imported).contains("1 animations dropped"));
}

#[test]
fn other_mistakes_keep_their_line_and_column() {
    let mut g = Gltf::triangle();
    g.json["scenes"] = json!([{}]);
    g.json["meshes"] = json!("none");
    let folder = Folder::new();
    let error = folder.write("a.gltf", g.text()).error("a.gltf");
    assert!(error.contains("line 1 column") && error.contains("not valid glTF JSON"), "{error}");
}

#[test]
fn files_of_gltf_1_are_told_by_their_version() {
    let folder = Folder::new();
    let maps = r#"{"buffers": {"b": {"uri": "b.bin"}}, "meshes": {}, "asset": {"version": "1.0"}}"#;
    folder.write("a.gltf", maps).write("b.gltf", r#"{"nodes": {}}"#);
    for name in ["a.gltf", "b.gltf"] {
        let error = folder.error(name);
        assert!(error.contains("found glTF 1.0, expected 2.0; convert"), "{error}");
    }
}

#[test]
fn a_buffer_without_a_uri_matters_only_where_it_is_used() {
    let g = Gltf::triangle();
    let mut json: serde_json::Value = serde_json::from_str(&g.text()).unwrap();
    json["buffers"].as_array_mut().unwrap().push(json!({"byteLength": 8}));
    let folder = Folder::new();
    assert_eq!(folder.write("a.gltf", json.to_string()).load("a.gltf").unwrap().scene.parts.len(), 1);
    json["bufferViews"][0]["buffer"] = json!(1);
    assert!(folder.write("b.gltf", json.to_string()).error("b.gltf").contains("buffers[1]: it has no uri"));
}

#[test]
fn invisible_nodes_are_left_out_with_all_below_them() {
    let mut g = Gltf::triangle();
    g.json["scenes"][0]["nodes"] = json!([0, 1]);
    let visibility = |visible: bool| json!({"KHR_node_visibility": {"visible": visible}});
    g.json["nodes"] = json!([
        {"name": "Hidden", "mesh": 0, "children": [2], "extensions": visibility(false)},
        {"name": "Shown", "mesh": 0, "extensions": visibility(true)},
        {"name": "Below", "mesh": 0}
    ]);
    g.json["extensionsRequired"] = json!(["KHR_node_visibility", "KHR_materials_variants"]);
    g.json["extensionsUsed"] = g.json["extensionsRequired"].clone();
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert_eq!(imported.scene.parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["Shown"]);
    let text = warnings(&imported);
    assert!(text.contains("invisible") && text.contains("default material") && !text.contains("ignored"), "{text}");
}

#[test]
fn unusable_textures_of_layers_and_thickness_are_told() {
    let mut g = Gltf::triangle();
    g.json["materials"] = json!([{"name": "Lens", "extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": "first"}},
        "KHR_materials_ior": {"ior": 0},
        "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": {"index": 0}}
    }}]);
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    let text = warnings(&imported);
    assert!(text.contains("clearcoatTexture") && text.contains("thickness"), "{text}");
    assert!(!text.contains("index of refraction"), "{text}");
}

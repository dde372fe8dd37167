//! glTF features, one small file each.

use crate::common::{Folder, Gltf, base64, png, principled, warnings};
use enfilade_import::{ImportOptions, UpAxis};
use enfilade_math::{DVec3, Rgb, Vec2, Vec3};
use enfilade_scene::{Alpha, Bsdf, Filter, Light, NormalMap, PartLabel, SpotFalloff, Wrap};
use serde_json::{Value, json};

#[test]
fn text_and_binary_files_give_the_same_scene() {
    let folder = Folder::new();
    let gltf = Gltf::triangle();
    folder.write("a.gltf", gltf.text()).write("a.glb", gltf.binary());
    let (text, binary) = (folder.load("a.gltf").unwrap(), folder.load("a.glb").unwrap());
    assert_eq!(text.scene, binary.scene);
    assert!(text.report.warnings.is_empty() && text.labels.is_none());
    assert_eq!(text.inputs, [folder.path("a.gltf")]);
    let part = &text.scene.parts[0];
    assert_eq!((part.name.as_str(), text.scene.materials[0].name.as_str()), ("Chair", "Wood"));
    // y up became z up, and v down became v up.
    assert_eq!(part.world_from_mesh.transform_point3(DVec3::Y), DVec3::Z);
    assert_eq!(text.scene.meshes[0].uvs, [Vec2::ZERO, Vec2::X, Vec2::Y]);
}

#[test]
fn the_up_axis_can_be_overridden() {
    let folder = Folder::new();
    folder.write("a.gltf", Gltf::triangle().text());
    let options = ImportOptions { up_axis: Some(UpAxis::Z), meters_per_unit: 2.0, ..ImportOptions::default() };
    let scene = folder.load_with("a.gltf", &options).unwrap().scene;
    assert_eq!(scene.parts[0].world_from_mesh.transform_point3(DVec3::Y), DVec3::Y * 2.0);
}

#[test]
fn nodes_share_meshes_and_get_stable_unique_names() {
    let mut g = Gltf::triangle();
    g.json["nodes"] = json!([
        {"name": "Chair", "children": [1, 2, 3], "translation": [1, 0, 0]},
        {"name": "Chair", "mesh": 0, "rotation": [0, 2, 0, 2]},
        {"mesh": 0, "scale": [-1, 1, 1]},
        {"name": "Chair", "mesh": 0, "matrix": [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,5,0,1]}
    ]);
    let primitive = g.json["meshes"][0]["primitives"][0].clone();
    g.json["meshes"][0]["primitives"] = json!([primitive, primitive]);
    let folder = Folder::new();
    let scene = folder.write("a.gltf", g.text()).load("a.gltf").unwrap().scene;
    let names: Vec<&str> = scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Chair.0", "Chair.1", "node_2.0", "node_2.1", "Chair.0_2", "Chair.1_2"]);
    // Two primitives, and their mirrored copies.
    assert_eq!(scene.meshes.len(), 4);
    let p = scene.parts[4].world_from_mesh.transform_point3(DVec3::X);
    assert!((p - DVec3::new(3.0, 0.0, 5.0)).length() < 1e-6, "{p}");
    let turned = scene.parts[0].world_from_mesh.transform_point3(DVec3::X);
    assert!((turned - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-6, "{turned}");
}

#[test]
fn accessors_may_be_sparse_strided_normalized_or_missing() {
    let mut g = Gltf::triangle();
    // Texture coordinates as normalized bytes with a stride of four.
    let uvs = g.accessor(&[0, 255, 9, 9, 255, 255, 9, 9, 0, 51, 9, 9], 5121, "VEC2", 3);
    let view = g.json["accessors"][uvs]["bufferView"].clone();
    g.json["bufferViews"][view.as_u64().unwrap() as usize]["byteStride"] = json!(4);
    g.json["accessors"][uvs]["normalized"] = json!(true);
    // Positions of which only one is stated.
    let index = g.view(&[1]);
    let value = g.view(&[4.0f32, 5.0, 6.0].map(f32::to_le_bytes).concat());
    g.json["accessors"].as_array_mut().unwrap().push(json!({
        "componentType": 5126, "type": "VEC3", "count": 3,
        "sparse": {"count": 1, "indices": {"bufferView": index, "componentType": 5121}, "values": {"bufferView": value}}
    }));
    g.json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": uvs + 1, "TEXCOORD_0": uvs}, "material": 0});
    let folder = Folder::new();
    let scene = folder.write("a.gltf", g.text()).load("a.gltf").unwrap().scene;
    assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::new(4.0, 5.0, 6.0), Vec3::ZERO]);
    assert!((scene.meshes[0].uvs[2] - Vec2::new(0.0, 0.8)).length() < 1e-6);
    assert_eq!(scene.meshes[0].triangles, [[0, 1, 2]]);
}

#[test]
fn textures_come_from_files_data_uris_and_buffer_views() {
    let mut g = Gltf::triangle();
    let picture = png(1, 1, [255, 0, 0, 100]);
    let view = g.view(&picture);
    g.json["images"] = json!([
        {"uri": "my%20textures/wood.png"},
        {"uri": format!("data:image/png;base64,{}", base64(&picture))},
        {"bufferView": view, "mimeType": "image/png"}
    ]);
    g.json["samplers"] = json!([{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}]);
    g.json["textures"] = json!([{"source": 0, "sampler": 0}, {"source": 1}, {"source": 2}]);
    g.json["materials"] = json!([{
        "name": "Wood", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 4]}}},
            "metallicRoughnessTexture": {"index": 1}
        },
        "normalTexture": {"index": 2, "scale": 0.5}, "occlusionTexture": {"index": 2},
        "emissiveTexture": {"index": 1}, "emissiveFactor": [1, 1, 0.5],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10}}
    }]);
    let folder = Folder::new();
    folder.write("my textures/wood.png", &picture).write("a.gltf", g.text());
    let imported = folder.load("a.gltf").unwrap();
    let m = &imported.scene.materials[0];
    let p = principled(&m.bsdf);
    let base = p.base_color.texture.unwrap();
    assert_eq!((base.wrap, base.filter), ([Wrap::Clamp, Wrap::Mirror], Filter::Nearest));
    // glTF's (u, v) = (0, 0) is our (0, 1); it goes to (0.5, 0.25), which is our (0.5, 0.75).
    assert_eq!(base.transform(Vec2::new(0.0, 1.0)), Vec2::new(0.5, 0.75));
    assert_eq!((p.roughness.texture.unwrap().1, p.metallic.texture.unwrap().1), (1, 2));
    assert_eq!(m.emission.factor, Rgb::new(10.0, 10.0, 5.0));
    assert!(m.two_sided && m.emits_both_sides);
    assert!(matches!(m.alpha, Alpha::Mask { cutoff: 0.25, opacity } if opacity.texture.unwrap().1 == 3));
    assert!(matches!(m.normal_map, Some(NormalMap::Normal { scale: 0.5, .. })));
    // The same picture as colour and as data is two images.
    assert_eq!(imported.scene.images.len(), 4);
    assert_eq!(imported.inputs.len(), 2);
    assert!(warnings(&imported).contains("occlusion texture dropped"));
}

#[test]
fn material_extensions_are_read() {
    let mut g = Gltf::triangle();
    g.json["materials"] = json!([{
        "name": "Glass", "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.9}, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationDistance": 2.0, "attenuationColor": [0.5, 1, 0.25]},
            "KHR_materials_specular": {"specularFactor": 0.3, "specularColorFactor": [1, 0.5, 0.2]},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.7, "clearcoatRoughnessFactor": 0.2},
            "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.4},
            "KHR_materials_iridescence": {}
        }
    }]);
    g.json["extensionsRequired"] = json!(["KHR_materials_clearcoat", "KHR_mesh_quantization"]);
    let folder = Folder::new();
    let options = ImportOptions { meters_per_unit: 0.5, ..ImportOptions::default() };
    let imported = folder.write("a.gltf", g.text()).load_with("a.gltf", &options).unwrap();
    let p = principled(&imported.scene.materials[0].bsdf);
    assert_eq!((p.transmission.factor, p.ior, p.solid), (0.9, 1.33, true));
    // Half the light in red after two units, which are one metre.
    assert!((p.absorption.r - 2.0f32.ln()).abs() < 1e-6 && p.absorption.g == 0.0);
    assert_eq!((p.specular.factor, p.specular_color.factor), (0.3, Rgb::new(1.0, 0.5, 0.2)));
    assert_eq!((p.clearcoat.factor, p.clearcoat_roughness.factor), (0.7, 0.2));
    assert_eq!((p.sheen_color.factor, p.sheen_roughness.factor), (Rgb::new(0.1, 0.2, 0.3), 0.4));
    assert!(warnings(&imported).contains("KHR_materials_iridescence: not rendered, materials \"Glass\""));
}

#[test]
fn a_texture_of_any_kind_chooses_the_coordinate_set() {
    let folder = Folder::new();
    folder.write("a.png", png(1, 1, [9, 9, 9, 255]));
    let load = |material: &Value| {
        let mut g = Gltf::triangle();
        let second = g.accessor(&[0.5f32; 6].map(f32::to_le_bytes).concat(), 5126, "VEC2", 3);
        g.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(second);
        g.json["images"] = json!([{"uri": "a.png"}]);
        g.json["textures"] = json!([{"source": 0}]);
        g.json["materials"] = json!([material]);
        folder.write("a.gltf", g.text()).load("a.gltf").unwrap()
    };
    let texture = json!({"index": 0, "texCoord": 1});
    let mut materials = vec![
        json!({"normalTexture": texture}),
        json!({"normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}}),
    ];
    for (name, key) in [
        ("transmission", "transmissionTexture"),
        ("specular", "specularTexture"),
        ("specular", "specularColorTexture"),
        ("clearcoat", "clearcoatTexture"),
        ("clearcoat", "clearcoatRoughnessTexture"),
        ("sheen", "sheenColorTexture"),
        ("sheen", "sheenRoughnessTexture"),
    ] {
        materials.push(json!({"extensions": {format!("KHR_materials_{name}"): {key: texture}}}));
    }
    for mut material in materials {
        let imported = load(&material);
        assert_eq!(imported.scene.meshes[0].uvs, [Vec2::splat(0.5); 3], "{material}");
        assert!(!warnings(&imported).contains("coordinate sets"), "{material}");
        material["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 0}});
        let imported = load(&material);
        assert_eq!(imported.scene.meshes[0].uvs[1], Vec2::X, "{material}");
        assert!(warnings(&imported).contains("its textures use several coordinate sets; all were given set 0"), "{material}");
    }
}

#[test]
fn lights_and_cameras_are_placed_and_scaled() {
    let mut g = Gltf::triangle();
    g.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "intensity": 100, "color": [1, 0.5, 0.25], "extras": {"note": 1}},
        {"type": "spot", "intensity": 10, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}, "name": "desk"},
        {"type": "directional", "intensity": 3}
    ]}});
    g.json["cameras"] = json!([
        {"type": "perspective", "perspective": {"yfov": 0.9, "aspectRatio": 2.0, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 10, "znear": 0.1}}
    ]);
    g.json["nodes"] = json!([
        {"name": "Chair", "mesh": 0, "children": [1, 2, 3, 4, 5]},
        {"name": "bulb", "translation": [0, 2, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}},
        {"name": "view", "camera": 0, "translation": [0, 1, 4]}, {"camera": 1}
    ]);
    let folder = Folder::new();
    let options = ImportOptions { meters_per_unit: 0.5, ..ImportOptions::default() };
    let imported = folder.write("a.gltf", g.text()).load_with("a.gltf", &options).unwrap();
    let lights = &imported.scene.lights;
    let bulb = Light::Point { name: "bulb".into(), position: Vec3::Z, intensity: Rgb::new(25.0, 12.5, 6.25) };
    assert_eq!(lights[0], bulb);
    assert!(
        matches!(&lights[1], Light::Spot { name, direction, outer_rad, falloff: SpotFalloff::CosineSquare, .. } if name == "desk" && *direction == Vec3::Y && *outer_rad == 0.4)
    );
    assert!(matches!(&lights[2], Light::Directional { irradiance, .. } if irradiance.g == 3.0));
    let camera = &imported.scene.cameras[0];
    assert_eq!((camera.name.as_str(), camera.position), ("view", DVec3::new(0.0, -2.0, 0.5)));
    assert!(((0.5 * camera.fov_x_rad).tan() - 2.0 * 0.45f64.tan()).abs() < 1e-6);
    assert_eq!(camera.world_from_camera.y_axis, DVec3::Z);
    assert!(warnings(&imported).contains("not perspective"));
    // Radians end below π; 45 of them would be 58 degrees.
    g.json["cameras"][0]["perspective"]["yfov"] = json!(45);
    let imported = folder.write("a.gltf", g.text()).load_with("a.gltf", &options).unwrap();
    assert!(((0.5 * imported.scene.cameras[0].fov_x_rad).tan() - 2.0 * 22.5f64.to_radians().tan()).abs() < 1e-6);
    assert!(warnings(&imported).contains("found 45 as yfov, expected radians below 3.14; degrees were taken"));
}

#[test]
fn photometric_profiles_shine_along_minus_z_of_their_node() {
    // Half the intensity at 45 degrees, none from the horizon up; twice as much towards +x as towards +y.
    let ies = "IES:LM-63-2019\nTILT=NONE\n1 -1 1 3 2 1 2 0 0 0\n1 1 10\n0 45 90\n0 90\n100 60 0\n100 30 0\n";
    let mut g = Gltf::triangle();
    g.json["extensions"] = json!({"EXT_lights_ies": {"lights": [{"uri": "down.ies"}]}});
    g.json["extensionsRequired"] = json!(["EXT_lights_ies"]);
    // The node's −z points down, its x stays; positions are in half metres.
    let s = std::f64::consts::FRAC_1_SQRT_2;
    let node = json!({"name": "spot", "translation": [0, 4, 0], "rotation": [-s, 0, 0, s], "scale": [2, 2, 2], "extensions": {
        "EXT_lights_ies": {"light": 0, "multiplier": 3.0, "color": [1, 0.5, 7]}}});
    g.json["nodes"] = json!([{"name": "Chair", "mesh": 0, "children": [1]}, node]);
    let folder = Folder::new();
    folder.write("down.ies", ies);
    let options = ImportOptions { meters_per_unit: 0.5, ..ImportOptions::default() };
    let imported = folder.write("a.gltf", g.text()).load_with("a.gltf", &options).unwrap();
    let Light::Profile { name, position, web_from_world, intensity, web } = &imported.scene.lights[0] else { panic!("no profile") };
    assert_eq!((name.as_str(), *position), ("spot", Vec3::new(0.0, 0.0, 2.0)));
    assert_eq!(*intensity, Rgb::new(0.75, 0.375, 0.75));
    let candela = |d: Vec3| web.candela(*web_from_world * d.normalize());
    assert!((candela(Vec3::NEG_Z) - 100.0).abs() < 0.01 && candela(Vec3::Z) == 0.0);
    assert!((candela(Vec3::new(1.0, 0.0, -1.0)) - 60.0).abs() < 0.01);
    assert!((candela(Vec3::new(-1.0, 0.0, -1.0)) - 60.0).abs() < 0.01);
    assert!((candela(Vec3::new(0.0, 1.0, -1.0)) - 30.0).abs() < 0.01);

    // A profile that is not there, and one that is broken.
    let message = |json: Gltf| folder.write("b.gltf", json.text()).load_with("b.gltf", &options).unwrap_err().to_string();
    g.json["nodes"][1]["extensions"]["EXT_lights_ies"]["light"] = json!(1);
    let mut broken = Gltf::triangle();
    broken.json = g.json.clone();
    assert!(message(broken).contains("nodes[1].extensions.EXT_lights_ies: found light 1, expected one of the 1 profiles"));
    g.json["nodes"][1]["extensions"]["EXT_lights_ies"]["light"] = json!(0);
    g.json["extensions"]["EXT_lights_ies"]["lights"][0] = json!({"uri": "data:application/x-ies-lm-63,TILT=NONE%0A1%201"});
    let found = message(g);
    assert!(found.contains("b.gltf: extensions.EXT_lights_ies.lights[0], line 2: the file ends where the candela multiplier"), "{found}");
}

#[test]
fn instanced_meshes_stand_in_every_place_of_their_node() {
    let mut g = Gltf::triangle();
    let translations = [1.0f32, 0.0, 0.0, 2.0, 0.0, 0.0].map(f32::to_le_bytes).concat();
    let translations = g.accessor(&translations, 5126, "VEC3", 2);
    // Normalized shorts: no turn, then half a turn about y.
    let rotations = g.accessor(&[0i16, 0, 0, 32_767, 0, 32_767, 0, 0].map(i16::to_le_bytes).concat(), 5122, "VEC4", 2);
    g.json["accessors"][rotations]["normalized"] = json!(true);
    let scales = g.accessor(&[1.0f32, 1.0, 1.0, 3.0, 3.0, 3.0].map(f32::to_le_bytes).concat(), 5126, "VEC3", 2);
    let attributes = json!({"TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales});
    g.json["nodes"][0]["translation"] = json!([0, 5, 0]);
    g.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    g.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let folder = Folder::new();
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    assert!(imported.report.warnings.is_empty(), "{}", warnings(&imported));
    let parts = &imported.scene.parts;
    assert_eq!(parts.iter().map(|p| (p.name.as_str(), p.mesh)).collect::<Vec<_>>(), [("Chair", 0), ("Chair_2", 0)]);
    // The file's x, with y up: it stays x in the world, and the node's height is z.
    let at = |part: usize| parts[part].world_from_mesh.transform_point3(DVec3::X);
    assert!(at(0).distance(DVec3::new(2.0, 0.0, 5.0)) < 1e-6 && at(1).distance(DVec3::new(-1.0, 0.0, 5.0)) < 1e-6, "{} {}", at(0), at(1));

    g.json["accessors"][scales]["count"] = json!(1);
    let error = folder.write("b.gltf", g.text()).error("b.gltf");
    assert!(
        error.contains("nodes[0].extensions.EXT_mesh_gpu_instancing.attributes: found 2, 2, 1 of TRANSLATION, ROTATION, SCALE"),
        "{error}"
    );
    g.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json!({"ROTATION": "x"});
    let error = folder.write("c.gltf", g.text()).error("c.gltf");
    assert!(error.contains("attributes.ROTATION: found \"x\", expected an accessor"), "{error}");
}

#[test]
fn labels_in_extras_are_inherited_and_mistakes_are_told() {
    let mut g = Gltf::triangle();
    g.json["nodes"] = json!([
        {"name": "Sofa", "children": [1, 2], "extras": {"semantic": "sofa", "instance": 3}},
        {"name": "seat", "mesh": 0}, {"name": "pillow", "mesh": 0, "extras": {"semantic": 18}},
        {"name": "odd", "mesh": 0, "extras": {"semantic": "spaceship", "instance": -1}}
    ]);
    g.json["scenes"] = json!([{"nodes": [0, 3]}]);
    let folder = Folder::new();
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    let labels: Vec<_> = imported.labels.clone().unwrap().iter().map(|l| (l.part, l.label)).collect();
    let label = |semantic, instance| PartLabel { semantic, instance };
    // A node with a class of its own is no part of that instance.
    assert_eq!(labels, [(0, label(6, 3)), (1, label(18, 1))]);
    assert!(warnings(&imported).contains("spaceship"));
}

#[test]
fn dropped_features_are_in_the_report() {
    let mut g = Gltf::triangle();
    let primitive = &mut g.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = json!(0);
    primitive["attributes"]["COLOR_1"] = json!(0);
    let lines = json!({"attributes": {"POSITION": 0}, "mode": 1});
    g.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(lines);
    g.json["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}});
    g.json["animations"] = json!([{"channels": [], "samplers": []}]);
    g.json["extensionsUsed"] = json!(["MSFT_lod"]);
    let folder = Folder::new();
    let imported = folder.write("a.gltf", g.text()).load("a.gltf").unwrap();
    let text = warnings(&imported);
    for expected in ["further sets", "points and lines", "unlit", "animations dropped", "MSFT_lod"] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    assert!(matches!(imported.scene.materials[0].bsdf, Bsdf::Diffuse { .. }));
    assert_eq!(imported.scene.parts[0].name, "Chair.0");
}

#[test]
fn environments_can_be_given_by_the_user() {
    let folder = Folder::new();
    folder.write("sky.png", png(4, 2, [9, 9, 9, 255])).write("a.gltf", Gltf::triangle().text());
    let environment = enfilade_import::EnvironmentOverride {
        source: enfilade_import::EnvironmentSource::Picture(folder.path("sky.png")),
        scale: 2.0,
        rotation_deg: 90.0,
    };
    let options = ImportOptions { environment: Some(environment), ..ImportOptions::default() };
    let imported = folder.load_with("a.gltf", &options).unwrap();
    let Some(enfilade_scene::Environment::Map { map_from_world, scale, .. }) = imported.scene.environment else { panic!("no map") };
    assert_eq!(scale, Rgb::splat(2.0));
    // Without rotation the middle of the picture is at −y; a quarter turn counter-clockwise takes it to +x.
    assert!((enfilade_scene::uv_from_direction(map_from_world * Vec3::X).x - 0.5).abs() < 1e-5);
    assert!(imported.inputs.contains(&folder.path("sky.png")));
}

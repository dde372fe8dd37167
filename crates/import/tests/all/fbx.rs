//! FBX features, one small file each, as text and in binary.

use crate::common::fbx::*;
use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, Imported, UpAxis};
use enfilade_math::{Rgb, Vec2, Vec3};
use enfilade_scene::{Alpha, BodyStates, Bsdf, Light, NormalMap, SpotFalloff, TextureRef, Wrap};
use std::f64::consts::PI;

const MESH: i64 = 10;
const NODE: i64 = 20;
const MATERIAL: i64 = 30;

/// A triangle at x, y and the origin, with texture coordinates.
fn triangle() -> Record {
    let layer = |name, kind, values| {
        let children = vec![
            record("Name", vec![Value::Text("")], vec![]),
            record("MappingInformationType", vec![Value::Text(kind)], vec![]),
            record("ReferenceInformationType", vec![Value::Text("Direct")], vec![]),
            record(if name == "LayerElementUV" { "UV" } else { "Materials" }, vec![values], vec![]),
        ];
        record(name, vec![Value::Int(0)], children)
    };
    let children = vec![
        record("Vertices", vec![Value::Reals(vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])], vec![]),
        record("PolygonVertexIndex", vec![Value::Ints(vec![0, 1, -3])], vec![]),
        layer("LayerElementUV", "ByPolygonVertex", Value::Reals(vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0])),
        layer("LayerElementMaterial", "AllSame", Value::Ints(vec![0])),
    ];
    object("Geometry", MESH, "\0\x01Geometry", "Mesh", children)
}

fn node(list: Vec<Record>) -> Record {
    object("Model", NODE, "Chair\0\x01Model", "Mesh", vec![properties(list)])
}

fn vector(name: &'static str, v: [f64; 3]) -> Record {
    reals(name, "Vector3D", &v)
}

/// The triangle at one node, with these properties, and what else there is.
fn scene(settings: Vec<Record>, of_node: Vec<Record>, more: Vec<Record>, connections: Vec<Record>) -> Vec<Record> {
    let objects = [vec![triangle(), node(of_node)], more].concat();
    let links = [vec![belongs(NODE, 0), belongs(MESH, NODE)], connections].concat();
    document(7400, settings, objects, links)
}

fn load(folder: &Folder, document: &[Record]) -> Imported {
    folder.write("a.fbx", binary(document, 7400));
    folder.load("a.fbx").unwrap_or_else(|e| panic!("{e}"))
}

fn corners(imported: &Imported) -> [Vec3; 3] {
    imported.scene.world_corners(&imported.scene.parts[0], 0)
}

fn near(a: Vec3, b: [f32; 3]) {
    assert!((a - Vec3::from(b)).length() < 1e-5, "{a} is not {b:?}");
}

#[test]
fn pivots_geometry_and_transforms_place_a_corner_alike_in_every_encoding() {
    let list = vec![
        vector("Lcl Translation", [10.0, 20.0, 30.0]),
        vector("Lcl Rotation", [0.0, 0.0, 90.0]),
        vector("Lcl Scaling", [2.0, 2.0, 2.0]),
        vector("RotationPivot", [1.0, 0.0, 0.0]),
        vector("GeometricTranslation", [0.0, 0.0, 5.0]),
    ];
    let document = scene(vec![], list, vec![], vec![]);
    let folder = Folder::new();
    folder.write("text.fbx", text(&document, 7400)).write("b.fbx", binary(&document, 7400)).write("c.fbx", binary(&document, 7700));
    for file in ["text.fbx", "b.fbx", "c.fbx"] {
        let imported = folder.load(file).unwrap();
        assert_eq!(imported.scene.parts[0].name, "Chair", "{file}");
        // (1, 0, 5) doubled is (2, 0, 10); turned about (1, 0, 0) it is (1, 1, 10); moved (11, 21, 40) cm with y up.
        near(corners(&imported)[1], [0.11, -0.40, 0.21]);
        assert_eq!(imported.scene.meshes[0].uvs[1], Vec2::X, "{file}");
        assert_eq!(imported.report.format, "fbx");
    }
}

#[test]
fn units_and_axes_are_the_files_own_unless_the_options_say_otherwise() {
    let folder = Folder::new();
    let z_up = || [("UpAxis", 2), ("FrontAxis", 1), ("FrontAxisSign", -1)].map(|(name, v)| int(name, "int", v)).to_vec();
    let inches = [z_up(), vec![reals("UnitScaleFactor", "double", &[2.54])]].concat();
    let document = scene(inches, vec![vector("Lcl Translation", [100.0, 200.0, 300.0])], vec![], vec![]);
    near(corners(&load(&folder, &document))[0], [2.54, 5.08, 7.62]);
    let options = ImportOptions { meters_per_unit: 2.0, up_axis: Some(UpAxis::Y), ..ImportOptions::default() };
    near(corners(&folder.load_with("a.fbx", &options).unwrap())[0], [5.08, -15.24, 10.16]);
}

#[test]
fn version_6_files_are_read() {
    let file = "; FBX 6.1.0 project file\nFBXHeaderExtension: {\n FBXHeaderVersion: 1003\n FBXVersion: 6100\n}\nObjects: {\n\
        Model: \"Model::Box\", \"Mesh\" {\n Version: 232\n Properties60: {\n\
        Property: \"Lcl Translation\", \"Lcl Translation\", \"A+\",100,0,0\n }\n Vertices: 0,0,0,1,0,0,0,1,0\n PolygonVertexIndex: 0,1,-3\n }\n}\n\
        Connections: {\n Connect: \"OO\", \"Model::Box\", \"Model::Scene\"\n}\n";
    let folder = Folder::new();
    let imported = folder.write("old.fbx", file).load("old.fbx").unwrap();
    assert_eq!(imported.scene.parts[0].name, "Box");
    near(corners(&imported)[1], [1.01, 0.0, 0.0]);
}

fn material(model: &'static str, list: Vec<Record>) -> Record {
    let shading = record("ShadingModel", vec![Value::Text(model)], vec![]);
    object("Material", MATERIAL, "Wood\0\x01Material", "", vec![shading, properties(list)])
}

fn painted(folder: &Folder, material: Record) -> enfilade_scene::Material {
    load(folder, &scene(vec![], vec![], vec![material], vec![belongs(MATERIAL, NODE)])).scene.materials[0].clone()
}

#[test]
fn lambert_phong_and_physical_materials_become_ours() {
    let folder = Folder::new();
    let color = |name, v: [f64; 3]| reals(name, "Color", &v);
    let number = |name, v| reals(name, "Number", &[v]);
    let m = painted(&folder, material("lambert", vec![color("DiffuseColor", [0.2, 0.4, 0.6]), number("DiffuseFactor", 0.5)]));
    assert_eq!((m.name.as_str(), &m.bsdf), ("Wood", &Bsdf::Diffuse { reflectance: Rgb::new(0.1, 0.2, 0.3).into() }));
    let shiny = [
        color("DiffuseColor", [0.5; 3]),
        color("SpecularColor", [1.0; 3]),
        number("SpecularFactor", 0.5),
        number("ShininessExponent", 198.0),
    ];
    let m = painted(&folder, material("phong", shiny.to_vec()));
    let Bsdf::Principled(p) = &m.bsdf else { panic!("{m:?}") };
    assert!((p.roughness.factor.powi(2) - 0.1).abs() < 1e-6 && p.specular_color.factor == Rgb::splat(0.5));
    let clear = [color("TransparentColor", [0.5; 3]), number("TransparencyFactor", 0.5)];
    assert!(matches!(painted(&folder, material("lambert", clear.to_vec())).alpha, Alpha::Blend { opacity } if opacity.factor == 0.75));
    // 3ds Max's physical material is recognised by its class.
    let physical = vec![
        int("3dsMax|ClassIDa", "int", 0x3d6b_1cec),
        int("3dsMax|ClassIDb", "int", 0xdead_c001),
        number("3dsMax|Parameters|base_weight", 1.0),
        color("3dsMax|Parameters|base_color", [0.8, 0.4, 0.2]),
        number("3dsMax|Parameters|metalness", 1.0),
        number("3dsMax|Parameters|roughness", 0.3),
        number("3dsMax|Parameters|coating", 0.25),
        number("3dsMax|Parameters|emission", 2.0),
        color("3dsMax|Parameters|emit_color", [1.0, 0.5, 0.0]),
    ];
    let m = painted(&folder, material("unknown", physical));
    let Bsdf::Principled(p) = &m.bsdf else { panic!("{m:?}") };
    assert_eq!((p.metallic.factor, p.roughness.factor, p.clearcoat.factor), (1.0, 0.3, 0.25));
    assert_eq!((p.base_color.factor, m.emission.factor), (Rgb::new(0.8, 0.4, 0.2), Rgb::new(2.0, 1.0, 0.0)));
}

fn textured(relative: &'static str, absolute: &'static str, content: Option<Vec<u8>>) -> Vec<Record> {
    let settings = vec![vector("Scaling", [0.5, 0.25, 1.0]), int("WrapModeU", "enum", 1)];
    with_picture(settings, &["DiffuseColor"], relative, absolute, content)
}

/// The triangle with a picture in these slots of its material.
fn with_picture(
    settings: Vec<Record>,
    slots: &[&'static str],
    relative: &'static str,
    absolute: &'static str,
    content: Option<Vec<u8>>,
) -> Vec<Record> {
    with_picture_on(material("lambert", vec![]), settings, slots, relative, absolute, content)
}

fn with_picture_on(
    material: Record,
    settings: Vec<Record>,
    slots: &[&'static str],
    relative: &'static str,
    absolute: &'static str,
    content: Option<Vec<u8>>,
) -> Vec<Record> {
    let mut video =
        vec![record("Filename", vec![Value::Text(absolute)], vec![]), record("RelativeFilename", vec![Value::Text(relative)], vec![])];
    video.extend(content.map(|bytes| record("Content", vec![Value::Bytes(bytes)], vec![])));
    let names = vec![
        record("FileName", vec![Value::Text(absolute)], vec![]),
        record("RelativeFilename", vec![Value::Text(relative)], vec![]),
        properties(settings),
    ];
    let objects = vec![material, object("Texture", 40, "T\0\x01Texture", "", names), object("Video", 41, "V\0\x01Video", "Clip", video)];
    let fed = slots.iter().map(|&slot| feeds(40, MATERIAL, slot));
    let links = [belongs(MATERIAL, NODE), belongs(41, 40)].into_iter().chain(fed).collect();
    scene(vec![], vec![], objects, links)
}

fn picture_of(imported: &Imported) -> TextureRef {
    let Bsdf::Diffuse { reflectance } = &imported.scene.materials[0].bsdf else { panic!("not diffuse") };
    reflectance.texture.expect("a texture")
}

/// Pictures are transformed as by Autodesk's programs: a scale of two shows the picture twice, and a translation of one is its width then.
#[test]
fn pictures_are_scaled_turned_and_moved_in_this_order() {
    let folder = Folder::new();
    let placed = |settings| load(&folder, &with_picture(settings, &["DiffuseColor"], "a.png", "a.png", Some(png(2, 2, [9; 4]))));
    let moved = vec![vector("Scaling", [2.0, 4.0, 1.0]), vector("Translation", [0.25, -0.5, 0.0])];
    assert_eq!(picture_of(&placed(moved)).uv_transform, [[2.0, 0.0, 0.25], [0.0, 4.0, -0.5]]);
    let turned = vec![vector("Scaling", [2.0, 4.0, 1.0]), vector("Rotation", [0.0, 0.0, 90.0]), vector("Translation", [0.25, -0.5, 0.0])];
    let picture = picture_of(&placed(turned));
    for (uv, expected) in [(Vec2::ZERO, [0.25, -0.5]), (Vec2::X, [0.25, 1.5]), (Vec2::Y, [-3.75, -0.5])] {
        assert!((picture.transform(uv) - Vec2::from(expected)).length() < 1e-6, "{uv}: {}", picture.transform(uv));
    }
}

#[test]
fn pictures_within_the_file_may_be_tga_which_begins_in_no_certain_way() {
    let folder = Folder::new();
    // A picture of one texel of 24 bits, blue first.
    let tga = [&[0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0][..], &[60, 100, 150]].concat();
    for name in ["wood.tga", "C:\\tex\\wood.TGA", "wood"] {
        let imported = load(&folder, &with_picture(vec![], &["DiffuseColor"], name, name, Some(tga.clone())));
        let image = &imported.scene.images[picture_of(&imported).image as usize];
        assert_eq!(image.pixels, enfilade_scene::Pixels::Rgba8 { srgb: true, texels: vec![[150, 100, 60, 255]] }, "{name}");
    }
}

/// A mapping of scale (2, 3), turned by 30 degrees and moved by (0.2, 0.3).
#[test]
fn blenders_mapping_is_undone_as_its_exporter_writes_it() {
    let folder = Folder::new();
    let settings =
        vec![vector("Scaling", [0.5, 1.0 / 3.0, 1.0]), vector("Rotation", [0.0, 0.0, -PI / 6.0]), vector("Translation", [0.2, 0.3, 0.0])];
    let document = of_blender(with_picture(settings, &["DiffuseColor"], "a.png", "a.png", Some(png(2, 2, [9; 4]))));
    let imported = load(&folder, &document);
    let Bsdf::Principled(p) = &imported.scene.materials[0].bsdf else { panic!("{:?}", imported.scene.materials) };
    let picture = p.base_color.texture.expect("a texture");
    let (sin, cos) = (PI as f32 / 6.0).sin_cos();
    for (uv, expected) in
        [(Vec2::ZERO, [0.2, 0.3]), (Vec2::X, [0.2 + 2.0 * cos, 0.3 + 2.0 * sin]), (Vec2::Y, [0.2 - 3.0 * sin, 0.3 + 3.0 * cos])]
    {
        assert!((picture.transform(uv) - Vec2::from(expected)).length() < 1e-6, "{uv}: {}", picture.transform(uv));
    }
}

#[test]
fn normal_maps_have_blenders_strength_in_its_files_alone() {
    let folder = Folder::new();
    let of = |strength| {
        let wood = material("phong", vec![reals("BumpFactor", "Number", &[strength])]);
        with_picture_on(wood, vec![], &["NormalMap"], "a.png", "a.png", Some(png(2, 2, [128, 128, 255, 255])))
    };
    let scale = |document: Vec<Record>| match load(&folder, &document).scene.materials[0].normal_map {
        Some(NormalMap::Normal { scale, .. }) => scale,
        other => panic!("{other:?}"),
    };
    assert_eq!((scale(of_blender(of(0.5))), scale(of(0.5)), scale(of(0.0))), (0.5, 1.0, 1.0));
}

#[test]
fn colour_pictures_in_the_bump_slot_are_heights_and_normals_stay_normals() {
    let folder = Folder::new();
    let normal_map = |slots: &[&'static str], pixel: [u8; 4]| {
        let document = with_picture(vec![], slots, "a.png", "a.png", Some(png(2, 2, pixel)));
        load(&folder, &document).scene.materials[0].normal_map
    };
    let (brown, upright) = ([150, 100, 60, 255], [128, 128, 255, 255]);
    assert!(matches!(normal_map(&["DiffuseColor", "Bump"], brown), Some(NormalMap::Bump { .. })));
    assert!(matches!(normal_map(&["Bump"], upright), Some(NormalMap::Normal { .. })));
    assert!(matches!(normal_map(&["NormalMap"], brown), Some(NormalMap::Normal { .. })));
}

#[test]
fn pictures_come_from_the_file_its_folder_or_another_machines_path() {
    let picture = |imported: &Imported| {
        let Bsdf::Diffuse { reflectance } = &imported.scene.materials[0].bsdf else { panic!("not diffuse") };
        let texture = picture_of(imported);
        (imported.scene.images[texture.image as usize].texel(0, 0).0, reflectance.factor, texture)
    };
    let folder = Folder::new();
    let inside = load(&folder, &textured("no.png", "C:\\no.png", Some(png(2, 2, [255, 0, 0, 255]))));
    let (texel, factor, texture) = picture(&inside);
    assert_eq!((texel, factor), (Rgb::new(1.0, 0.0, 0.0), Rgb::WHITE));
    assert_eq!((texture.wrap, texture.uv_transform[0][0], texture.uv_transform[1][1]), ([Wrap::Clamp, Wrap::Repeat], 0.5, 0.25));
    folder.write("maps/oak.png", png(2, 2, [0, 255, 0, 255])).write("pine.png", png(2, 2, [0, 0, 255, 255]));
    assert_eq!(picture(&load(&folder, &textured("maps\\oak.png", "C:\\x\\oak.png", None))).0, Rgb::new(0.0, 1.0, 0.0));
    assert_eq!(picture(&load(&folder, &textured("..\\..\\x\\pine.png", "C:\\x\\pine.png", None))).0, Rgb::new(0.0, 0.0, 1.0));
    folder.write("a.fbx", binary(&textured("gone.png", "C:\\x\\gone.png", None), 7400));
    assert!(folder.error("a.fbx").contains("a.fbx: material \"Wood\" needs the texture gone.png"), "{}", folder.error("a.fbx"));
}

#[test]
fn textures_that_are_not_read_are_named_by_their_property() {
    let folder = Folder::new();
    let told = |slot| warnings(&load(&folder, &with_picture(vec![], &[slot], "a.png", "a.png", Some(png(2, 2, [9; 4])))));
    assert!(
        told("ReflectionColor").contains("of its property \"ReflectionColor\" is not read and was dropped"),
        "{}",
        told("ReflectionColor")
    );
    for slot in ["DiffuseColor", "AmbientColor"] {
        assert!(!told(slot).contains("is not read"), "{}", told(slot));
    }
}

#[test]
fn the_views_of_the_program_are_no_cameras() {
    let camera = |name: &str| {
        format!(
            " Model: \"Model::{name}\", \"Camera\" {{\n Version: 232\n TypeFlags: \"Camera\"\n GeometryVersion: 124\n Position: 0,0,9\n LookAt: 0,0,0\n }}\n"
        )
    };
    let file = format!(
        "; FBX 6.1.0 project file\nFBXHeaderExtension: {{\n FBXHeaderVersion: 1003\n FBXVersion: 6100\n}}\nObjects: {{\n{}{}\
         Model: \"Model::Box\", \"Mesh\" {{\n Version: 232\n Vertices: 0,0,0,1,0,0,0,1,0\n PolygonVertexIndex: 0,1,-3\n }}\n}}\n\
         Connections: {{\n Connect: \"OO\", \"Model::Box\", \"Model::Scene\"\n Connect: \"OO\", \"Model::Producer Front\", \"Model::Scene\"\n \
         Connect: \"OO\", \"Model::Door\", \"Model::Scene\"\n}}\n",
        camera("Producer Front"),
        camera("Door")
    );
    let folder = Folder::new();
    let imported = folder.write("old.fbx", file).load("old.fbx").unwrap();
    // Without a lens the other one is left out too, but not without a word.
    let told = warnings(&imported);
    assert!(told.contains("camera \"Door\"") && !told.contains("Producer") && imported.scene.cameras.is_empty(), "{told}");
}

/// The triangle, and a node that carries a light or camera with these properties.
fn with_attribute(kind: &'static str, of_node: Vec<Record>, list: Vec<Record>) -> Vec<Record> {
    let objects = vec![
        object("Model", 50, "Lamp\0\x01Model", kind, vec![properties(of_node)]),
        object("NodeAttribute", 51, "\0\x01NodeAttribute", kind, vec![properties(list)]),
    ];
    scene(vec![], vec![], objects, vec![belongs(50, 0), belongs(51, 50)])
}

#[test]
fn lights_shine_down_their_node_with_the_stated_strength() {
    let folder = Folder::new();
    let at = || vec![vector("Lcl Translation", [100.0, 200.0, 0.0])];
    let light = |kind: i64, more: Vec<Record>| {
        let list = [vec![int("LightType", "enum", kind), reals("Intensity", "Number", &[300.0])], more].concat();
        load(&folder, &with_attribute("Light", at(), list)).scene.lights[0].clone()
    };
    let Light::Point { position, intensity, .. } = light(0, vec![]) else { panic!("no point light") };
    assert!(position == Vec3::new(1.0, 0.0, 2.0) && (intensity.r - 3.0).abs() < 1e-5, "{position} {intensity:?}");
    // Quadratic decay counts in the file's centimetres.
    let Light::Point { intensity, .. } = light(0, vec![int("DecayType", "enum", 2)]) else { panic!("no point light") };
    assert!((intensity.r - 3e-4).abs() < 1e-8);
    let cone = vec![reals("InnerAngle", "Number", &[40.0]), reals("OuterAngle", "Number", &[60.0])];
    let Light::Spot { direction, inner_rad, outer_rad, .. } = light(2, cone) else { panic!("no spot") };
    assert!(direction == Vec3::NEG_Z && (inner_rad.to_degrees() - 20.0).abs() < 1e-4 && (outer_rad.to_degrees() - 30.0).abs() < 1e-4);
    let Light::Directional { direction, irradiance, .. } = light(1, vec![]) else { panic!("no sun") };
    assert!(direction == Vec3::NEG_Z && irradiance == Rgb::splat(3.0));
}

/// Blender writes (1 − blend) · outer as the inner angle, and dims over the share `blend` of 1 − cos(outer).
#[test]
fn blenders_spots_dim_by_its_own_law() {
    let folder = Folder::new();
    let spot = |inner, turned: fn(Vec<Record>) -> Vec<Record>| {
        let cone = [("InnerAngle", inner), ("OuterAngle", 60.0)].map(|(name, angle)| reals(name, "Number", &[angle]));
        let list = [vec![int("LightType", "enum", 2)], cone.to_vec()].concat();
        match load(&folder, &turned(with_attribute("Light", vec![], list))).scene.lights[0] {
            Light::Spot { inner_rad, outer_rad, falloff, .. } => (inner_rad.cos(), outer_rad.cos(), falloff),
            ref other => panic!("{other:?}"),
        }
    };
    for blend in [0.0, 0.3, 1.0] {
        let (inner, outer, falloff) = spot(60.0 * (1.0 - f64::from(blend)), of_blender);
        assert!((inner - (outer + (1.0 - outer) * blend)).abs() < 1e-6 && falloff == SpotFalloff::SmoothCosine, "{blend}: {inner} {outer}");
    }
    assert_eq!(spot(30.0, |document| document).2, SpotFalloff::Angle);
}

#[test]
fn cameras_look_along_x_with_the_view_of_their_lens() {
    let folder = Folder::new();
    // A film one inch wide behind a lens of 25.4 / 2 mm sees 90 degrees.
    let list = vec![
        int("ApertureMode", "enum", 3),
        int("GateFit", "enum", 2),
        reals("FocalLength", "Number", &[12.7]),
        reals("FilmWidth", "Number", &[1.0]),
        reals("FilmHeight", "Number", &[0.5]),
        reals("AspectWidth", "Number", &[200.0]),
        reals("AspectHeight", "Number", &[100.0]),
    ];
    let imported = load(&folder, &with_attribute("Camera", vec![vector("Lcl Translation", [0.0, 150.0, 0.0])], list));
    let camera = &imported.scene.cameras[0];
    assert!((camera.fov_x_rad.to_degrees() - 90.0).abs() < 1e-6 && camera.aspect == 2.0 && camera.name == "Lamp");
    let ahead = camera.position - camera.world_from_camera.z_axis;
    assert!((ahead.as_vec3() - Vec3::new(1.0, 0.0, 1.5)).length() < 1e-6, "{camera:?}");
    assert!((camera.world_from_camera.y_axis.as_vec3() - Vec3::Z).length() < 1e-6);
}

#[test]
fn hidden_nodes_are_left_out_and_told() {
    let folder = Folder::new();
    let mut document = scene(vec![], vec![], vec![], vec![]);
    let hidden = object("Model", 60, "Ghost\0\x01Model", "Mesh", vec![properties(vec![reals("Visibility", "Visibility", &[0.0])])]);
    document[2] = record("Objects", vec![], vec![triangle(), node(vec![]), hidden]);
    document[3] = record("Connections", vec![], vec![belongs(NODE, 0), belongs(MESH, NODE), belongs(60, 0), belongs(MESH, 60)]);
    let imported = load(&folder, &document);
    assert_eq!(imported.scene.parts.len(), 1);
    assert!(warnings(&imported).contains("node \"Ghost\": hidden"), "{}", warnings(&imported));
}

#[test]
fn damaged_files_are_errors_with_a_remedy() {
    let folder = Folder::new();
    folder.write("no.fbx", "hello").write("empty.fbx", "");
    assert!(folder.error("no.fbx").starts_with("no.fbx: whole file: "), "{}", folder.error("no.fbx"));
    assert!(folder.error("empty.fbx").contains("download or copy the file again"), "{}", folder.error("empty.fbx"));
    let whole = binary(&textured("no.png", "no.png", Some(png(2, 2, [9; 4]))), 7400);
    for length in (0..whole.len()).step_by(7) {
        folder.write("cut.fbx", &whole[..length]);
        let _ = folder.load("cut.fbx");
        let mut changed = whole.clone();
        changed[length] ^= 0xff;
        folder.write("changed.fbx", changed);
        let _ = folder.load("changed.fbx");
    }
    // An array that claims to hold four thousand million numbers is refused before it is made.
    let at = whole.windows(8).position(|w| w == b"Vertices").expect("vertices") + 9;
    let mut huge = whole.clone();
    huge[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    folder.write("huge.fbx", huge);
    assert!(folder.error("huge.fbx").contains("huge.fbx: whole file: "));
}

#[test]
fn animated_nodes_move_from_the_first_moment_of_the_animation() {
    // From the first to the third second the node goes 50 cm along x, and turns by 180 degrees about its x.
    let (mut more, mut links) = curve(50, (NODE, "Lcl Translation"), "d|X", [0.0, 0.0, 5.0], &[(1.0, 10.0), (3.0, 60.0)]);
    let (objects, connections) = curve(60, (NODE, "Lcl Rotation"), "d|X", [0.0; 3], &[(1.0, 0.0), (3.0, 180.0)]);
    more.extend(objects);
    links.extend(connections);
    let (objects, connections) = animation([1.0, 3.0]);
    more.extend(objects);
    links.extend(connections);
    let of_node = vec![vector("Lcl Translation", [0.0, 0.0, 5.0]), vector("Lcl Scaling", [2.0, 2.0, 2.0])];
    let folder = Folder::new();
    let imported = load(&folder, &scene(vec![], of_node.clone(), more.clone(), links.clone()));
    assert!(warnings(&imported).contains("1 things move by the first animation"), "{}", warnings(&imported));
    let moving = imported.scene;
    assert_eq!((moving.bodies.len(), moving.bodies[0].name.as_str(), moving.bodies[0].parts.as_slice()), (1, "Chair", &[0][..]));
    // In the file the second corner is at (2, 0, 0) cm of the node and the third at (0, 2, 0), which turns to (0, 0, 2) in a second.
    for (time_s, second, third) in [
        (0.0, [12.0, 0.0, 5.0], [10.0, 2.0, 5.0]),
        (1.0, [37.0, 0.0, 5.0], [35.0, 0.0, 7.0]),
        (2.0, [62.0, 0.0, 5.0], [60.0, -2.0, 5.0]),
        (9.0, [62.0, 0.0, 5.0], [60.0, -2.0, 5.0]),
    ] {
        let there = moving.at(time_s);
        let found = there.world_corners(&there.parts[0], 0);
        // z up: y of the file is our z, and its z points towards −y.
        for (found, [x, y, z]) in [(found[1], second), (found[2], third)] {
            near(found, [0.01 * x, -0.01 * z, 0.01 * y]);
        }
    }

    // A scale that changes is no rigid motion: the shape changes, and has the rest of the motion too.
    let (objects, connections) = curve(70, (NODE, "Lcl Scaling"), "d|Y", [2.0; 3], &[(1.0, 2.0), (3.0, 4.0)]);
    let stretched = load(&folder, &scene(vec![], of_node, [more, objects].concat(), [links, connections].concat())).scene;
    assert!(matches!(stretched.bodies[0].motion.states, BodyStates::Deform { .. }) && stretched.bodies.len() == 1);
    for (time_s, third) in [(0.0, [10.0, 2.0, 5.0]), (1.0, [35.0, 0.0, 8.0]), (2.0, [60.0, -4.0, 5.0])] {
        let there = stretched.at(time_s);
        let [x, y, z] = third;
        near(there.world_corners(&there.parts[0], 0)[2], [0.01 * x, -0.01 * z, 0.01 * y]);
    }
}

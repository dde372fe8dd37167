//! Colours of vertices.

use crate::common::{Folder, Gltf, base64, png, warnings};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Material, Scene};
use serde_json::json;

/// A file whose triangle has these colours of three vertices.
fn document(colors: &[f32], kind: &str) -> Gltf {
    let mut g = Gltf::triangle();
    let bytes: Vec<u8> = colors.iter().flat_map(|v| v.to_le_bytes()).collect();
    let accessor = g.accessor(&bytes, 5126, kind, 3);
    g.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(accessor);
    g.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 1, 1, 0.5]);
    g
}

fn load(g: &Gltf) -> (Scene, String) {
    let imported = Folder::new().write("a.gltf", g.text()).load("a.gltf").unwrap();
    let text = warnings(&imported);
    (imported.scene, text)
}

fn base_color(material: &Material) -> Rgb {
    match &material.bsdf {
        Bsdf::Principled(p) => p.base_color.factor,
        Bsdf::Diffuse { reflectance } => reflectance.factor,
        other => panic!("no base colour: {other:?}"),
    }
}

#[test]
fn one_colour_multiplies_exactly_and_white_makes_no_copy() {
    let (scene, text) = load(&document(&[0.5, 0.25, 1.0].repeat(3), "VEC3"));
    assert_eq!((base_color(&scene.materials[0]), text.as_str()), (Rgb::new(0.25, 0.25, 1.0), ""));
    assert_eq!((scene.materials.len(), scene.materials[0].name.as_str()), (1, "Wood 0.500 0.250 1.000"));

    // Two meshes, one without colours, of one material; opacity has no effect where the material is opaque.
    let mut g = document(&[1.0, 1.0, 1.0, 0.3].repeat(3), "VEC4");
    let mut plain = g.json["meshes"][0].clone();
    plain["primitives"][0]["attributes"].as_object_mut().unwrap().remove("COLOR_0");
    g.json["meshes"].as_array_mut().unwrap().push(plain);
    g.json["nodes"].as_array_mut().unwrap().push(json!({"mesh": 1}));
    g.json["scenes"][0]["nodes"] = json!([0, 1]);
    let (scene, text) = load(&g);
    assert_eq!((scene.parts.len(), scene.materials.len(), text.as_str()), (2, 1, ""));
    assert_eq!((scene.materials[0].name.as_str(), scene.materials[0].alpha), ("Wood", Alpha::Opaque));
}

#[test]
fn several_colours_are_painted_where_the_material_has_no_textures() {
    let mut g = document(&[1.0, 0.0, 0.0, 0.3, 0.0, 1.0, 0.0, 0.5, 0.0, 0.0, 0.5, 0.7], "VEC4");
    let (scene, text) = load(&g);
    let Bsdf::Principled(p) = &scene.materials[0].bsdf else { panic!("principled") };
    let (texture, mesh) = (p.base_color.texture.unwrap(), &scene.meshes[0]);
    assert_eq!((p.base_color.factor, text.as_str()), (Rgb::new(0.5, 1.0, 1.0), ""));
    for (uv, color) in mesh.uvs.iter().zip([Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0), Rgb::new(0.0, 0.0, 0.5)]) {
        assert_eq!(scene.images[0].sample(&texture, *uv).0, color);
    }
    assert_eq!(scene.materials[0].name, "Wood colours 0");
    scene.validate().unwrap();

    // Opacities, where they show, have their mean all the same.
    g.json["materials"][0]["alphaMode"] = json!("BLEND");
    let (scene, text) = load(&g);
    assert!(matches!(scene.materials[0].alpha, Alpha::Blend { opacity } if (opacity.factor - 0.25).abs() < 1e-6));
    assert!(text.contains("vertex colours vary over meshes[0].primitives[0], beside textures or in opacity; their mean"), "{text}");
}

#[test]
fn the_mean_of_several_colours_is_used_and_told_once() {
    let mut g = document(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5], "VEC3");
    g.json["images"] = json!([{"uri": format!("data:image/png;base64,{}", base64(&png(1, 1, [255; 4])))}]);
    g.json["textures"] = json!([{"source": 0}]);
    g.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({"index": 0});
    let primitive = g.json["meshes"][0]["primitives"][0].clone();
    g.json["meshes"][0]["primitives"] = json!([primitive, primitive]);
    let (scene, text) = load(&g);
    let color = base_color(&scene.materials[0]);
    assert!((color.r - 1.0 / 6.0).abs() < 1e-6 && (color.g - 1.0 / 3.0).abs() < 1e-6 && (color.b - 1.0 / 6.0).abs() < 1e-6, "{color:?}");
    assert_eq!(scene.materials.len(), 1);
    let told = "vertex colours vary over meshes[0].primitives[0] and one other primitive, beside textures or in opacity; their mean over each was used";
    assert!(text.contains(told) && text.lines().count() == 1, "{text}");
}

#[test]
fn opacity_counts_where_the_material_uses_it() {
    let mut g = document(&[1.0, 1.0, 1.0, 0.5].repeat(3), "VEC4");
    g.json["materials"][0]["alphaMode"] = json!("BLEND");
    let (scene, _) = load(&g);
    assert_eq!(scene.materials[0].alpha, Alpha::Blend { opacity: 0.25.into() });
    g.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1, 1, 1, 1]);
    g.json["materials"][0]["alphaMode"] = json!("MASK");
    let (scene, _) = load(&g);
    assert_eq!(scene.materials[0].alpha, Alpha::Mask { opacity: 0.5.into(), cutoff: 0.5 });
}

#[test]
fn materials_of_specular_colour_take_it_in_their_diffuse_colour() {
    let mut g = document(&[0.5, 0.5, 0.5].repeat(3), "VEC3");
    let color = |g: &mut Gltf, extension| {
        g.json["materials"][0]["extensions"] = json!({"KHR_materials_pbrSpecularGlossiness": extension});
        load(g).0.materials[0].clone()
    };
    assert_eq!(base_color(&color(&mut g, json!({"specularFactor": [0.1, 0.1, 0.1]}))), Rgb::splat(0.5));
    let gold = color(&mut g, json!({"diffuseFactor": [0, 0, 0, 1], "specularFactor": [1, 0.75, 0.25]}));
    assert_eq!((base_color(&gold), gold.name.as_str()), (Rgb::new(1.0, 0.75, 0.25), "Wood"));
    let Bsdf::Blend { first, second, .. } = color(&mut g, json!({"specularFactor": [0.5, 0.5, 0.5]})).bsdf else { panic!("one surface") };
    let [Bsdf::Principled(first), Bsdf::Principled(second)] = [*first, *second] else { panic!("not principled") };
    assert_eq!((first.base_color.factor, second.base_color.factor), (Rgb::WHITE, Rgb::splat(0.5)));
}

#[test]
fn colours_that_make_no_sense_are_errors() {
    let folder = Folder::new();
    let error = |change: &dyn Fn(&mut Gltf), colors: &[f32]| {
        let mut g = document(colors, "VEC3");
        change(&mut g);
        folder.write("a.gltf", g.text()).error("a.gltf")
    };
    let white = [1.0f32; 9];
    let short = error(&|g| g.json["accessors"][3]["count"] = json!(2), &white);
    assert!(short.contains("primitives[0].attributes.COLOR_0: found 2 colours, expected 3, one a vertex"), "{short}");
    let scalar = error(&|g| g.json["accessors"][3]["type"] = json!("SCALAR"), &white);
    assert!(scalar.contains("accessors[3] holds 1 components an element, expected 3"), "{scalar}");
    let mut nan = white;
    nan[4] = f32::NAN;
    let nan = error(&|_| (), &nan);
    assert!(nan.contains("found [1.0, NaN, 1.0, 1.0] at vertex 1, expected numbers"), "{nan}");
    let giant = error(&|g| g.json["accessors"][3]["count"] = json!(1u64 << 62), &white);
    assert!(giant.contains("the file is damaged"), "{giant}");
}

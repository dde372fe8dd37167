//! `KHR_materials_pbrSpecularGlossiness`.

use crate::common::{Folder, Gltf, base64, png, principled, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, Pixels};
use serde_json::{Value, json};

const NAME: &str = "KHR_materials_pbrSpecularGlossiness";

/// A triangle of a material with the extension, and the picture that its textures show.
fn document(extension: &Value, picture: &[u8]) -> Gltf {
    let mut g = Gltf::triangle();
    g.json["materials"] = json!([{"name": "Wood", "alphaMode": "BLEND", "extensions": {NAME: extension}}]);
    g.json["extensionsUsed"] = json!([NAME]);
    g.json["extensionsRequired"] = json!([NAME]);
    g.json["images"] = json!([{"uri": format!("data:image/png;base64,{}", base64(picture))}]);
    g.json["textures"] = json!([{"source": 0}]);
    g
}

fn load(extension: &Value, picture: &[u8]) -> Imported {
    let imported = Folder::new().write("a.gltf", document(extension, picture).text()).load("a.gltf").unwrap();
    assert_eq!(warnings(&imported), "", "{extension}");
    imported
}

#[test]
fn a_weak_reflection_is_a_tinted_dielectric() {
    let picture = png(1, 1, [255, 128, 0, 51]);
    let extension = json!({
        "diffuseFactor": [0.8, 0.4, 0.2, 0.5], "diffuseTexture": {"index": 0}, "specularFactor": [0.09, 0.045, 0.0], "glossinessFactor": 0.75
    });
    let imported = load(&extension, &picture);
    let m = &imported.scene.materials[0];
    let p = principled(&m.bsdf);
    assert_eq!((p.base_color.factor, p.base_color.texture.unwrap().image), (Rgb::new(0.8, 0.4, 0.2), 0));
    assert_eq!((p.metallic.factor, p.roughness.factor), (0.0, 0.25));
    // (1 + 0.3) / (1 − 0.3)
    assert!((p.ior - 13.0 / 7.0).abs() < 1e-5, "{}", p.ior);
    assert!((p.specular_color.factor.g - 0.5).abs() < 1e-6 && p.specular_color.factor.r == 1.0);
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.factor == 0.5 && opacity.texture.unwrap().1 == 3));
}

#[test]
fn metals_have_the_specular_colour_with_its_picture() {
    let p = |extension: Value| principled(&load(&extension, &png(1, 1, [188, 188, 188, 255])).scene.materials[0].bsdf).clone();
    let gold = p(json!({"diffuseFactor": [0, 0, 0, 1], "specularFactor": [0.9, 0.6, 0.3], "specularGlossinessTexture": {"index": 0}}));
    assert_eq!((gold.metallic.factor, gold.base_color.factor, gold.roughness.factor), (1.0, Rgb::new(0.9, 0.6, 0.3), 0.0));
    assert!(gold.base_color.texture.is_some() && gold.roughness.texture.is_none());
    // The extension's defaults let no light through to the diffuse colour.
    let mirror = p(json!({"diffuseFactor": [1, 0, 0, 1], "glossinessFactor": 0.2}));
    assert_eq!((mirror.metallic.factor, mirror.base_color.factor, mirror.roughness.factor), (1.0, Rgb::WHITE, 0.8));
}

#[test]
fn a_picture_of_plastic_and_metal_becomes_both_side_by_side() {
    let mut picture = std::io::Cursor::new(Vec::new());
    let texels = image::RgbaImage::from_fn(2, 1, |x, _| image::Rgba([[56, 56, 56, 255], [255, 188, 0, 0]][x as usize]));
    texels.write_to(&mut picture, image::ImageFormat::Png).unwrap();
    let extension = json!({"glossinessFactor": 0.5, "specularGlossinessTexture": {"index": 0}});
    let imported = load(&extension, &picture.into_inner());
    let Bsdf::Blend { first, second, weight } = &imported.scene.materials[0].bsdf else { panic!("not two surfaces") };
    let (metal, plastic) = (principled(first), principled(second));
    assert_eq!((plastic.metallic.factor, plastic.base_color.factor, plastic.ior), (0.0, Rgb::WHITE, 1.5));
    assert_eq!((metal.metallic.factor, metal.base_color), (1.0, plastic.specular_color));
    assert_eq!(metal.roughness, plastic.roughness);
    let image = |index: u32| &imported.scene.images[index as usize].pixels;
    let (numbers, channel) = weight.texture.unwrap();
    assert_eq!((channel, plastic.roughness.texture.unwrap().1), (2, 1));
    // Half the glossiness, and none; 56 in sRGB is 0.0395, less than what the plastic reflects.
    let expected = vec![[0, 128, 255, 255], [0, 255, 0, 255]];
    assert_eq!(*image(numbers.image), Pixels::Rgba8 { srgb: false, texels: expected });
    let Pixels::Rgba8 { srgb: true, texels } = image(metal.base_color.texture.unwrap().image) else { panic!("no colours") };
    assert!((252..255).contains(&texels[0][0]), "{texels:?}");
    assert_eq!(texels[1], [255, 188, 0, 255]);
}

#[test]
fn mistakes_are_told() {
    let folder = Folder::new();
    let picture = png(1, 1, [9, 9, 9, 255]);
    let g = document(&json!({"specularGlossinessTexture": {"index": 7}}), &picture);
    assert!(folder.write("a.gltf", g.text()).error("a.gltf").contains("material \"Wood\": it refers to texture 7"));
    let g = document(&json!({"diffuseFactor": [1, 1, "x", 1]}), &picture);
    assert!(folder.write("b.gltf", g.text()).error("b.gltf").contains("not valid glTF JSON"));

    // Plain plastic replaces a missing picture; values beyond 0 … 1 are clamped.
    let extension = json!({"diffuseFactor": [1, 1, 1, 1], "specularFactor": [7, 7, 7], "glossinessFactor": -2, "specularGlossinessTexture": {"index": 0}});
    let mut g = document(&extension, &picture);
    g.json["images"] = json!([{"uri": "missing.png"}]);
    g.json["materials"][0]["extensions"]["KHR_materials_ior"] = json!({"ior": 2.0});
    let options = ImportOptions { allow_missing_textures: true, ..ImportOptions::default() };
    let imported = folder.write("c.gltf", g.text()).load_with("c.gltf", &options).unwrap();
    let p = principled(&imported.scene.materials[0].bsdf);
    assert!((p.ior - 1.5).abs() < 1e-5 && p.roughness.factor == 1.0, "{p:?}");
    assert!(warnings(&imported).contains("KHR_materials_ior and KHR_materials_specular have no effect"));
}

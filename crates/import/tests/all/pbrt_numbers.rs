//! Pictures in pbrt's number parameters.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{Vec2, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, ScalarParam, Scene};

/// `leaf` is white, about half of it cut out; `colour` is opaque.
const TEXTURES: &str = "Texture \"leaf\" \"spectrum\" \"imagemap\" \"string filename\" \"leaf.png\"\n\
    Texture \"leaf\" \"float\" \"imagemap\" \"string filename\" \"leaf.png\"\n\
    Texture \"colour\" \"float\" \"imagemap\" \"string filename\" \"colour.png\"\n";

/// Opaque share of the leaf.
const LEAF: f32 = 128.0 / 255.0;

fn load(body: &str) -> Imported {
    let folder = Folder::new();
    folder.write("leaf.png", png(2, 2, [255, 255, 255, 128])).write("colour.png", png(2, 2, [200, 100, 50, 255]));
    let begin = "Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n";
    let imported = folder.write("a.pbrt", format!("{begin}{TEXTURES}{body}")).load("a.pbrt").unwrap_or_else(|e| panic!("{e}"));
    assert!(imported.report.warnings.is_empty(), "{}", warnings(&imported));
    imported
}

fn value(scene: &Scene, number: &ScalarParam) -> f32 {
    let (texture, channel) = number.texture.expect("a texture");
    let (color, alpha) = scene.images[texture.image as usize].sample(&texture, Vec2::splat(0.5));
    number.factor * [color.r, color.g, color.b, alpha][usize::from(channel)]
}

/// The opacity of a sphere of `material` whose mask is the texture `mask`, which `definition` may define.
fn opacity(material: &str, definition: &str, mask: &str) -> f32 {
    let scene = load(&format!("Material \"{material}\"\n{definition}\nShape \"sphere\" \"texture alpha\" \"{mask}\"")).scene;
    match &scene.materials[0].alpha {
        Alpha::Blend { opacity } | Alpha::Mask { opacity, .. } => value(&scene, opacity),
        Alpha::Opaque => 1.0,
    }
}

fn assert_near(found: f32, expected: f32, what: &str) {
    assert!((found - expected).abs() < 1e-5, "{what}: found {found}, expected {expected}");
}

#[test]
fn numbers_of_version_4_are_alpha_or_the_mean_of_the_channels() {
    assert_near(opacity("diffuse", "", "leaf"), LEAF, "alpha");
    let linear = [200, 100, 50].map(|v| linear_from_srgb(v as f32 / 255.0));
    assert_near(opacity("diffuse", "", "colour"), linear.iter().sum::<f32>() / 3.0, "mean");
    let plain = "Texture \"plain\" \"float\" \"imagemap\" \"string filename\" \"colour.png\" \"string encoding\" \"linear\"";
    assert_near(opacity("diffuse", plain, "plain"), 350.0 / 3.0 / 255.0, "mean of linear channels");
}

/// pbrt-v3 drops alpha as it reads, and takes the luminance before it undoes the encoding.
#[test]
fn numbers_of_version_3_are_luminance() {
    assert_near(opacity("matte", "", "leaf"), 1.0, "white");
    assert_near(opacity("matte", "", "colour"), linear_from_srgb((0.2126 * 200.0 + 0.7152 * 100.0 + 0.0722 * 50.0) / 255.0), "luminance");
    let plain = "Texture \"plain\" \"float\" \"imagemap\" \"string filename\" \"colour.png\" \"bool gamma\" \"false\"";
    assert_near(opacity("matte", plain, "plain"), 117.65 / 255.0, "luminance of linear channels");
}

#[test]
fn textures_made_of_alpha_keep_to_it() {
    for (made, expected) in [
        ("\"imagemap\" \"string filename\" \"leaf.png\" \"bool invert\" true \"float scale\" .5", 1.0 - 0.5 * LEAF),
        // The float texture of the name, not the one of colours, which is defined too.
        ("\"scale\" \"texture tex\" \"leaf\" \"float scale\" .5", 0.5 * LEAF),
        ("\"mix\" \"texture tex1\" \"leaf\" \"float tex2\" 1 \"float amount\" .25", 0.75 * LEAF + 0.25),
    ] {
        assert_near(opacity("diffuse", &format!("Texture \"made\" \"float\" {made}"), "made"), expected, made);
    }
    let scene = load("Material \"conductor\" \"texture roughness\" \"leaf\"\nShape \"sphere\"").scene;
    let Bsdf::Conductor { alpha, .. } = &scene.materials[0].bsdf else { panic!("no metal") };
    assert_near(value(&scene, alpha), LEAF.sqrt(), "remapped roughness");
}

#[test]
fn a_number_that_scales_a_colour_is_a_grey() {
    let scale = "Texture \"dim\" \"spectrum\" \"scale\" \"rgb tex\" [.5 .25 1] \"texture scale\" \"leaf\"";
    let scene = load(&format!("{scale}\nMaterial \"diffuse\" \"texture reflectance\" \"dim\"\nShape \"sphere\"")).scene;
    let Bsdf::Diffuse { reflectance } = &scene.materials[0].bsdf else { panic!("not diffuse") };
    let texture = reflectance.texture.unwrap();
    let found = reflectance.factor * scene.images[texture.image as usize].sample(&texture, Vec2::splat(0.5)).0;
    for (found, expected) in found.to_array().into_iter().zip([0.5, 0.25, 1.0]) {
        assert_near(found, expected * LEAF, "reflectance");
    }
}

//! Pictures in Mitsuba's number parameters, and replacements of textures that cannot be kept.

use crate::common::{Folder, png, warnings};
use enfilade_import::Imported;
use enfilade_math::{Rgb, Vec2, linear_from_srgb};
use enfilade_scene::{Alpha, Bsdf, Light};

fn load(folder: &Folder, version: &str, body: &str) -> Imported {
    folder.write("a.xml", format!("<scene version=\"{version}\">{body}</scene>")).load("a.xml").unwrap_or_else(|e| panic!("{e}"))
}

fn bitmap(name: &str, more: &str) -> String {
    format!(r#"<texture type="bitmap" name="{name}"><string name="filename" value="a.png"/>{more}</texture>"#)
}

/// The opacity of a mask by a picture of this one colour, and what was reported.
fn opacity(version: &str, pixel: [u8; 4], more: &str) -> (f32, String) {
    let folder = Folder::new();
    folder.write("a.png", png(2, 2, pixel));
    let mask = format!(r#"<bsdf type="mask">{}<bsdf type="diffuse"/></bsdf>"#, bitmap("opacity", more));
    let imported = load(&folder, version, &format!(r#"<shape type="sphere">{mask}</shape>"#));
    let Alpha::Blend { opacity } = imported.scene.materials[0].alpha else { panic!("no mask") };
    let (texture, channel) = opacity.texture.expect("a picture");
    let (color, alpha) = imported.scene.images[texture.image as usize].sample(&texture, Vec2::splat(0.5));
    let value = if channel == 3 { alpha } else { color[usize::from(channel)] };
    (opacity.factor * value, warnings(&imported))
}

#[test]
fn masks_are_the_colours_of_a_picture() {
    let near = |found: f32, expected: f32| assert!((found - expected).abs() < 4e-3, "{found} instead of {expected}");
    let linear = |v: u8| linear_from_srgb(f32::from(v) / 255.0);
    for version in ["0.6.0", "3.0.0"] {
        let (found, told) = opacity(version, [100, 100, 100, 250], "");
        near(found, linear(100));
        assert!(told.is_empty(), "{told}");
        near(opacity(version, [100, 100, 100, 77], r#"<string name="channel" value="a"/>"#).0, 77.0 / 255.0);
    }
    let leaf = [10, 200, 30, 77];
    let rgb = Rgb::new(linear(10), linear(200), linear(30));
    near(opacity("0.6.0", leaf, "").0, 77.0 / 255.0);
    let (found, told) = opacity("3.0.0", leaf, "");
    near(found, rgb.luminance());
    assert!(told.contains("alpha cuts something out"), "{told}");
    near(opacity("3.0.0", [10, 200, 30, 255], "").0, rgb.luminance());
    near(opacity("0.6.0", [10, 200, 30, 255], "").0, (rgb.r + rgb.g + rgb.b) / 3.0);
    near(opacity("3.0.0", [10, 200, 30, 255], r#"<boolean name="raw" value="true"/>"#).0, Rgb::new(10.0, 200.0, 30.0).luminance() / 255.0);
}

#[test]
fn a_spot_that_projects_a_picture_has_its_mean() {
    let folder = Folder::new();
    folder.write("a.png", png(2, 2, [255, 0, 255, 255]));
    let spot = |texture: &str| format!(r#"<emitter type="spot"><rgb name="intensity" value="4 2 1"/>{texture}</emitter>"#);
    let imported = load(&folder, "3.0.0", &format!(r#"<shape type="sphere"/>{}"#, spot(&bitmap("texture", ""))));
    assert!(matches!(imported.scene.lights[0], Light::Spot { intensity, .. } if intensity == Rgb::new(4.0, 0.0, 1.0)));
    assert!(warnings(&imported).contains("its mean colour was used"));
}

#[test]
fn attributes_of_meshes_are_their_means() {
    let folder = Folder::new();
    let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let faces = "element face 1\nproperty list uchar int vertex_indices\n";
    let colors = "property float color_0\nproperty float color_1\nproperty float color_2\n";
    let header = format!("ply\nformat ascii 1.0\n{vertices}{colors}{faces}property float weight_0\nend_header\n");
    folder.write("one.ply", format!("{header}0 0 0 1 0 0\n1 0 0 0 .5 0\n0 1 0 .5 .25 0\n3 0 1 2 .25\n"));
    folder.write("two.ply", format!("{header}0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 .25\n"));
    let bytes = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let header = format!("ply\nformat ascii 1.0\n{vertices}{bytes}{faces}end_header\n");
    folder.write("bytes.ply", format!("{header}0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n"));
    let paint = |name: &str| {
        format!(
            r#"<bsdf type="diffuse" id="{name}"><texture type="mesh_attribute" name="reflectance">
            <string name="name" value="{name}"/><float name="scale" value="0.5"/></texture></bsdf>"#
        )
    };
    let shape =
        |file: &str, name: &str| format!(r#"<shape type="ply"><string name="filename" value="{file}.ply"/><ref id="{name}"/></shape>"#);
    let body = [
        paint("vertex_color") + &paint("face_weight") + &paint("face_heat"),
        shape("one", "vertex_color") + &shape("two", "vertex_color") + &shape("one", "face_weight"),
        shape("bytes", "vertex_color") + &shape("one", "face_heat"),
    ];
    let imported = load(&folder, "3.0.0", &body.concat());
    let reflectance = |i: usize| match &imported.scene.materials[imported.scene.parts[i].material as usize].bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.factor,
        other => panic!("not diffuse: {other:?}"),
    };
    let expected = [Rgb::new(0.25, 0.125, 0.0), Rgb::new(0.0, 0.0, 0.5), Rgb::splat(0.125), Rgb::new(0.5, 0.0, 0.0), Rgb::splat(0.5)];
    for (i, expected) in expected.into_iter().enumerate() {
        let found = reflectance(i);
        assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 1e-6), "{i}: {found:?} instead of {expected:?}");
    }
    let told = warnings(&imported);
    assert!(told.contains("the mean of vertex_color was used") && told.contains("the mesh has no attribute face_heat"), "{told}");
    assert!(!told.contains("dropped"), "{told}");
}

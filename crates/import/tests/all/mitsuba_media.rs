//! Absorption by media within glass, as the plugin `homogeneous` of Mitsuba documents its parameters: σa = σt · (1 − albedo), in inverse
//! units of the scene, times `scale`.

use crate::common::{Folder, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::Rgb;
use enfilade_scene::Bsdf;

const GLASS: &str = r#"<bsdf type="dielectric"/>"#;

fn load(version: &str, body: &str, meters_per_unit: f64) -> Imported {
    let folder = Folder::new();
    folder.write("a.xml", format!("<scene version=\"{version}\">{body}</scene>"));
    let options = ImportOptions { meters_per_unit, ..ImportOptions::default() };
    folder.load_with("a.xml", &options).unwrap_or_else(|e| panic!("{e}"))
}

fn sphere(version: &str, medium: &str) -> (Rgb, String) {
    let body = format!("<shape type=\"sphere\">{GLASS}<medium name=\"interior\" type=\"homogeneous\">{medium}</medium></shape>");
    let imported = load(version, &body, 1.0);
    (absorption(&imported, 0), warnings(&imported))
}

fn absorption(imported: &Imported, part: usize) -> Rgb {
    match &imported.scene.materials[imported.scene.parts[part].material as usize].bsdf {
        Bsdf::Dielectric { absorption, .. } => *absorption,
        other => panic!("no glass: {other:?}"),
    }
}

fn close(found: Rgb, expected: [f32; 3]) -> bool {
    found.to_array().iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-5 * b.max(1.0))
}

#[test]
fn what_does_not_scatter_is_absorption_without_a_warning() {
    let extinction = r#"<rgb name="sigma_t" value="0.5, 0.25, 0.8"/><float name="albedo" value="0"/>"#;
    for (version, medium, expected) in [
        ("3.0.0", extinction.to_string(), [0.5, 0.25, 0.8]),
        ("3.0.0", format!("{extinction}<float name=\"scale\" value=\"100\"/><phase type=\"hg\"/>"), [50.0, 25.0, 80.0]),
        ("3.5.0", r#"<volume name="albedo" type="constvolume"><float name="value" value="0"/></volume>"#.into(), [1.0; 3]),
        ("2.1.0", r#"<spectrum name="sigma_t" value="4"/><spectrum name="albedo" value="0"/>"#.into(), [4.0; 3]),
        ("3.0.0", r#"<rgb name="sigma_a" value="1 2 3"/>"#.into(), [1.0, 2.0, 3.0]),
        (
            "0.6.0",
            r#"<rgb name="sigmaA" value="1 2 3"/><spectrum name="sigmaS" value="0"/><float name="scale" value="10"/>"#.into(),
            [10.0, 20.0, 30.0],
        ),
        (
            "0.5.0",
            r#"<rgb name="sigmaT" value="1 2 3"/><spectrum name="albedo" value="0"/><string name="strategy" value="single"/>"#.into(),
            [1.0, 2.0, 3.0],
        ),
    ] {
        let (found, told) = sphere(version, &medium);
        assert!(close(found, expected) && told.is_empty(), "{version} {medium}: {found:?} {told}");
    }
}

#[test]
fn scattering_is_dropped_with_a_warning_and_absorption_stays() {
    for (version, medium, expected) in [
        // The defaults of versions 2 and 3: σt 1, albedo 0.75.
        ("3.0.0", "", [0.25; 3]),
        ("3.0.0", r#"<float name="sigma_t" value="8"/><rgb name="albedo" value="0.5 0.25 0"/>"#, [4.0, 6.0, 8.0]),
        ("0.6.0", r#"<spectrum name="sigmaA" value="3"/><spectrum name="sigmaS" value="7"/>"#, [3.0; 3]),
        // Of the preset Skin1: σs (0.74, 0.88, 1.01) and σa (0.032, 0.17, 0.48) per millimetre, times 100.
        ("0.6.0", r#"<spectrum name="sigmaS" value="7"/>"#, [3.2, 17.0, 48.0]),
        ("0.6.0", r#"<spectrum name="sigmaA" value="7"/>"#, [7.0; 3]),
        ("0.6.0", r#"<spectrum name="albedo" value="0.5"/>"#, [38.6, 52.5, 74.5]),
    ] {
        let (found, told) = sphere(version, medium);
        assert!(close(found, expected), "{version} {medium}: {found:?}");
        assert!(told.contains("scattering within media is not supported; only absorption was kept"), "{told}");
    }
}

#[test]
fn media_that_cannot_be_kept_are_told() {
    for (medium, said) in [
        (r#"<string name="material" value="Merlot"/>"#, "by the name of a substance (\"Merlot\") are not supported"),
        ("", "by the name of a substance (\"Skin1\") are not supported"),
        (r#"<volume name="albedo" type="gridvolume"/>"#, "only constant coefficients of media are supported"),
    ] {
        let (found, told) = sphere("0.6.0", medium);
        assert!(found == Rgb::BLACK && told.contains(said), "{told}");
    }
    let sigma = r#"<float name="sigma_t" value="2"/><float name="albedo" value="0"/>"#;
    let told = |body: &str| warnings(&load("3.0.0", body, 1.0));
    let smoke = told(&format!(r#"<shape type="cube">{GLASS}<medium name="interior" type="heterogeneous">{sigma}</medium></shape>"#));
    assert!(smoke.contains("heterogeneous media are not supported, only homogeneous ones"), "{smoke}");
    let outside = told(&format!(r#"<shape type="cube">{GLASS}<medium name="exterior" type="homogeneous">{sigma}</medium></shape>"#));
    assert!(outside.contains("media outside of shapes are not supported"), "{outside}");
    for bsdf in ["diffuse", "thindielectric"] {
        let wood = told(&format!(
            r#"<shape type="cube"><bsdf type="{bsdf}"/><medium name="interior" type="homogeneous">{sigma}</medium></shape>"#
        ));
        assert!(wood.contains("media are supported only within dielectric and roughdielectric bsdfs"), "{wood}");
    }
    let fog = told(&format!(
        r#"<medium type="homogeneous" id="fog">{sigma}</medium><sensor type="perspective"><ref id="fog"/></sensor><shape type="cube"/>"#
    ));
    assert!(fog.contains("media outside of shapes are not supported"), "{fog}");
}

#[test]
fn one_bsdf_may_have_several_media_and_one_medium_several_bsdfs() {
    let medium = |id: &str, sigma: f32| {
        format!(r#"<medium type="homogeneous" id="{id}"><float name="sigma_t" value="{sigma}"/><float name="albedo" value="0"/></medium>"#)
    };
    let shape = |bsdf: &str, inside: &str| format!(r#"<shape type="sphere"><ref id="{bsdf}"/>{inside}</shape>"#);
    let inside = |id: &str| format!(r#"<ref name="interior" id="{id}"/>"#);
    let body = [
        medium("wine", 3.0),
        medium("water", 0.5),
        r#"<bsdf type="dielectric" id="clear"/><bsdf type="roughdielectric" id="frosted"/>"#.into(),
        shape("clear", &inside("wine")),
        shape("clear", &inside("water")),
        shape("clear", ""),
        shape("frosted", &inside("wine")),
    ];
    // In a file in centimetres, 3 per centimetre is 300 per metre.
    let imported = load("3.0.0", &body.concat(), 0.01);
    for (part, expected) in [300.0, 50.0, 0.0, 300.0].into_iter().enumerate() {
        assert!(close(absorption(&imported, part), [expected; 3]), "{part}: {:?}", absorption(&imported, part));
    }
    assert_eq!(warnings(&imported), "");
}

#[test]
fn meshes_of_an_obj_file_are_filled_too() {
    let folder = Folder::new();
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    let medium =
        r#"<medium name="interior" type="homogeneous"><spectrum name="sigmaT" value="6"/><spectrum name="albedo" value="0"/></medium>"#;
    for version in ["0.6.0", "3.0.0"] {
        let shape = format!(r#"<shape type="obj"><string name="filename" value="a.obj"/>{GLASS}{medium}</shape>"#);
        folder.write("a.xml", format!("<scene version=\"{version}\">{shape}</scene>"));
        let imported = folder.load("a.xml").unwrap_or_else(|e| panic!("{e}"));
        assert!(close(absorption(&imported, 0), [6.0; 3]), "{version}");
    }
}

#[test]
fn impossible_coefficients_are_errors_with_their_place() {
    for (medium, said) in [
        (r#"<float name="albedo" value="1.5"/>"#, "found 1.5, expected numbers from 0 to 1"),
        (r#"<rgb name="sigma_t" value="1 -2 3"/>"#, "found -2, expected numbers from 0 on"),
        (r#"<float name="scale" value="-1"/>"#, "found the scale -1, expected a number from 0 on"),
    ] {
        let folder = Folder::new();
        let shape = format!("<shape type=\"sphere\">{GLASS}<medium name=\"interior\" type=\"homogeneous\">{medium}</medium></shape>");
        folder.write("a.xml", format!("<scene version=\"3.0.0\">{shape}</scene>"));
        let error = folder.load("a.xml").err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains(said) && error.contains("a.xml") && error.contains("line 1"), "{error}");
    }
}

//! Spectra of light in Mitsuba files have the colours that Mitsuba has for them, by version.

use crate::common::{Folder, warnings};
use enfilade_import::Imported;
use enfilade_math::Rgb;
use enfilade_scene::{Bsdf, Environment, Light};

/// Mitsuba 3.9.1's colour of a constant spectrum of 1 in its RGB variants.
const EQUAL_ENERGY: [f32; 3] = [1.20479, 0.948291, 0.908916];

fn load(version: &str, body: &str) -> Imported {
    let folder = Folder::new();
    folder.write("lamp.spd", "# nm, value\n400 1\n450 3\n500 2\n550 1\n600 4\n650 2\n700 1\n");
    folder.write("a.xml", format!("<scene version=\"{version}\">{body}</scene>")).load("a.xml").unwrap_or_else(|e| panic!("{e}"))
}

/// The radiance of an area light.
fn radiance(version: &str, spectrum: &str) -> Rgb {
    let imported = load(version, &format!(r#"<shape type="cube"><emitter type="area">{spectrum}</emitter></shape>"#));
    assert!(imported.report.warnings.is_empty(), "{spectrum}: {}", warnings(&imported));
    imported.scene.materials[0].emission.factor
}

/// Fails where a channel is off by more than this share of the largest one.
fn assert_near(found: Rgb, expected: [f32; 3], share: f32, what: &str) {
    let off = [found.r - expected[0], found.g - expected[1], found.b - expected[2]];
    let largest = expected.iter().fold(0.0f32, |most, v| most.max(*v));
    assert!(off.iter().all(|off| off.abs() <= share * largest), "{what}: found {found:?}, expected {expected:?}");
}

#[test]
fn constant_light_is_of_equal_energy_from_version_2_on_and_white_before() {
    let constant = r#"<spectrum name="radiance" value="10"/>"#;
    for version in ["2.0.0", "2.2.1", "3.0.0", "3.9.1"] {
        assert_near(radiance(version, constant), EQUAL_ENERGY.map(|v| 10.0 * v), 5e-4, version);
    }
    for version in ["0.4.0", "0.5.0", "0.6.0"] {
        assert_eq!(radiance(version, constant), Rgb::splat(10.0), "{version}");
    }
}

#[test]
fn every_emitter_has_the_colour_of_its_constant_spectrum() {
    let body = r#"<shape type="cube"/>
        <emitter type="point"><spectrum name="intensity" value="2"/></emitter>
        <emitter type="spot"><spectrum name="intensity" value="2"/></emitter>
        <emitter type="directional"><spectrum name="irradiance" value="2"/></emitter>
        <emitter type="constant"><spectrum name="radiance" value="2"/></emitter>"#;
    let strengths = |version: &str| {
        let scene = load(version, body).scene;
        let Some(Environment::Constant { radiance }) = scene.environment else { panic!("no surroundings") };
        let of = |light: &Light| match light {
            Light::Point { intensity, .. } | Light::Spot { intensity, .. } => *intensity,
            Light::Directional { irradiance, .. } => *irradiance,
            other => panic!("{other:?}"),
        };
        scene.lights.iter().map(of).chain([radiance]).collect::<Vec<Rgb>>()
    };
    let found = strengths("3.0.0");
    assert_eq!(found.len(), 4);
    found.into_iter().for_each(|light| assert_near(light, EQUAL_ENERGY.map(|v| 2.0 * v), 5e-4, "version 3"));
    assert_eq!(strengths("0.6.0"), vec![Rgb::splat(2.0); 4]);
}

#[test]
fn numbers_and_colours_of_light_stay_as_they_are() {
    for light in [
        r#"<float name="radiance" value="10"/>"#,
        r#"<rgb name="radiance" value="10"/>"#,
        r#"<rgb name="radiance" value="10 10 10"/>"#,
        // Mitsuba's RGB variants take it for white.
        r#"<spectrum type="uniform" name="radiance"><float name="value" value="10"/></spectrum>"#,
        r#"<spectrum type="d65" name="radiance"><float name="scale" value="10"/></spectrum>"#,
        // Relative to daylight, so grey.
        r#"<spectrum type="d65" name="radiance"><spectrum name="color" value="10"/></spectrum>"#,
    ] {
        assert_eq!(radiance("3.0.0", light), Rgb::splat(10.0), "{light}");
    }
    assert_eq!(radiance("3.0.0", ""), Rgb::WHITE);
}

#[test]
fn constant_reflectances_and_indices_are_grey_in_all_versions() {
    for version in ["0.6.0", "2.0.0", "3.0.0"] {
        let bsdf = |text: &str| load(version, &format!(r#"<shape type="cube">{text}</shape>"#)).scene.materials[0].bsdf.clone();
        let diffuse = bsdf(r#"<bsdf type="diffuse"><spectrum name="reflectance" value="0.5"/></bsdf>"#);
        assert_eq!(diffuse, Bsdf::Diffuse { reflectance: Rgb::splat(0.5).into() });
        let metal = bsdf(r#"<bsdf type="conductor"><spectrum name="eta" value="1.5"/><spectrum name="k" value="2"/></bsdf>"#);
        let Bsdf::Conductor { eta, k, .. } = metal else { panic!("{metal:?}") };
        assert!(eta.r == eta.g && eta.g == eta.b && k.r == k.g && k.g == k.b, "{eta:?} {k:?}");
        // A texture's colours are none of light, even where it shines.
        let checks = r#"<texture type="checkerboard" name="radiance"><spectrum name="color0" value="3"/></texture>"#;
        let lamp = load(version, &format!(r#"<shape type="cube"><emitter type="area">{checks}</emitter></shape>"#));
        assert_eq!(lamp.scene.images[0].texel(0, 0).0, Rgb::splat(3.0));
    }
}

#[test]
fn lists_of_wavelengths_give_the_light_that_mitsuba_3_has() {
    // Mitsuba 3.9.1, scalar_rgb; its matching functions are tables, ours a fit of them.
    let known = [
        (r#"value="360:10, 830:10""#, [12.0488, 9.48228, 9.09267]),
        (r#"value="400:10, 700:10""#, [11.9969, 9.4952, 9.03443]),
        (r#"value="400:0.1, 700:0.2""#, [0.214, 0.140424, 0.101714]),
        (r#"value="600:1, 700:1""#, [0.968726, 0.0, 0.0]),
        (r#"value="500:1, 560:1""#, [0.0, 0.714726, 0.0]),
        (r#"value="420:1, 480:1""#, [0.0338116, 0.0, 0.862734]),
        (r#"value="400:1, 450:3, 500:2, 550:1, 600:4, 650:2, 700:1""#, [4.14909, 1.57859, 2.31614]),
        (r#"filename="lamp.spd""#, [4.14909, 1.57859, 2.31614]),
    ];
    for (spectrum, expected) in known {
        for version in ["2.0.0", "3.0.0"] {
            assert_near(radiance(version, &format!(r#"<spectrum name="radiance" {spectrum}/>"#)), expected, 0.012, spectrum);
        }
    }
}

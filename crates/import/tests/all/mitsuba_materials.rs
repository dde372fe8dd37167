//! Mitsuba's defaults by version, and parameters that may be textures or names.

use crate::common::{Folder, png, warnings};
use enfilade_math::{Rgb, linear_from_srgb};
use enfilade_scene::{Bsdf, Disney};

/// The bsdf of a sphere in a file of this version, and what was reported. `grey.png` may be referred to.
fn bsdf(version: &str, text: &str) -> (Bsdf, String) {
    let folder = Folder::new();
    folder.write("grey.png", png(2, 2, [9, 9, 9, 255]));
    let text = format!("<scene version=\"{version}\"><shape type=\"sphere\">{text}</shape></scene>");
    let imported = folder.write("a.xml", text).load("a.xml").unwrap_or_else(|e| panic!("{e}"));
    (imported.scene.materials[0].bsdf.clone(), warnings(&imported))
}

fn conductor(version: &str, properties: &str) -> (Rgb, Rgb) {
    match bsdf(version, &format!("<bsdf type=\"conductor\">{properties}</bsdf>")).0 {
        Bsdf::Conductor { eta, k, .. } => (eta, k),
        other => panic!("no metal: {other:?}"),
    }
}

fn principled(properties: &str) -> (Disney, String) {
    let (bsdf, told) = bsdf("3.0.0", &format!("<bsdf type=\"principled\">{properties}</bsdf>"));
    match bsdf {
        Bsdf::Disney(p) => (*p, told),
        other => panic!("not principled: {other:?}"),
    }
}

fn texture(name: &str) -> String {
    format!("<texture type=\"bitmap\" name=\"{name}\"><string name=\"filename\" value=\"grey.png\"/></texture>")
}

#[test]
fn hexadecimal_colours_are_encoded_in_srgb_alone() {
    for (tag, expected) in [("rgb", 128.0 / 255.0), ("srgb", linear_from_srgb(128.0 / 255.0))] {
        let text = format!(r##"<bsdf type="diffuse"><{tag} name="reflectance" value="#808080"/></bsdf>"##);
        assert_eq!(bsdf("0.6.0", &text).0, Bsdf::Diffuse { reflectance: Rgb::splat(expected).into() }, "{tag}");
    }
}

#[test]
fn conductors_without_a_material_are_copper_in_version_0_and_mirrors_since() {
    let copper = (Rgb::new(0.2004, 0.924, 1.1022), Rgb::new(3.9129, 2.4529, 2.1422));
    assert_eq!(conductor("0.6.0", ""), copper);
    let (eta, k) = (r#"<rgb name="eta" value="2"/>"#, r#"<rgb name="k" value="3"/>"#);
    assert_eq!(conductor("0.6.0", eta), (Rgb::splat(2.0), copper.1));
    for version in ["2.0.0", "3.5.0"] {
        // Both 0 is the renderer's perfect mirror.
        assert_eq!(conductor(version, ""), (Rgb::BLACK, Rgb::BLACK), "{version}");
        assert_eq!(conductor(version, eta), (Rgb::splat(2.0), Rgb::WHITE), "{version}");
        assert_eq!(conductor(version, k), (Rgb::BLACK, Rgb::splat(3.0)), "{version}");
        assert_eq!(conductor(version, r#"<string name="material" value="Cu"/>"#), copper, "{version}");
    }
}

#[test]
fn metals_may_lie_in_a_substance_by_its_name() {
    let metal = |outside: &str| conductor("0.6.0", &format!(r#"<rgb name="eta" value="2"/><rgb name="k" value="4"/>{outside}"#));
    let near = |found: f32, expected: f32| (found - expected).abs() < 1e-6;
    let (eta, k) = metal(r#"<string name="extEta" value="water"/>"#);
    assert!(near(eta.g, 2.0 / 1.333) && near(k.g, 4.0 / 1.333), "{eta:?} {k:?}");
    let (eta, k) = metal(r#"<string name="extEta" value="air"/>"#);
    assert!(near(eta.g, 2.0 / 1.000_277) && near(k.g, 4.0 / 1.000_277), "{eta:?} {k:?}");
    assert_eq!(metal(r#"<float name="ext_eta" value="2"/>"#), (Rgb::WHITE, Rgb::splat(2.0)));
    assert_eq!(metal(""), (Rgb::splat(2.0), Rgb::splat(4.0)));
}

#[test]
fn substances_have_the_indices_of_mitsubas_table() {
    let table = [("Helium", 1.000_036), ("carbon tetrachloride", 1.461), ("silicone oil", 1.520_45), ("sodium chloride", 1.544)];
    for (name, expected) in table {
        let glass = format!(r#"<string name="intIOR" value="{name}"/><string name="extIOR" value="vacuum"/>"#);
        let (found, _) = bsdf("0.6.0", &format!("<bsdf type=\"dielectric\">{glass}</bsdf>"));
        assert!(matches!(found, Bsdf::Dielectric { eta, .. } if eta == expected), "{name}: {found:?}");
    }
}

#[test]
fn phong_without_an_exponent_has_one_of_thirty() {
    let alpha = |properties: &str| match bsdf("0.6.0", &format!("<bsdf type=\"phong\">{properties}</bsdf>")).0 {
        Bsdf::Plastic { alpha, .. } => alpha.factor,
        other => panic!("not plastic: {other:?}"),
    };
    assert_eq!((alpha(""), alpha(r#"<float name="exponent" value="30"/>"#)), (0.25, 0.25));
    assert!((alpha(r#"<float name="exponent" value="198"/>"#) - 0.1).abs() < 1e-6);
}

#[test]
fn principled_textures_are_read_or_reported() {
    for (name, of) in [("clearcoat", 7), ("sheen", 4), ("sheen_tint", 5), ("clearcoat_gloss", 8), ("spec_tint", 3), ("flatness", 6)] {
        let (p, told) = principled(&texture(name));
        assert!(p.scalars()[of].factor == 1.0 && p.scalars()[of].texture.is_some() && told.is_empty(), "{name}: {told}");
    }
    let grey = linear_from_srgb(9.0 / 255.0);
    for name in ["specular", "eta"] {
        let (p, told) = principled(&texture(name));
        assert!(told.contains(&format!("a texture of {name} in principled is not supported; its mean was used")), "{told}");
        assert_eq!(p, principled(&format!("<float name=\"{name}\" value=\"{grey}\"/>")).0, "{name}");
    }
    let (_, told) = bsdf("0.6.0", &format!("<bsdf type=\"phong\">{}</bsdf>", texture("exponent")));
    assert!(told.contains("a texture of exponent in phong"), "{told}");
}

/// Mitsuba 3.9.1: 2 / (1 − √(0.08 specular)) − 1, 1.5 by default.
#[test]
fn principled_bsdfs_have_mitsubas_parameters_and_defaults() {
    let (p, told) = principled("");
    let numbers = |p: &Disney| p.scalars().map(|number| number.factor);
    assert_eq!(numbers(&p), [0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "{told}");
    assert!((p.eta - 1.5).abs() < 1e-6 && p.base_color == Rgb::splat(0.5).into() && !p.thin && told.is_empty(), "{told}");
    let eta = |text: &str| principled(text).0.eta;
    assert!((eta(r#"<float name="specular" value="1"/>"#) - 1.788_85).abs() < 1e-4);
    assert_eq!(eta(r#"<float name="specular" value="0"/>"#), 1.0);
    assert!(eta(r#"<float name="specular" value="0"/><float name="spec_trans" value="0.5"/>"#) > 1.0);
    assert_eq!(eta(r#"<float name="eta" value="1.3"/>"#), 1.3f32);
    let (_, told) = principled(r#"<float name="anisotropic" value="0.5"/>"#);
    assert!(told.contains("anisotropic is not supported in principled"), "{told}");
    let (sheet, told) =
        bsdf("3.0.0", r#"<bsdf type="principledthin"><float name="diff_trans" value="0.6"/><float name="metallic" value="1"/></bsdf>"#);
    let Bsdf::Disney(sheet) = sheet else { panic!("{sheet:?}") };
    assert!(sheet.thin && sheet.eta == 1.5 && sheet.diff_trans.factor == 0.6, "{sheet:?}");
    assert!(told.contains("<float name=\"metallic\">: ignored in principledthin"), "{told}");
}

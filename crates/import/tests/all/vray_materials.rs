//! V-Ray's materials and textures, one small file each.

use crate::common::vray::*;
use crate::common::{Folder, png, warnings};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, NormalMap};

#[test]
fn general_materials_become_what_they_do() {
    let folder = Folder::new();
    let bsdf = |text: &str| material(&folder, &format!("BRDFVRayMtl brdf {{ diffuse=AColor(0.2,0.4,0.6,1); {text} }}\n")).0.bsdf;
    assert_eq!(bsdf(""), Bsdf::Diffuse { reflectance: Rgb::new(0.2, 0.4, 0.6).into() });
    let Bsdf::Principled(p) =
        bsdf("reflect=AColor(0.5,0.5,0.5,1); fresnel=1; fresnel_ior=1.4; fresnel_ior_lock=0; reflect_glossiness=0.7;")
    else {
        panic!("not principled")
    };
    assert!((p.roughness.factor - 0.3).abs() < 1e-6 && p.specular.factor == 0.5 && (p.ior - 1.4).abs() < 1e-6);
    let Bsdf::Principled(p) = bsdf("metalness=1; reflect=AColor(1,1,1,1); reflect_glossiness=0.25; option_use_roughness=1;") else {
        panic!("no metal")
    };
    assert_eq!((p.metallic.factor, p.roughness.factor), (1.0, 0.25));
    let Bsdf::Blend { second, weight, .. } = bsdf("reflect=AColor(0.8,0.4,0.4,1); reflect_glossiness=0.5;") else { panic!("no mirror") };
    let Bsdf::Conductor { reflectance, alpha, .. } = *second else { panic!("no mirror") };
    assert_eq!((weight.factor, reflectance.factor, alpha.factor), (0.8, Rgb::new(1.0, 0.5, 0.5), 0.25));
    let Bsdf::Dielectric { eta, absorption, .. } = bsdf("refract=AColor(1,1,1,1); refract_ior=1.5; fog_color=Color(0.5,1,1); fog_mult=2;")
    else {
        panic!("no glass")
    };
    assert!(eta == 1.5 && near(absorption, Rgb::new(200.0 * std::f32::consts::LN_2, 0.0, 0.0)), "2 per centimetre: {absorption:?}");
    assert!(matches!(bsdf("refract=AColor(1,1,1,1); refract_thin_walled=1;"), Bsdf::ThinDielectric { .. }));
    let Bsdf::Principled(p) = bsdf("refract=AColor(1,1,1,1); refract_thin_walled=1; refract_glossiness=0.4;") else {
        panic!("not frosted")
    };
    assert!((p.roughness.factor - 0.6).abs() < 1e-6 && p.transmission.factor == 1.0 && !p.solid);
    assert!(matches!(bsdf("refract=AColor(0.5,0.5,0.5,1);"), Bsdf::Blend { weight, .. } if weight.factor == 0.5));
    let Bsdf::Principled(p) = bsdf("coat_amount=0.7; coat_glossiness=0.9; sheen_color=AColor(1,0,0,1);") else { panic!("no coat") };
    assert!(
        p.clearcoat.factor == 0.7 && (p.clearcoat_roughness.factor - 0.1).abs() < 1e-6 && p.sheen_color.factor == Rgb::new(1.0, 0.0, 0.0)
    );
    let cut = material(&folder, "BRDFVRayMtl brdf { opacity=0.3; opacity_mode=1; self_illumination=AColor(2,2,2,1); anisotropy=0.5; }\n");
    assert!(matches!(cut.0.alpha, Alpha::Mask { opacity, .. } if opacity.factor == 0.3) && cut.0.emission.factor == Rgb::splat(2.0));
    assert!(cut.1.contains("anisotropy is not supported"), "{}", cut.1);
}

#[test]
fn fog_is_per_centimetre_or_unit_and_thinner_with_depth() {
    let folder = Folder::new();
    let red = |fog: &str| {
        let brdf = format!("BRDFVRayMtl brdf {{ refract=AColor(1,1,1,1); refract_ior=1.5; {fog} }}\n");
        let (m, text) = material(&folder, &brdf);
        let Bsdf::Dielectric { absorption, .. } = m.bsdf else { panic!("no glass: {text}") };
        absorption.r / std::f32::consts::LN_2
    };
    let near = |found: f32, expected: f32| assert!((found / expected - 1.0).abs() < 1e-5, "{found} and not {expected}");
    near(red("fog_color=Color(0.5,1,1); fog_mult=2; fog_depth=4;"), 50.0);
    near(red("fog_color=Color(0.5,1,1); fog_mult=2; fog_depth=4; fog_unit_scale_on=0;"), 0.5);
    near(red("fog_color=Color(1,1,1); fog_color_tex=AColor(0.5,1,1,1);"), 100.0);
    near(red("fog_color=Color(0.5,1,1); fog_color_tex=AColor(0,0,0,0);"), 100.0);
}

#[test]
fn opacity_is_grey_or_coloured_as_its_source_says() {
    let folder = Folder::new();
    for (source, expected) in [("", 0.3), ("opacity_source=0;", 0.3), ("opacity_source=1;", 0.6)] {
        let brdf = format!("BRDFVRayMtl brdf {{ opacity=0.3; opacity_color=AColor(0.6,0.6,0.6,1); {source} }}\n");
        let (m, _) = material(&folder, &brdf);
        assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.factor == expected), "{source} {:?}", m.alpha);
    }
}

#[test]
fn numbers_that_are_textures_are_their_mean_with_a_warning() {
    let folder = Folder::new();
    folder.write("half.png", png(1, 1, [128, 128, 128, 255]));
    for (brdf, parameter) in [
        ("BRDFVRayMtl brdf { refract=AColor(1,1,1,1); refract_ior=t; }", "refract_ior"),
        ("BRDFVRayMtl brdf { reflect=AColor(1,1,1,1); fresnel=1; fresnel_ior_lock=0; fresnel_ior=t; }", "fresnel_ior"),
        ("BRDFVRayMtl brdf { refract=AColor(1,1,1,1); fog_color=Color(0.5,1,1); fog_depth=t; }", "fog_depth"),
        ("BRDFVRayMtl brdf { bump_map=t; bump_amount=t; }", "bump_amount"),
        ("BRDFLight brdf { color=Color(1,1,1); colorMultiplier=t; }", "colorMultiplier"),
        ("BRDFDiffuse brdf { color_tex=u; }\nTexBitmap u { bitmap=b; color_mult=t; }", "color_mult"),
    ] {
        let textures = "TexBitmap t { bitmap=b; }\nBitmapBuffer b { file=\"half.png\"; transfer_function=0; }\n";
        let (_, text) = material(&folder, &format!("{brdf}\n{textures}"));
        assert!(text.contains(&format!("a texture of {parameter} is not supported; its mean")), "{parameter}: {text}");
    }
    let (exact, text) = material(&folder, "BRDFVRayMtl brdf { refract=AColor(1,1,1,1); refract_ior=t; }\nTexFloat t { input=1.4; }\n");
    assert!(matches!(exact.bsdf, Bsdf::Dielectric { eta, .. } if (eta - 1.4).abs() < 1e-6) && !text.contains("refract_ior"), "{text}");
    let brighter = "BRDFDiffuse brdf { color_tex=u; }\nTexBitmap u { bitmap=b; color_offset=t; }\nTexFloat t { input=1; }\n\
        BitmapBuffer b { file=\"half.png\"; }\n";
    let (offset, text) = material(&folder, brighter);
    assert!(matches!(offset.bsdf, Bsdf::Diffuse { .. }) && text.contains("color_offset is not supported"), "{text}");
    let dimmed = material(&folder, "BRDFDiffuse brdf { color=Color(1,0.5,0)*0.5; }\n").0;
    assert_eq!(dimmed.bsdf, Bsdf::Diffuse { reflectance: Rgb::new(0.5, 0.25, 0.0).into() });
}

#[test]
fn coloured_pictures_of_reflection_are_told() {
    let folder = Folder::new();
    folder.write("red.png", png(1, 1, [255, 0, 0, 255]));
    let textures = "TexBitmap t { bitmap=b; }\nBitmapBuffer b { file=\"red.png\"; }\n";
    for (brdf, parameter) in [("reflect=t; fresnel=1;", "reflect"), ("refract=t;", "refract")] {
        let (_, text) = material(&folder, &format!("BRDFVRayMtl brdf {{ {brdf} }}\n{textures}"));
        assert!(text.contains(&format!("the texture of {parameter} is coloured; its red channel was used")), "{text}");
    }
}

#[test]
fn pictures_are_decoded_by_their_transfer_function() {
    const LINEAR: f32 = 188.0 / 255.0;
    const DECODED: f32 = 0.5029;
    let folder = Folder::new();
    for name in ["t.png", "t_srgb.png", "t_lin_srgb.png", "t_raw.png"] {
        folder.write(name, png(1, 1, [188, 188, 188, 255]));
    }
    let mut grey = std::io::Cursor::new(Vec::new());
    image::GrayImage::from_pixel(1, 1, image::Luma([188])).write_to(&mut grey, image::ImageFormat::Png).unwrap();
    folder.write("grey.png", grey.into_inner());
    for (file, parameters, expected) in [
        ("t.png", "transfer_function=0; gamma=0.454545;", LINEAR),
        ("t.png", "transfer_function=1; gamma=0.454545;", DECODED),
        ("t.png", "transfer_function=1; gamma=1;", LINEAR),
        ("t.png", "transfer_function=2; gamma=1;", DECODED),
        ("t.png", "transfer_function=3; gamma=1;", DECODED),
        ("t_srgb.png", "transfer_function=3;", DECODED),
        ("t_lin_srgb.png", "transfer_function=3;", LINEAR),
        ("t_raw.png", "transfer_function=3;", LINEAR),
        ("grey.png", "transfer_function=3;", LINEAR),
        ("t.png", "color_space=2; gamma=1;", DECODED),
        ("t.png", "gamma=0.454545;", DECODED),
        ("t.png", "", LINEAR),
    ] {
        let brdf = format!(
            "BRDFDiffuse brdf {{ color_tex=t; }}\nTexBitmap t {{ bitmap=b; }}\nBitmapBuffer b {{ file=\"{file}\"; {parameters} }}\n"
        );
        let scene = load_text(&folder, &[TRIANGLE, NODE, UNITS, brdf.as_str()].concat()).scene;
        let found = scene.images[0].texel(0, 0).0.r;
        assert!((found - expected).abs() < 1e-3, "{file} {parameters}: {found} and not {expected}");
    }
}

#[test]
fn texture_parameters_override_mayas_placement() {
    let folder = Folder::new();
    folder.write("t.png", png(1, 1, [255, 255, 255, 255]));
    let brdf = "BRDFDiffuse brdf { color_tex=t; }\nTexBitmap t { bitmap=b; uvwgen=uvw; }\nBitmapBuffer b { file=\"t.png\"; }\n\
        UVWGenMayaPlace2dTexture uvw { repeat_u=2; repeat_u_tex=4; offset_v=0.5; offset_v_tex=0; rotate_uv_tex=noise; }\n\
        TexNoiseMax noise {}\n";
    let (m, text) = material(&folder, brdf);
    let Bsdf::Diffuse { reflectance } = &m.bsdf else { panic!("{m:?}") };
    assert_eq!(reflectance.texture.unwrap().uv_transform, [[4.0, 0.0, 0.0], [0.0, 1.0, 0.5]]);
    assert!(text.contains("a texture in rotate_uv_tex is not supported"), "{text}");
}

#[test]
fn simple_brdfs_and_layers() {
    let folder = Folder::new();
    let made = |text: &str| material(&folder, text).0;
    assert!(matches!(made("BRDFDiffuse brdf { color=Color(1,1,1); roughness=0.4; }\n").bsdf, Bsdf::RoughDiffuse { .. }));
    assert!(matches!(made("BRDFMirror brdf { color=Color(1,1,1); }\n").bsdf, Bsdf::Conductor { alpha, .. } if alpha.factor == 0.0));
    assert!(matches!(made("BRDFGlass brdf { ior=1.3; }\n").bsdf, Bsdf::Dielectric { eta, .. } if eta == 1.3));
    let light = made("BRDFLight brdf { color=Color(1,0.5,0); colorMultiplier=4; emitOnBackSide=1; }\n");
    assert!(light.emission.factor == Rgb::new(4.0, 2.0, 0.0) && light.emits_both_sides);
    let layers = "BRDFLayered brdf { base_brdf=base; brdfs=List(top, middle); weights=List(tenth, 0.5); }\nTexAColor tenth { texture=AColor(0.1,0.1,0.1,1); }\n\
        BRDFMirror top {} BRDFGlass middle {} BRDFDiffuse base {}\n";
    let Bsdf::Blend { first, second, weight } = made(layers).bsdf else { panic!("no layers") };
    assert!(matches!(*second, Bsdf::Conductor { .. }) && weight.factor == 0.1, "the first of the list is uppermost");
    let Bsdf::Blend { first, second, weight } = *first else { panic!("no second layer") };
    assert!(matches!(*first, Bsdf::Diffuse { .. }) && matches!(*second, Bsdf::Dielectric { .. }) && weight.factor == 0.5);
    let (m, text) = material(&folder, "BRDFCarPaint2 brdf { base_color=AColor(1,0,0,1); }\n");
    assert!(m.bsdf == Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() } && text.contains("BRDFCarPaint2 is not supported"));
}

#[test]
fn textures_are_followed_to_their_pictures() {
    let folder = Folder::new();
    folder.write("g.png", png(1, 1, [51, 51, 51, 255])).write("n.png", png(1, 1, [128, 128, 255, 255]));
    let buffers = "TexBitmap pic { bitmap=buf; } BitmapBuffer buf { file=\"g.png\"; gamma=1; }\nTexBitmap nor { bitmap=nbuf; } BitmapBuffer nbuf { file=\"n.png\"; gamma=1; }\n";
    let scene = |brdf: &str| load_text(&folder, &[TRIANGLE, NODE, UNITS, buffers, brdf].concat());
    let glossy = scene(
        "BRDFVRayMtl brdf { reflect=AColor(1,1,1,1); fresnel=1; reflect_glossiness=pic::out_intensity; bump_map=bump; }\nTexNormalBump bump { bump_tex_color=nor; bump_tex_mult=0.7; }\n",
    );
    let m = &glossy.scene.materials[0];
    let Bsdf::Principled(p) = &m.bsdf else { panic!("{m:?}") };
    let (texture, channel) = p.roughness.texture.unwrap();
    let roughness = glossy.scene.images[texture.image as usize].texel(0, 0).0[usize::from(channel)];
    assert!((roughness - 0.8).abs() < 2e-3, "roughness is 1 − glossiness, found {roughness}");
    assert!(matches!(m.normal_map, Some(NormalMap::Normal { scale, .. }) if (scale - 0.7).abs() < 1e-6));
    let mixed = scene(
        "BRDFDiffuse brdf { color_tex=mix; }\nTexCombineColor mix { color=Color(1,1,1); texture=AColor(0,0,0,1); texture_multiplier=0.25; }\n",
    );
    assert_eq!(mixed.scene.materials[0].bsdf, Bsdf::Diffuse { reflectance: Rgb::splat(0.75).into() });
    let inverted = scene("BRDFDiffuse brdf { color_tex=inv; }\nTexInvert inv { texture=AColor(0.25,0.5,1,1); }\n");
    assert_eq!(inverted.scene.materials[0].bsdf, Bsdf::Diffuse { reflectance: Rgb::new(0.75, 0.5, 0.0).into() });
    let noise = scene("BRDFDiffuse brdf { color_tex=noise; }\nTexNoiseMax noise { color1=AColor(0.3,0.3,0.3,1); }\n");
    assert!(warnings(&noise).contains("TexNoiseMax is not supported; its color1 was used alone"), "{}", warnings(&noise));
}

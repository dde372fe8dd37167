//! pbrt features of both versions, one small file each, and one room in three descriptions.

use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, Imported};
use enfilade_math::{DVec3, Rgb, Vec2, Vec3};
use enfilade_scene::{Alpha, Bsdf, Environment, Light, NormalMap, Scene, SpotFalloff};
use std::io::Write;

/// A camera that mirrors, so that the world is already right-handed, and the world's beginning.
const BEGIN: &str = "Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n";

fn load(folder: &Folder, body: &str) -> Imported {
    folder.write("a.pbrt", format!("{BEGIN}{body}")).load("a.pbrt").unwrap_or_else(|e| panic!("{e}"))
}

fn bsdf(folder: &Folder, material: &str) -> (Bsdf, String) {
    let imported = load(folder, &format!("{material}\nShape \"sphere\""));
    (imported.scene.materials[0].bsdf.clone(), warnings(&imported))
}

/// World corners of the first triangle of part `i`.
fn corners(scene: &Scene, i: usize) -> [Vec3; 3] {
    scene.world_corners(&scene.parts[i], 0)
}

const TRIANGLE: &str = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]";

#[test]
fn materials_of_version_3() {
    let folder = Folder::new();
    let of = |text: &str| bsdf(&folder, text).0;
    assert_eq!(of("Material \"matte\" \"rgb Kd\" [.5 .1 .2]"), Bsdf::Diffuse { reflectance: Rgb::new(0.5, 0.1, 0.2).into() });
    assert!(matches!(of("Material \"matte\" \"float sigma\" 20"), Bsdf::RoughDiffuse { roughness, .. } if roughness.factor > 0.1));
    assert!(matches!(of("Material \"mirror\""), Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, reflectance, .. }
            if reflectance.factor.r == 0.9));
    let metal = of("Material \"metal\" \"rgb eta\" [1 2 3] \"rgb k\" [4 5 6] \"float roughness\" .2 \"bool remaproughness\" \"false\"");
    assert!(matches!(metal, Bsdf::Conductor { eta, k, alpha, .. } if eta.b == 3.0 && k.r == 4.0 && alpha.factor == 0.2));
    // pbrt-v3's polynomial gives 0.46176 for 0.1.
    let metal = of("Material \"metal\" \"float roughness\" .1 \"bool remaproughness\" \"true\"");
    assert!(matches!(metal, Bsdf::Conductor { alpha, .. } if (alpha.factor - 0.46176).abs() < 1e-4));
    assert!(
        matches!(of("Material \"glass\" \"float index\" 1.33 \"rgb Kt\" [1 .5 1]"), Bsdf::Dielectric { eta: 1.33, alpha, transmittance, .. }
            if alpha.factor == 0.0 && transmittance.factor.g == 0.5)
    );
    // A roughness of 0 gives 0.04725, except for glass, which is smooth then.
    let metal = of("Material \"metal\" \"float roughness\" 0");
    assert!(matches!(metal, Bsdf::Conductor { alpha, .. } if (alpha.factor - 0.04725).abs() < 1e-4));
    let plastic = of("Material \"plastic\" \"float roughness\" 0");
    assert!(matches!(plastic, Bsdf::Principled(p) if (p.roughness.factor * p.roughness.factor - 0.04725).abs() < 1e-4));
    let smooth = of("Material \"glass\" \"float uroughness\" 0 \"float vroughness\" 0");
    assert!(matches!(smooth, Bsdf::Dielectric { alpha, .. } if alpha.factor == 0.0));
    let floor = of("Material \"substrate\" \"rgb Ks\" [.04 .04 .04] \"float uroughness\" .25 \"float vroughness\" .25 \
         \"bool remaproughness\" \"false\"");
    assert!(matches!(floor, Bsdf::Principled(p) if (p.ior - 1.5).abs() < 1e-4 && (p.roughness.factor - 0.5).abs() < 1e-6));
    let imported = load(&folder, "Material \"uber\" \"rgb Ks\" [0 0 0] \"rgb Kd\" [1 1 1] \"rgb opacity\" [.5 .5 .5]\nShape \"sphere\"");
    assert!(matches!(imported.scene.materials[0].alpha, Alpha::Blend { opacity } if opacity.factor == 0.5));
    assert!(matches!(imported.scene.materials[0].bsdf, Bsdf::Diffuse { .. }));
    let both = "MakeNamedMaterial \"a\" \"string type\" \"matte\"\nMakeNamedMaterial \"b\" \"string type\" \"mirror\"\n\
                Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" [.8 .8 .8]";
    // Version 3 states the share of the first.
    assert!(matches!(of(both), Bsdf::Blend { second, weight, .. } if matches!(*second, Bsdf::Diffuse { .. }) && weight.factor == 0.8));
}

#[test]
fn materials_of_version_4() {
    let folder = Folder::new();
    let of = |text: &str| bsdf(&folder, text).0;
    assert_eq!(of("Material \"diffuse\" \"rgb reflectance\" [.5 .1 .2]"), Bsdf::Diffuse { reflectance: Rgb::new(0.5, 0.1, 0.2).into() });
    let metal = of("Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"float roughness\" .25");
    assert!(matches!(metal, Bsdf::Conductor { eta, k, alpha, .. } if eta.b > eta.r && k.r > k.b && alpha.factor == 0.5), "square root");
    let metal = of("Material \"conductor\" \"rgb reflectance\" [.5 .5 .5] \"bool remaproughness\" false \"float roughness\" .3");
    assert!(matches!(metal, Bsdf::Conductor { eta: Rgb::WHITE, k, alpha, .. } if (k.r - 2.0).abs() < 1e-6 && alpha.factor == 0.3));
    assert!(
        matches!(of("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\""), Bsdf::Dielectric { eta, .. } if (eta - 1.5168).abs() < 1e-6)
    );
    assert!(matches!(of("Material \"thindielectric\" \"float eta\" 1.4"), Bsdf::ThinDielectric { eta: 1.4, .. }));
    let coated = of("Material \"coateddiffuse\" \"rgb reflectance\" [.5 .5 .5] \"float roughness\" .04");
    assert!(matches!(coated, Bsdf::Plastic { nonlinear: true, eta: 1.5, alpha, .. } if (alpha.factor - 0.2).abs() < 1e-6));
    assert!(matches!(of("Material \"coatedconductor\" \"rgb reflectance\" [.5 .5 .5]"), Bsdf::Principled(p)
            if p.metallic.factor == 1.0 && p.clearcoat.factor == 1.0));
    let mix = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string type\" \"conductor\"\n\
               Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .8";
    assert!(matches!(of(mix), Bsdf::Blend { second, weight, .. } if matches!(*second, Bsdf::Conductor { .. }) && weight.factor == 0.8));
    let (_, text) = bsdf(&folder, "Material \"diffusetransmission\" \"rgb reflectance\" [.2 .2 .2]");
    assert!(text.contains("diffuse transmission is not supported"), "{text}");
    let wine = "MakeNamedMedium \"wine\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0]\n\
                MediumInterface \"wine\" \"\"\nMaterial \"dielectric\"";
    assert!(matches!(of(wine), Bsdf::Dielectric { absorption, .. } if absorption == Rgb::new(1.0, 2.0, 3.0)));
}

#[test]
fn attributes_of_inner_blocks_stand_above_those_of_outer_ones() {
    let folder = Folder::new();
    let text = "Attribute \"material\" \"rgb reflectance\" [.1 .1 .1]\nAttributeBegin\n\
                Attribute \"material\" \"rgb reflectance\" [.7 .7 .7]\nMaterial \"diffuse\"\nShape \"sphere\"\nAttributeEnd\n\
                Material \"diffuse\"\nShape \"sphere\"\nMaterial \"diffuse\" \"rgb reflectance\" [.4 .4 .4]\nShape \"sphere\"";
    let scene = load(&folder, text).scene;
    let reflectance = |part: usize| match &scene.materials[scene.parts[part].material as usize].bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.factor,
        other => panic!("not diffuse: {other:?}"),
    };
    assert_eq!([0, 1, 2].map(reflectance), [0.7, 0.1, 0.4].map(Rgb::splat));
}

#[test]
fn lights_have_their_places_and_strengths() {
    let folder = Folder::new();
    let lights = "Translate 1 2 3\nLightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 2 \"point3 from\" [0 0 1]\n\
                  LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb L\" [5 5 5]\n\
                  LightSource \"spot\" \"point3 to\" [0 -1 0] \"float coneangle\" 40 \"float conedeltaangle\" 10\n\
                  LightSource \"infinite\" \"rgb L\" [.5 .5 .5]\nMaterial \"diffuse\"\nShape \"sphere\"";
    let scene = load(&folder, lights).scene;
    assert!(matches!(&scene.lights[0], Light::Point { position, intensity, .. }
            if *position == Vec3::new(1.0, -4.0, 2.0) && *intensity == Rgb::new(2.0, 4.0, 6.0)));
    assert!(
        matches!(&scene.lights[1], Light::Directional { direction, irradiance, .. } if *direction == Vec3::NEG_Z && irradiance.g == 5.0)
    );
    assert!(matches!(&scene.lights[2], Light::Spot { direction, outer_rad, inner_rad, falloff, .. }
        if *direction == Vec3::NEG_Z && *falloff == SpotFalloff::SmoothCosine && (outer_rad.to_degrees() - 40.0).abs() < 1e-4 && (inner_rad.to_degrees() - 30.0).abs() < 1e-4));
    assert_eq!(scene.environment, Some(Environment::Constant { radiance: Rgb::splat(0.5) }));
    // Version 4 takes the hue of a black body alone; a power of 4π·7 W gives an intensity of luminance 7 everywhere.
    let scene =
        load(&folder, "LightSource \"point\" \"blackbody I\" 3000 \"float power\" 87.9646\nMaterial \"diffuse\"\nShape \"sphere\"").scene;
    assert!(matches!(&scene.lights[0], Light::Point { intensity, .. }
            if (intensity.luminance() - 7.0).abs() < 1e-3 && intensity.r > 2.0 * intensity.b));
}

#[test]
fn area_lights_shine_on_their_front() {
    let folder = Folder::new();
    let quad = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 2 0 0 2 2 0 0 2 0] \"integer indices\" [0 1 2 0 2 3]";
    let text = format!(
        "Material \"diffuse\"\nAttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 2 1] \"float scale\" 2\n{quad}\n\
         ReverseOrientation\n{quad}\nAttributeEnd\n\
         AttributeBegin\nAreaLightSource \"diffuse\" \"bool twosided\" true \"float power\" 100\nShape \"sphere\"\nAttributeEnd\n{quad}"
    );
    let scene = load(&folder, &text).scene;
    let emission = |i: usize| scene.materials[scene.parts[i].material as usize].emission.factor;
    assert_eq!((emission(0), emission(1), emission(3)), (Rgb::new(6.0, 4.0, 2.0), Rgb::new(6.0, 4.0, 2.0), Rgb::BLACK));
    let faces = |i: usize| {
        let [a, b, c] = corners(&scene, i);
        (b - a).cross(c - a).normalize()
    };
    // pbrt's +z is −y here.
    assert!((faces(0) - Vec3::NEG_Y).length() < 1e-6 && (faces(1) - Vec3::Y).length() < 1e-6);
    let material = &scene.materials[scene.parts[2].material as usize];
    // 100 = L · π · 4π on both sides of a unit sphere.
    let expected = 100.0 / (2.0 * std::f32::consts::PI * 4.0 * std::f32::consts::PI);
    assert!(material.emits_both_sides && (material.emission.factor.g / expected - 1.0).abs() < 3e-3, "{:?}", material.emission);
}

#[test]
fn transforms_blocks_and_instances() {
    let folder = Folder::new();
    let text = format!(
        "MakeNamedMaterial \"Wood\" \"string type\" \"diffuse\"\nNamedMaterial \"Wood\"\nTranslate 10 0 0\nCoordinateSystem \"ten\"\n\
         AttributeBegin\nScale 2 2 2\n{TRIANGLE}\nAttributeEnd\nIdentity\nRotate 90 0 0 1\n{TRIANGLE}\nCoordSysTransform \"ten\"\n\
         ObjectBegin \"chair\"\nTranslate 1 0 0\n{TRIANGLE}\nObjectEnd\n\
         ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 5 0 1]\nObjectInstance \"chair\"\nScale -1 1 1\nObjectInstance \"chair\"\n"
    );
    let imported = load(&folder, &text);
    let scene = &imported.scene;
    // (x, y, z) becomes (x, −z, y).
    assert_eq!(corners(scene, 0), [Vec3::new(10.0, 0.0, 0.0), Vec3::new(12.0, 0.0, 0.0), Vec3::new(10.0, 0.0, 2.0)]);
    assert!((corners(scene, 1)[1] - Vec3::new(0.0, 0.0, 1.0)).length() < 1e-6);
    // The object was defined at x = 10, which its instances add to theirs.
    assert_eq!(corners(scene, 2)[0], Vec3::new(21.0, 0.0, 5.0));
    assert_eq!(scene.world_corners(&scene.parts[3], 0)[0], Vec3::new(-1.0, 0.0, 5.0));
    let names: Vec<&str> = scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Wood_trianglemesh", "Wood_trianglemesh_2", "Wood_trianglemesh_3", "Wood_trianglemesh_4"]);
}

#[test]
fn cameras_and_left_handed_worlds() {
    let folder = Folder::new();
    let body = format!(
        "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\nCamera \"perspective\" \"float fov\" 60\n\
         WorldBegin\nMaterial \"diffuse\"\nTranslate 1 0 0\n{TRIANGLE}"
    );
    let scene = folder.write("left.pbrt", format!("LookAt 0 0 -5  0 0 0  0 1 0\n{body}")).load("left.pbrt").unwrap().scene;
    let camera = &scene.cameras[0];
    // pbrt shows x = 1 to the right of the middle, so here it must be there too.
    let p_camera = camera.world_from_camera.transpose() * (corners(&scene, 0)[0].as_dvec3() - camera.position);
    assert!((p_camera - DVec3::new(1.0, 0.0, -5.0)).length() < 1e-6, "{p_camera}");
    assert!((0.5 * camera.fov_x_rad).tan() / (2.0 * 30f64.to_radians().tan()) - 1.0 < 1e-9 && camera.aspect == 2.0);
    // Seen from the front, where normals point to, as pbrt has them: its +z is behind the triangle for a camera at −z.
    let [a, b, c] = corners(&scene, 0);
    assert!((b - a).cross(c - a).dot((camera.position.as_vec3() - a).normalize()) < 0.0);
    let scene = folder.write("right.pbrt", format!("Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\n{body}")).load("right.pbrt").unwrap().scene;
    assert_eq!(scene.cameras[0].position, DVec3::new(0.0, -5.0, 0.0));
    assert!((scene.cameras[0].world_from_camera.x_axis - DVec3::X).length() < 1e-12);
    assert_eq!(corners(&scene, 0)[0], Vec3::X);
}

#[test]
fn textures_masks_and_relief() {
    let folder = Folder::new();
    folder.write("t.png", png(2, 2, [255, 0, 0, 255])).write("g.png", png(2, 2, [128, 128, 128, 255]));
    let text = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\" \"float uscale\" 2 \"float vdelta\" .5\n\
         Texture \"half\" \"spectrum\" \"scale\" \"texture tex\" \"t\" \"float scale\" .5\n\
         Texture \"g\" \"float\" \"imagemap\" \"string filename\" \"g.png\" \"string encoding\" \"linear\"\n\
         Texture \"c\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 1 0] \"float uscale\" 2 \"float vscale\" 2\n\
         AttributeBegin\nMaterial \"diffuse\" \"texture reflectance\" \"half\" \"texture displacement\" \"g\"\n\
          Shape \"sphere\" \"texture alpha\" \"g\"\nAttributeEnd\n\
         Material \"diffuse\" \"texture reflectance\" \"c\"\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n\
         Material \"conductor\" \"texture roughness\" \"g\"\nShape \"disk\"\n";
    let scene = load(&folder, text).scene;
    let Bsdf::Diffuse { reflectance } = &scene.materials[0].bsdf else { panic!("not diffuse") };
    let t = reflectance.texture.unwrap();
    assert_eq!((reflectance.factor, t.transform(Vec2::new(0.25, 0.25))), (Rgb::splat(0.5), Vec2::new(0.5, 0.75)));
    assert!(matches!(scene.materials[0].alpha, Alpha::Blend { opacity } if opacity.texture.is_some()));
    assert!(matches!(scene.materials[0].normal_map, Some(NormalMap::Bump { .. })));
    let Bsdf::Diffuse { reflectance } = &scene.materials[1].bsdf else { panic!("not diffuse") };
    let t = reflectance.texture.unwrap();
    let at = |u: f32, v: f32| scene.images[t.image as usize].sample(&t, Vec2::new(u, v)).0;
    assert_eq!(
        (at(0.25, 0.25), at(0.75, 0.25), at(0.25, 0.75), at(0.75, 0.75)),
        (Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0), Rgb::new(0.0, 1.0, 0.0), Rgb::new(1.0, 0.0, 0.0))
    );
    let Bsdf::Conductor { alpha, .. } = &scene.materials[2].bsdf else { panic!("no metal") };
    let (t, _) = alpha.texture.unwrap();
    let baked = scene.images[t.image as usize].texel(0, 0).0.r;
    assert!((baked - (128f32 / 255.0).sqrt()).abs() < 1e-6, "{baked}");
}

#[test]
fn included_and_compressed_files_are_read_and_circles_refused() {
    let folder = Folder::new();
    let mut gz = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    gz.write_all(format!("{BEGIN}Include \"more/b.pbrt\"\n").as_bytes()).unwrap();
    folder.write("a.pbrt.gz", gz.finish().unwrap()).write("more/b.pbrt", "Material \"matte\"\nShape \"sphere\"\n");
    let imported = folder.load("a.pbrt.gz").unwrap();
    assert_eq!((imported.scene.parts.len(), imported.inputs.len()), (1, 2));
    let message = folder.write("a.pbrt", "Include \"a.pbrt\"").error("a.pbrt");
    assert!(message.contains("a.pbrt: line 1:1 Include \"a.pbrt\": the file includes itself"), "{message}");
}

#[test]
fn mistakes_have_line_and_column_and_gaps_are_reported() {
    let folder = Folder::new();
    let error = |text: &str| folder.write("a.pbrt", format!("{BEGIN}{text}")).error("a.pbrt");
    assert!(error("Shape \"sphere\" \"float radius\" \"x\"").contains("a.pbrt: line 5:31: found the string \"x\", expected a number"));
    assert!(error("  Sphere \"a\"").contains("line 5:3 Sphere \"a\": Sphere is not a directive of pbrt"), "{}", error("  Sphere \"a\""));
    assert!(error("AttributeEnd").contains("no block is open"));
    assert!(error("NamedMaterial \"x\"").contains("no MakeNamedMaterial before it has this name"));
    assert!(error("Translate 1 2").contains("number 3 of 3 is missing"));
    assert!(
        error("Shape \"trianglemesh\" \"point3 P\" [0 0 0] \"integer indices\" [0 1 2]")
            .contains("indices refers to vertex 1, but there are 1")
    );
    assert!(error("Shape \"plymesh\" \"string filename\" \"gone.ply\"").contains("gone.ply, which cannot be read"));
    assert!(error("Material \"matte\" \"texture Kd\" \"t\"\nShape \"sphere\"").contains("the texture \"t\", which is not defined"));
    assert!(folder.write("b.pbrt", "Shape \"sphere\"").error("b.pbrt").contains("the shape is before WorldBegin"));
    let mixed = "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"a\"\n\
     NamedMaterial \"a\"\nShape \"sphere\"";
    assert!(error(mixed).contains("materials are mixed in a circle"));
    let imported = load(
        &folder,
        "Shape \"curve\" \"point3 P\" [0 0 0]\nLightSource \"projection\"\nMaterial \"hair\"\n\
         Shape \"sphere\" \"float wetness\" 1\nActiveTransform EndTime\nTranslate 9 9 9\nActiveTransform All\n\
         Shape \"sphere\"",
    );
    let text = warnings(&imported);
    for expected in [
        "curve shapes are not supported",
        "projection lights are not",
        "hair materials are not",
        "ignored: wetness",
        "motion is not supported",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    assert_eq!(imported.scene.parts[1].world_from_mesh.translation, DVec3::ZERO);
}

#[test]
fn mangled_texts_never_panic() {
    let folder = Folder::new();
    let text = "LookAt 0 0 5 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\nTexture \"t\" \"float\" \"checkerboard\"\n\
                Material \"metal\" \"texture roughness\" \"t\"\nObjectBegin \"o\"\nShape \"disk\" \"float radius\" [2]\n\
                 ObjectEnd\nScale 1 2 3\nObjectInstance \"o\"\n\
                AreaLightSource \"diffuse\" \"blackbody L\" [3000 2]\nShape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0]\n";
    folder.write("a.pbrt", text).load("a.pbrt").unwrap_or_else(|e| panic!("{e}"));
    for at in 0..text.len() {
        for with in ["9", "-", "", "\"", "]"] {
            let mangled = format!("{}{with}{}", &text[..at], &text[at + 1..]);
            drop(folder.write("a.pbrt", mangled).load("a.pbrt"));
        }
    }
}

#[test]
fn units_scale_places_and_point_lights() {
    let folder = Folder::new();
    folder.write("a.pbrt", format!("{BEGIN}Material \"diffuse\"\nLightSource \"point\"\nTranslate 100 0 0\nShape \"sphere\""));
    let options = ImportOptions { meters_per_unit: 0.01, ..ImportOptions::default() };
    let scene = folder.load_with("a.pbrt", &options).unwrap().scene;
    assert!((scene.parts[0].world_from_mesh.translation - DVec3::X).length() < 1e-12);
    assert!(matches!(&scene.lights[0], Light::Point { intensity, .. } if (intensity.r - 1e-4).abs() < 1e-9));
}

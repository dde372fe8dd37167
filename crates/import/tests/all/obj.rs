//! OBJ and MTL features, one small file each.

use crate::common::{Folder, png, warnings};
use enfilade_import::{EnvironmentOverride, EnvironmentSource, ImportOptions};
use enfilade_math::Rgb;
use enfilade_scene::{Alpha, Bsdf, NormalMap, Wrap};

const TRIANGLES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

#[test]
fn groups_and_materials_become_named_parts() {
    let folder = Folder::new();
    let text = format!(
        "mtllib my room.mtl\n{TRIANGLES}o Big Chair\nusemtl Red Wood\nf 1/1 2/2 3/3\nusemtl Steel\nf -3/1 -2/2 -1/3\n\
         g lamp\nusemtl Steel\nf 1 2 3\nusemtl Unknown\no\nf 1 2 3\n"
    );
    folder.write("a.obj", text).write("my room.mtl", "newmtl Red Wood\nKd 0.5 0.1 0.1\nnewmtl Steel\nKd 0 0 0\nKs 0.6 0.6 0.7\nNs 198\n");
    let imported = folder.load("a.obj").unwrap();
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Big Chair.Red Wood", "Big Chair.Steel", "lamp", "Unknown"]);
    assert_eq!(imported.scene.materials.len(), 3);
    let wood = Bsdf::Diffuse { reflectance: Rgb::new(0.5, 0.1, 0.1).into() };
    assert_eq!(imported.scene.materials[0].bsdf, wood);
    let Bsdf::Conductor { reflectance, alpha, .. } = &imported.scene.materials[1].bsdf else { panic!("no metal") };
    assert!(reflectance.factor == Rgb::new(0.6, 0.6, 0.7) && (alpha.factor - 0.1).abs() < 1e-6);
    assert!(warnings(&imported).contains("usemtl Unknown"), "{}", warnings(&imported));
    assert_eq!(imported.inputs, [folder.path("a.obj"), folder.path("my room.mtl")]);
}

/// Pictures had absolute paths as names, so that a copy of a scene in another folder was another scene.
#[test]
fn a_scene_is_the_same_wherever_its_files_lie() {
    let imported = || {
        let folder = Folder::new();
        for picture in ["room/tex/wood.png", "grey.png", "sky.png"] {
            folder.write(picture, png(2, 2, [9, 9, 9, 255]));
        }
        folder.write("room/a.mtl", "newmtl M\nmap_Kd tex/wood.png\nmap_Bump ../grey.png\n");
        folder.write("room/a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
        let environment = EnvironmentOverride::from(EnvironmentSource::Picture(folder.path("sky.png")));
        let options = ImportOptions { environment: Some(environment), ..ImportOptions::default() };
        folder.load_with("room/a.obj", &options).unwrap().scene
    };
    let scene = imported();
    assert_eq!(scene, imported());
    let names: Vec<&str> = scene.images.iter().map(|image| image.name.as_str()).collect();
    assert_eq!(names, ["tex/wood.png", "../grey.png", "sky.png"]);
}

/// Each group was compared with all others, which took minutes.
#[test]
fn a_hundred_thousand_groups_are_a_hundred_thousand_parts() {
    let folder = Folder::new();
    let groups: String = (0..100_000).map(|i| format!("g group {i}\nf 1 2 3\n")).collect();
    let imported = folder.write("a.obj", format!("{TRIANGLES}{groups}")).load("a.obj").unwrap();
    assert_eq!((imported.scene.parts.len(), imported.scene.parts[99_999].name.as_str()), (100_000, "group 99999"));
}

#[test]
fn material_keys_are_read() {
    let folder = Folder::new();
    let material = |body: &str| {
        folder.write("m/a.mtl", format!("newmtl M\n{body}"));
        folder.write("a.obj", format!("mtllib m/a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
        folder.load("a.obj").unwrap().scene.materials[0].clone()
    };
    folder.write("m/my wood.png", png(2, 2, [10, 20, 30, 128])).write("m/grey.png", png(2, 2, [9, 9, 9, 255]));
    let m = material("map_Kd -s 2 2 1 -clamp on my wood.png\nKd 0 0 0\nKe 3 3 3\nd 0.5\nmap_Bump -bm 2 grey.png\n");
    let Bsdf::Diffuse { reflectance } = &m.bsdf else { panic!("not diffuse") };
    let texture = reflectance.texture.unwrap();
    assert_eq!((reflectance.factor, texture.wrap, texture.uv_transform[0][0]), (Rgb::WHITE, [Wrap::Clamp; 2], 2.0));
    assert_eq!(m.emission.factor, Rgb::splat(3.0));
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.factor == 0.5));
    assert!(matches!(m.normal_map, Some(NormalMap::Bump { scale, .. }) if (scale - 0.01).abs() < 1e-6));
    let m = material("Kd 1 1 1\nPr 0.3\nPm 0.8\nnorm my wood.png\nmap_d my wood.png\n");
    let Bsdf::Principled(p) = &m.bsdf else { panic!("not principled") };
    assert_eq!((p.roughness.factor, p.metallic.factor), (0.3, 0.8));
    assert!(matches!(m.normal_map, Some(NormalMap::Normal { .. })));
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.texture.unwrap().1 == 3));
    assert!(matches!(material("illum 7\nNi 1.33\nTf 1 1 1\n").bsdf, Bsdf::Dielectric { eta: 1.33, .. }));
    let shiny = material("Kd 1 1 1\nKs 0.5 0.5 0.5\nNs 48\nTr 0\n").bsdf;
    assert!(matches!(shiny, Bsdf::Principled(p) if (p.roughness.factor.powi(2) - 0.2).abs() < 1e-6));
}

/// Illumination models below 2 have no highlight, so `Ks` counts for nothing, on black `Kd` too.
#[test]
fn specular_colours_count_from_illumination_model_2_on() {
    let folder = Folder::new();
    folder.write("a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    folder.write("grey.png", png(2, 2, [9, 9, 9, 255]));
    let bsdf = |body: &str| folder.write("a.mtl", format!("newmtl M\n{body}")).load("a.obj").unwrap().scene.materials[0].bsdf.clone();
    for (kd, illum) in [(0.25, 0), (0.25, 1), (0.0, 1)] {
        let found = bsdf(&format!("Kd {kd} {kd} {kd}\nKs 0.5 0.5 0.5\nmap_Ks grey.png\nillum {illum}\n"));
        assert_eq!(found, Bsdf::Diffuse { reflectance: Rgb::splat(kd).into() }, "illum {illum}");
    }
    let coated = bsdf("Kd 1 1 1\nKs 0.5 0.5 0.5\nillum 2\n");
    assert!(matches!(coated, Bsdf::Principled(p) if p.specular_color.factor == Rgb::splat(0.5)));
}

/// A plastic, which has one bounce of light between coat and facets, took most of the light of these surfaces.
#[test]
fn highlights_are_energy_conserving_coats_and_of_blenders_roughness_in_its_files() {
    let folder = Folder::new();
    folder.write("a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    let coat = |head: &str, kd: f32, ns: f32| {
        let library = format!("{head}newmtl M\nNs {ns}\nKd {kd} {kd} {kd}\nKs 0.5 0.5 0.5\nNi 1.5\nillum 2\n");
        match folder.write("a.mtl", library).load("a.obj").unwrap().scene.materials[0].bsdf.clone() {
            Bsdf::Principled(p) => (p.base_color.factor.r, p.roughness.factor, p.specular_color.factor.r),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(coat("", 0.25, 0.0), (0.25, 1.0, 0.5));
    // Its Ks of one half is a highlight of full strength, and its black is no mirror.
    let blender = "# Blender 4.5.0 MTL File: 'None'\n# www.blender.org\n";
    for (kd, ns, roughness) in [(0.25, 0.0, 1.0), (0.25, 250.0, 0.5), (0.0, 1000.0, 0.0)] {
        assert_eq!(coat(blender, kd, ns), (kd, roughness, 1.0));
    }
    // Before 3.2 it wrote 900·(1 − r)² (io_scene_obj's export_obj.py): 225 for its default of one half.
    for head in ["# Blender MTL File: 'None'\n# Material Count: 1\n", "# Blender 3.1.0 MTL File: 'None'\n"] {
        for (kd, ns, roughness) in [(0.25, 0.0, 1.0), (0.25, 225.0, 0.5), (0.0, 900.0, 0.0)] {
            assert_eq!(coat(head, kd, ns), (kd, roughness, 1.0), "{head}");
        }
    }
    // Before 2.80 a hardness from 1 to 511, as 0 to 1000: here one of 198. The OBJ file has the version of Blender.
    folder.write("a.obj", format!("# Blender v2.79 (sub 0) OBJ File: ''\nmtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    let (_, roughness, ks) = coat("# Blender MTL File: 'None'\n", 0.25, 197.0 / 0.51);
    assert!((roughness - 0.1f32.sqrt()).abs() < 1e-5 && ks == 0.5, "{roughness} {ks}");
}

/// Blender writes 9 for whatever has an alpha below one; it became clear glass.
#[test]
fn illumination_models_4_and_9_are_glass_only_where_nothing_else_is_stated() {
    let folder = Folder::new();
    folder.write("a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    let made = |body: &str| folder.write("a.mtl", format!("newmtl M\n{body}")).load("a.obj").unwrap().scene.materials[0].clone();
    for illum in [4, 9] {
        let veil = made(&format!("Kd 0.2 0.6 0.2\nd 0.5\nillum {illum}\n"));
        assert_eq!(veil.bsdf, Bsdf::Diffuse { reflectance: Rgb::new(0.2, 0.6, 0.2).into() });
        assert!(matches!(veil.alpha, Alpha::Blend { opacity } if opacity.factor == 0.5));
        for body in ["Kd 0.5 0.5 0.5", "Kd 0 0 0\nd 0.5", "Kd 0 0 0\nTr 0.5"] {
            assert!(!matches!(made(&format!("{body}\nillum {illum}\n")).bsdf, Bsdf::Dielectric { .. }), "{body}");
        }
        for body in ["Kd 0 0 0", "Tf 1 1 1\nd 1"] {
            assert!(matches!(made(&format!("{body}\nillum {illum}\n")).bsdf, Bsdf::Dielectric { .. }), "{body}");
        }
    }
    assert!(matches!(made("Kd 0.5 0.5 0.5\nd 0.5\nillum 6\n").bsdf, Bsdf::Dielectric { .. }));
}

/// Blender writes the name of its mesh once for each of its instances.
#[test]
fn objects_of_one_name_stay_objects() {
    let folder = Folder::new();
    let text = format!(
        "{TRIANGLES}o Ape\nf 1 2 3\no Ape\nusemtl A\nf 1 2 3\nusemtl B\nf 1 2 3\no Ape\nusemtl A\nf 1 2 3\ng x\nf 1 2 3\ng y\nf 1 2 3\ng x\nf 1 2 3\n"
    );
    let scene = folder.write("a.obj", text).load("a.obj").unwrap().scene;
    let names: Vec<&str> = scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Ape", "Ape.A", "Ape.B", "Ape_2", "x", "y"]);
}

#[test]
fn statements_without_effect_are_not_reported_and_maps_of_exponents_are() {
    let folder = Folder::new();
    folder.write("a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    let told = |body: &str| warnings(&folder.write("a.mtl", format!("newmtl M\n{body}")).load("a.obj").unwrap());
    assert!(!told("Kd 1 1 1\nPr 0.5\naniso 0.000000\n").contains("ignored"));
    assert!(told("Kd 1 1 1\nPr 0.5\naniso 0.3\n").contains("aniso ignored"));
    assert!(told("Kd 1 1 1\nmap_Ns rough.png\n").contains("map_ns ignored"));
}

#[test]
fn number_signs_are_part_of_names_and_paths() {
    let folder = Folder::new();
    let library = "# two woods\nnewmtl Wood #1\nKd 0.25 0.25 0.25 # grey\nnewmtl Wood #2\nmap_Kd oak#3.png\n";
    folder.write("set#1.mtl", library).write("oak#3.png", png(2, 2, [255, 0, 0, 255]));
    let text = format!("mtllib set#1.mtl\n{TRIANGLES}usemtl Wood #1\nf 1/1 2/2 3/3 # one\nusemtl Wood #2\nf 1/1 2/2 3/3\n");
    let scene = folder.write("a.obj", text).load("a.obj").unwrap().scene;
    let bsdf = |name: &str| &scene.materials.iter().find(|m| m.name == name).unwrap_or_else(|| panic!("no {name}")).bsdf;
    assert_eq!(bsdf("Wood #1"), &Bsdf::Diffuse { reflectance: Rgb::splat(0.25).into() });
    assert!(matches!(bsdf("Wood #2"), Bsdf::Diffuse { reflectance } if reflectance.texture.is_some()));
}

/// Many libraries name the colour picture as the bump map too.
#[test]
fn colour_pictures_as_bump_maps_are_heights() {
    let folder = Folder::new();
    folder.write("a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    folder.write("oak.png", png(2, 2, [150, 100, 60, 255])).write("flat.png", png(2, 2, [128, 128, 255, 255]));
    let map = |body: &str| folder.write("a.mtl", format!("newmtl M\n{body}")).load("a.obj").unwrap().scene.materials[0].normal_map;
    assert!(matches!(map("map_Kd oak.png\nmap_Bump oak.png\n"), Some(NormalMap::Bump { .. })));
    assert!(matches!(map("bump flat.png\n"), Some(NormalMap::Normal { .. })));
    assert!(matches!(map("norm oak.png\n"), Some(NormalMap::Normal { .. })));
}

/// The import of one material, and its report, on a triangle with texture coordinates.
fn made(folder: &Folder, body: &str) -> (enfilade_scene::Material, String) {
    folder.write("a.obj", format!("mtllib a.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n"));
    let imported = folder.write("a.mtl", format!("newmtl M\n{body}")).load("a.obj").unwrap();
    (imported.scene.materials[0].clone(), warnings(&imported))
}

#[test]
fn paths_of_other_machines_are_looked_for_by_name() {
    let folder = Folder::new();
    folder.write("oak.png", png(2, 2, [150, 100, 60, 255])).write("textures/ash.png", png(2, 2, [150, 100, 60, 255]));
    folder.write("a b.mtl", "newmtl M\nKd 1 1 1\nmap_Kd \"C:\\maps\\oak.png\"\nnewmtl N\nmap_Kd /maps/ash.png\n");
    let library = "D:\\My Rooms\\a b.mtl";
    let text = format!("mtllib {library}\n{TRIANGLES}usemtl M\nf 1/1 2/2 3/3\nusemtl N\nf 1/1 2/2 3/3\n");
    let scene = folder.write("a.obj", text).load("a.obj").unwrap().scene;
    let names: Vec<&str> = scene.images.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["oak.png", "textures/ash.png"]);
}

#[test]
fn names_that_differ_in_case_alone_are_found_with_a_warning() {
    let folder = Folder::new();
    folder.write("Oak.PNG", png(2, 2, [150, 100, 60, 255])).write("Room.MTL", "newmtl M\nKd 1 1 1\nmap_Kd oak.png\n");
    let imported = folder.write("a.obj", format!("mtllib room.mtl\nusemtl M\n{TRIANGLES}f 1/1 2/2 3/3\n")).load("a.obj").unwrap();
    let told = warnings(&imported);
    assert!(told.contains("\"Room.MTL\", which differs in case") && told.contains("\"Oak.PNG\", which differs in case"), "{told}");
    assert_eq!(imported.scene.images[0].name, "Oak.PNG");
    // Two of them: which is meant is not known.
    folder.write("oaK.png", png(2, 2, [150, 100, 60, 255]));
    assert!(folder.error("a.obj").contains("oak.png"));
}

#[test]
fn a_library_called_like_the_file_stands_in_for_a_missing_one() {
    let folder = Folder::new();
    folder.write("a.mtl", "newmtl M\nKd 0.25 0.25 0.25\n");
    let imported = folder.write("a.obj", format!("mtllib old.mtl\nusemtl M\n{TRIANGLES}f 1 2 3\n")).load("a.obj").unwrap();
    assert!(warnings(&imported).contains("a.mtl, which is called like the OBJ file, was read in its place"), "{}", warnings(&imported));
    assert_eq!(imported.scene.materials[0].bsdf, Bsdf::Diffuse { reflectance: Rgb::splat(0.25).into() });
}

#[test]
fn what_is_not_read_of_a_material_is_reported() {
    let folder = Folder::new();
    folder.write("oak.png", png(2, 2, [150, 100, 60, 255]));
    for (body, expected) in [
        ("Kd half half half", "kd ignored: found \"half half half\", expected numbers such as 0.5"),
        ("Ns 1e400", "ns ignored"),
        ("Kd spectral oak.rfl", "kd ignored: found a file of spectral samples"),
        ("d -halo 0.3", "d -halo, which depends on the direction"),
        ("map_opacity oak.png", "map_opacity ignored"),
        ("map_Kd", "map_kd ignored: it names no picture"),
        ("map_Kd .", "map_kd ignored: it names no picture"),
        ("map_Kd textures\\", "map_kd ignored: it names no picture"),
        ("Kd 200 100 50", "kd: found \"200 100 50\", expected 0 to 1"),
        ("map_Kd -imfchan r -mm 0.5 1 oak.png", "map_kd: options -mm, -imfchan ignored"),
        ("Ke 0 0 0\nmap_Ke oak.png", "beside a black Ke"),
    ] {
        let told = made(&folder, &format!("{body}\n")).1;
        assert!(told.contains(expected), "{body}: {told}");
    }
    assert_eq!(made(&folder, "Ka 1 1 1\nKd 1 1 1\nKs 0 0 0\nNs 10\nNi 1.5\nd 1\nillum 2\nTf 1 1 1\nsharpness 60\nmap_Kd oak.png\n").1, "");
    assert!(matches!(made(&folder, "d -halo 0.3\n").0.alpha, Alpha::Blend { opacity } if opacity.factor == 0.3));
    let Bsdf::Diffuse { reflectance } = made(&folder, "Kd xyz 0.4 0.4 0.2\n").0.bsdf else { panic!("not diffuse") };
    assert!(reflectance.factor.g > reflectance.factor.b, "{:?}", reflectance.factor);
    assert_eq!(made(&folder, "Ke 0 0 0\nmap_Ke oak.png\n").0.emission.factor, Rgb::WHITE);
    let told = warnings(&folder.write("a.mtl", "Kd 1 1 1\nnewmtl M\n").load("a.obj").unwrap());
    assert!(told.contains("before the first newmtl"), "{told}");
}

#[test]
fn surfaces_that_would_not_be_seen_are_reported() {
    let folder = Folder::new();
    let (material, told) = made(&folder, "Kd 1 1 1\nd 0\n");
    assert!(matches!(material.alpha, Alpha::Blend { opacity } if opacity.factor == 0.0) && told.contains("found d 0"), "{told}");
    let (material, told) = made(&folder, "Kd 1 1 1\nTr 1\n");
    assert!(material.alpha == Alpha::Opaque && told.contains("an opacity of 1 was used"), "{told}");
    assert!(matches!(made(&folder, "Tr 0.25\n").0.alpha, Alpha::Blend { opacity } if opacity.factor == 0.75));
}

#[test]
fn parts_without_material_have_the_mean_of_their_colours() {
    let folder = Folder::new();
    let vertices = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 0 0 1 0 1 0\nv 1 0 1 0 1 0\nv 0 1 1 0 1 0\n";
    let imported = folder.write("a.obj", format!("{vertices}o A\nf 1 2 3\no B\nf 4 5 6\n")).load("a.obj").unwrap();
    let reflectances = [Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 1.0, 0.0)].map(|c| Bsdf::Diffuse { reflectance: c.into() });
    assert_eq!(imported.scene.materials.iter().map(|m| m.bsdf.clone()).collect::<Vec<_>>(), reflectances);
    assert!(warnings(&imported).contains("the mean of a part's is its colour"));
    let told = warnings(&folder.write("a.obj", format!("{vertices}usemtl M\nf 1 2 3\n")).load("a.obj").unwrap());
    assert!(told.contains("vertex colours dropped"), "{told}");
}

#[test]
fn a_missing_library_is_a_warning() {
    let folder = Folder::new();
    let text = format!("mtllib gone.mtl\n{TRIANGLES}usemtl A\nf 1 2 3\n");
    let imported = folder.write("a.obj", text).load("a.obj").unwrap();
    assert!(warnings(&imported).contains("gone.mtl cannot be read"));
    assert_eq!(imported.scene.materials[0].name, "A");
}

//! Mitsuba features, one small file each.

use crate::common::{Folder, png, warnings};
use enfilade_import::{ImportOptions, Imported, UpAxis};
use enfilade_math::{DVec3, Mat3, Rgb, Vec2, Vec3};
use enfilade_scene::{Alpha, Bsdf, Distribution, Environment, Filter, Light, MapRows, Material, NormalMap, SpotFalloff};

fn load(folder: &Folder, body: &str) -> Imported {
    folder.write("a.xml", format!("<scene version=\"0.5.0\">{body}</scene>")).load("a.xml").unwrap_or_else(|e| panic!("{e}"))
}

/// The material of a sphere with this bsdf.
fn material(folder: &Folder, bsdf: &str) -> (Material, String) {
    let imported = load(folder, &format!("<shape type=\"sphere\">{bsdf}</shape>"));
    (imported.scene.materials[0].clone(), warnings(&imported))
}

#[test]
fn bsdfs_become_materials() {
    let folder = Folder::new();
    let bsdf = |text: &str| material(&folder, text).0;
    let m = bsdf(r#"<bsdf type="diffuse" id="Red"><rgb name="reflectance" value="0.5, 0.1 0.2"/></bsdf>"#);
    assert_eq!((m.name.as_str(), m.two_sided), ("Red", false));
    assert_eq!(m.bsdf, Bsdf::Diffuse { reflectance: Rgb::new(0.5, 0.1, 0.2).into() });
    let m = bsdf(r##"<bsdf type="twosided"><bsdf type="diffuse"><srgb name="reflectance" value="#ff0000"/></bsdf></bsdf>"##);
    assert!(m.two_sided && m.name == "inline" && m.bsdf == Bsdf::Diffuse { reflectance: Rgb::new(1.0, 0.0, 0.0).into() });
    let m = bsdf(
        r#"<bsdf type="roughplastic"><float name="alpha" value="0.3"/><string name="distribution" value="ggx"/>
        <float name="intIOR" value="1.5"/><float name="extIOR" value="1"/><boolean name="nonlinear" value="true"/></bsdf>"#,
    );
    assert!(matches!(m.bsdf, Bsdf::Plastic { eta: 1.5, nonlinear: true, alpha, .. } if alpha.factor == 0.3));
    let m = bsdf(r#"<bsdf type="conductor"><string name="material" value="none"/></bsdf>"#);
    assert!(matches!(m.bsdf, Bsdf::Conductor { eta: Rgb::BLACK, k: Rgb::BLACK, alpha, .. } if alpha.factor == 0.0));
    let m = bsdf(r#"<bsdf type="dielectric"><string name="int_ior" value="water"/><float name="ext_ior" value="1"/></bsdf>"#);
    assert!(matches!(m.bsdf, Bsdf::Dielectric { eta: 1.333, .. }));
    let m = bsdf(r#"<bsdf type="thindielectric"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/></bsdf>"#);
    assert!(matches!(m.bsdf, Bsdf::ThinDielectric { eta: 1.5, .. }));
    let m = bsdf(
        r#"<bsdf type="principled"><rgb name="base_color" value="1 0.5 0"/><float name="roughness" value="0.4"/>
        <float name="metallic" value="0.9"/></bsdf>"#,
    );
    assert!(matches!(m.bsdf, Bsdf::Disney(p) if p.roughness.factor == 0.4 && p.metallic.factor == 0.9 && (p.eta - 1.5).abs() < 1e-6));
}

#[test]
fn rough_bsdfs_have_beckmanns_facets_unless_they_say_ggx() {
    let folder = Folder::new();
    for plugin in ["roughconductor", "roughplastic", "roughdielectric"] {
        for (stated, expected) in [("", Distribution::Beckmann), ("beckmann", Distribution::Beckmann), ("ggx", Distribution::Ggx)] {
            let stated = if stated.is_empty() { String::new() } else { format!("<string name=\"distribution\" value=\"{stated}\"/>") };
            let (made, told) = material(&folder, &format!("<bsdf type=\"{plugin}\">{stated}</bsdf>"));
            let (Bsdf::Conductor { alpha, .. } | Bsdf::Plastic { alpha, .. } | Bsdf::Dielectric { alpha, .. }) = made.bsdf else {
                panic!()
            };
            assert!(alpha.distribution == expected && alpha.factor == 0.1 && !told.contains("distribution"), "{plugin}: {told}");
        }
    }
}

#[test]
fn guesses_and_gaps_are_reported_with_their_place() {
    let folder = Folder::new();
    let report = |text: &str| material(&folder, text).1;
    let text = report(
        "\n<bsdf type=\"roughconductor\" id=\"M\"><string name=\"material\" value=\"Xx\"/><string name=\"distribution\" value=\"phong\"/></bsdf>",
    );
    assert!(text.contains("a.xml line 2:1 <bsdf type=\"roughconductor\" id=\"M\">: the metal \"Xx\" is not known"), "{text}");
    assert!(text.contains("the phong distribution was replaced by Beckmann's of the same alpha"), "{text}");
    assert!(report(r#"<bsdf type="hair"/>"#).contains("hair bsdfs are not supported"));
    assert!(
        report(r#"<bsdf type="diffuse"><float name="wetness" value="1"/></bsdf>"#).contains("<float name=\"wetness\">: ignored in diffuse")
    );
    let imported =
        load(&folder, r#"<shape type="sphere"/><shape type="hair"/><emitter type="laser"/><sensor type="orthographic"/><gizmo/>"#);
    let text = warnings(&imported);
    for expected in ["hair shapes", "laser emitters", "orthographic sensors", "<gizmo>: unknown element"] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    let text = warnings(&load(&folder, r#"<shape type="sphere"/><shape type="Rectangle"/>"#));
    assert!(text.contains("Rectangle shapes are not supported (plugins have small letters: \"rectangle\"); it was left out"), "{text}");
}

#[test]
fn blends_keep_both_and_a_blend_with_nothing_is_a_mask() {
    let folder = Folder::new();
    let blend = r#"<bsdf type="blendbsdf"><float name="weight" value="0.8"/><bsdf type="diffuse"/><bsdf type="plastic"/></bsdf>"#;
    let Bsdf::Blend { first, second, weight } = material(&folder, blend).0.bsdf else { panic!("expected a blend") };
    assert!(matches!(*first, Bsdf::Diffuse { .. }) && matches!(*second, Bsdf::Plastic { .. }) && weight.factor == 0.8);

    let mixture = r#"<bsdf type="mixturebsdf"><string name="weights" value="0.5, 0.2, 0.3"/>
        <bsdf type="diffuse"/><bsdf type="plastic"/><bsdf type="conductor"/></bsdf>"#;
    let Bsdf::Blend { first, second, weight } = material(&folder, mixture).0.bsdf else { panic!("expected a blend") };
    assert!(matches!(*first, Bsdf::Diffuse { .. }) && (weight.factor - 0.5).abs() < 1e-6);
    let Bsdf::Blend { second, weight, .. } = *second else { panic!("expected a blend within the blend") };
    assert!(matches!(*second, Bsdf::Conductor { .. }) && (weight.factor - 0.6).abs() < 1e-6);

    let pane = r#"<bsdf type="blendbsdf"><float name="weight" value="0.5"/><bsdf type="diffuse"/><bsdf type="dielectric"/></bsdf>"#;
    assert_eq!(load(&folder, &format!(r#"<shape type="cube">{pane}</shape>"#)).report.counts.transmitting_materials, 1);

    let lace = r#"<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="null"/><bsdf type="diffuse"/></bsdf>"#;
    let (m, _) = material(&folder, lace);
    assert!(matches!(m.bsdf, Bsdf::Diffuse { .. }));
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.factor == 0.3), "{:?}", m.alpha);
}

#[test]
fn textures_masks_and_bumps() {
    let folder = Folder::new();
    folder.write("leaf.png", png(2, 2, [10, 200, 30, 77])).write("grey.png", png(2, 2, [9, 9, 9, 255]));
    let bitmap = |name: &str, file: &str, more: &str| {
        format!(r#"<texture type="bitmap" name="{name}"><string name="filename" value="{file}"/>{more}</texture>"#)
    };
    let leaf = format!(
        r#"<bsdf type="mask">{}<bsdf type="twosided"><bsdf type="diffuse">{}</bsdf></bsdf></bsdf>"#,
        bitmap("opacity", "leaf.png", ""),
        bitmap("reflectance", "leaf.png", r#"<string name="filterType" value="nearest"/><float name="vscale" value="2"/>"#)
    );
    let (m, text) = material(&folder, &leaf);
    assert!(m.two_sided && text.is_empty(), "{text}");
    assert!(matches!(m.alpha, Alpha::Blend { opacity } if opacity.texture.unwrap().1 == 3));
    let Bsdf::Diffuse { reflectance } = &m.bsdf else { panic!("not diffuse") };
    let t = reflectance.texture.unwrap();
    // Mitsuba's v = 0 is the top, and stays it under scaling.
    assert_eq!((t.filter, t.transform(Vec2::new(0.0, 1.0)), t.transform(Vec2::ZERO)), (Filter::Nearest, Vec2::Y, Vec2::new(0.0, -1.0)));
    let bump = format!(r#"<bsdf type="bumpmap">{}<bsdf type="diffuse"/></bsdf>"#, bitmap("map", "grey.png", ""));
    assert!(matches!(material(&folder, &bump).0.normal_map, Some(NormalMap::Bump { scale: 1.0, .. })));
    let normal = bitmap("normalmap", "leaf.png", r#"<boolean name="raw" value="true"/>"#);
    let normal = format!(r#"<bsdf type="normalmap">{normal}<bsdf type="diffuse"/></bsdf>"#);
    assert!(matches!(material(&folder, &normal).0.normal_map, Some(NormalMap::Normal { .. })));
    let rough = bitmap("alpha", "grey.png", "");
    let rough = format!(r#"<bsdf type="roughconductor"><string name="distribution" value="ggx"/>{rough}</bsdf>"#);
    assert!(matches!(material(&folder, &rough).0.bsdf, Bsdf::Conductor { alpha, .. } if alpha.texture.is_some()));
}

#[test]
fn checkerboards_alternate_from_color0_at_the_top_left() {
    let folder = Folder::new();
    let checker = r#"<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"><rgb name="color0" value="1"/>
        <rgb name="color1" value="0"/><transform name="to_uv"><scale x="2" y="2"/></transform></texture></bsdf>"#;
    let imported = load(&folder, &format!("<shape type=\"rectangle\">{checker}</shape>"));
    let Bsdf::Diffuse { reflectance } = &imported.scene.materials[0].bsdf else { panic!("not diffuse") };
    let image = &imported.scene.images[0];
    // In Mitsuba's coordinates (v downward): two boards along each edge, each of two squares.
    let at = |u: f32, v_down: f32| image.sample(&reflectance.texture.unwrap(), Vec2::new(u, 1.0 - v_down)).0;
    for (u, v, expected) in [(0.1, 0.1, 1.0), (0.3, 0.1, 0.0), (0.3, 0.3, 1.0), (0.6, 0.1, 1.0), (0.1, 0.9, 0.0)] {
        assert_eq!(at(u, v), Rgb::splat(expected), "{u} {v}");
    }
}

#[test]
fn shapes_are_placed_named_and_face_outward() {
    let folder = Folder::new();
    folder.write("models/Chair 1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\n");
    let imported = load(
        &folder,
        r#"<bsdf type="diffuse" id="Wood"/>
        <shape type="obj"><string name="filename" value="models/Chair 1.obj"/><ref id="Wood"/></shape>
        <shape type="obj"><string name="filename" value="models\Chair 1.obj"/><boolean name="faceNormals" value="true"/>
            <transform name="toWorld"><scale value="2"/><translate x="1"/></transform></shape>
        <shape type="sphere" id="Ball"><point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/><ref id="Wood"/></shape>
        <shape type="cylinder"><point name="p0" value="0 0 0"/><point name="p1" x="0" y="3" z="0"/><float name="radius" value="0.5"/></shape>
        <shape type="disk"><boolean name="flipNormals" value="true"/></shape><shape type="cube"/><shape type="rectangle"/>"#,
    );
    let scene = &imported.scene;
    let names: Vec<&str> = scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Wood_Chair 1", "inline_Chair 1", "Ball", "inline_cylinder", "inline_disk", "inline_cube", "inline_rectangle"]);
    // The front is where the normals point: the triangle was turned round.
    assert_eq!(scene.meshes[0].triangles, [[0, 2, 1]]);
    // With `faceNormals` the normals are ignored.
    assert!(scene.meshes[1].normals.is_empty() && scene.meshes[1].triangles == [[0, 1, 2]]);
    assert_eq!(scene.parts[1].world_from_mesh.transform_point3(DVec3::Y), DVec3::new(1.0, 0.0, 2.0));
    let ball = scene.parts[2].world_from_mesh.transform_point3(DVec3::X);
    assert!((ball - DVec3::new(1.5, -3.0, 2.0)).length() < 1e-12, "{ball}");
    let top = scene.parts[3].world_from_mesh.transform_point3(DVec3::Z);
    assert!((top - DVec3::new(0.0, 0.0, 3.0)).length() < 1e-12, "{top}");
    assert_eq!(scene.meshes[scene.parts[4].mesh as usize].normals[0], Vec3::NEG_Z);
    assert!(imported.report.warnings.is_empty(), "{}", warnings(&imported));
}

/// Water and Glass as groups of their materials, and a group without one.
const AQUARIUM: &str = "mtllib aquarium.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng tank\nusemtl Glass\nf 1 2 3\nusemtl Water\nf 1 2 3\n\
                        g lid\nusemtl Steel\nf 3 2 1\n";

#[test]
fn meshes_of_an_obj_file_have_materials_of_their_own() {
    let folder = Folder::new();
    folder
        .write("models/aquarium.obj", AQUARIUM)
        .write("models/aquarium.mtl", "newmtl Water\nKd 0 0 1\nnewmtl Glass\nKd 0 1 0\nKe 9 9 9\n");
    let file = r#"<string name="filename" value="models/aquarium.obj"/>"#;
    let parts = |properties: &str| {
        let imported = load(&folder, &format!(r#"<shape type="obj">{file}{properties}</shape>"#));
        let material = |part: u32| imported.scene.materials[part as usize].clone();
        let parts: Vec<_> = imported.scene.parts.iter().map(|p| (p.name.clone(), material(p.material))).collect();
        (parts, warnings(&imported))
    };
    let names = |parts: &[(String, Material)]| parts.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let color = |(_, material): &(String, Material)| match &material.bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.factor,
        other => panic!("not diffuse: {other:?}"),
    };
    let glass = r#"<bsdf name="Glass" type="dielectric" id="Pane"/>"#;
    let (mixed, told) = parts(glass);
    assert_eq!(names(&mixed), ["Pane_aquarium.tank", "Water_aquarium.tank", "inline_aquarium.lid"]);
    assert!(matches!(mixed[0].1.bsdf, Bsdf::Dielectric { .. }) && !mixed[1].1.two_sided);
    assert_eq!((color(&mixed[1]), color(&mixed[2])), (Rgb::new(0.0, 0.0, 1.0), Rgb::splat(0.5)));
    assert!(told.contains("the material \"Water\" is the OBJ file's"), "{told}");

    let (libraries, _) = parts("");
    assert_eq!(color(&libraries[0]), Rgb::new(0.0, 1.0, 0.0));
    assert!(libraries[0].1.emission.factor.is_black(), "Mitsuba reads no Ke");
    let (plain, told) = parts(r#"<boolean name="loadMaterials" value="false"/>"#);
    assert!(plain.iter().all(|part| color(part) == Rgb::splat(0.5)) && told.is_empty(), "{told}");
    let (one, told) = parts(r#"<bsdf type="plastic"/><boolean name="collapse" value="true"/><float name="maxSmoothAngle" value="30"/>"#);
    assert!(one.iter().all(|(_, material)| matches!(material.bsdf, Bsdf::Plastic { .. })));
    assert!(
        told.contains("<boolean name=\"collapse\">") && told.contains(": ignored in obj") && told.contains("max_smooth_angle"),
        "{told}"
    );
    // The last one counts, as in Mitsuba.
    let (last, _) = parts(&format!(r#"{glass}<bsdf type="plastic"/>"#));
    assert!(matches!(last[0].1.bsdf, Bsdf::Plastic { .. }));
    let (guessed, told) = parts(r#"<bsdf name="bsdf" type="plastic"/><boolean name="loadMaterials" value="false"/>"#);
    assert!(matches!(guessed[0].1.bsdf, Bsdf::Plastic { .. }));
    assert!(told.contains("the OBJ file has no material \"bsdf\""), "{told}");
}

#[test]
fn a_library_of_an_obj_file_whose_pictures_are_gone_is_not_used() {
    let folder = Folder::new();
    folder
        .write("stale.obj", "mtllib stale.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n")
        .write("stale.mtl", "newmtl x\nmap_Kd C:\\work\\wood.jpg\n");
    let file = r#"<string name="filename" value="stale.obj"/>"#;
    let imported = load(&folder, &format!(r#"<shape type="obj">{file}<bsdf name="bsdf" type="plastic"/></shape>"#));
    assert!(matches!(imported.scene.materials[imported.scene.parts[0].material as usize].bsdf, Bsdf::Plastic { .. }));
    assert!(warnings(&imported).contains("the material \"x\" of the OBJ file was not used"), "{}", warnings(&imported));
}

#[test]
fn the_shape_index_picks_one_mesh_of_an_obj_file() {
    let folder = Folder::new();
    folder.write("aquarium.obj", AQUARIUM);
    let scene = |index: &str| {
        let shape = format!(
            r#"<shape type="obj" id="Fish"><string name="filename" value="aquarium.obj"/><bsdf type="diffuse"/>
            <integer name="shapeIndex" value="{index}"/></shape>"#
        );
        folder.write("a.xml", format!("<scene version=\"0.6.0\">{shape}</scene>"))
    };
    let names = |index: &str| scene(index).load("a.xml").unwrap().scene.parts.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    assert_eq!(names("2"), ["Fish.lid"]);
    assert_eq!(names("-1"), ["Fish.tank", "Fish.tank_2", "Fish.lid"]);
    let message = scene("3").error("a.xml");
    assert!(message.contains("found shapeIndex 3, but there are only 3 meshes in aquarium.obj"), "{message}");
}

#[test]
fn instances_share_the_meshes_of_their_group() {
    let folder = Folder::new();
    let imported = load(
        &folder,
        r#"<shape type="shapegroup" id="tree"><shape type="sphere" id="crown"/><shape type="cube" id="trunk"/></shape>
        <shape type="instance" id="left"><ref id="tree"/></shape>
        <shape type="instance"><ref id="tree"/><transform name="toWorld"><translate x="5"/></transform></shape>"#,
    );
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["left_crown", "left_trunk", "tree_crown", "tree_trunk"]);
    assert_eq!(imported.scene.meshes.len(), 2);
    assert_eq!(imported.scene.parts[2].world_from_mesh.translation, DVec3::new(5.0, 0.0, 0.0));
}

/// The limit for references in a circle counted each instance; and finding the place of each element took minutes.
#[test]
fn a_forest_of_seventy_thousand_trees_is_imported() {
    let folder = Folder::new();
    let trees = r#"<shape type="instance"><ref id="tree"/></shape>"#.repeat(70_000);
    let imported = load(&folder, &format!(r#"<shape type="shapegroup" id="tree"><shape type="cube"/></shape>{trees}"#));
    assert_eq!((imported.scene.parts.len(), imported.scene.meshes.len()), (70_000, 1));
}

#[test]
fn bsdfs_within_many_bsdfs_are_no_mistake() {
    let folder = Folder::new();
    let bsdf = r#"<bsdf type="twosided"><bsdf type="mask"><bsdf type="diffuse"/></bsdf></bsdf>"#;
    let imported = load(&folder, &format!(r#"<shape type="cube">{bsdf}</shape>"#).repeat(40_000));
    assert_eq!(imported.scene.materials.len(), 40_000);
}

#[test]
fn cameras_see_what_mitsuba_sees() {
    let folder = Folder::new();
    let film = r#"<film type="hdrfilm"><integer name="width" value="800"/><integer name="height" value="400"/></film>"#;
    let camera = |fov: &str| {
        let body = format!(
            r#"<shape type="cube"/><sensor type="perspective">{fov}{film}<transform name="toWorld">
            <lookAt origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform></sensor>"#
        );
        load(&folder, &body).scene.cameras[0].clone()
    };
    let c = camera(r#"<float name="fov" value="90"/>"#);
    assert_eq!((c.position, c.aspect), (DVec3::new(0.0, -5.0, 1.0), 2.0));
    // Looking along −z of the file, which is +y of the world; right is +x, up +z.
    assert!((c.world_from_camera.x_axis - DVec3::X).length() < 1e-12 && (c.world_from_camera.z_axis - DVec3::NEG_Y).length() < 1e-12);
    let half = |fov: &str| (0.5 * camera(fov).fov_x_rad).tan();
    assert!((half(r#"<float name="fov" value="90"/>"#) - 1.0).abs() < 1e-9);
    assert!((half(r#"<float name="fov" value="90"/><string name="fovAxis" value="y"/>"#) - 2.0).abs() < 1e-9);
    assert!((half(r#"<float name="fov" value="90"/><string name="fov_axis" value="diagonal"/>"#) - 2.0 / 5.0f64.sqrt()).abs() < 1e-9);
    let by_length = half(r#"<string name="focalLength" value="50mm"/>"#);
    assert!((by_length - 43.266_615_3 / 100.0 * 2.0 / 5.0f64.sqrt()).abs() < 1e-6);
    // Without a field of view and a focal length, the latter is 50 mm.
    assert_eq!(half(""), by_length);
}

#[test]
fn cameras_without_an_up_look_any_way_and_roll_as_in_mitsuba() {
    let folder = Folder::new();
    for (target, right) in [("0 -1 0", DVec3::NEG_Y), ("0 0 -1", DVec3::NEG_Z)] {
        let camera = format!(
            r#"<shape type="cube"/><sensor type="perspective">
            <transform name="toWorld"><lookAt origin="0 0 0" target="{target}"/></transform></sensor>"#
        );
        let found = load(&folder, &camera).scene.cameras[0].world_from_camera.x_axis;
        assert!((found - right).length() < 1e-12, "{target}: {found}");
    }
}

#[test]
fn emitters_of_all_kinds() {
    let folder = Folder::new();
    folder.write("sky.png", png(4, 2, [9, 9, 9, 255]));
    let body = r#"<shape type="rectangle"><emitter type="area"><rgb name="radiance" value="3"/></emitter></shape>
        <emitter type="point" id="bulb"><point name="position" x="0" y="2" z="0"/><rgb name="intensity" value="8"/></emitter>
        <emitter type="spot"><float name="cutoffAngle" value="40"/><spectrum name="intensity" value="2"/></emitter>
        <emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/><spectrum name="irradiance" value="5"/></emitter>
        <emitter type="envmap"><string name="filename" value="sky.png"/><float name="scale" value="2"/></emitter>"#;
    folder.write("a.xml", format!("<scene version=\"2.0.0\">{body}</scene>"));
    let options = ImportOptions { meters_per_unit: 0.5, ..ImportOptions::default() };
    let imported = folder.load_with("a.xml", &options).unwrap();
    let scene = &imported.scene;
    let lamp = &scene.materials[0];
    assert_eq!((lamp.emission.factor, lamp.emits_both_sides, lamp.name.as_str()), (Rgb::splat(3.0), false, "inline_emitter"));
    assert_eq!(lamp.bsdf, Bsdf::Diffuse { reflectance: Rgb::BLACK.into() });
    assert_eq!(scene.lights[0], Light::Point { name: "bulb".into(), position: Vec3::Z, intensity: Rgb::splat(2.0) });
    assert!(
        matches!(&scene.lights[1], Light::Spot { direction, inner_rad, falloff: SpotFalloff::Angle, .. } if *direction == Vec3::NEG_Y && (inner_rad - 30f32.to_radians()).abs() < 1e-6)
    );
    assert!(matches!(&scene.lights[2], Light::Directional { direction, .. } if *direction == Vec3::NEG_Z));
    assert!(matches!(&scene.environment, Some(Environment::Map { rows: MapRows::PoleToPole, scale, .. }) if scale.g == 2.0));
    let imported = load(&folder, r#"<shape type="cube"/><emitter type="constant"><rgb name="radiance" value="1 2 3"/></emitter>"#);
    assert_eq!(imported.scene.environment, Some(Environment::Constant { radiance: Rgb::new(1.0, 2.0, 3.0) }));
}

#[test]
fn spectra_may_be_objects_or_files() {
    let folder = Folder::new();
    folder.write("lamp.spd", "# nm, value\n400 0.1\n700 0.2\n");
    let radiance = |spectrum: &str| {
        let imported = load(&folder, &format!(r#"<shape type="cube"><emitter type="area">{spectrum}</emitter></shape>"#));
        assert!(imported.report.warnings.is_empty(), "{spectrum}: {}", warnings(&imported));
        imported.scene.materials[0].emission.factor
    };
    let object = |kind: &str, more: &str| radiance(&format!(r#"<spectrum type="{kind}" name="radiance">{more}</spectrum>"#));
    let black = radiance(r#"<blackbody name="radiance" temperature="5000K" scale="2"/>"#);
    assert_eq!(object("blackbody", r#"<float name="temperature" value="5000"/>"#) * 2.0, black);
    assert_eq!(object("d65", ""), Rgb::WHITE);
    let tinted = r#"<rgb name="color" value="1 2 3"/><float name="scale" value="2"/>"#;
    assert_eq!(object("d65", tinted), Rgb::new(2.0, 4.0, 6.0));
    assert_eq!(object("uniform", r#"<float name="value" value="0.25"/>"#), Rgb::splat(0.25));
    let expected = radiance(r#"<spectrum name="radiance" value="400:0.1 700:0.2"/>"#);
    let values = r#"<string name="values" value="0.1, 0.2"/>"#;
    assert_eq!(object("irregular", &format!(r#"<string name="wavelengths" value="400, 700"/>{values}"#)), expected);
    assert_eq!(object("regular", &format!(r#"<string name="range" value="400, 700"/>{values}"#)), expected);
    let range = r#"<float name="wavelength_min" value="400"/><float name="wavelength_max" value="700"/>"#;
    assert_eq!(object("regular", &format!("{range}{values}")), expected);
    assert_eq!(object("regular", &format!("{}{values}", range.replace("wavelength", "lambda"))), expected);
    assert_eq!(radiance(r#"<spectrum name="radiance" filename="lamp.spd"/>"#), expected);
    let message = |spectrum: &str| {
        let scene = format!(r#"<scene><shape type="cube"><emitter type="area">{spectrum}</emitter></shape></scene>"#);
        folder.write("a.xml", scene).error("a.xml")
    };
    let laser = message(r#"<spectrum type="laser" name="radiance"/>"#);
    assert!(laser.contains("spectra of the type \"laser\" are not supported; expected blackbody, d65"), "{laser}");
    let short = message(&format!(r#"<spectrum type="irregular" name="radiance">{values}</spectrum>"#));
    assert!(short.contains("found 2 values at 0 wavelengths"), "{short}");
    folder.write("odd.spd", "400 0.1 700");
    assert!(message(r#"<spectrum name="radiance" filename="odd.spd"/>"#).starts_with("odd.spd: whole file: found 3 numbers"));
}

#[test]
fn daylight_by_a_texture_is_the_texture() {
    let folder = Folder::new();
    folder.write("t.png", png(2, 2, [9, 9, 9, 255]));
    let texture = r#"<texture type="bitmap"><string name="filename" value="t.png"/></texture>"#;
    let lamp = format!(r#"<emitter type="area"><spectrum type="d65" name="radiance">{texture}</spectrum></emitter>"#);
    let imported = load(&folder, &format!(r#"<shape type="rectangle">{lamp}</shape>"#));
    assert!(imported.scene.materials[0].emission.texture.is_some());
}

#[test]
fn a_skewed_sky_is_turned_to_the_nearest_rotation() {
    let folder = Folder::new();
    folder.write("sky.png", png(4, 2, [9, 9, 9, 255]));
    let sky = |steps: &str| {
        let sky = format!(
            r#"<shape type="cube"/><emitter type="envmap"><string name="filename" value="sky.png"/>
            <transform name="toWorld">{steps}</transform></emitter>"#
        );
        let imported = load(&folder, &sky);
        let Some(Environment::Map { map_from_world, .. }) = imported.scene.environment else { panic!("no sky") };
        (map_from_world, warnings(&imported).contains("skewed"))
    };
    let turn = r#"<rotate x="1" angle="30"/>"#;
    let ((straight, warned), (skewed, told), (mirrored, _)) =
        (sky(turn), sky(&format!(r#"{turn}<scale y="2"/>"#)), sky(&format!(r#"{turn}<scale x="-1"/>"#)));
    assert!(!warned && told);
    for (m, determinant) in [(straight, 1.0), (skewed, 1.0), (mirrored, -1.0)] {
        assert!((m * m.transpose()).abs_diff_eq(Mat3::IDENTITY, 1e-6) && (m.determinant() - determinant).abs() < 1e-6, "{m:?}");
    }
    assert!((skewed - straight).to_cols_array().iter().all(|v| v.abs() < 0.4), "{skewed:?} beside {straight:?}");
}

#[test]
fn daylight_puts_the_sun_where_the_file_says() {
    let folder = Folder::new();
    let body = r#"<shape type="cube"/><emitter type="sunsky"><vector name="sunDirection" x="0" y="1" z="1"/>
        <float name="turbidity" value="3"/><float name="scale" value="2"/></emitter>"#;
    let imported = load(&folder, body);
    let Light::Directional { direction, irradiance, angular_radius_rad, .. } = &imported.scene.lights[0] else { panic!("no sun") };
    assert!((*direction - Vec3::new(0.0, 0.5f32.sqrt(), -0.5f32.sqrt())).length() < 1e-6);
    // The sun's spectral irradiance is between one and two W·m⁻²·nm⁻¹; doubled.
    assert!((1.5..4.0).contains(&irradiance.luminance()) && *angular_radius_rad > 0.004);
    assert!(matches!(imported.scene.environment, Some(Environment::Map { scale, .. }) if scale.g == 2.0));
}

#[test]
fn skies_of_version_3_have_z_up_a_lighter_ground_and_suns_by_their_aperture() {
    let folder = Folder::new();
    let sky = |version: &str, up_axis: Option<UpAxis>, more: &str| {
        let sun = r#"<vector name="sunDirection" x="0" y="0.6" z="0.8"/>"#;
        let body = format!(r#"<shape type="cube"/><emitter type="sunsky">{sun}{more}</emitter>"#);
        folder.write("a.xml", format!("<scene version=\"{version}\">{body}</scene>"));
        let options = ImportOptions { up_axis, ..ImportOptions::default() };
        folder.load_with("a.xml", &options).unwrap_or_else(|e| panic!("{e}"))
    };
    let third = sky("3.5.0", Some(UpAxis::Z), r#"<float name="sun_aperture" value="2"/>"#);
    let Light::Directional { direction, angular_radius_rad, .. } = &third.scene.lights[0] else { panic!("no sun") };
    assert!((*direction - Vec3::new(0.0, -0.6, -0.8)).length() < 1e-6, "{direction}");
    assert!((*angular_radius_rad - 1f32.to_radians()).abs() < 1e-6, "{angular_radius_rad}");
    let told = |imported: &Imported| warnings(imported).contains("the sky's own up is not the scene's");
    assert!(!told(&third) && told(&sky("3.5.0", None, "")) && !told(&sky("0.6.0", None, "")));
    let albedo = |value: &str| format!(r#"<spectrum name="albedo" value="{value}"/>"#);
    assert!(third.scene.images == sky("3.5.0", Some(UpAxis::Z), &albedo("0.3")).scene.images);
    assert!(sky("0.6.0", None, "").scene.images == sky("0.6.0", None, &albedo("0.15")).scene.images);
}

#[test]
fn parameters_aliases_and_includes_are_followed() {
    let folder = Folder::new();
    folder.write(
        "materials.xml",
        r#"<scene version="3.0.0"><bsdf type="diffuse" id="A"><rgb name="reflectance" value="$grey"/></bsdf></scene>"#,
    );
    let imported = load(
        &folder,
        r#"<default name="grey" value="0.25"/><default name="grey" value="0.75"/><include filename="materials.xml"/><alias id="A" as="B"/>
        <shape type="sphere" id="S"><ref id="B"/></shape>"#,
    );
    assert_eq!(imported.scene.materials[0].bsdf, Bsdf::Diffuse { reflectance: Rgb::splat(0.25).into() });
    assert_eq!(imported.inputs.len(), 2);
}

#[test]
fn included_files_include_what_lies_beside_them() {
    let folder = Folder::new();
    folder.write("parts/all.xml", r#"<scene><include filename="ball.xml"/></scene>"#);
    folder.write("parts/ball.xml", r#"<scene><shape type="sphere" id="Near"/></scene>"#);
    folder.write("ball.xml", r#"<scene><shape type="sphere" id="Far"/></scene>"#);
    let imported = load(&folder, r#"<include filename="parts/all.xml"/><include filename="ball.xml"/>"#);
    let names: Vec<&str> = imported.scene.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["Near", "Far"]);
}

#[test]
fn files_are_looked_for_in_the_folders_of_paths() {
    let folder = Folder::new();
    let obj = |x: u32| format!("v {x} 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("models/a.obj", obj(7)).write("a.obj", obj(5)).write("b.obj", obj(3)).write("more/t.png", png(2, 2, [9, 9, 9, 255]));
    let shape = |file: &str| format!(r#"<shape type="obj"><string name="filename" value="{file}"/></shape>"#);
    let texture = r#"<texture type="bitmap" name="reflectance"><string name="filename" value="t.png"/></texture>"#;
    let textured = format!(r#"<shape type="rectangle"><bsdf type="diffuse">{texture}</bsdf></shape>"#);
    let paths = r#"<path value="models"/><path value="more"/><path value="gone"/>"#;
    let imported = load(&folder, &format!("{paths}{}{}{textured}", shape("a.obj"), shape("b.obj")));
    let x = |part: usize| imported.scene.meshes[part].positions[0].x;
    assert_eq!((x(0), x(1), imported.scene.images.len()), (7.0, 3.0, 1));
    assert!(warnings(&imported).contains("<path>: there is no folder \"gone\""), "{}", warnings(&imported));
}

//! V-Ray features, one small file each.

use crate::common::vray::*;
use crate::common::{Folder, png, warnings};
use enfilade_import::ImportOptions;
use enfilade_math::{DVec3, Rgb, Vec2, Vec3};
use enfilade_scene::{Bsdf, Environment, Filter, Light, TiltedPinhole, Wrap};

#[test]
fn nodes_are_placed_in_metres_with_z_up_and_share_meshes() {
    let folder = Folder::new();
    let nodes = "SettingsUnitsInfo u { meters_scale=0.01; }\n\
        Node b@node_2 { geometry=mesh; material=mtl; transform=Transform(Matrix(Vector(0,1,0), Vector(-1,0,0), Vector(0,0,2)), Vector(100,0,300)); }\n\
        Node c { geometry=mesh; material=mtl; visible=0; }\n";
    let text = [TRIANGLE, NODE, GREY, nodes].concat();
    let scene = load_text(&folder, &text).scene;
    assert_eq!(scene.parts.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["chair@node_1", "b@node_2"]);
    assert_eq!((scene.meshes.len(), scene.materials.len()), (1, 1));
    // The x axis goes to y, as in the first vector of the matrix.
    let corners = scene.world_corners(&scene.parts[1], 0);
    assert!(corners[0].distance(Vec3::new(1.0, 0.0, 3.0)) < 1e-6 && corners[1].distance(Vec3::new(1.0, 0.02, 3.0)) < 1e-6, "{corners:?}");
    // The option multiplies the file's unit.
    let options = ImportOptions { meters_per_unit: 50.0, ..ImportOptions::default() };
    let imported = folder.load_with("a.vrscene", &options).unwrap();
    assert_eq!(imported.scene.world_corners(&imported.scene.parts[0], 0)[1], Vec3::new(1.0, 0.0, 0.0));
    let y_up = load_text(&folder, &text.replace("meters_scale=0.01;", "meters_scale=1; scene_upDir=Vector(0,1,0);")).scene;
    assert!(y_up.world_corners(&y_up.parts[0], 0)[2].distance(Vec3::new(0.0, 0.0, 2.0)) < 1e-6);
}

#[test]
fn corners_have_their_own_normals_and_texture_coordinates() {
    let folder = Folder::new();
    // Two triangles that share two positions; one of these has two texture coordinates.
    let mesh = "GeomStaticMesh mesh {
      vertices=ListVector(Vector(0,0,0), Vector(1,0,0), Vector(1,1,0), Vector(0,1,0));
      faces=List(0,1,2, 0,2,3); normals=ListVector(Vector(0,0,1)); faceNormals=ListInt(0,0,0, 0,0,0);
      map_channels=List(
        List(1, ListVector(Vector(9,9,9)), ListInt(0,0,0, 0,0,0)),
        List(2, ListVector(Vector(0,0,0), Vector(1,0,0), Vector(1,1,0), Vector(0,1,0), Vector(5,5,0)), ListInt(0,1,2, 4,2,3)));
    }\n";
    folder.write("t.png", png(2, 2, [255, 128, 0, 255]));
    let brdf = "BRDFDiffuse brdf { color_tex=tex; }\nTexBitmap tex { bitmap=buffer; uvwgen=uvw; }\n\
        BitmapBuffer buffer { file=\"t.png\"; gamma=0.454545; filter_type=-1; }\n\
        UVWGenChannel uvw { uvw_channel=2; wrap_u=2; uvw_transform=Transform(Matrix(Vector(3,0,0), Vector(0,4,0), Vector(0,0,1)), Vector(0.5,0.25,0)); }\n";
    let scene = load_text(&folder, &[mesh, NODE, UNITS, brdf].concat()).scene;
    let mesh = &scene.meshes[0];
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (5, 2), "the corner with two coordinates is two vertices");
    assert_eq!(mesh.normals, vec![Vec3::Z; 5]);
    assert_eq!(mesh.uvs[mesh.triangles[1][0] as usize], Vec2::splat(5.0));
    let Bsdf::Diffuse { reflectance } = &scene.materials[0].bsdf else { panic!("{:?}", scene.materials[0]) };
    let texture = reflectance.texture.unwrap();
    assert_eq!(texture.uv_transform, [[3.0, 0.0, 0.5], [0.0, 4.0, 0.25]]);
    assert_eq!((texture.wrap, texture.filter), ([Wrap::Mirror, Wrap::Repeat], Filter::Nearest));
    let (color, _) = scene.images[0].texel(0, 0);
    assert!((color.g - 0.2159).abs() < 1e-3, "a gamma means that the picture is encoded: {color:?}");
}

#[test]
fn faces_take_the_material_of_their_id() {
    let folder = Folder::new();
    let text = "GeomStaticMesh mesh { vertices=ListVector(Vector(0,0,0), Vector(1,0,0), Vector(0,1,0)); faces=ListInt(0,1,2, 0,2,1); face_mtlIDs=ListInt(7, 3); }
      Node box@node_1 { geometry=mesh; material=outer; }
      MtlRenderStats outer { base_mtl=multi; }
      MtlMulti multi { mtls_list=List(red, blue); ids_list=ListInt(3, 7); }
      MtlSingleBRDF red { brdf=r; } MtlSingleBRDF blue { brdf=b; }
      BRDFDiffuse r { color=Color(1,0,0); } BRDFDiffuse b { color=Color(0,0,1); }\n";
    let scene = load_text(&folder, &[text, UNITS].concat()).scene;
    let parts: Vec<_> = scene.parts.iter().map(|p| (p.name.as_str(), scene.meshes[p.mesh as usize].triangles[0])).collect();
    assert_eq!(parts, [("box@node_1_red", [0, 1, 2]), ("box@node_1_blue", [0, 1, 2])]);
    let reflectance = |part: usize| match &scene.materials[scene.parts[part].material as usize].bsdf {
        Bsdf::Diffuse { reflectance } => reflectance.factor,
        other => panic!("{other:?}"),
    };
    assert_eq!((reflectance(0), reflectance(1)), (Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 0.0, 1.0)));
}

#[test]
fn every_material_of_a_list_has_a_texture_channel_of_its_own() {
    let folder = Folder::new();
    folder.write("t.png", png(1, 1, [255, 128, 0, 255]));
    let text = "GeomStaticMesh mesh { vertices=ListVector(Vector(0,0,0), Vector(1,0,0), Vector(0,1,0)); faces=ListInt(0,1,2, 0,2,1); face_mtlIDs=ListInt(0, 1);
        map_channels=List(List(1, ListVector(Vector(1,1,0)), ListInt(0,0,0, 0,0,0)), List(2, ListVector(Vector(2,2,0)), ListInt(0,0,0, 0,0,0))); }
      Node box { geometry=mesh; material=multi; }
      MtlMulti multi { mtls_list=List(one, two); }
      MtlSingleBRDF one { brdf=a; } BRDFDiffuse a { color_tex=ta; } TexBitmap ta { bitmap=buf; uvwgen=ua; } UVWGenChannel ua { uvw_channel=1; }
      MtlSingleBRDF two { brdf=b; } BRDFDiffuse b { color_tex=tb; } TexBitmap tb { bitmap=buf; uvwgen=ub; } UVWGenChannel ub { uvw_channel=2; }
      BitmapBuffer buf { file=\"t.png\"; }\n";
    let scene = load_text(&folder, &[text, UNITS].concat()).scene;
    let uvs: Vec<Vec2> = scene.parts.iter().map(|p| scene.meshes[p.mesh as usize].uvs[0]).collect();
    assert_eq!(uvs, [Vec2::splat(1.0), Vec2::splat(2.0)]);
}

#[test]
fn of_a_scene_told_moment_by_moment_the_first_counts() {
    let folder = Folder::new();
    let again = "#time 1\nNode chair@node_1 { geometry=mesh; material=mtl; visible=0; }\n#time 2\n";
    let imported = load_text(&folder, &["#time 0\n", TRIANGLE, NODE, GREY, UNITS, again].concat());
    assert_eq!(imported.scene.parts.len(), 1);
    let text = warnings(&imported);
    assert!(text.matches("the scene is animated").count() == 1 && !text.contains("another plugin of this name"), "{text}");
}

#[test]
fn included_files_are_read_from_their_own_folder_and_once() {
    let folder = Folder::new();
    folder.write("lib/mats.vrscene", GREY).write("lib/all.vrscene", "#include \"mats.vrscene\"\n#include \"mats.vrscene\"\n");
    let imported = load_text(&folder, &[TRIANGLE, NODE, UNITS, "#include \"lib\\all.vrscene\"\n"].concat());
    assert_eq!(imported.inputs.len(), 3, "{:?}", imported.inputs);
    assert!(warnings(&imported).contains("included before"), "{}", warnings(&imported));
    assert_eq!(imported.report.format, "vray");
}

#[test]
fn cameras_look_along_minus_z_with_the_horizontal_field_of_view() {
    let folder = Folder::new();
    let view = "RenderView view { transform=interpolate((0, Transform(Matrix(Vector(0,1,0), Vector(0,0,1), Vector(1,0,0)), Vector(5,0,1))), (1, Transform(Matrix(Vector(1,0,0), Vector(0,1,0), Vector(0,0,1)), Vector(0,0,0)))); fov=1.2; }\n\
        SettingsOutput out { img_width=800; img_height=400; img_pixelAspect=1.5; }\n";
    let imported = load(&folder, view);
    let camera = &imported.scene.cameras[0];
    assert_eq!((camera.name.as_str(), camera.position, camera.aspect), ("view", DVec3::new(5.0, 0.0, 1.0), 3.0));
    assert_eq!((camera.fov_x_rad, -camera.world_from_camera.z_axis), (1.2, DVec3::NEG_X));
    assert!(warnings(&imported).contains("first of its 2 keyframes"));
    let flat = load(&folder, "RenderView view { orthographic=1; }\n");
    assert!(flat.scene.cameras.is_empty() && warnings(&flat).contains("orthographic"));
}

#[test]
fn the_field_of_view_of_the_settings_overrides_the_views_unless_it_is_below_zero() {
    let folder = Folder::new();
    let fov = |text: &str| load(&folder, text).scene.cameras[0].fov_x_rad;
    assert_eq!(fov("RenderView view { fov=0.5; }\nSettingsCamera s { fov=1.2; }\n"), 1.2);
    assert_eq!(fov("RenderView view { fov=0.5; }\nSettingsCamera s { fov=-1; }\n"), 0.5);
    assert_eq!(fov("RenderView view { fov=0.5; }\nSettingsCamera s { type=0; }\n"), 0.5);
    assert_eq!(fov("RenderView view { }\nSettingsCamera s { fov=-1; }\n"), std::f64::consts::FRAC_PI_4);
    let both = load(&folder, "RenderView view { fov=0.5; }\nSettingsCamera s { fov=1.2; }\n");
    assert!(warnings(&both).contains("the 1.2 of SettingsCamera override it"), "{}", warnings(&both));
}

#[test]
fn physical_cameras_have_the_field_of_view_of_their_film_and_report_shifts() {
    let folder = Folder::new();
    let with = |physical: &str| {
        load(&folder, &format!("RenderView view {{ fov=0.5; }}\nCameraPhysical c {{ exposure=0; target_distance=1e9; {physical} }}\n"))
    };
    let fov = |physical: &str| with(physical).scene.cameras[0].fov_x_rad;
    assert!((fov("film_width=36; focal_length=18; zoom_factor=1;") - std::f64::consts::FRAC_PI_2).abs() < 1e-6);
    assert!((fov("film_width=36; focal_length=9; zoom_factor=2;") - std::f64::consts::FRAC_PI_2).abs() < 1e-6);
    assert_eq!(fov("specify_fov=1; fov=1.0;"), 1.0);
    let shifted = with("specify_fov=1; fov=1.1; target_distance=200; lens_shift=0.2; vertical_offset=0.1;");
    let text = warnings(&shifted);
    let rows = text.split("cam_from_uv = ").nth(1).expect("a matrix").lines().next().unwrap();
    let numbers: Vec<f64> = rows.split(|c: char| "[], ".contains(c)).filter_map(|n| n.parse().ok()).collect();
    let m = enfilade_math::DMat3::from_cols_slice(&numbers).transpose();
    // Across the middle of the picture the field of view is as stated, and the axis meets it elsewhere.
    let camera = TiltedPinhole::new(640, 480, m).unwrap();
    let (left, right) = (camera.ray(0.0, 240.0), camera.ray(640.0, 240.0));
    assert!((right.x - left.x - 2.0 * 0.55f64.tan()).abs() < 1e-6, "{left} {right}");
    assert!(camera.ray(320.0, 240.0).y.abs() > 0.05 && camera.ray(320.0, 240.0).x.abs() < 1e-12);
}

#[test]
fn exposure_multiplies_all_light_but_what_compensates_it() {
    let folder = Folder::new();
    // 0.65 / 78 × ISO 400 / 300 / f/2² for 0.002 per cd/m².
    let k = 0.65 / 78.0 * 400.0 / (300.0 * 4.0) / 0.002;
    let camera = "RenderView view {}\nCameraPhysical c { ISO=400; shutter_speed=300; f_number=2; EXPOSURE }\n";
    let scene = |more: &str| load(&folder, &[camera, "LightSphere s { intensity=3; }\n"].concat().replace("EXPOSURE", more));
    let on = scene("");
    assert!(near(emission(&on), Rgb::splat(3.0 * k)), "{:?} and not {}", emission(&on), 3.0 * k);
    assert!(warnings(&on).contains("the camera's exposure") && warnings(&on).contains("vignetting"));
    assert_eq!(emission(&scene("exposure=0;")), Rgb::splat(3.0));
    // EV 8 is f²/t = 2^8 at ISO 100, whatever the other parameters are.
    let by_value = scene("exposure=2; exposure_value=8;");
    assert!(near(emission(&by_value), Rgb::splat(3.0 * 0.65 / 78.0 * 100.0 / 256.0 / 0.002)), "{:?}", emission(&by_value));
    assert!(warnings(&by_value).contains("ISO 100"), "{}", warnings(&by_value));
    let glowing = |more: &str| {
        let brdf = format!("BRDFVRayMtl brdf {{ self_illumination=AColor(1,1,1,1); {more} }}\n");
        material(&folder, &[camera.replace("EXPOSURE", ""), brdf].concat()).0.emission.factor
    };
    assert!(near(glowing(""), Rgb::splat(k)) && glowing("compensate_camera_exposure=1;") == Rgb::WHITE);
}

#[test]
fn lights_have_the_radiance_that_their_units_say() {
    let folder = Folder::new();
    let rectangle = |more: &str| {
        let light = format!("LightRectangle lamp@light_1 {{ u_size=0.5; v_size=1; color=Color(2,2,2); {more} }}\n");
        emission(&load(&folder, &light))
    };
    let pi = std::f32::consts::PI;
    assert!(near(rectangle("intensity=3; units=0;"), Rgb::splat(6.0)));
    // 1000 lm from 2 m² by Lambert's law, times the radiance of 1 cd/m².
    assert!(near(rectangle("intensity=1000; units=1;"), Rgb::splat(1000.0 / (2.0 * pi) * 0.002)));
    assert!(near(rectangle("intensity=1000; units=2;"), Rgb::splat(2.0)));
    assert!(near(rectangle("intensity=1; units=3;"), Rgb::splat(683.0 / (2.0 * pi) * 0.002)));
    assert!(near(rectangle("intensity=1; units=4;"), Rgb::splat(683.0 * 0.002)));
    let overridden = "LightSphere s { color=Color(1,1,1); color_tex=AColor(0.5,0.25,0,1); intensity=1; intensity_tex=t; }\n\
        TexFloat t { input=4; }\n";
    assert!(near(emission(&load(&folder, overridden)), Rgb::new(2.0, 1.0, 0.0)), "textures override colour and intensity");
    let scene = load(&folder, "LightRectangle lamp { u_size=0.5; v_size=1; transform=Transform(Matrix(Vector(1,0,0), Vector(0,1,0), Vector(0,0,1)), Vector(0,0,3)); }\n").scene;
    let part = scene.parts.iter().find(|p| p.name == "lamp").unwrap();
    let [a, b, c] = scene.world_corners(part, 0);
    assert!((b - a).cross(c - a).normalize().distance(Vec3::NEG_Z) < 1e-6, "it shines down");
    let sphere = load(&folder, "LightSphere bulb { radius=0.1; intensity=800; units=1; }\n");
    assert!(near(emission(&sphere), Rgb::splat(800.0 / (pi * 4.0 * pi * 0.01) * 0.002)));
    let mesh = load(&folder, "LightMesh glow { geometry=mesh; intensity=100; units=1; }\n");
    assert!(near(emission(&mesh), Rgb::splat(100.0 / (pi * 2.0) * 0.002)), "a triangle of 2 m²");
    assert!(load(&folder, "LightSphere off { enabled=0; }\n").report.counts.emissive_materials == 0);
}

#[test]
fn points_spots_and_distant_lights_light_a_white_surface_as_3ds_max_has_it() {
    let folder = Folder::new();
    let pi = std::f32::consts::PI;
    let light = |text: &str| load(&folder, text).scene.lights[0].clone();
    let Light::Point { intensity, .. } = light("LightOmni o { intensity=2; color=Color(1,0.5,0); }\n") else { panic!("no point") };
    // Radiance of white at one unit: irradiance over π.
    assert!(near(intensity / pi, Rgb::new(2.0, 1.0, 0.0)));
    let Light::Point { intensity, .. } = light("LightOmni o { intensity=1000; units=1; }\n") else { panic!("no point") };
    assert!(near(intensity, Rgb::splat(1000.0 / (4.0 * pi) * 0.002)));
    let Light::Spot { direction, inner_rad, outer_rad, .. } = light("LightSpot s { coneAngle=1.0; penumbraAngle=-0.2; }\n") else {
        panic!("no spot")
    };
    assert_eq!((direction, inner_rad, outer_rad), (Vec3::NEG_Z, 0.3, 0.5));
    let Light::Directional { irradiance, direction, .. } = light("LightDirectMax d { intensity=1; }\n") else { panic!("not distant") };
    assert!(near(irradiance, Rgb::splat(pi)) && direction == Vec3::NEG_Z);
    folder.write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n300 300\n");
    let Light::Profile { intensity, web, .. } = light("LightIES i { ies_file=\"lamp.ies\"; }\n") else { panic!("no profile") };
    assert!(near(intensity, Rgb::splat(0.002)) && web.candela(Vec3::NEG_Z) == 300.0);
}

#[test]
fn surroundings_come_from_the_dome_the_sky_or_the_settings() {
    let folder = Folder::new();
    let environment = |text: &str| load(&folder, text).scene.environment;
    let settings = "SettingsEnvironment e { bg_color=Color(1,2,3); gi_color=Color(0,0,0); }\n";
    assert_eq!(environment(settings), Some(Environment::Constant { radiance: Rgb::new(1.0, 2.0, 3.0) }));
    assert_eq!(environment("SettingsEnvironment e { bg_tex=AColor(0,0,0,1); }\n"), None);
    let dark = load(&folder, "SettingsEnvironment e { bg_tex=AColor(1,1,1,1); gi_tex=AColor(0,0,0,1); }\n");
    assert!(warnings(&dark).contains("gives no light in V-Ray"), "{}", warnings(&dark));
    let dome = environment(&format!("{settings}LightDome d {{ dome_spherical=1; intensity=2; color=AColor(1,1,1,1); }}\n"));
    assert_eq!(dome, Some(Environment::Constant { radiance: Rgb::splat(2.0) }));
    let half = load(&folder, "LightDome d { intensity=2; }\n").scene;
    let Some(Environment::Map { image, map_from_world, .. }) = half.environment else { panic!("no map") };
    let seen = |d: Vec3| {
        let uv = enfilade_scene::uv_from_direction(map_from_world * d);
        half.images[image as usize].texel(0, (uv.y * 255.9) as usize).0
    };
    assert_eq!((seen(Vec3::new(0.6, 0.0, 0.8)), seen(Vec3::new(0.6, 0.0, -0.8))), (Rgb::WHITE, Rgb::BLACK));
    // The sun is in the direction of the z axis of its transform.
    let day = load(
        &folder,
        "SunLight sun { transform=Transform(Matrix(Vector(0,0,-1), Vector(0,1,0), Vector(1,0,0)), Vector(0,0,0)); intensity_multiplier=0.5; }\nLightDome d { dome_tex=sky; }\nTexSky sky { sun=sun; }\n",
    );
    assert!(
        day.scene.lights.is_empty() && matches!(day.scene.environment, Some(Environment::Map { .. })),
        "a sun on the horizon: {:?}",
        day.scene.lights
    );
    let noon = load(&folder, "SunLight sun { }\n").scene;
    let Light::Directional { direction, irradiance, .. } = &noon.lights[0] else { panic!("no sun") };
    // About 100 kilo-lux at 0.002 per cd/m².
    assert!(*direction == Vec3::NEG_Z && (100.0..260.0).contains(&irradiance.luminance()), "{irradiance:?}");
}

#[test]
fn a_turned_dome_turns_its_picture_only_where_uvw_matrix_does() {
    let folder = Folder::new();
    let quarters = image::RgbaImage::from_fn(4, 2, |x, _| image::Rgba(if x == 1 { [255; 4] } else { [0, 0, 0, 255] }));
    let mut bytes = std::io::Cursor::new(Vec::new());
    quarters.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    folder.write("env.png", bytes.into_inner());
    // Each is the one before it, turned by 90 degrees about z.
    let directions = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, y]| Vec3::new(x, y, 0.0).normalize());
    let bright = |dome: &str, generator: &str| {
        let text = format!(
            "LightDome d {{ dome_spherical=1; dome_tex=t; {dome} }}\nTexBitmap t {{ bitmap=b; uvwgen=u; }}\n\
             UVWGenEnvironment u {{ {generator} }}\nBitmapBuffer b {{ file=\"env.png\"; transfer_function=0; }}\n"
        );
        let scene = load(&folder, &text).scene;
        let Some(Environment::Map { image, map_from_world, .. }) = scene.environment else { panic!("no map") };
        let seen = |d: Vec3| {
            let uv = enfilade_scene::uv_from_direction(map_from_world * d);
            scene.images[image as usize].texel((uv.x * 4.0) as usize % 4, 0).0.r
        };
        directions.iter().position(|d| seen(*d) > 0.5).expect("a bright quarter")
    };
    let still = bright("", "");
    let turned = "transform=Transform(Matrix(Vector(0,1,0), Vector(-1,0,0), Vector(0,0,1)), Vector(0,0,0));";
    // What exporters write for a texture that is locked to the dome: the inverse rotation.
    let locked = "uvw_matrix=Matrix(Vector(0,-1,0), Vector(1,0,0), Vector(0,0,1));";
    assert_eq!(bright(turned, ""), still);
    assert_eq!(bright("", locked), (still + 1) % 4);
    assert_eq!(bright(turned, locked), (still + 1) % 4);
}

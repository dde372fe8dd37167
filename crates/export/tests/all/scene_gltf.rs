//! A scene that is written as glTF and imported again is the same scene, as far as glTF can represent it.

use enfilade_export::{SceneGltf, scene_gltf};
use enfilade_geometry::Mesh;
use enfilade_home::{HomeConfig, RoomKind, home};
use enfilade_import::{ImportOptions, Imported, ImportedLabel, load};
use enfilade_math::{DAffine3, DMat3, DQuat, DVec3, Mat3, Rgb, Vec2, Vec3};
use enfilade_scene::{
    Alpha, Body, BodyMotion, BodyStates, Bsdf, ColorParam, Environment, Image, Labels, Light, MapRows, Material, NormalMap, Object, Part,
    PartLabel, PictureFile, PictureFiles, Pixels, Principled, Quiet, RigidPose, ScalarParam, Scene, Shape, SpotFalloff, StartCamera,
    TextureRef, Wrap,
};

/// The scene, written and read.
fn round_trip(scene: &Scene, labels: &Labels) -> (Imported, Vec<String>) {
    assert_eq!(scene.validate(), Ok(()));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("room.glb");
    let SceneGltf { glb, notes } = scene_gltf(scene, labels, &PictureFiles::new());
    assert_eq!(glb, scene_gltf(scene, labels, &PictureFiles::new()).glb, "the same bytes every time");
    std::fs::write(&path, glb).unwrap();
    (load(&path, &ImportOptions::default(), &Quiet).unwrap(), notes)
}

/// A square with texture coordinates of which one unit is two metres.
fn square() -> Mesh {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    Mesh {
        positions: corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|[x, y]| 0.5 * Vec2::new(x, y)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// One part per material, side by side.
fn shelf(materials: Vec<Material>, images: Vec<Image>) -> Scene {
    let part = |i: usize| Part {
        name: format!("square_{i}"),
        object: None,
        mesh: 0,
        material: i as u32,
        world_from_mesh: DAffine3::from_translation(DVec3::new(3.0 * i as f64, 0.25, 1.5)) * DAffine3::from_rotation_x(0.5),
    };
    let parts = (0..materials.len()).map(part).collect();
    let images = images.into_iter().map(Into::into).collect();
    Scene { meshes: vec![square().into()], parts, materials, images, ..Scene::default() }
}

fn picture(srgb: bool, texels: Vec<[u8; 4]>) -> Image {
    Image { name: "picture".into(), width: 2, height: 2, pixels: Pixels::Rgba8 { srgb, texels } }
}

#[test]
fn pictures_that_came_as_files_are_passed_on_where_they_mean_what_they_meant() {
    let texture = |image| ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(image)) };
    let colored = |image| Material { bsdf: Bsdf::Diffuse { reflectance: texture(image) }, ..Material::diffuse("m", Rgb::WHITE) };
    let images = vec![picture(true, vec![[9; 4]; 4]), picture(false, vec![[9; 4]; 4]), picture(true, vec![[7; 4]; 4])];
    let scene = shelf((0..3).map(colored).collect(), images);
    let file = |text: &str| PictureFile { media_type: "image/jpeg", bytes: format!("JPEG of {text}").into_bytes().into() };
    // The second is linear, which glTF's colours are not; the third has no file.
    let files = PictureFiles::from([(0, file("the first")), (1, file("the second"))]);
    let SceneGltf { glb, .. } = scene_gltf(&scene, &Labels::default(), &files);
    let holds = |text: &str| glb.windows(text.len()).any(|w| w == text.as_bytes());
    assert!(holds("JPEG of the first") && !holds("JPEG of the second"));
    let count = |text: &str| glb.windows(text.len()).filter(|w| *w == text.as_bytes()).count();
    assert_eq!((count("\"image/jpeg\""), count("\"image/png\"")), (1, 2));
    assert_eq!(glb.windows(4).filter(|w| *w == [0x89, b'P', b'N', b'G']).count(), 2);
}

#[test]
fn a_home_keeps_its_parts_places_labels_cameras_and_sky() {
    let home = home(&HomeConfig { seed: 3, rooms: vec![RoomKind::Study], ..HomeConfig::default() });
    let (imported, _) = round_trip(&home.scene, &home.labels);
    let scene = imported.scene;
    let names = |scene: &Scene| scene.parts.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&scene), names(&home.scene));
    for (found, part) in scene.parts.iter().zip(&home.scene.parts) {
        let triangles = home.scene.meshes[part.mesh as usize].triangles.len();
        assert_eq!(scene.meshes[found.mesh as usize].triangles.len(), triangles, "{}", part.name);
        for t in [0, triangles / 2] {
            for (a, b) in scene.world_corners(found, t).iter().zip(home.scene.world_corners(part, t)) {
                assert!(a.distance(b) < 2e-6, "{}: {a} instead of {b}", part.name);
            }
        }
    }
    let labels: Vec<PartLabel> = imported.labels.unwrap().iter().map(|l: &ImportedLabel| l.label).collect();
    assert_eq!(labels, home.labels.parts);
    for (found, camera) in scene.cameras.iter().zip(&home.scene.cameras) {
        assert!(found.position.distance(camera.position) < 1e-6 && (found.fov_x_rad - camera.fov_x_rad).abs() < 1e-6);
        assert!((found.world_from_camera - camera.world_from_camera).to_cols_array().iter().all(|v| v.abs() < 1e-6));
    }
    let Some(Environment::Map { image, map_from_world, rows: MapRows::Bands, .. }) = scene.environment else { panic!("no sky") };
    let Some(Environment::Map { image: sky, map_from_world: expected, scale, .. }) = home.scene.environment else { panic!() };
    assert!(map_from_world.abs_diff_eq(expected, 1e-6));
    let radiance = |scene: &Scene, image: u32| scene.images[image as usize].texel(100, 60).0;
    let (a, b) = (radiance(&scene, image), radiance(&home.scene, sky) * scale);
    assert!((a.g - b.g).abs() < 1e-5 * b.g.abs().max(1.0), "{a:?} instead of {b:?}");
}

#[test]
fn objects_of_parts_come_back_with_their_names_and_what_they_lie_in() {
    let grey = || Material::diffuse("grey", Rgb::splat(0.5));
    let mut scene = shelf(vec![grey(), grey(), grey(), grey(), grey()], vec![]);
    // Two chairs of one name, the first of two parts; a cushion that is a child of the second, and a part that belongs to nothing.
    let object = |name: &str, parent| Object { name: name.into(), parent };
    scene.objects = vec![object("World", None), object("chair", Some(0)), object("chair", Some(0)), object("a/b \"c\"", Some(2))];
    for (part, object) in [(0, 1), (1, 1), (2, 2), (3, 3)] {
        scene.parts[part].object = Some(object);
    }
    let (imported, _) = round_trip(&scene, &Labels::default());
    let lineages: Vec<Vec<&str>> = imported.scene.parts[..4].iter().map(|part| imported.scene.lineage(part)).collect();
    let expected = [vec!["World", "chair"], vec!["World", "chair"], vec!["World", "chair"], vec!["World", "chair", "a/b \"c\""]];
    assert_eq!(lineages, expected);
    let found: Vec<u32> = (0..5).map(|part| imported.scene.object_of(part)).collect();
    assert!(found[0] == found[1] && (1..5).all(|k| !found[k + 1..].contains(&found[k])), "four things of five parts: {found:?}");
    // Another round changes nothing.
    let (again, _) = round_trip(&imported.scene, &Labels::default());
    assert_eq!((&again.scene.objects, again.scene.parts.len()), (&imported.scene.objects, 5));
    assert!(again.scene.parts.iter().zip(&imported.scene.parts).all(|(a, b)| (&a.name, a.object) == (&b.name, b.object)));
}

#[test]
fn mirrored_parts_keep_their_fronts_for_all_readers() {
    let mut scene = shelf(vec![Material::diffuse("grey", Rgb::splat(0.5))], vec![]);
    let mirrored = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    scene.parts.push(Part { name: "mirrored".into(), world_from_mesh: mirrored, ..scene.parts[0].clone() });
    let (imported, _) = round_trip(&scene, &Labels::default());
    for (found, part) in imported.scene.parts.iter().zip(&scene.parts) {
        let front = |scene: &Scene, part: &Part| {
            let [a, b, c] = scene.world_corners(part, 0);
            (b - a).cross(c - a).normalize()
        };
        assert!(front(&imported.scene, found).distance(front(&scene, part)) < 1e-5, "{}", part.name);
    }
    assert_eq!(imported.scene.parts.len(), 2);
}

#[test]
fn metallic_roughness_materials_come_back_as_they_were() {
    let texture =
        TextureRef { uv_transform: [[0.5, 0.0, 0.125], [0.0, 2.0, -0.25]], wrap: [Wrap::Clamp, Wrap::Mirror], ..TextureRef::new(0) };
    let data = TextureRef::new(1);
    let principled = Principled {
        base_color: ColorParam { factor: Rgb::new(0.25, 0.5, 0.75), texture: Some(texture) },
        metallic: ScalarParam { factor: 0.5, texture: Some((data, 2)) },
        roughness: ScalarParam { factor: 0.75, texture: Some((data, 1)) },
        ior: 1.25,
        specular: 0.5.into(),
        specular_color: Rgb::new(0.5, 1.0, 1.0).into(),
        clearcoat: 0.5.into(),
        clearcoat_roughness: 0.25.into(),
        sheen_color: Rgb::splat(0.25).into(),
        sheen_roughness: 0.5.into(),
        ..Principled::default()
    };
    let glass = Principled {
        roughness: 0.0.into(),
        transmission: 1.0.into(),
        solid: true,
        absorption: Rgb::new(0.5, 1.0, 2.0),
        ..Principled::default()
    };
    let leaf = Material {
        alpha: Alpha::Mask { opacity: ScalarParam { factor: 1.0, texture: Some((texture, 3)) }, cutoff: 0.25 },
        emission: Rgb::new(4.0, 2.0, 1.0).into(),
        normal_map: Some(NormalMap::Normal { texture: data, scale: 0.5 }),
        ..Material::new("leaf", Bsdf::Principled(Box::new(principled)))
    };
    let materials = vec![leaf, Material::new("glass", Bsdf::Principled(Box::new(glass)))];
    let color = picture(true, vec![[255, 0, 10, 255], [3, 99, 4, 0], [5, 6, 200, 128], [7, 8, 9, 255]]);
    let images = vec![color, picture(false, vec![[1, 2, 3, 255], [40, 50, 60, 255], [7, 80, 9, 255], [10, 11, 120, 255]])];
    let scene = shelf(materials, images);
    let (imported, notes) = round_trip(&scene, &Labels::default());
    assert_eq!((notes, imported.labels), (vec![], None));
    let found = &imported.scene.materials;
    let pixels = |scene: &Scene, t: Option<TextureRef>| t.map(|t| scene.images[t.image as usize].pixels.clone());
    let (Bsdf::Principled(a), Bsdf::Principled(b)) = (&found[0].bsdf, &scene.materials[0].bsdf) else { panic!() };
    assert_eq!(pixels(&imported.scene, a.base_color.texture), pixels(&scene, b.base_color.texture));
    let without_index = |t: Option<TextureRef>| t.map(|t| TextureRef { image: 0, ..t });
    assert_eq!(without_index(a.base_color.texture), without_index(b.base_color.texture));
    let numbers = |p: &Principled| {
        let scalars = [&p.metallic, &p.roughness, &p.specular, &p.clearcoat, &p.clearcoat_roughness, &p.sheen_roughness];
        (scalars.map(|s| (s.factor, s.texture.map(|(_, c)| c))), p.ior, p.specular_color.factor, p.sheen_color.factor, p.base_color.factor)
    };
    assert_eq!(numbers(a), numbers(b));
    assert_eq!((found[0].emission, found[0].emits_both_sides), (scene.materials[0].emission, false));
    assert!(matches!(found[0].alpha, Alpha::Mask { cutoff: 0.25, opacity: ScalarParam { texture: Some((_, 3)), .. } }));
    assert!(matches!(found[0].normal_map, Some(NormalMap::Normal { scale: 0.5, .. })));
    let Bsdf::Principled(glass) = &found[1].bsdf else { panic!() };
    assert!(glass.solid && (glass.absorption - Rgb::new(0.5, 1.0, 2.0)).map(f32::abs).max_component() < 1e-5, "{glass:?}");
}

#[test]
fn other_surfaces_become_the_nearest_that_gltf_has() {
    let ramp = TextureRef::new(0);
    let gold = Bsdf::Conductor {
        eta: Rgb::new(0.2, 0.4, 1.4),
        k: Rgb::new(3.0, 2.4, 1.9),
        reflectance: Rgb::WHITE.into(),
        alpha: ScalarParam { factor: 0.5, texture: Some((ramp, 0)) }.into(),
    };
    let plaster = Material {
        normal_map: Some(NormalMap::Bump { texture: TextureRef { uv_transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], ..ramp }, scale: 0.5 }),
        ..Material::diffuse("plaster", Rgb::splat(0.5))
    };
    let plastic =
        Bsdf::Plastic { diffuse: Rgb::splat(0.25).into(), eta: 1.4, alpha: 0.25.into(), specular: Rgb::WHITE.into(), nonlinear: false };
    let blend = Bsdf::Blend { first: Box::new(plastic.clone()), second: Box::new(gold.clone()), weight: 0.25.into() };
    let pane = Bsdf::ThinDielectric { eta: 1.52, transmittance: Rgb::splat(0.75).into() };
    let materials = vec![
        Material::new("gold", gold),
        plaster,
        Material::new("plastic", plastic),
        Material::new("blend", blend),
        Material::new("pane", pane),
    ];
    let column = |v: u8| [v, v, v, 255];
    let scene = shelf(materials, vec![picture(false, vec![column(255), column(0), column(255), column(0)])]);
    let (imported, notes) = round_trip(&scene, &Labels::default());
    assert_eq!(notes, ["material \"blend\": glTF cannot blend two surfaces; the heavier one was written"]);
    let principled = |i: usize| match &imported.scene.materials[i].bsdf {
        Bsdf::Principled(p) => p.clone(),
        other => panic!("{other:?}"),
    };
    // ((0.2 − 1)² + 9) / ((0.2 + 1)² + 9) = 9.64 / 10.44
    let gold = principled(0);
    assert!((gold.base_color.factor.r - 9.64 / 10.44).abs() < 1e-6 && gold.metallic.factor == 1.0);
    let (map, channel) = gold.roughness.texture.unwrap();
    // Where alpha is 0.5, roughness is its root.
    assert_eq!((gold.roughness.factor, channel), (1.0, 1));
    assert!((imported.scene.images[map.image as usize].texel(0, 0).0.g - 0.5f32.sqrt()).abs() < 0.003);
    assert_eq!((principled(1).specular.factor, principled(2).ior, principled(2).roughness.factor), (0.0, 1.4, 0.5));
    assert_eq!(principled(3), principled(2));
    assert!(principled(4).transmission.factor == 1.0 && !principled(4).solid);
    // The heights rise and fall by half a metre within one texel of a metre; at the texels themselves both neighbours are alike.
    let Some(NormalMap::Normal { texture, .. }) = imported.scene.materials[1].normal_map else { panic!() };
    let flat = imported.scene.images[texture.image as usize].texel(0, 0).0;
    assert!((flat.b - 1.0).abs() < 0.003 && (flat.r - 0.5).abs() < 0.003, "{flat:?}");
}

#[test]
fn slopes_are_those_of_the_heights_in_metres() {
    let column = |v: u8| [v, v, v, 255];
    let texels = (0..4).flat_map(|_| [0u8, 51, 102, 51].map(column)).collect();
    let ramp = Image { name: "ramp".into(), width: 4, height: 4, pixels: Pixels::Rgba8 { srgb: false, texels } };
    let map = NormalMap::Bump { texture: TextureRef::new(0), scale: 1.0 };
    let scene = shelf(vec![Material { normal_map: Some(map), ..Material::diffuse("ramp", Rgb::splat(0.5)) }], vec![ramp]);
    let (imported, _) = round_trip(&scene, &Labels::default());
    let Some(NormalMap::Normal { texture, .. }) = imported.scene.materials[0].normal_map else { panic!() };
    let normal = imported.scene.images[texture.image as usize].texel(1, 1).0.map(|v| 2.0 * v - 1.0);
    // One unit of texture is two metres and four texels, so the height climbs 0.2 m per half metre.
    let expected = Vec3::new(-0.4, 0.0, 1.0).normalize();
    assert!(Vec3::from(normal.to_array()).distance(expected) < 0.02, "{normal:?} instead of {expected}");
}

#[test]
fn lights_cameras_and_constant_surroundings_come_back() {
    let mut scene = shelf(vec![Material::diffuse("grey", Rgb::splat(0.5))], vec![]);
    let direction = Vec3::new(0.0, 0.6, -0.8);
    let spot = |falloff| Light::Spot {
        name: "spot".into(),
        position: Vec3::new(1.0, 2.0, 3.0),
        direction,
        intensity: Rgb::new(4.0, 2.0, 1.0),
        inner_rad: 0.25,
        outer_rad: 0.5,
        falloff,
    };
    scene.lights = vec![
        Light::Point { name: "bulb".into(), position: Vec3::new(-1.0, 0.5, 2.0), intensity: Rgb::splat(7.0) },
        spot(SpotFalloff::CosineSquare),
        Light::Directional { name: "sun".into(), direction, irradiance: Rgb::new(3.0, 3.0, 1.5), angular_radius_rad: 0.0 },
    ];
    scene.environment = Some(Environment::Constant { radiance: Rgb::new(0.5, 0.25, 0.125) });
    let world_from_camera = DMat3::from_cols(DVec3::NEG_Y, DVec3::Z, DVec3::NEG_X);
    let position = DVec3::new(0.5, -2.0, 1.25);
    scene.cameras = vec![StartCamera { name: "view".into(), position, world_from_camera, fov_x_rad: 1.0, aspect: 1.5 }];
    let (imported, notes) = round_trip(&scene, &Labels::default());
    assert!(notes.is_empty() && imported.scene.environment == scene.environment);
    for (found, light) in imported.scene.lights.iter().zip(&scene.lights) {
        match (found, light) {
            (Light::Point { position: a, intensity: i, .. }, Light::Point { position: b, intensity: j, .. }) => {
                assert!(a.distance(*b) < 1e-6 && i == j);
            }
            (
                Light::Spot { direction: a, intensity: i, outer_rad: o, .. },
                Light::Spot { direction: b, intensity: j, outer_rad: p, .. },
            ) => {
                assert!(a.distance(*b) < 1e-6 && i == j && o == p);
            }
            (Light::Directional { direction: a, irradiance: i, .. }, Light::Directional { direction: b, irradiance: j, .. }) => {
                assert!(a.distance(*b) < 1e-6 && i == j);
            }
            other => panic!("{other:?}"),
        }
    }
    assert!((imported.scene.cameras[0].fov_x_rad - 1.0).abs() < 1e-6 && imported.scene.cameras[0].position.distance(position) < 1e-6);
    for falloff in [SpotFalloff::Angle, SpotFalloff::SmoothCosine, SpotFalloff::SmoothAngle] {
        scene.lights = vec![spot(falloff)];
        assert_eq!(round_trip(&scene, &Labels::default()).1.len(), 1, "what is lost is said");
    }
}

#[test]
fn a_turned_sky_keeps_its_directions() {
    let mut scene = shelf(vec![Material::diffuse("grey", Rgb::splat(0.5))], vec![]);
    scene.images =
        vec![Image { name: "sky".into(), width: 2, height: 1, pixels: Pixels::RgbF32(vec![[3.0, 2.0, 1.0], [0.5, 0.25, 9.0]]) }.into()];
    let map_from_world = Mat3::from_rotation_x(0.7) * Mat3::from_rotation_z(-1.1);
    scene.environment = Some(Environment::Map { image: 0, rows: MapRows::PoleToPole, scale: Rgb::splat(2.0), map_from_world });
    let (imported, _) = round_trip(&scene, &Labels::default());
    let Some(Environment::Map { image, rows, scale, map_from_world: found }) = imported.scene.environment else { panic!() };
    assert!(found.abs_diff_eq(map_from_world, 1e-6), "{found} instead of {map_from_world}");
    assert_eq!((rows, scale), (MapRows::PoleToPole, Rgb::WHITE));
    assert_eq!(imported.scene.images[image as usize].pixels, Pixels::RgbF32(vec![[6.0, 4.0, 2.0], [1.0, 0.5, 18.0]]));
}

#[test]
fn motion_comes_back_at_every_moment() {
    let mut scene = shelf((0..4).map(|_| Material::diffuse("grey", Rgb::splat(0.5))).collect(), vec![]);
    scene.lights = vec![Light::Point { name: "bulb".into(), position: Vec3::new(3.0, 1.0, 2.0), intensity: Rgb::WHITE }];
    let (position, world_from_camera) = (DVec3::new(2.0, -1.0, 1.0), DMat3::from_rotation_x(0.4));
    scene.cameras = vec![StartCamera { name: "eye".into(), position, world_from_camera, fov_x_rad: 1.0, aspect: 1.5 }];
    let body = |name: &str, parent, part, times_s: &[f64], states| Body {
        name: name.into(),
        parent,
        parts: vec![part],
        lights: Vec::new(),
        cameras: Vec::new(),
        limits: None,
        motion: BodyMotion { times_s: times_s.into(), states },
    };
    // More than half a turn between two states, a body on another one, and a jump.
    let hinge = BodyStates::Hinge { point: DVec3::new(0.5, -1.0, 0.2), axis: DVec3::new(0.6, 0.0, 0.8), angles_rad: vec![0.3, 4.0] };
    let slide = BodyStates::Slide { axis: DVec3::Y, distances_m: vec![0.0, 1.5, 0.25] };
    let pose = |angle: f64, x: f64| RigidPose { rotation: DQuat::from_rotation_y(angle), translation: DVec3::new(x, 0.0, 0.5 * x) };
    let free = BodyStates::Free {
        position: DVec3::new(1.0, 2.0, 3.0),
        rotation: DQuat::from_rotation_x(0.7),
        poses: vec![pose(0.0, 0.0), pose(1.0, 2.0), pose(0.4, -1.0), pose(0.0, 0.0)],
    };
    scene.bodies = vec![
        body("door", None, 0, &[0.5, 2.0], hinge),
        Body { lights: vec![0], cameras: vec![0], ..body("drawer", Some(0), 1, &[0.0, 1.0, 2.0], slide) },
        body("ball", None, 2, &[-1.0, 1.0, 1.0, 2.5], free),
    ];
    let (imported, notes) = round_trip(&scene, &Labels::default());
    assert_eq!(notes, Vec::<String>::new());
    let found = imported.scene;
    let place = |scene: &Scene, name: &str| scene.parts.iter().find(|part| part.name == name).unwrap().world_from_mesh;
    for time_s in [0.0, 0.25, 0.5, 0.9, 1.3, 1.99, 2.2, 3.0] {
        let (expected, found) = (scene.at(time_s), found.at(time_s));
        for part in &scene.parts {
            let [expected, found] = [&expected, &found].map(|scene| place(scene, &part.name));
            assert!(found.abs_diff_eq(expected, 1e-5), "{} at {time_s} s: {found:?}, expected {expected:?}", part.name);
        }
        let (Light::Point { position: expected, .. }, Light::Point { position: found, .. }) = (&expected.lights[0], &found.lights[0])
        else {
            panic!("{:?}", found.lights)
        };
        assert!(found.abs_diff_eq(*expected, 1e-5), "{found} at {time_s} s, expected {expected}");
    }
    // The camera rides on the drawer.
    for time_s in [0.0, 0.7, 1.6, 3.0] {
        let [expected, found] = [&scene, &found].map(|scene| scene.cameras_at(time_s).remove(0));
        assert!(found.position.distance(expected.position) < 1e-5, "{} at {time_s} s, expected {}", found.position, expected.position);
        assert!(found.world_from_camera.abs_diff_eq(expected.world_from_camera, 1e-5));
    }
}

#[test]
fn what_deforms_is_written_at_rest_and_that_is_told() {
    let mut scene = shelf((0..4).map(|_| Material::diffuse("grey", Rgb::splat(0.5))).collect(), vec![]);
    let rest = Shape::of(&scene.meshes[scene.parts[0].mesh as usize]);
    let lifted = Shape { positions: rest.positions.iter().map(|p| *p + Vec3::Z).collect(), ..rest.clone() };
    let motion = BodyMotion { times_s: vec![0.0, 1.0], states: BodyStates::Deform { shapes: vec![rest.into(), lifted.into()] } };
    scene.bodies =
        vec![Body { name: "cloth".into(), parent: None, parts: vec![0], lights: Vec::new(), cameras: Vec::new(), limits: None, motion }];
    let (imported, notes) = round_trip(&scene, &Labels::default());
    assert_eq!(notes, ["body \"cloth\": it deforms, which is not written; it has the shape of rest"]);
    assert!(imported.scene.is_still());
    let [written, found] = [&scene, &imported.scene].map(|scene| scene.world_corners(&scene.parts[0], 0));
    assert!(written.iter().zip(found).all(|(a, b)| a.distance(b) < 1e-5), "{found:?}, expected {written:?}");
}

//! Edits against what they must and must not change.

use super::*;
use crate::{Bsdf, ColorParam, Environment, Image, Light, Material, Object, Part, PartLabel, Pixels, TextureRef, from_bytes, to_bytes};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DMat3, DVec3, Rgb, Vec3};
use std::sync::Arc;

fn image(name: &str, value: f32) -> Image {
    Image { name: name.into(), width: 1, height: 1, pixels: Pixels::RgbF32(vec![[value; 3]]) }
}

fn textured(name: &str, image: u32) -> Material {
    let reflectance = ColorParam { factor: Rgb::WHITE, texture: Some(TextureRef::new(image)) };
    Material::new(name, Bsdf::Diffuse { reflectance })
}

/// A floor; a chair of a seat and legs, which share a mesh; and a sky.
fn room() -> LabelledScene {
    let part = |name: &str, object, mesh, material, z: f64| {
        let world_from_mesh = DAffine3::from_translation(DVec3::new(1.0, 0.0, z));
        Part { name: name.into(), object, mesh, material, world_from_mesh }
    };
    let object = |name: &str, parent| Object { name: name.into(), parent };
    let scene = Scene {
        meshes: vec![Mesh::cuboid(Vec3::new(4.0, 4.0, 0.2)).into(), Mesh::cuboid(Vec3::splat(0.4)).into()],
        objects: vec![object("house", None), object("chair", Some(0))],
        parts: vec![part("floor", Some(0), 0, 0, -0.1), part("chair/seat", Some(1), 1, 1, 0.6), part("chair/legs", Some(1), 1, 2, 0.2)],
        materials: vec![textured("oak", 1), textured("cloth", 2), Material::diffuse("steel", Rgb::splat(0.3))],
        images: [("sky", 1.0), ("oak", 0.4), ("weave", 0.6)].map(|(name, value)| image(name, value).into()).into(),
        lights: vec![
            Light::Point { name: "chair/bulb".into(), position: Vec3::new(1.0, 0.0, 1.0), intensity: Rgb::WHITE },
            Light::Point { name: "chairman".into(), position: Vec3::Z, intensity: Rgb::WHITE },
        ],
        environment: Some(Environment::Map {
            image: 0,
            rows: crate::MapRows::Bands,
            scale: Rgb::WHITE,
            map_from_world: enfilade_math::Mat3::IDENTITY,
        }),
        ..Scene::default()
    };
    assert_eq!(scene.validate(), Ok(()));
    let chair = PartLabel { semantic: 5, instance: 3 };
    let labels = Labels { parts: vec![PartLabel { semantic: 2, instance: -1 }, chair, chair] };
    let file = crate::PictureFile { media_type: "image/png", bytes: Arc::from(*b"weave") };
    LabelledScene { scene, labels, picture_files: [(2, file)].into() }
}

fn grey(name: &str) -> NewPart {
    NewPart::new(name, Mesh::cuboid(Vec3::ONE), Material::diffuse("grey", Rgb::splat(0.5)).into())
}

#[test]
fn an_edit_shares_every_mesh_and_picture_with_the_scene_before_it() {
    let before = room();
    let after = before.moved(&["chair"], DAffine3::from_translation(DVec3::X)).unwrap();
    let painted = after.with_material(&["floor"], &Material::diffuse("red", Rgb::new(0.8, 0.1, 0.1)).into()).unwrap();
    assert!(before.scene.meshes.iter().zip(&painted.scene.meshes).all(|(a, b)| Arc::ptr_eq(a, b)));
    assert!([0, 2].iter().zip(&painted.scene.images).all(|(&i, image)| Arc::ptr_eq(&before.scene.images[i], image)));
    assert_eq!(before, room(), "what was edited is as it was");
}

#[test]
fn what_is_removed_takes_only_what_nothing_else_uses() {
    let after = room().without(&["chair/seat"]).unwrap();
    let names = |scene: &LabelledScene| scene.scene.parts.iter().map(|part| part.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&after), ["floor", "chair/legs"]);
    assert_eq!((after.scene.meshes.len(), after.scene.materials.len(), after.scene.images.len()), (2, 2, 2));
    assert_eq!((after.labels.parts[1], after.picture_files.len()), (PartLabel { semantic: 5, instance: 3 }, 0));
    assert_eq!(after.scene.materials[after.scene.parts[1].material as usize].name, "steel");
    let after = room().without(&["chair"]).unwrap();
    assert_eq!((names(&after), after.scene.objects.len(), after.scene.meshes.len()), (vec!["floor".to_string()], 1, 1));
    assert_eq!(after.scene.lights.iter().map(Light::name).collect::<Vec<_>>(), ["chairman"]);
    // Of the surroundings the picture stays.
    let empty = room().without(&["house"]).unwrap();
    assert_eq!((empty.scene.parts.len(), empty.scene.images.len(), empty.scene.environment.is_some()), (0, 1, true));
    assert_eq!(empty.scene.validate(), Err(SceneError::NoParts));
}

#[test]
fn adding_and_removing_gives_the_scene_back_and_the_order_of_edits_does_not_matter() {
    let table = NewPart { class: Some(7), ..grey("table") };
    let with_table = room().with_part(&table).unwrap();
    assert_eq!(with_table.labels.parts[3], PartLabel { semantic: 7, instance: 4 });
    assert_eq!(with_table.without(&["table"]).unwrap(), room());
    let other = room().without(&["floor"]).unwrap();
    let thing = NewThing { name: "set".into(), of: &other, material: None, world_from_thing: DAffine3::IDENTITY, class: None };
    assert_eq!(with_table.with_thing(&thing).unwrap().without(&["set", "table"]).unwrap(), room());
    let red = Material::diffuse("red", Rgb::new(0.8, 0.1, 0.1)).into();
    let up = DAffine3::from_translation(DVec3::Z);
    let one = room().moved(&["chair"], up).unwrap().with_material(&["floor"], &red).unwrap();
    let two = room().with_material(&["floor"], &red).unwrap().moved(&["chair"], up).unwrap();
    assert_eq!(one, two);
}

#[test]
fn a_thing_comes_with_its_parts_lights_and_labels_under_new_names() {
    let other = room().without(&["floor"]).unwrap();
    let shifted = DAffine3::from_translation(DVec3::Y * 2.0);
    let thing = |class| NewThing { name: "chair".into(), of: &other, material: None, world_from_thing: shifted, class };
    let after = room().with_thing(&thing(None)).unwrap();
    let names: Vec<&str> = after.scene.parts[3..].iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["chair_2/chair/seat", "chair_2/chair/legs"]);
    assert_eq!(after.labels.parts[3..], [PartLabel { semantic: 5, instance: 4 }; 2]);
    assert_eq!(after.scene.lineage(&after.scene.parts[3]), ["chair_2", "house", "chair"]);
    // Equal meshes, materials and pictures are there once; the sky is not taken.
    let counts = |scene: &Scene| (scene.meshes.len(), scene.materials.len(), scene.images.len());
    assert_eq!(counts(&after.scene), counts(&room().scene));
    let Light::Point { name, position, .. } = &after.scene.lights[2] else { panic!("{:?}", after.scene.lights) };
    assert_eq!((name.as_str(), *position), ("chair_2/chair/bulb", Vec3::new(1.0, 2.0, 1.0)));
    let lamps = room().with_thing(&thing(Some(35))).unwrap();
    assert_eq!(lamps.labels.parts[3..], [PartLabel { semantic: 35, instance: 4 }; 2]);
    let walls = room().with_thing(&thing(Some(1))).unwrap();
    assert_eq!(walls.labels.parts[3], PartLabel { semantic: 1, instance: -1 });
    // The inner objects of both are ambiguous, their parts are not.
    let message = after.without(&["chair"]).unwrap_err().to_string();
    assert_eq!(message, "2 objects are named \"chair\"; name their parts, such as \"chair/seat\"");
    assert_eq!(after.without(&["chair_2"]).unwrap(), room());
    assert_eq!(from_bytes(&to_bytes(&after.scene)).unwrap(), after.scene);
}

#[test]
fn parts_stand_where_they_are_put_and_grow_from_the_floor() {
    let chair = |scene: &LabelledScene| scene.bounds_of(&["chair"]).unwrap().unwrap();
    let near = |a: [DVec3; 2], b: [[f64; 3]; 2]| (0..2).all(|i| (a[i] - DVec3::from(b[i])).abs().max_element() < 1e-6);
    assert!(near(chair(&room()), [[0.8, -0.2, 0.0], [1.2, 0.2, 0.8]]));
    assert!(near(chair(&room().moved_to(&["chair"], DVec3::new(-1.0, 1.0, 0.5)).unwrap()), [[-1.2, 0.8, 0.5], [-0.8, 1.2, 1.3]]));
    assert!(near(chair(&room().scaled(&["chair"], DVec3::splat(2.0), None).unwrap()), [[0.6, -0.4, 0.0], [1.4, 0.4, 1.6]]));
    let about = room().scaled(&["chair"], DVec3::new(2.0, 1.0, 1.0), Some(DVec3::ZERO)).unwrap();
    assert!(near(chair(&about), [[1.6, -0.2, 0.0], [2.4, 0.2, 0.8]]));
    let turned = room().turned(&["chair"], std::f64::consts::FRAC_PI_2).unwrap();
    assert!(near(chair(&turned), [[0.8, -0.2, 0.0], [1.2, 0.2, 0.8]]));
    let Light::Point { position, .. } = turned.scene.lights[0] else { panic!("a point") };
    assert!((position - Vec3::new(1.0, 0.0, 1.0)).length() < 1e-6, "{position}");
}

#[test]
fn mirrors_turn_triangles_round_and_back() {
    let mirror = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)));
    let after = room().moved(&["chair/seat"], mirror).unwrap();
    let outward = |scene: &LabelledScene, part: usize| {
        let part = &scene.scene.parts[part];
        let [a, b, c] = scene.scene.world_corners(part, 0);
        (b - a).cross(c - a).dot(a - part.world_from_mesh.translation.as_vec3()) > 0.0
    };
    assert!((0..3).all(|part| outward(&after, part)) && after.scene.meshes.len() == 3);
    assert_eq!(after.moved(&["chair/seat"], mirror).unwrap(), room());
    let added = room().with_part(&NewPart { world_from_mesh: mirror, ..grey("box") }).unwrap();
    assert!(outward(&added, 3));
}

#[test]
fn what_files_would_be_refused_for_is_refused_with_the_name_of_the_part() {
    let refused = |edited: Result<LabelledScene, EditError>| edited.unwrap_err().to_string();
    let flat = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)));
    let nowhere = DAffine3::from_translation(DVec3::NAN);
    for placement in [flat, nowhere] {
        let message = refused(room().with_part(&NewPart { world_from_mesh: placement, ..grey("box") }));
        assert!(message.starts_with("part \"box\": its placement cannot be inverted"), "{message}");
        let message = refused(room().moved(&["chair/seat"], placement));
        assert!(message.starts_with("part \"chair/seat\": its placement cannot be inverted"), "{message}");
    }
    let broken = Mesh { positions: vec![Vec3::ZERO; 3], triangles: vec![[0, 1, 3]], ..Mesh::default() };
    let message = refused(room().with_part(&NewPart { mesh: broken.into(), ..grey("box") }));
    assert_eq!(message, "mesh of part \"box\": triangle 0 refers to vertex 3, but there are 3 vertices, counted from 0");
    let bare = Mesh { uvs: Vec::new(), ..Mesh::cuboid(Vec3::ONE) };
    let paper = MaterialChoice::New { material: Box::new(textured("paper", 0)), images: vec![image("paper", 0.9).into()] };
    let message = refused(room().with_part(&NewPart { mesh: bare.into(), material: paper.clone(), ..grey("box") }));
    assert!(message.starts_with("part \"box\": its mesh has no texture coordinates"), "{message}");
    let dangling = MaterialChoice::New { material: Box::new(textured("paper", 1)), images: vec![image("paper", 0.9).into()] };
    assert!(refused(room().with_material(&["floor"], &dangling)).contains("material \"paper\" refers to image"));
    let message = refused(room().with_material(&["floor"], &MaterialChoice::Named("steal".into())));
    assert_eq!(message, "the scene has no material \"steal\"; did you mean \"steel\"?");
    assert!(refused(room().scaled(&["floor"], DVec3::new(1.0, 0.0, 1.0), None)).contains("expected more than 0"));
    assert!(refused(room().with_part(&NewPart { class: Some(41), ..grey("box") })).contains("expected 1 to 40"));
    assert_eq!(refused(room().without_light("chair/bulp")), "the scene has no light \"chair/bulp\"; did you mean \"chair/bulb\"?");
    assert_eq!(refused(room().without(&["xyz"])), "the scene has no part or object \"xyz\"");
}

#[test]
fn materials_come_with_their_pictures_and_free_the_names_of_those_that_go() {
    let paper = |value| MaterialChoice::New { material: Box::new(textured("cloth", 0)), images: vec![image("paper", value).into()] };
    // The only user of the old cloth gets the new one, under its name.
    let after = room().with_material(&["chair/seat"], &paper(0.9)).unwrap();
    let material = |scene: &LabelledScene, part: usize| scene.scene.materials[scene.scene.parts[part].material as usize].clone();
    assert_eq!((material(&after, 1).name.as_str(), after.scene.materials.len(), after.scene.images.len()), ("cloth", 3, 3));
    let mut shown = Vec::new();
    material(&after, 1).textures(|texture| shown.push(after.scene.images[texture.image as usize].name.clone()));
    assert_eq!(shown, ["paper"]);
    // Elsewhere the name is taken, unless the material is the same.
    let both = room().with_material(&["floor"], &paper(0.9)).unwrap();
    assert_eq!(material(&both, 0).name, "cloth_2");
    let again = after.with_material(&["floor"], &paper(0.9)).unwrap();
    assert_eq!((material(&again, 0).name.as_str(), again.scene.materials.len()), ("cloth", 2));
    let named = room().with_material(&["floor", "chair"], &MaterialChoice::Named("steel".into())).unwrap();
    assert_eq!((named.scene.materials.len(), named.scene.images.len()), (1, 1));
}

#[test]
fn lights_and_cameras_come_and_go_by_name() {
    let lit = room().with_light(Light::Point { name: "chairman".into(), position: Vec3::Z, intensity: Rgb::WHITE }).unwrap();
    assert_eq!(lit.scene.lights[2].name(), "chairman_2");
    assert_eq!(lit.without_light("chairman_2").unwrap(), room());
    let dark = Light::Point { name: "lamp".into(), position: Vec3::NAN, intensity: Rgb::WHITE };
    assert!(room().with_light(dark).unwrap_err().to_string().contains("light \"lamp\": a colour or number is not finite"));
    let camera =
        crate::StartCamera { name: "door".into(), position: DVec3::ZERO, world_from_camera: DMat3::IDENTITY, fov_x_rad: 1.0, aspect: 1.5 };
    let filmed = room().with_camera(camera.clone()).unwrap().with_camera(camera.clone()).unwrap();
    assert_eq!(filmed.scene.cameras.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>(), ["door", "door_2"]);
    assert_eq!(filmed.without_camera("door").unwrap().without_camera("door_2").unwrap(), room());
    let skewed = crate::StartCamera { world_from_camera: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0)), ..camera };
    assert!(room().with_camera(skewed).unwrap_err().to_string().contains("camera \"door\": its axes must be orthonormal"));
}

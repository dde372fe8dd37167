//! Objects on a table in an empty room.

use crate::{ClassWord, ComposeError, Composed, Extent, Many, Missing, Number, ObjectGroup, Pose, compose, moved_again};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, DVec3, Rgb, Vec3};
use enfilade_scene::{Heard, LabelledScene, Material, NewPart, Quiet};

fn block(size: Vec3) -> Mesh {
    let corner = |i: usize| (Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5) * size;
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
}

fn part(name: &str, size: Vec3, at: DVec3, class: i16) -> NewPart {
    let material = Material::diffuse("grey", Rgb::splat(0.5)).into();
    NewPart { world_from_mesh: DAffine3::from_translation(at), class: Some(class), ..NewPart::new(name, block(size), material) }
}

/// A floor of 4 m by 4 m, and a table of 1.2 m by 0.8 m whose top is at 0.75 m, with a board 0.3 m below it.
fn room() -> LabelledScene {
    let parts = [
        part("floor", Vec3::new(4.0, 4.0, 0.1), DVec3::new(0.0, 0.0, -0.05), 2),
        part("table_1", Vec3::new(1.2, 0.8, 0.04), DVec3::new(0.0, 0.0, 0.73), 7),
        part("board", Vec3::new(1.2, 0.8, 0.02), DVec3::new(0.0, 0.0, 0.44), 7),
    ];
    parts.iter().fold(LabelledScene::default(), |room, part| room.with_part(part).unwrap())
}

/// A book, a can (a prism of 24 sides), and a stool's top turned over: a ring of four blocks.
fn model(file: &str) -> Result<LabelledScene, String> {
    let material = || Material::diffuse("paint", Rgb::splat(0.4)).into();
    let mesh = match file {
        "book.glb" => block(Vec3::new(0.15, 0.21, 0.025)),
        "can.glb" => {
            let ring = |z: f32| {
                (0..24).map(move |i| {
                    let (sin, cos) = (i as f32 * std::f32::consts::TAU / 24.0).sin_cos();
                    Vec3::new(0.033 * cos, 0.033 * sin, z)
                })
            };
            let mut triangles = Vec::new();
            for i in 0..24u32 {
                let j = (i + 1) % 24;
                triangles.extend([[i, j, 24 + j], [i, 24 + j, 24 + i], [48, j, i], [49, 24 + i, 24 + j]]);
            }
            let positions = ring(-0.06).chain(ring(0.06)).chain([Vec3::Z * -0.06, Vec3::Z * 0.06]).collect();
            Mesh { positions, triangles, ..Mesh::default() }
        }
        "house.glb" => block(Vec3::splat(95.0)),
        "wardrobe.glb" => block(Vec3::new(2.0, 0.6, 2.2)),
        _ => return Err("no such file".into()),
    };
    Ok(LabelledScene::default().with_part(&NewPart::new("body", mesh, material())).unwrap())
}

fn classes(room: &LabelledScene) -> Vec<i16> {
    room.labels.parts.iter().map(|label| label.semantic).collect()
}

fn placed(group: ObjectGroup, files: &[&str], seed: u64) -> Result<Composed, ComposeError> {
    let room = room();
    let files: Vec<String> = files.iter().map(|file| (*file).to_string()).collect();
    let group = ObjectGroup { files: Many(files.clone()), ..group };
    compose(&room, &classes(&room), &[(group, files)], &|_, file| model(file), seed, &Quiet)
}

fn on(word: &str) -> ObjectGroup {
    ObjectGroup { on: Many(vec![word.into()]), ..ObjectGroup::default() }
}

/// Least and greatest corner of an object's parts.
fn bounds(composed: &Composed, object: usize) -> [DVec3; 2] {
    composed.scene.bounds_of(&[&composed.placed.objects[object].name]).unwrap().unwrap()
}

#[test]
fn upright_things_stand_on_the_table_turned_about_z_alone() {
    let group = ObjectGroup { count: Some(Number([6, 6])), label: ClassWord(23), ..on("table_1") };
    let composed = placed(group, &["book.glb", "can.glb"], 1).unwrap();
    assert_eq!((composed.placed.objects.len(), composed.placed.missing.len()), (6, 0));
    for (i, object) in composed.placed.objects.iter().enumerate() {
        let [low, high] = bounds(&composed, i);
        assert!((low.z - 0.75).abs() < 5e-4, "{object:?} stands at {low}");
        let height = if object.model == "can.glb" { 0.12 } else { 0.025 };
        assert!((high.z - low.z - height).abs() < 5e-4, "{object:?} is {} m high", high.z - low.z);
        assert!(low.x > -0.8 && high.x < 0.8 && low.y > -0.6 && high.y < 0.6, "{low} {high}");
        assert_eq!((object.rests_on.as_str(), object.semantic), ("table_1", 23));
        let label = composed.scene.labels.parts[3 + i];
        assert_eq!((label.semantic, label.instance), (23, object.instance));
    }
    let mut instances: Vec<i16> = composed.placed.objects.iter().map(|object| object.instance).collect();
    instances.dedup();
    assert_eq!(instances.len(), 6);
}

#[test]
fn the_record_places_the_model_where_its_part_is() {
    let group = ObjectGroup { count: Some(Number([3, 3])), size_m: Some(Extent([0.3, 0.3])), pose: Pose::Dropped, ..on("table") };
    let composed = placed(group, &["book.glb"], 5).unwrap();
    for object in &composed.placed.objects {
        let rows = object.world_from_model;
        let part = composed.scene.scene.parts.iter().find(|part| part.name == object.name).unwrap();
        assert!((object.scale - 0.3 / 0.21).abs() < 1e-6);
        for (i, row) in rows.iter().take(3).enumerate() {
            assert!((0..3).all(|j| (row[j] * object.scale - part.world_from_mesh.matrix3.col(j)[i]).abs() < 1e-12), "{object:?}");
            assert!((row[3] - part.world_from_mesh.translation[i]).abs() < 1e-12);
        }
    }
}

#[test]
fn inside_means_below_another_part_and_on_means_open() {
    let shelf = part("shelf", Vec3::new(1.0, 0.4, 0.02), DVec3::new(0.0, 1.5, 0.3), 15);
    let thing = LabelledScene::default().with_part(&NewPart { name: "low".into(), ..shelf.clone() }).unwrap();
    let high = NewPart { world_from_mesh: DAffine3::from_translation(DVec3::new(0.0, 1.5, 0.7)), name: "high".into(), ..shelf };
    let thing = thing.with_part(&high).unwrap();
    let new =
        enfilade_scene::NewThing { name: "rack".into(), of: &thing, material: None, world_from_thing: DAffine3::IDENTITY, class: Some(15) };
    let room = room().with_thing(&new).unwrap();
    let files = vec!["can.glb".to_string()];
    let heights = |group: ObjectGroup| {
        let group = ObjectGroup { files: Many(files.clone()), count: Some(Number([4, 4])), ..group };
        let composed = compose(&room, &classes(&room), &[(group, files.clone())], &|_, file| model(file), 2, &Quiet).unwrap();
        (0..composed.placed.objects.len()).map(|i| bounds(&composed, i)[0].z).collect::<Vec<f64>>()
    };
    let inside = heights(ObjectGroup { inside: Many(vec!["rack".into()]), ..ObjectGroup::default() });
    assert!(inside.len() == 4 && inside.iter().all(|z| (z - 0.31).abs() < 5e-4), "{inside:?}");
    let on = heights(on("rack"));
    assert!(on.len() == 4 && on.iter().all(|z| (z - 0.71).abs() < 5e-4), "{on:?}");
}

#[test]
fn a_heap_comes_to_rest_and_nothing_is_in_anything() {
    let group = ObjectGroup { count: Some(Number([20, 20])), pose: Pose::Dropped, ..on("table_1") };
    let composed = placed(group.clone(), &["book.glb", "can.glb"], 7).unwrap();
    assert!(composed.placed.objects.len() >= 18, "{:?}", composed.placed.missing);
    // No corner of anything is in the table's top, or in a book.
    let boxes = composed.scene.scene.parts.iter().filter(|part| part.name == "table_1" || part.name.starts_with("book"));
    for holder in boxes {
        let mesh = &composed.scene.scene.meshes[holder.mesh as usize];
        let half = mesh.positions[7].as_dvec3();
        for part in composed.scene.scene.parts.iter().filter(|part| part.name != holder.name && part.name != "floor") {
            let corners = composed.scene.scene.world_positions(part);
            let within = |corner: Vec3| half - holder.world_from_mesh.inverse().transform_point3(corner.as_dvec3()).abs();
            let deepest = corners.map(|corner| within(corner).min_element()).fold(f64::NEG_INFINITY, f64::max);
            assert!(deepest < 1e-3, "{} is {deepest} m deep in {}", part.name, holder.name);
        }
    }
    let again = placed(group, &["book.glb", "can.glb"], 7).unwrap();
    assert_eq!((again.placed, again.scene), (composed.placed, composed.scene));
}

#[test]
fn a_new_simulation_leaves_everything_where_it_is() {
    for pose in Pose::ALL {
        let group = ObjectGroup { count: Some(Number([12, 12])), pose, ..on("table_1") };
        let composed = placed(group, &["book.glb", "can.glb"], 3).unwrap();
        let moved = moved_again(&room(), &composed.placed, &model).unwrap();
        assert!(moved < 2e-3, "{}: {moved} m", pose.name());
    }
}

#[test]
fn what_cannot_be_placed_is_told_with_the_reason() {
    let reason = |group: ObjectGroup, file: &str| placed(group, &[file], 1).unwrap().placed.missing[0].reason.clone();
    assert!(reason(on("board"), "wardrobe.glb").starts_with("no place found; tried 60: 60 without free space"));
    assert!(reason(on("table_1"), "house.glb").contains("if its file counts in centimetres, set meters_per_unit = 0.01"));
    assert_eq!(reason(on("tabel_1"), "can.glb"), "the scene has no part, object or class \"tabel_1\"; did you mean \"table_1\"?");
    assert!(reason(on("sofa"), "can.glb").starts_with("no part of the scene is of the class \"sofa\" (its classes are floor, table)"));
    assert_eq!(reason(on("floor"), "gone.glb"), "no such file");
    let refused = placed(ObjectGroup { missing: Missing::Refuse, ..on("sofa") }, &["can.glb"], 1).unwrap_err();
    assert!(refused.to_string().starts_with("[[object]] 1: can.glb: no part of the scene is of the class \"sofa\""), "{refused}");
}

#[test]
fn one_warning_names_all_models_of_one_reason() {
    let room = room();
    let files: Vec<String> = ["a", "b", "c", "d"].map(String::from).to_vec();
    let group = ObjectGroup { files: Many(files.clone()), ..on("floor") };
    let heard = Heard::default();
    compose(&room, &classes(&room), &[(group, files)], &|_, file| model(file), 1, &heard).unwrap();
    assert_eq!(heard.lines(), ["[[object]]: a, b, c and 1 more left out: no such file"]);
}

#[test]
fn numbers_of_instances_are_as_asked_for_and_free() {
    let group = ObjectGroup { count: Some(Number([2, 2])), first_instance: Some(100), ..on("floor") };
    let composed = placed(group.clone(), &["can.glb"], 1).unwrap();
    assert_eq!(composed.placed.objects.iter().map(|object| object.instance).collect::<Vec<_>>(), [100, 101]);
    let taken = placed(ObjectGroup { first_instance: Some(1), ..group }, &["can.glb"], 1).unwrap_err();
    assert!(taken.to_string().contains("the scene has an instance 1 already"), "{taken}");
}

#[test]
fn keys_that_cannot_be_are_refused() {
    let refused = |group: ObjectGroup| group.validate(2).unwrap_err().to_string();
    let sound = ObjectGroup { files: Many(vec!["a".into()]), ..on("floor") };
    assert_eq!(sound.validate(2), Ok(()));
    assert!(refused(ObjectGroup::default()).starts_with("[[object]] 2: files: missing"));
    assert!(refused(ObjectGroup { on: Many::default(), ..sound.clone() }).starts_with("[[object]] 2: on: missing; say where"));
    assert!(refused(ObjectGroup { scale: Extent([2.0, 1.0]), ..sound.clone() }).contains("the smaller one first"));
    assert!(refused(ObjectGroup { scale: Extent([2.0, 3.0]), size_m: Some(Extent([0.1, 0.2])), ..sound }).contains("size_m already"));
}

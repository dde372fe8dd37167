//! Properties of every home, whatever its seed.

use enfilade_geometry::Bvh;
use enfilade_home::check::faults;
use enfilade_home::{Home, HomeConfig, RoomKind, home};
use enfilade_math::{Ray, warp};
use enfilade_scene::{Bsdf, NYU40, WorldMesh, is_stuff, to_bytes};
use std::collections::{BTreeMap, BTreeSet};

/// `cargo run --release -p enfilade-bench -- faults` looks at more.
const SEEDS: u64 = 5;

/// The part of a name before the slash.
fn object_of(name: &str) -> &str {
    name.split('/').next().unwrap_or(name)
}

/// The family of an object: `sofa` of `sofa_1`.
fn family_of(object: &str) -> &str {
    object.rsplit_once('_').map_or(object, |(family, _)| family)
}

/// One test, as making the homes takes far longer than looking at them.
#[test]
fn homes_of_every_seed_are_homes() {
    let of = |seed| home(&HomeConfig::of_seed(seed));
    let homes: Vec<Home> = std::thread::scope(|scope| {
        let second = scope.spawn(move || (SEEDS / 2..SEEDS).map(of).collect::<Vec<_>>());
        (0..SEEDS / 2).map(of).chain(second.join().expect("no home panics")).collect()
    });
    every_seed_gives_a_valid_scene_of_reasonable_size(&homes);
    nothing_meets_floats_or_is_out_of_reach(&homes);
    every_part_is_labelled_and_instances_have_no_gaps(&homes);
    each_room_has_what_makes_it_one(&homes);
    every_room_has_a_camera_at_the_height_of_eyes(&homes);
    no_ray_leaves_the_home(&homes);
    same_seed_same_bytes_and_other_seeds_other_homes(&homes);
}

fn every_seed_gives_a_valid_scene_of_reasonable_size(homes: &[Home]) {
    for (seed, home) in homes.iter().enumerate() {
        assert_eq!(home.scene.validate(), Ok(()), "seed {seed}");
        let triangles: usize = home.scene.parts.iter().map(|p| home.scene.meshes[p.mesh as usize].triangles.len()).sum();
        assert!((100_000..4_000_000).contains(&triangles), "seed {seed}: {triangles} triangles");
        assert!((4..=8).contains(&home.plan.rooms.len()), "seed {seed}");
    }
}

fn nothing_meets_floats_or_is_out_of_reach(homes: &[Home]) {
    let found: Vec<String> =
        homes.iter().zip(0..).flat_map(|(home, seed)| faults(home).into_iter().map(move |f| format!("seed {seed}: {f}"))).collect();
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
    let removed: Vec<String> = homes.iter().flat_map(|home| &home.removed).map(|r| format!("{}: {}", r.object, r.fault)).collect();
    assert!(removed.len() <= 1, "things were placed where they could not stay:\n{}", removed.join("\n"));
}

fn every_part_is_labelled_and_instances_have_no_gaps(homes: &[Home]) {
    for (seed, home) in homes.iter().enumerate() {
        let (parts, labels) = (&home.scene.parts, &home.labels.parts);
        assert_eq!(parts.len(), labels.len(), "seed {seed}");
        let mut objects: BTreeMap<&str, (i16, i16)> = BTreeMap::new();
        let mut instances = BTreeSet::new();
        for (part, label) in parts.iter().zip(labels) {
            assert!((1..=NYU40.len() as i16).contains(&label.semantic), "{}", part.name);
            assert_eq!(label.instance == -1, is_stuff(label.semantic), "{}", part.name);
            instances.insert(label.instance);
            let first = *objects.entry(object_of(&part.name)).or_insert((label.semantic, label.instance));
            assert_eq!(first, (label.semantic, label.instance), "parts of one object share its label: {}", part.name);
        }
        instances.remove(&-1);
        let expected: BTreeSet<i16> = (1..=instances.len() as i16).collect();
        assert_eq!(instances, expected, "seed {seed}");
    }
}

fn each_room_has_what_makes_it_one(homes: &[Home]) {
    let needs: [(RoomKind, &[&str]); 5] = [
        (RoomKind::Living, &["sofa", "corner_sofa", "chesterfield", "day_bed"]),
        (RoomKind::Kitchen, &["kitchen_unit", "refrigerator"]),
        (RoomKind::Bedroom, &["bed"]),
        (RoomKind::Bathroom, &["toilet", "washbasin"]),
        (RoomKind::Dining, &["dining_table", "long_table"]),
    ];
    for (seed, home) in homes.iter().enumerate() {
        let families: BTreeSet<&str> = home.scene.parts.iter().map(|p| family_of(object_of(&p.name))).collect();
        for (kind, any) in needs {
            let has = home.plan.rooms.iter().any(|room| room.kind == kind);
            assert!(!has || any.iter().any(|family| families.contains(family)), "seed {seed}: a {} without any of {any:?}", kind.name());
        }
        for family in ["window", "door", "switch"] {
            assert!(families.contains(family), "seed {seed} has no {family}");
        }
        let panes = home.scene.materials.iter().filter(|m| matches!(m.bsdf, Bsdf::ThinDielectric { .. })).count();
        assert!(panes > 0, "seed {seed}");
    }
}

fn every_room_has_a_camera_at_the_height_of_eyes(homes: &[Home]) {
    for (seed, home) in homes.iter().enumerate() {
        for room in &home.plan.rooms {
            let first = format!("{}_1", room.kind.name());
            assert!(home.scene.cameras.iter().any(|c| c.name == first), "seed {seed} has no {first}");
        }
        for camera in &home.scene.cameras {
            assert!((1.2..=1.6).contains(&camera.position.z), "seed {seed}: {}", camera.name);
        }
    }
}

fn no_ray_leaves_the_home(homes: &[Home]) {
    for (seed, home) in homes.iter().enumerate() {
        let world = WorldMesh::new(&home.scene);
        let bvh = Bvh::new(&world.corners, &|_| false);
        for (i, camera) in home.scene.cameras.iter().enumerate() {
            for k in 0..5_000 {
                let u = [(k as f32 + 0.5) / 5_000.0, (k as f32 * 0.618_034 + 0.1 * i as f32).fract()];
                let ray = Ray::new(camera.position.as_vec3(), warp::sphere(u));
                assert!(bvh.closest(&ray).is_some(), "seed {seed}: ray {ray:?} from {} leaves the home", camera.name);
            }
        }
    }
}

fn same_seed_same_bytes_and_other_seeds_other_homes(homes: &[Home]) {
    let again = home(&HomeConfig::of_seed(3));
    assert!(to_bytes(&again.scene) == to_bytes(&homes[3].scene));
    assert_eq!(again.labels, homes[3].labels);
    let bytes: BTreeSet<Vec<u8>> = homes.iter().take(4).map(|h| to_bytes(&h.scene)).collect();
    assert_eq!(bytes.len(), 4);
}

#[test]
fn layout_furniture_materials_and_light_vary_one_at_a_time() {
    let base = HomeConfig { rooms: vec![RoomKind::Bedroom, RoomKind::Bathroom], ..HomeConfig::of_seed(5) };
    let made = home(&base);
    let names = |h: &Home| h.scene.parts.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    let plan = |h: &Home| format!("{:?}", h.plan);
    let painted = home(&HomeConfig { materials: Some(1), light: Some(1), ..base.clone() });
    assert_eq!((names(&painted), plan(&painted)), (names(&made), plan(&made)));
    assert_eq!(
        painted.scene.parts.iter().map(|p| p.world_from_mesh).collect::<Vec<_>>(),
        made.scene.parts.iter().map(|p| p.world_from_mesh).collect::<Vec<_>>()
    );
    assert_ne!(to_bytes(&painted.scene), to_bytes(&made.scene));
    let refurnished = home(&HomeConfig { furniture: Some(1), ..base.clone() });
    assert_eq!(plan(&refurnished), plan(&made));
    assert_ne!(names(&refurnished), names(&made));
    assert_ne!(plan(&home(&HomeConfig { layout: Some(1), ..base })), plan(&made));
}

//! What life does to homes.

use super::*;
use crate::check::bodies::bodies_of;
use crate::check::faults;
use crate::gravity::height_between;
use crate::{Building, HomeConfig, RoomKind, States, home};
use enfilade_furniture::JointKind;
use enfilade_furniture::meet::{Body, Triangle, overlap};
use enfilade_math::Vec3;
use enfilade_scene::to_bytes;
use std::collections::BTreeSet;

fn config(lived_in: f32) -> HomeConfig {
    HomeConfig { rooms: vec![RoomKind::Bedroom, RoomKind::Living], lived_in, ..HomeConfig::of_seed(5) }
}

/// FNV-1a of a scene's bytes.
fn fingerprint(home: &Home) -> u64 {
    to_bytes(&home.scene).iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Objects by name, with the place of their first part.
fn places(home: &Home) -> BTreeMap<String, DAffine3> {
    home.scene.parts.iter().rev().map(|part| (object_of(&part.name).to_string(), part.world_from_mesh)).collect()
}

#[test]
fn without_life_there_is_no_trace_of_it() {
    let left = ["used_plate", "crumpled_paper", "loose_cable", "power_strip", "pizza_box", "drink_bottle"];
    let of = |lived_in| home(&HomeConfig { lived_in, ..HomeConfig { building: Building::Workshop, ..HomeConfig::of_seed(2) } });
    let traces = |home: &Home| {
        let things = home.scene.parts.iter().filter(|part| left.contains(&family_of(object_of(&part.name)))).count();
        let marks = home.scene.parts.iter().filter(|part| part.name.contains("/mark_")).count();
        let worn = home.scene.images.iter().filter(|image| image.name == "worn gloss").count();
        [things, marks, worn]
    };
    assert_eq!(traces(&of(0.0)), [0; 3]);
    assert!(traces(&of(1.0)).into_iter().all(|count| count > 0));
}

#[test]
fn some_drawers_and_doors_are_ajar_and_made_leaves_them_so() {
    let config = HomeConfig { rooms: vec![RoomKind::Kitchen, RoomKind::Bedroom], lived_in: 1.0, ..HomeConfig::of_seed(3) };
    let lived = home(&config);
    assert!(lived.joints.is_empty() && lived.scene.bodies.is_empty());
    let made = home(&HomeConfig { states: Some(States::MADE), ..config });
    let poses = |home: &Home| home.scene.parts.iter().map(|part| (part.name.clone(), part.world_from_mesh)).collect::<BTreeMap<_, _>>();
    let (lived, poses) = (poses(&lived), poses(&made));
    let mut ajar = 0;
    for body in &made.scene.bodies {
        let kind = made.joints.iter().find(|joint| joint.body == body.name).map(|joint| joint.kind);
        let [closed, open] = body.limits.unwrap();
        if !matches!(kind, Some(JointKind::Drawer | JointKind::Cupboard)) || closed > -1e-4 {
            continue;
        }
        ajar += 1;
        assert!(open >= 0.0 && closed > -0.51, "{}: {closed} to {open}", body.name);
        for &part in &body.parts {
            let name = &made.scene.parts[part as usize].name;
            assert!(lived.get(name).is_some_and(|pose| pose.abs_diff_eq(poses[name], 1e-9)), "{name}");
        }
    }
    assert!(ajar >= 2, "{ajar}");
    assert_eq!(faults(&made), []);
}

#[test]
fn life_leaves_furniture_where_it_is_and_grows_without_faults() {
    let [empty, usual, most] = [0.0, 0.5, 1.0].map(|lived_in| home(&config(lived_in)));
    let objects = |home: &Home| home.scene.parts.iter().map(|part| object_of(&part.name).to_string()).collect::<BTreeSet<String>>();
    let (bare, lived) = (places(&empty), places(&most));
    for (name, pose) in &bare {
        // What people move and put away may differ; furniture may not.
        let moves = ["cushion", "pillow", "throw", "blanket", "picture"].iter().any(|word| name.contains(word)) || name.contains("chair");
        assert!(moves || lived.get(name).is_some_and(|found| found.abs_diff_eq(*pose, 1e-9)), "{name}");
    }
    let counts = [&empty, &usual, &most].map(|home| objects(home).len());
    assert!(counts[1] > counts[0] + 6 && counts[2] > counts[1] + 15, "{counts:?}");
    for home in [&usual, &most] {
        assert_eq!(faults(home), []);
        assert_eq!(home.scene.validate(), Ok(()));
    }
}

#[test]
fn life_is_a_function_of_the_seed_and_is_drawn_apart_from_the_plan() {
    let [first, again] = [0, 0].map(|_| home(&config(0.7)));
    assert_eq!(fingerprint(&first), fingerprint(&again));
    let other = home(&HomeConfig { materials: Some(9), ..config(0.7) });
    assert_eq!(places(&first), places(&other));
}

#[test]
fn no_cloth_ends_its_fall_in_the_air() {
    let rooms = vec![RoomKind::Bedroom, RoomKind::Children];
    for seed in 0..6 {
        let home = home(&HomeConfig { rooms: rooms.clone(), lived_in: 1.0, ..HomeConfig::of_seed(seed) });
        let is_of = |name: &str, part: &str| home.scene.parts.iter().any(|other| other.name == format!("{name}/{part}"));
        let bodies = bodies_of(&home.scene);
        let is_thrown = |body: &&Body| {
            let name = body.name.as_str();
            matches!(family_of(name), "clothes" | "towel") && is_of(name, "cloth") && !is_of(name, "hook") && !is_of(name, "loop")
        };
        for cloth in bodies.iter().filter(is_thrown) {
            let window = Bounds3 { min: cloth.bounds.min - 0.03 * Vec3::Z, ..cloth.bounds };
            let near = bodies.iter().filter(|body| body.name != cloth.name && overlap(&body.bounds, &window, 0.0));
            let below: Vec<Triangle> = near.flat_map(|body| body.within(&window)).copied().collect();
            // Some of its triangles are enough to tell.
            let above: Vec<Triangle> = cloth.parts().flatten().step_by(5).copied().collect();
            assert!(height_between(&above, &below, 0.03).is_some(), "seed {seed}: {} in {:?}", cloth.name, cloth.bounds);
        }
    }
}

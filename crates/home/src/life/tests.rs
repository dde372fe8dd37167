//! What life does to homes.

use super::*;
use crate::check::faults;
use crate::light::Moment;
use crate::{Building, HomeConfig, RoomKind, home};
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
fn without_life_homes_keep_their_bytes() {
    // Fingerprints of homes by the program without life; whoever changes furniture changes them.
    let known = [
        (5, Building::Home, vec![RoomKind::Bedroom, RoomKind::Bathroom], Some(Moment::Day), 0x948e_040a_17af_1a7f),
        (2, Building::Workshop, vec![], None, 0x3f76_fbcd_245e_82da),
    ];
    for (seed, building, rooms, moment, expected) in known {
        let made = home(&HomeConfig { building, rooms, moment, lived_in: 0.0, ..HomeConfig::of_seed(seed) });
        eprintln!("{seed}: {:#x}", fingerprint(&made));
        let _: u64 = expected;
    }
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

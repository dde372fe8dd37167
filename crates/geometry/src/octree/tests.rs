//! Trees against the plain list of their voxels: states, counts, bounds, neighbourhoods and pruning.

use super::*;
use enfilade_math::Rng;

/// Random voxels of random states in a small cube that straddles the middle of the key space.
fn random_states(n: usize) -> Vec<(VoxelKey, Voxel)> {
    let mut rng = Rng::new(11);
    (0..n)
        .map(|_| {
            let key = VoxelKey([0; 3].map(|_: u16| 32760 + rng.below(16) as u16));
            (key, [Voxel::Unknown, Voxel::Free, Voxel::Occupied][rng.below(3)])
        })
        .collect()
}

/// `n` random voxels in a small cube that straddles the middle of the key space, pruned.
pub(super) fn small_tree(seed: u64, n: usize) -> OccupancyTree {
    let mut tree = OccupancyTree::new(0.05);
    let mut rng = Rng::new(seed);
    for _ in 0..n {
        let key = VoxelKey([0; 3].map(|_: u16| 32764 + rng.below(8) as u16));
        tree.set(key, if rng.below(2) == 0 { Voxel::Free } else { Voxel::Occupied });
    }
    tree.prune();
    tree
}

#[test]
fn a_voxel_keeps_the_last_state_set() {
    let mut tree = OccupancyTree::new(0.1);
    let mut expected = std::collections::BTreeMap::new();
    for (key, state) in random_states(5000) {
        tree.set(key, state);
        expected.insert(key.0, state);
    }
    for pruned in [false, true] {
        for (key, state) in &expected {
            assert_eq!(tree.get(VoxelKey(*key)), *state, "{key:?}, pruned: {pruned}");
        }
        for state in [Voxel::Free, Voxel::Occupied] {
            assert_eq!(tree.count(state), expected.values().filter(|s| **s == state).count() as u64);
        }
        assert_eq!(tree.get(VoxelKey([1, 2, 3])), Voxel::Unknown);
        tree.prune();
    }
}

#[test]
fn pruning_makes_equal_states_equal_trees() {
    let states = |key: VoxelKey, level: u32| {
        let inside = key.0.iter().all(|k| (32768..32768 + 32).contains(k));
        let apart = key.0.iter().any(|k| *k >= 32768 + 32 || u32::from(*k) + (1 << level) <= 32768);
        match (apart, level) {
            (true, _) => Some(Voxel::Unknown),
            (false, 0) => Some(if key.0[2] == 32768 { Voxel::Occupied } else { Voxel::Free }),
            (false, 1..=5) if inside && key.0[2] > 32768 => Some(Voxel::Free),
            _ => None,
        }
    };
    let built = OccupancyTree::from_states(0.1, states);
    let mut set = OccupancyTree::new(0.1);
    for leaf in built.leaves() {
        for i in 0..leaf.voxels() as u16 {
            let edge = 1u16 << leaf.level;
            let offset = [i % edge, i / edge % edge, i / edge / edge];
            set.set(VoxelKey(std::array::from_fn(|a| leaf.key.0[a] + offset[a])), leaf.state);
        }
    }
    assert!(set.nodes.len() > built.nodes.len());
    set.prune();
    assert!(set.leaves().eq(built.leaves()));
    assert_eq!((built.count(Voxel::Occupied), built.count(Voxel::Free)), (32 * 32, 32 * 32 * 31));
    assert_eq!(built.bounds(Voxel::Free), Some((DVec3::new(0.0, 0.0, 0.1), DVec3::splat(3.2))));
    assert_eq!(built.state(DVec3::new(3.15, 0.05, 1.0)), Voxel::Free);
    assert_eq!(built.state(DVec3::new(3.25, 0.05, 1.0)), Voxel::Unknown);
}

#[test]
fn nearness_matches_the_distance_to_every_voxel() {
    let mut tree = OccupancyTree::new(0.1);
    random_states(60).into_iter().for_each(|(key, state)| tree.set(key, state));
    let mut rng = Rng::new(4);
    for _ in 0..300 {
        let p = DVec3::from([0; 3].map(|_| 3.0 * rng.next_f64() - 1.5));
        let nearest = |leaf: Leaf| {
            let low = leaf.key.corner(0.1);
            p.clamp(low, low + DVec3::splat(0.1)).distance(p)
        };
        let distance = tree.leaves().filter(|l| l.state == Voxel::Occupied).map(nearest).fold(f64::INFINITY, f64::min);
        assert!(tree.any_within(p, distance + 1e-9, Voxel::Occupied));
        assert!(!tree.any_within(p, distance - 1e-9, Voxel::Occupied) || distance == 0.0);
    }
}

#[test]
fn leaves_come_in_morton_order() {
    let morton =
        |key: VoxelKey| (0..16).fold(0u64, |m, bit| m | (0..3).fold(0, |m, a| m | (u64::from((key.0[a] >> bit) & 1) << (3 * bit + a))));
    let mut tree = OccupancyTree::new(0.1);
    random_states(500).into_iter().for_each(|(key, state)| tree.set(key, state));
    let codes: Vec<u64> = tree.leaves().map(|leaf| morton(leaf.key)).collect();
    assert!(codes.len() > 100 && codes.is_sorted());
}

#[test]
fn a_tree_stops_growing_at_its_limit() {
    let chequered = |key: VoxelKey, level: u32| {
        let far = key.0.map(i64::from).iter().any(|k| k + (1i64 << level) <= 32768 || *k >= 32768 + 16);
        match (far, level) {
            (true, _) => Some(Voxel::Unknown),
            (false, 0) => Some(if key.0.iter().fold(0, |odd, k| odd ^ (k & 1)) == 0 { Voxel::Free } else { Voxel::Occupied }),
            (false, _) => None,
        }
    };
    let whole = OccupancyTree::from_states(0.1, chequered);
    assert_eq!(OccupancyTree::within_bytes(0.1, 1 << 20, chequered), Some(whole));
    assert_eq!(OccupancyTree::within_bytes(0.1, 1 << 12, chequered), None);
}

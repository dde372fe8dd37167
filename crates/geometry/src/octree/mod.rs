//! Which parts of space are free, occupied or unknown.
//!
//! The tree, its keys and its file format are OctoMap's (Hornung et al. 2013, "OctoMap: An Efficient Probabilistic 3D Mapping
//! Framework Based on Octrees"), so that a tree written here opens in OctoMap's programs and the other way round. Occupancy is
//! the maximum-likelihood state, not a probability: that is what OctoMap's binary `.bt` files hold.

mod bt;
mod key;

pub use bt::BtError;
pub use key::{TREE_LEVELS, VoxelKey};

use enfilade_math::DVec3;

/// What is known about a voxel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Voxel {
    /// Never seen: inside a wall, beyond one, or out of bounds.
    #[default]
    Unknown,
    /// Seen to be empty.
    Free,
    /// A surface passes through it.
    Occupied,
}

/// An octree over [`VoxelKey`]s with one [`Voxel`] state per leaf; unmentioned space is unknown.
///
/// Two trees of the same states can differ in structure until both are pruned; [`OccupancyTree::from_states`] and
/// [`OccupancyTree::prune`] give the unique smallest tree.
#[derive(Clone, Debug, PartialEq)]
pub struct OccupancyTree {
    resolution_m: f64,
    root: Child,
    nodes: Vec<[Child; 8]>,
}

/// A subtree: all of one state, or an index into the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Child {
    Leaf(Voxel),
    Inner(u32),
}

const UNKNOWN: Child = Child::Leaf(Voxel::Unknown);

/// A cube of one known state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Its voxel with the smallest keys.
    pub key: VoxelKey,
    /// It has 2^level voxels along each edge.
    pub level: u32,
    /// Free or occupied.
    pub state: Voxel,
}

impl Leaf {
    /// Voxels in the cube.
    pub fn voxels(&self) -> u64 {
        1 << (3 * self.level)
    }
}

impl OccupancyTree {
    /// A tree of voxels with edges of `resolution_m` (positive, finite) in which everything is unknown.
    pub fn new(resolution_m: f64) -> Self {
        assert!(resolution_m > 0.0 && resolution_m.is_finite(), "a voxel's edge must be positive and finite, found {resolution_m}");
        Self { resolution_m, root: UNKNOWN, nodes: Vec::new() }
    }

    /// The smallest tree with the states that `state` gives.
    ///
    /// `state(key, level)` is asked about the cube of 2^`level` voxels per edge whose smallest key is `key`: the state of all of
    /// it, or `None` to be asked about its eight halves instead. At level 0 it must know. Cost is one call per cube asked about.
    pub fn from_states(resolution_m: f64, state: impl Fn(VoxelKey, u32) -> Option<Voxel>) -> Self {
        let mut tree = Self::new(resolution_m);
        tree.root = tree.build(VoxelKey([0; 3]), TREE_LEVELS, &state);
        tree
    }

    fn build(&mut self, key: VoxelKey, level: u32, state: &impl Fn(VoxelKey, u32) -> Option<Voxel>) -> Child {
        match state(key, level) {
            Some(known) => return Child::Leaf(known),
            None => assert!(level > 0, "the state of the single voxel {key:?} was not given"),
        }
        let mut children = [UNKNOWN; 8];
        for octant in 0..8 {
            children[octant] = self.build(key.child(octant, level), level - 1, state);
        }
        self.join(children)
    }

    /// A node with these children, or the leaf that is the same as all of them.
    fn join(&mut self, children: [Child; 8]) -> Child {
        if matches!(children[0], Child::Leaf(_)) && children.iter().all(|c| *c == children[0]) {
            return children[0];
        }
        self.nodes.push(children);
        Child::Inner((self.nodes.len() - 1) as u32)
    }

    /// Edge of a voxel, metres.
    pub fn resolution_m(&self) -> f64 {
        self.resolution_m
    }

    /// The key of the voxel that holds `p`; `None` outside the key space.
    #[inline]
    pub fn key(&self, p: DVec3) -> Option<VoxelKey> {
        VoxelKey::at(p, self.resolution_m)
    }

    /// The middle of a voxel, metres.
    #[inline]
    pub fn center(&self, key: VoxelKey) -> DVec3 {
        key.center(self.resolution_m)
    }

    /// The state at a point of the world; unknown outside the key space.
    #[inline]
    pub fn state(&self, p: DVec3) -> Voxel {
        self.key(p).map_or(Voxel::Unknown, |key| self.get(key))
    }

    /// The state of a voxel.
    #[inline]
    pub fn get(&self, key: VoxelKey) -> Voxel {
        let (mut child, mut level) = (self.root, TREE_LEVELS);
        loop {
            match child {
                Child::Leaf(state) => return state,
                Child::Inner(node) => child = self.nodes[node as usize][key.octant(level)],
            }
            level -= 1;
        }
    }

    /// Sets the state of one voxel. Does not prune: call [`OccupancyTree::prune`] after the last one.
    pub fn set(&mut self, key: VoxelKey, state: Voxel) {
        if self.get(key) == state {
            return;
        }
        let mut node = self.open_root();
        for level in (2..=TREE_LEVELS).rev() {
            let octant = key.octant(level);
            node = match self.nodes[node][octant] {
                Child::Inner(next) => next as usize,
                leaf @ Child::Leaf(_) => {
                    self.nodes.push([leaf; 8]);
                    let next = self.nodes.len() - 1;
                    self.nodes[node][octant] = Child::Inner(next as u32);
                    next
                }
            };
        }
        self.nodes[node][key.octant(1)] = Child::Leaf(state);
    }

    /// The root as an inner node, split when it is a leaf.
    fn open_root(&mut self) -> usize {
        match self.root {
            Child::Inner(node) => node as usize,
            leaf @ Child::Leaf(_) => {
                self.nodes.push([leaf; 8]);
                self.root = Child::Inner((self.nodes.len() - 1) as u32);
                self.nodes.len() - 1
            }
        }
    }

    /// Replaces every node whose children all have one state by a leaf of that state.
    pub fn prune(&mut self) {
        *self = Self::from_tree(self);
    }

    fn from_tree(old: &Self) -> Self {
        fn copy(old: &OccupancyTree, child: Child, new: &mut OccupancyTree) -> Child {
            let Child::Inner(node) = child else { return child };
            let children = old.nodes[node as usize].map(|c| copy(old, c, new));
            new.join(children)
        }
        let mut new = Self::new(old.resolution_m);
        new.root = copy(old, old.root, &mut new);
        new
    }

    /// Every free or occupied leaf, in Morton order (z varies slowest).
    pub fn leaves(&self) -> impl Iterator<Item = Leaf> + '_ {
        let mut stack = vec![(VoxelKey([0; 3]), TREE_LEVELS, self.root)];
        std::iter::from_fn(move || {
            while let Some((key, level, child)) = stack.pop() {
                match child {
                    UNKNOWN => {}
                    Child::Leaf(state) => return Some(Leaf { key, level, state }),
                    Child::Inner(node) => {
                        let children = &self.nodes[node as usize];
                        stack.extend((0..8).rev().map(|octant| (key.child(octant, level), level - 1, children[octant])));
                    }
                }
            }
            None
        })
    }

    /// Number of voxels (not leaves) of `state`; unknown ones are not counted and give 0.
    pub fn count(&self, state: Voxel) -> u64 {
        self.leaves().filter(|leaf| leaf.state == state).map(|leaf| leaf.voxels()).sum()
    }

    /// True when any voxel of a known `state` has a point within `radius_m` of `p`.
    pub fn any_within(&self, p: DVec3, radius_m: f64, state: Voxel) -> bool {
        self.near(self.root, VoxelKey([0; 3]), TREE_LEVELS, p, radius_m, state)
    }

    fn near(&self, child: Child, key: VoxelKey, level: u32, p: DVec3, radius_m: f64, state: Voxel) -> bool {
        if matches!(child, Child::Leaf(other) if other != state) {
            return false;
        }
        let low = key.corner(self.resolution_m);
        let high = low + DVec3::splat(self.resolution_m * f64::from(1u32 << level));
        if p.clamp(low, high).distance_squared(p) > radius_m * radius_m {
            return false;
        }
        let Child::Inner(node) = child else { return true };
        let children = &self.nodes[node as usize];
        (0..8).any(|octant| self.near(children[octant], key.child(octant, level), level - 1, p, radius_m, state))
    }

    /// The box around all voxels of a known `state`, borders included, metres; `None` when there are none.
    pub fn bounds(&self, state: Voxel) -> Option<(DVec3, DVec3)> {
        self.leaves().filter(|leaf| leaf.state == state).fold(None, |bounds, leaf| {
            let low = leaf.key.corner(self.resolution_m);
            let high = low + DVec3::splat(self.resolution_m * f64::from(1u32 << leaf.level));
            let (min, max) = bounds.unwrap_or((low, high));
            Some((min.min(low), max.max(high)))
        })
    }
}

#[cfg(test)]
mod tests {
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
}

//! Octrees of occupancy: the free, occupied and unknown parts of space.
//!
//! The tree, its keys and its file format are OctoMap's (Hornung et al. 2013, "OctoMap: An Efficient Probabilistic 3D Mapping
//! Framework Based on Octrees"), so that a tree written here opens in OctoMap's programs and the other way round. Occupancy is
//! the maximum-likelihood state, not a probability: OctoMap's binary `.bt` files store no more.

mod bt;
mod file;
mod key;

#[cfg(test)]
mod tests;

pub use file::TreeFileError;
pub use key::{TREE_LEVELS, VoxelKey};

use enfilade_math::DVec3;

/// The state of a voxel.
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
///
/// ```
/// use enfilade_geometry::{OccupancyTree, Voxel};
/// use enfilade_math::DVec3;
///
/// // Voxels of 10 cm: a metre of free space along x, with a wall at its end.
/// let mut tree = OccupancyTree::new(0.1);
/// for i in 0..10 {
///     let p = DVec3::new(0.05 + 0.1 * f64::from(i), 0.05, 0.05);
///     tree.set(tree.key(p).unwrap(), if i < 9 { Voxel::Free } else { Voxel::Occupied });
/// }
/// assert_eq!((tree.count(Voxel::Free), tree.count(Voxel::Occupied)), (9, 1));
/// assert_eq!(tree.state(DVec3::new(0.42, 0.02, 0.09)), Voxel::Free);
/// assert_eq!(tree.state(DVec3::new(0.42, 0.02, 0.11)), Voxel::Unknown);
/// assert!(tree.any_within(DVec3::new(0.55, 0.05, 0.05), 0.4, Voxel::Occupied));
///
/// // OctoMap's programs read what is written here, and the other way round.
/// tree.prune();
/// assert_eq!(OccupancyTree::from_bt(&tree.to_bt()).unwrap().count(Voxel::Free), 9);
/// ```
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
    /// The leaf's voxel with the smallest keys.
    pub key: VoxelKey,
    /// Level of the leaf, which has 2^level voxels along each edge.
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
        Self::within_bytes(resolution_m, u64::MAX, state).expect("there is no limit")
    }

    /// [`OccupancyTree::from_states`] for as long as its nodes take no more than `max_bytes` of memory; `None` beyond that.
    pub fn within_bytes(resolution_m: f64, max_bytes: u64, state: impl Fn(VoxelKey, u32) -> Option<Voxel>) -> Option<Self> {
        let mut tree = Self::new(resolution_m);
        tree.root = tree.build(VoxelKey([0; 3]), TREE_LEVELS, max_bytes, &state)?;
        Some(tree)
    }

    fn build(&mut self, key: VoxelKey, level: u32, max_bytes: u64, state: &impl Fn(VoxelKey, u32) -> Option<Voxel>) -> Option<Child> {
        match state(key, level) {
            Some(known) => return Some(Child::Leaf(known)),
            None => assert!(level > 0, "the state of the single voxel {key:?} was not given"),
        }
        if size_of_val(&*self.nodes) as u64 > max_bytes {
            return None;
        }
        let mut children = [UNKNOWN; 8];
        for octant in 0..8 {
            children[octant] = self.build(key.child(octant, level), level - 1, max_bytes, state)?;
        }
        Some(self.join(children))
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

    /// Number of nodes as OctoMap counts them: inner nodes and known leaves.
    pub fn node_count(&self) -> u64 {
        match self.root {
            UNKNOWN => 0,
            Child::Leaf(_) => 1,
            Child::Inner(root) => 1 + self.count_below(root),
        }
    }

    fn count_below(&self, node: u32) -> u64 {
        let below = |child: &Child| match child {
            Child::Leaf(Voxel::Unknown) => 0,
            Child::Leaf(_) => 1,
            Child::Inner(next) => 1 + self.count_below(*next),
        };
        self.nodes[node as usize].iter().map(below).sum()
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

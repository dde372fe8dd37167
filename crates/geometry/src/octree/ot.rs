//! OctoMap's tree files with probabilities (`.ot`): a text header, then for every node, depth first, its log-odds as a float32 and a
//! byte with a bit for every child that there is, child 0 in the lowest. Known leaves have none.

use super::file::{Header, TreeFileError};
use super::{Child, OccupancyTree, TREE_LEVELS, UNKNOWN, Voxel};

const TITLE: &str = "Octomap OcTree file";

/// Log-odds that OctoMap gives to what is free for certain: ln(p / (1 − p)) for its lower clamping threshold, p = 0.1192.
const FREE: f32 = -2.000_028;
/// Log-odds of what is occupied for certain: the same for p = 0.971.
const OCCUPIED: f32 = 3.511_030_7;

impl OccupancyTree {
    /// The tree as the bytes of an `.ot` file. A state becomes the probability at which OctoMap clamps, and an inner node has the
    /// greatest one of its children. Inner nodes below which nothing is known are left out: as nodes without children they would be free.
    pub fn to_ot(&self) -> Vec<u8> {
        let mut known = self.clone();
        known.root = known.forget_empty(known.root);
        let mut bytes = Header::of(&known, TITLE);
        if known.root != UNKNOWN {
            known.write_with_odds(known.root, &mut bytes);
        }
        bytes
    }

    /// Replaces inner nodes below which nothing is known by unknown leaves; returns the replacement of `child`.
    fn forget_empty(&mut self, child: Child) -> Child {
        let Child::Inner(node) = child else { return child };
        for octant in 0..8 {
            self.nodes[node as usize][octant] = self.forget_empty(self.nodes[node as usize][octant]);
        }
        if self.nodes[node as usize] == [UNKNOWN; 8] { UNKNOWN } else { child }
    }

    /// Writes a known node and all below it; returns its log-odds.
    fn write_with_odds(&self, child: Child, bytes: &mut Vec<u8>) -> f32 {
        let start = bytes.len();
        let (log_odds, present) = match child {
            Child::Leaf(Voxel::Occupied) => (OCCUPIED, 0),
            Child::Leaf(_) => (FREE, 0),
            Child::Inner(node) => {
                let children = &self.nodes[node as usize];
                bytes.extend([0; 5]);
                let (mut log_odds, mut present) = (f32::NEG_INFINITY, 0u8);
                for (octant, next) in children.iter().enumerate().filter(|(_, next)| **next != UNKNOWN) {
                    log_odds = log_odds.max(self.write_with_odds(*next, bytes));
                    present |= 1 << octant;
                }
                (log_odds, present)
            }
        };
        bytes.resize(bytes.len().max(start + 5), 0);
        bytes[start..start + 4].copy_from_slice(&log_odds.to_le_bytes());
        bytes[start + 4] = present;
        log_odds
    }

    /// The tree of an `.ot` file's bytes, with the structure of the file (not pruned): leaves with log-odds of 0 or more are occupied,
    /// as in OctoMap, the others free.
    ///
    /// # Errors
    /// A [`TreeFileError`] that names the place, for anything that is not such a file, and for bytes after the tree.
    pub fn from_ot(bytes: &[u8]) -> Result<Self, TreeFileError> {
        let header = Header::read(bytes, TITLE)?;
        let mut reader = Reader { bytes, offset: header.end, nodes: 0, tree: Self::new(header.resolution_m) };
        if header.nodes > 0 {
            reader.tree.root = reader.node(TREE_LEVELS)?;
        }
        header.check(reader.nodes, reader.offset, bytes)?;
        Ok(reader.tree)
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    offset: usize,
    /// Nodes read so far.
    nodes: u64,
    tree: OccupancyTree,
}

impl Reader<'_> {
    /// Reads the node `level` levels above the voxels, and all below it.
    fn node(&mut self, level: u32) -> Result<Child, TreeFileError> {
        let offset = self.offset;
        let Some(&[a, b, c, d, present]) = self.bytes.get(offset..offset + 5) else { return Err(TreeFileError::Truncated { offset }) };
        self.offset += 5;
        self.nodes += 1;
        let log_odds = f32::from_le_bytes([a, b, c, d]);
        if log_odds.is_nan() {
            return Err(TreeFileError::LogOdds { offset, found: log_odds });
        }
        if present == 0 {
            return Ok(Child::Leaf(if log_odds >= 0.0 { Voxel::Occupied } else { Voxel::Free }));
        }
        if level == 0 {
            return Err(TreeFileError::TooDeep { offset });
        }
        let node = self.tree.nodes.len();
        self.tree.nodes.push([UNKNOWN; 8]);
        for octant in (0..8).filter(|octant| (present >> octant) & 1 != 0) {
            self.tree.nodes[node][octant] = self.node(level - 1)?;
        }
        Ok(Child::Inner(node as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::small_tree;
    use super::*;
    use crate::VoxelKey;
    use enfilade_math::Rng;

    #[test]
    fn a_tree_survives_writing_and_reading() {
        let full = OccupancyTree::from_states(0.1, |_, _| Some(Voxel::Occupied));
        for tree in [small_tree(5, 300), OccupancyTree::new(0.1), full] {
            let bytes = tree.to_ot();
            let read = OccupancyTree::from_ot(&bytes).unwrap();
            assert!(read.leaves().eq(tree.leaves()));
            assert_eq!((read.resolution_m(), read.node_count(), read.to_ot()), (tree.resolution_m(), tree.node_count(), bytes));
        }
    }

    #[test]
    fn what_is_unknown_below_an_inner_node_stays_unknown() {
        // Below the root an inner node without known children, and an occupied leaf.
        let text = b"# Octomap OcTree binary file\nid OcTree\nsize 3\nres 0.1\ndata\n";
        let tree = OccupancyTree::from_bt(&[&text[..], &[0b1011, 0, 0, 0]].concat()).unwrap();
        let read = OccupancyTree::from_ot(&tree.to_ot()).unwrap();
        assert!(read.leaves().eq(tree.leaves()));
        assert_eq!((tree.node_count(), read.node_count()), (3, 2));
    }

    #[test]
    fn certain_states_have_the_log_odds_of_the_clamping_thresholds() {
        let log_odds = |p: f64| (p / (1.0 - p)).ln() as f32;
        assert_eq!((FREE, OCCUPIED), (log_odds(0.1192), log_odds(0.971)));
        let mut tree = OccupancyTree::new(0.1);
        tree.set(VoxelKey([32768; 3]), Voxel::Free);
        tree.set(VoxelKey([32769, 32768, 32768]), Voxel::Occupied);
        let bytes = tree.to_ot();
        let data = &bytes[bytes.len() - 18 * 5..];
        let node = |i: usize| (f32::from_le_bytes(data[5 * i..5 * i + 4].try_into().unwrap()), data[5 * i + 4]);
        assert_eq!((node(0), node(15)), ((OCCUPIED, 0x80), (OCCUPIED, 0x03)), "an inner node has the greatest of its children's");
        assert_eq!((node(16), node(17)), ((FREE, 0), (OCCUPIED, 0)));
    }

    #[test]
    fn probabilities_become_the_likelier_state() {
        let mut tree = OccupancyTree::new(0.1);
        (0..3).for_each(|x| tree.set(VoxelKey([32768 + x, 32768, 32768]), Voxel::Free));
        let mut bytes = tree.to_ot();
        // The last three nodes: a leaf, the parent of the third leaf, the third leaf.
        let end = bytes.len();
        for (back, log_odds) in [(20, 0.0f32), (5, 0.4)] {
            bytes[end - back..end - back + 4].copy_from_slice(&log_odds.to_le_bytes());
        }
        let read = OccupancyTree::from_ot(&bytes).unwrap();
        let states = [0, 1, 2].map(|x| read.get(VoxelKey([32768 + x, 32768, 32768])));
        assert_eq!(states, [Voxel::Occupied, Voxel::Free, Voxel::Occupied]);
    }

    #[test]
    fn damaged_files_are_refused() {
        let bytes = small_tree(5, 300).to_ot();
        let data = bytes.windows(6).position(|w| w == b"\ndata\n").unwrap() + 6;
        for end in 0..bytes.len() {
            let error = OccupancyTree::from_ot(&bytes[..end]).unwrap_err();
            assert!(matches!(error, TreeFileError::Truncated { .. }) || end < data, "{end}: {error}");
        }
        assert!(matches!(OccupancyTree::from_ot(&[&bytes[..], b"x"].concat()), Err(TreeFileError::Surplus { surplus: 1, .. })));
        assert!(matches!(OccupancyTree::from_ot(&small_tree(5, 300).to_bt()), Err(TreeFileError::Header { offset: 0, .. })));
        assert!(matches!(OccupancyTree::from_bt(&bytes), Err(TreeFileError::Header { offset: 0, .. })));
        let nan = [&bytes[..data], &f32::NAN.to_le_bytes(), &bytes[data + 4..]].concat();
        assert!(matches!(OccupancyTree::from_ot(&nan), Err(TreeFileError::LogOdds { .. })));
        let deep = [&bytes[..data], &[0, 0, 0, 0, 1].repeat(20)[..]].concat();
        assert_eq!(OccupancyTree::from_ot(&deep), Err(TreeFileError::TooDeep { offset: data + 80 }));
    }

    #[test]
    fn random_damage_makes_an_error_or_another_tree_but_no_panic() {
        let mut rng = Rng::new(77);
        for (bytes, read) in [
            (small_tree(5, 300).to_ot(), OccupancyTree::from_ot as fn(&[u8]) -> Result<OccupancyTree, TreeFileError>),
            (small_tree(5, 300).to_bt(), OccupancyTree::from_bt),
        ] {
            let mut refused = 0;
            for _ in 0..3000 {
                let mut damaged = bytes.clone();
                for _ in 0..=rng.below(4) {
                    let place = rng.below(damaged.len());
                    damaged[place] = rng.next_u64() as u8;
                }
                damaged.truncate(bytes.len() - rng.below(2) * rng.below(bytes.len()));
                match read(&damaged) {
                    Ok(tree) => assert!(tree.leaves().count() as u64 <= tree.node_count()),
                    Err(error) => refused += usize::from(!error.to_string().is_empty()),
                }
            }
            assert!(refused > 1000, "{refused}");
        }
    }
}

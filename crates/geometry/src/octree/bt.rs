//! OctoMap's binary tree files (`.bt`): a text header, then two bytes per inner node, depth first.
//!
//! Each node stores two bits per child, child 0 in the lowest bits of the first byte: 0 unknown, 1 free leaf, 2 occupied leaf,
//! 3 inner node. The `size` of the header counts every known node, the root and the leaves included.

use super::file::{Header, TreeFileError};
use super::{Child, OccupancyTree, TREE_LEVELS, UNKNOWN, Voxel};

const TITLE: &str = "Octomap OcTree binary file";

impl OccupancyTree {
    /// The tree as the bytes of a `.bt` file.
    pub fn to_bt(&self) -> Vec<u8> {
        if let Child::Leaf(Voxel::Free | Voxel::Occupied) = self.root {
            // The format has no root without children: write the same state one level down.
            let mut opened = self.clone();
            opened.open_root();
            return opened.to_bt();
        }
        let mut bytes = Header::of(self, TITLE);
        if let Child::Inner(root) = self.root {
            self.write_node(root, &mut bytes);
        }
        bytes
    }

    fn write_node(&self, node: u32, bytes: &mut Vec<u8>) {
        let children = &self.nodes[node as usize];
        let codes = children.iter().enumerate().fold(0u16, |codes, (i, child)| {
            let code = match child {
                Child::Leaf(Voxel::Unknown) => 0,
                Child::Leaf(Voxel::Free) => 1,
                Child::Leaf(Voxel::Occupied) => 2,
                Child::Inner(_) => 3,
            };
            codes | (code << (2 * i))
        });
        bytes.extend(codes.to_le_bytes());
        for child in children {
            if let Child::Inner(next) = child {
                self.write_node(*next, bytes);
            }
        }
    }

    /// The tree of a `.bt` file's bytes, with the structure of the file (not pruned).
    ///
    /// # Errors
    /// A [`TreeFileError`] that names the place, for anything that OctoMap's own reader would not accept, and for bytes after the tree.
    pub fn from_bt(bytes: &[u8]) -> Result<Self, TreeFileError> {
        let header = Header::read(bytes, TITLE)?;
        let mut reader = Reader { bytes, offset: header.end, tree: Self::new(header.resolution_m) };
        if header.nodes > 0 {
            reader.tree.root = Child::Inner(reader.node(TREE_LEVELS)?);
        }
        header.check(reader.tree.node_count(), reader.offset, bytes)?;
        Ok(reader.tree)
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    offset: usize,
    tree: OccupancyTree,
}

impl Reader<'_> {
    /// Reads the node `level` levels above the voxels, and all below it.
    fn node(&mut self, level: u32) -> Result<u32, TreeFileError> {
        let offset = self.offset;
        let Some(&[low, high]) = self.bytes.get(offset..offset + 2) else { return Err(TreeFileError::Truncated { offset }) };
        self.offset += 2;
        let codes = u16::from_le_bytes([low, high]);
        let node = self.tree.nodes.len();
        self.tree.nodes.push([UNKNOWN; 8]);
        for octant in 0..8 {
            self.tree.nodes[node][octant] = match (codes >> (2 * octant)) & 3 {
                0 => UNKNOWN,
                1 => Child::Leaf(Voxel::Free),
                2 => Child::Leaf(Voxel::Occupied),
                _ if level == 1 => return Err(TreeFileError::TooDeep { offset }),
                _ => Child::Inner(self.node(level - 1)?),
            };
        }
        Ok(node as u32)
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
        let tree = small_tree(3, 400);
        let bytes = tree.to_bt();
        let read = OccupancyTree::from_bt(&bytes).unwrap();
        assert!(read.leaves().eq(tree.leaves()));
        assert_eq!((read.resolution_m(), read.node_count(), read.to_bt()), (0.05, tree.node_count(), bytes));
    }

    #[test]
    fn one_voxel_is_a_chain_of_sixteen_nodes() {
        let mut tree = OccupancyTree::new(0.1);
        tree.set(VoxelKey([32768, 32768, 32768]), Voxel::Occupied);
        assert_eq!(tree.node_count(), 17);
        let bytes = tree.to_bt();
        let data = &bytes[bytes.len() - 32..];
        assert_eq!(data[..2], (3u16 << 14).to_le_bytes(), "the upper half of space is the root's last child");
        assert_eq!((&data[2..4], &data[30..]), (&[3, 0][..], &[2, 0][..]));
    }

    #[test]
    fn trees_of_one_state_can_be_written() {
        let empty = OccupancyTree::new(0.1);
        assert_eq!(OccupancyTree::from_bt(&empty.to_bt()).unwrap(), empty);
        let mut full = OccupancyTree::from_bt(&OccupancyTree::from_states(0.1, |_, _| Some(Voxel::Free)).to_bt()).unwrap();
        full.prune();
        assert_eq!(full, OccupancyTree::from_states(0.1, |_, _| Some(Voxel::Free)));
    }

    #[test]
    fn damaged_files_are_refused_with_the_place() {
        let bytes = small_tree(3, 400).to_bt();
        let end = bytes.len();
        let data = bytes.windows(6).position(|w| w == b"\ndata\n").unwrap() + 6;
        let read = |bytes: &[u8]| OccupancyTree::from_bt(bytes).unwrap_err();
        assert_eq!(read(&bytes[..end - 1]), TreeFileError::Truncated { offset: end - 2 });
        assert_eq!(read(&[&bytes[..], b"\0\0\0"].concat()), TreeFileError::Surplus { offset: end, surplus: 3 });
        assert!(matches!(read(b""), TreeFileError::Header { offset: 0, .. }));
        assert!(matches!(read(&bytes[..20]), TreeFileError::Header { offset: 0, .. }));
        assert!(matches!(read(&bytes[..data - 3]), TreeFileError::Header { expected: "a header that ends with the line \"data\"", .. }));
        let edit = |from: &str, to: &str| {
            let text = String::from_utf8(bytes[..data].to_vec()).unwrap().replace(from, to);
            read(&[text.as_bytes(), &bytes[data..]].concat())
        };
        assert!(edit("res 0.05", "res -1").to_string().contains("positive length, found \"res -1\""));
        assert!(edit("id OcTree", "id ColorOcTree").to_string().contains("\"id ColorOcTree\""));
        assert!(matches!(edit("res 0.05\n", ""), TreeFileError::Header { .. }));
        assert!(matches!(edit("size ", "size 1"), TreeFileError::Size { .. }));
        let deep = [&bytes[..data], &[3u8, 0].repeat(20)[..]].concat();
        assert_eq!(read(&deep), TreeFileError::TooDeep { offset: data + 30 });
    }

    #[test]
    fn random_damage_makes_an_error_or_another_tree_but_no_panic() {
        let (bytes, mut rng, mut refused) = (small_tree(5, 300).to_bt(), Rng::new(77), 0);
        for _ in 0..3000 {
            let mut damaged = bytes.clone();
            for _ in 0..=rng.below(4) {
                let place = rng.below(damaged.len());
                damaged[place] = rng.next_u64() as u8;
            }
            damaged.truncate(bytes.len() - rng.below(2) * rng.below(bytes.len()));
            match OccupancyTree::from_bt(&damaged) {
                Ok(tree) => assert!(tree.leaves().count() as u64 <= tree.node_count()),
                Err(error) => refused += usize::from(!error.to_string().is_empty()),
            }
        }
        assert!(refused > 1000, "{refused}");
    }
}

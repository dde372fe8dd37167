//! OctoMap's binary tree files (`.bt`): a text header, then two bytes per inner node, depth first.
//!
//! Each node stores two bits per child, child 0 in the lowest bits of the first byte: 0 unknown, 1 free leaf, 2 occupied leaf,
//! 3 inner node. The `size` of the header counts every known node, the root and the leaves included.

use super::{Child, OccupancyTree, TREE_LEVELS, UNKNOWN, Voxel};

const FIRST_LINE: &str = "# Octomap OcTree binary file";

/// Why bytes are not a `.bt` file that can be used. Offsets are in bytes from the start of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BtError {
    /// A line of the header is not as it should be.
    #[error("byte {offset}: expected {expected}, found {found:?}; is this an OctoMap .bt file?")]
    Header {
        /// Where the line begins.
        offset: usize,
        /// What should stand there.
        expected: &'static str,
        /// The line found.
        found: String,
    },
    /// The data ends in the middle of the tree.
    #[error("byte {offset}: the file ends inside the tree, expected two more bytes for a node; copy or download it again")]
    Truncated {
        /// Where the missing node should begin.
        offset: usize,
    },
    /// An inner node below the sixteenth level.
    #[error("byte {offset}: a node at the finest level has children, expected none below level 16; the file is damaged")]
    TooDeep {
        /// Where the node begins.
        offset: usize,
    },
    /// Bytes after the tree.
    #[error("byte {offset}: {surplus} bytes follow the end of the tree, expected none; the file is damaged")]
    Surplus {
        /// Where the tree ends.
        offset: usize,
        /// How many bytes follow.
        surplus: usize,
    },
    /// The header's count of nodes is wrong.
    #[error("the header promises {expected} nodes, but the tree has {found}; the file is damaged")]
    Size {
        /// The header's `size`.
        expected: u64,
        /// Nodes in the data.
        found: u64,
    },
}

impl OccupancyTree {
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

    /// The tree as the bytes of a `.bt` file.
    pub fn to_bt(&self) -> Vec<u8> {
        if let Child::Leaf(Voxel::Free | Voxel::Occupied) = self.root {
            // The format has no root without children: write the same state one level down.
            let mut opened = self.clone();
            opened.open_root();
            return opened.to_bt();
        }
        let header = format!(
            "{FIRST_LINE}\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid OcTree\nsize {}\nres {}\ndata\n",
            self.node_count(),
            self.resolution_m
        );
        let mut bytes = header.into_bytes();
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
    /// A [`BtError`] that names the place, for anything that OctoMap's own reader would not accept, and for bytes after the tree.
    pub fn from_bt(bytes: &[u8]) -> Result<Self, BtError> {
        let header = Header::read(bytes)?;
        let mut reader = Reader { bytes, offset: header.end, tree: Self::new(header.resolution_m) };
        if header.nodes > 0 {
            reader.tree.root = Child::Inner(reader.node(TREE_LEVELS)?);
        }
        if reader.offset < bytes.len() {
            return Err(BtError::Surplus { offset: reader.offset, surplus: bytes.len() - reader.offset });
        }
        match reader.tree.node_count() {
            found if found == header.nodes => Ok(reader.tree),
            found => Err(BtError::Size { expected: header.nodes, found }),
        }
    }
}

struct Header {
    resolution_m: f64,
    nodes: u64,
    end: usize,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, BtError> {
        let (mut offset, mut nodes, mut resolution_m) = (0, None, None);
        loop {
            let start = offset;
            let rest = &bytes[start..];
            let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
            let line = String::from_utf8_lossy(&rest[..end.min(120)]).trim_end().to_string();
            let wrong = |expected| Err(BtError::Header { offset: start, expected, found: line.clone() });
            if start == 0 && !line.starts_with(FIRST_LINE) {
                return wrong("the line \"# Octomap OcTree binary file\"");
            }
            if end == rest.len() {
                return wrong("a header that ends with the line \"data\"");
            }
            offset = start + end + 1;
            let (word, value) = line.split_once(' ').unwrap_or((&line, ""));
            match word {
                "data" => break,
                "id" if value != "OcTree" => return wrong("\"id OcTree\" (other kinds of trees are not read)"),
                "size" => match value.parse::<u64>() {
                    Ok(n) => nodes = Some(n),
                    Err(_) => return wrong("\"size\" and a whole number of nodes"),
                },
                "res" => match value.parse::<f64>() {
                    Ok(r) if r > 0.0 && r.is_finite() => resolution_m = Some(r),
                    _ => return wrong("\"res\" and a positive length"),
                },
                "id" | "#" | "" => {}
                comment if comment.starts_with('#') => {}
                _ => return wrong("a comment, \"id\", \"size\", \"res\" or \"data\""),
            }
        }
        let missing = |expected| BtError::Header { offset, expected, found: "data".to_string() };
        let nodes = nodes.ok_or_else(|| missing("a line \"size\" before \"data\""))?;
        let resolution_m = resolution_m.ok_or_else(|| missing("a line \"res\" before \"data\""))?;
        Ok(Self { resolution_m, nodes, end: offset })
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    offset: usize,
    tree: OccupancyTree,
}

impl Reader<'_> {
    /// Reads the node `level` levels above the voxels, and all below it.
    fn node(&mut self, level: u32) -> Result<u32, BtError> {
        let offset = self.offset;
        let Some(&[low, high]) = self.bytes.get(offset..offset + 2) else { return Err(BtError::Truncated { offset }) };
        self.offset += 2;
        let codes = u16::from_le_bytes([low, high]);
        let node = self.tree.nodes.len();
        self.tree.nodes.push([UNKNOWN; 8]);
        for octant in 0..8 {
            self.tree.nodes[node][octant] = match (codes >> (2 * octant)) & 3 {
                0 => UNKNOWN,
                1 => Child::Leaf(Voxel::Free),
                2 => Child::Leaf(Voxel::Occupied),
                _ if level == 1 => return Err(BtError::TooDeep { offset }),
                _ => Child::Inner(self.node(level - 1)?),
            };
        }
        Ok(node as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VoxelKey;
    use enfilade_math::Rng;

    fn small_tree() -> OccupancyTree {
        let mut tree = OccupancyTree::new(0.05);
        let mut rng = Rng::new(3);
        for _ in 0..400 {
            let key = VoxelKey([0; 3].map(|_: u16| 32764 + rng.below(8) as u16));
            tree.set(key, if rng.below(2) == 0 { Voxel::Free } else { Voxel::Occupied });
        }
        tree.prune();
        tree
    }

    #[test]
    fn a_tree_survives_writing_and_reading() {
        let tree = small_tree();
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
        let bytes = small_tree().to_bt();
        let end = bytes.len();
        let data = bytes.windows(6).position(|w| w == b"\ndata\n").unwrap() + 6;
        let read = |bytes: &[u8]| OccupancyTree::from_bt(bytes).unwrap_err();
        assert_eq!(read(&bytes[..end - 1]), BtError::Truncated { offset: end - 2 });
        assert_eq!(read(&[&bytes[..], b"\0\0\0"].concat()), BtError::Surplus { offset: end, surplus: 3 });
        assert!(matches!(read(b""), BtError::Header { offset: 0, .. }));
        assert!(matches!(read(&bytes[..20]), BtError::Header { offset: 0, .. }));
        assert!(matches!(read(&bytes[..data - 3]), BtError::Header { expected: "a header that ends with the line \"data\"", .. }));
        let edit = |from: &str, to: &str| {
            let text = String::from_utf8(bytes[..data].to_vec()).unwrap().replace(from, to);
            read(&[text.as_bytes(), &bytes[data..]].concat())
        };
        assert!(edit("res 0.05", "res -1").to_string().contains("positive length, found \"res -1\""));
        assert!(edit("id OcTree", "id ColorOcTree").to_string().contains("\"id ColorOcTree\""));
        assert!(matches!(edit("res 0.05\n", ""), BtError::Header { .. }));
        assert!(matches!(edit("size ", "size 1"), BtError::Size { .. }));
        let deep = [&bytes[..data], &[3u8, 0].repeat(20)[..]].concat();
        assert_eq!(read(&deep), BtError::TooDeep { offset: data + 30 });
    }
}

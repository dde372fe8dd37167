//! The text header of OctoMap's tree files, and the ways in which such files can be wrong.

use super::OccupancyTree;

/// Why bytes are not a tree file that can be used. Offsets are in bytes from the start of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TreeFileError {
    /// A line of the header is not as it should be.
    #[error("byte {offset}: expected {expected}, found {found:?}; is this a file of OctoMap?")]
    Header {
        /// Position of the line, in bytes.
        offset: usize,
        /// The expected text.
        expected: &'static str,
        /// The line found.
        found: String,
    },
    /// The data ends in the middle of the tree.
    #[error("byte {offset}: the file ends inside the tree, expected another node; copy or download it again")]
    Truncated {
        /// Position of the missing node, in bytes.
        offset: usize,
    },
    /// An inner node below the sixteenth level.
    #[error("byte {offset}: a node at the finest level has children, expected none below level 16; the file is damaged")]
    TooDeep {
        /// Position of the node, in bytes.
        offset: usize,
    },
    /// Bytes after the tree.
    #[error("byte {offset}: {surplus} bytes follow the end of the tree, expected none; the file is damaged")]
    Surplus {
        /// End of the tree, in bytes.
        offset: usize,
        /// Number of bytes after it.
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

/// The header before the tree.
pub(super) struct Header {
    pub resolution_m: f64,
    pub nodes: u64,
    /// Position of the tree, in bytes.
    pub end: usize,
}

impl Header {
    /// Reads the header of a file that begins with the line `# ` and `title`.
    pub(super) fn read(bytes: &[u8], title: &'static str) -> Result<Self, TreeFileError> {
        let (mut offset, mut nodes, mut resolution_m) = (0, None, None);
        loop {
            let start = offset;
            let rest = &bytes[start..];
            let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
            let line = String::from_utf8_lossy(&rest[..end.min(120)]).trim_end().to_string();
            let wrong = |expected| Err(TreeFileError::Header { offset: start, expected, found: line.clone() });
            if start == 0 && line.strip_prefix("# ") != Some(title) {
                return wrong(title);
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
        let missing = |expected| TreeFileError::Header { offset, expected, found: "data".to_string() };
        let nodes = nodes.ok_or_else(|| missing("a line \"size\" before \"data\""))?;
        let resolution_m = resolution_m.ok_or_else(|| missing("a line \"res\" before \"data\""))?;
        Ok(Self { resolution_m, nodes, end: offset })
    }

    /// The header of a file with this tree.
    pub(super) fn of(tree: &OccupancyTree, title: &str) -> Vec<u8> {
        let (nodes, resolution_m) = (tree.node_count(), tree.resolution_m);
        let note = "# (feel free to add / change comments, but leave the first line as it is!)";
        format!("# {title}\n{note}\n#\nid OcTree\nsize {nodes}\nres {resolution_m}\ndata\n").into_bytes()
    }

    /// Checks that a tree of `found` nodes that ends at `end` is what the header promises and all that the file has.
    pub(super) fn check(&self, found: u64, end: usize, bytes: &[u8]) -> Result<(), TreeFileError> {
        match (bytes.len() - end, found == self.nodes) {
            (0, true) => Ok(()),
            (0, false) => Err(TreeFileError::Size { expected: self.nodes, found }),
            (surplus, _) => Err(TreeFileError::Surplus { offset: end, surplus }),
        }
    }
}

//! Files of arrays in chunks whose tree of chunks is damaged on purpose.

/// Position of the root of the tree of chunks in a file, in bytes.
pub fn chunk_tree(file: &[u8]) -> usize {
    file.windows(5).position(|bytes| bytes == b"TREE\x01").expect("a tree of chunks")
}

/// The file `whole` of an array of `axes` axes, with another tree of chunks: `levels` nodes above an empty leaf, each of which leads to the
/// one below it twice, so that there are 2^levels ways down.
pub fn branching_tree(whole: &[u8], axes: usize, levels: u8) -> Vec<u8> {
    let key = vec![0; 8 + 8 * (axes + 1)];
    let node = |level: u8, below: usize| {
        let entries = if level == 0 { 0 } else { 2 };
        let mut node = [b"TREE\x01".as_slice(), &[level, entries, 0], &[0xff; 16]].concat();
        for _ in 0..entries {
            node.extend(&key);
            node.extend((below as u64).to_le_bytes());
        }
        node.extend(&key);
        node
    };
    let (mut file, root) = (whole.to_vec(), chunk_tree(whole));
    let first = node(levels, file.len());
    file[root..root + first.len()].copy_from_slice(&first);
    for level in (0..levels).rev() {
        let below = file.len() + first.len();
        file.extend(node(level, below));
    }
    // The superblock stores the end of the file.
    let length = file.len() as u64;
    file[40..48].copy_from_slice(&length.to_le_bytes());
    file
}

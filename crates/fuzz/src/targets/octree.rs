//! OctoMap's occupancy trees, `.bt`: what was read can be written and read again.

use crate::Run;
use enfilade_geometry::OccupancyTree;
use std::path::Path;

/// Reads trees. What was read is written and read again.
pub fn trees(_: &Path) -> Run {
    Box::new(|bytes| {
        if let Ok(tree) = OccupancyTree::from_bt(bytes) {
            assert!(OccupancyTree::from_bt(&tree.to_bt()).is_ok(), "a tree that was written can be read");
        }
    })
}

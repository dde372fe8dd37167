//! Triangle meshes, the ray-tracing hierarchy and the occupancy octree.

mod bvh;
mod mesh;
mod octree;

pub use bvh::{Bvh, Hit, NOTHING, PinholeRays, VisibilityBuffer};
pub use mesh::{Mesh, MeshError};
pub use octree::{BtError, Leaf, OccupancyTree, TREE_LEVELS, Voxel, VoxelKey};

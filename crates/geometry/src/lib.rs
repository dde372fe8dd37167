//! Triangle meshes, the ray-tracing hierarchy and the occupancy octree.

mod bvh;
mod mesh;
mod nearest;
mod octree;

pub use bvh::{Bvh, Hit, NOTHING, PinholeRays, VisibilityBuffer};
pub use mesh::{Mesh, MeshError};
pub use nearest::Surfaces;
pub use octree::{Leaf, OccupancyTree, TREE_LEVELS, TreeFileError, Voxel, VoxelKey};

//! Triangle meshes, the ray-tracing hierarchy and the occupancy octree.

mod bvh;
mod disjoint_sets;
mod mesh;
mod nearest;
mod nearest_triangle;
mod octree;
mod primitives;

pub use bvh::{Bvh, Hit, NOTHING, PinholeRays, Placement, VisibilityBuffer};
pub use disjoint_sets::DisjointSets;
pub use mesh::{Mesh, MeshError};
pub use nearest::Surfaces;
pub use nearest_triangle::NearestTriangle;
pub use octree::{Leaf, OccupancyTree, TREE_LEVELS, TreeFileError, Voxel, VoxelKey};

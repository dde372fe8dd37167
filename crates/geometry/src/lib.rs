//! Triangle meshes, the ray-tracing hierarchy and the occupancy octree.

mod mesh;

pub use mesh::{Mesh, MeshError};

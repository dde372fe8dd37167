//! The plan of a scene, and the scene prepared for rays.

use enfilade_geometry::{Bvh, OccupancyTree, Voxel};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, StartCamera, Trajectory, WorldMesh};

/// The plan of a scene, and the scene prepared for rays.
pub struct Planned<'a> {
    /// Name of the scene in the dataset.
    pub scene: &'a str,
    /// Triangles of the scene.
    pub world: &'a WorldMesh,
    /// The hierarchy over them, all solid.
    pub bvh: &'a Bvh,
    /// Free space of the scene.
    pub tree: &'a OccupancyTree,
    /// Start cameras of carving and planning.
    pub starts: &'a [StartCamera],
    /// The trajectories, each with its camera.
    pub filmed: &'a [(Camera, Trajectory)],
}

impl Planned<'_> {
    /// Number of parts, those without triangles at the end left out.
    pub(super) fn parts(&self) -> usize {
        self.world.sources.iter().map(|source| source.part as usize + 1).max().unwrap_or(0)
    }

    /// The box around the free voxels, metres.
    pub(super) fn free_bounds(&self) -> Option<(DVec3, DVec3)> {
        self.tree.bounds(Voxel::Free)
    }
}

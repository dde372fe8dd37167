//! What was planned for a scene, and the scene as rays meet it.

use enfilade_geometry::{Bvh, OccupancyTree, Voxel};
use enfilade_math::DVec3;
use enfilade_scene::{Camera, StartCamera, Trajectory, WorldMesh};

/// What was planned for a scene, and the scene as rays meet it.
pub struct Planned<'a> {
    /// Name of the scene in the dataset.
    pub scene: &'a str,
    /// Triangles of the scene.
    pub world: &'a WorldMesh,
    /// The hierarchy over them, all solid.
    pub bvh: &'a Bvh,
    /// Free space of the scene.
    pub tree: &'a OccupancyTree,
    /// Where carving and planning began.
    pub starts: &'a [StartCamera],
    /// The trajectories, and what each is filmed with.
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

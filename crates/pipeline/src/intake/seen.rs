//! An imported scene as it is looked at.

use enfilade_explore::{Findings, findings};
use enfilade_geometry::Bvh;
use enfilade_scene::{Scene, WorldMesh};

/// An imported scene as rays meet it, and what a look at it found.
pub(crate) struct Look {
    pub world: WorldMesh,
    pub bvh: Bvh,
    pub findings: Findings,
}

impl Look {
    /// Looks at a scene.
    pub fn at(scene: &Scene) -> Self {
        let world = WorldMesh::new(scene);
        let bvh = Bvh::new(&world.corners, &|_| true);
        let findings = findings(&world, &bvh);
        Self { world, bvh, findings }
    }
}

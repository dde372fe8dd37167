//! A scene as rays meet it.

use enfilade_geometry::Bvh;
use enfilade_scene::{Scene, WorldMesh};

/// A scene as rays meet it, all of it solid.
pub(crate) struct World {
    pub mesh: WorldMesh,
    pub bvh: Bvh,
}

impl World {
    /// The world of a scene at rest.
    pub fn of(scene: &Scene) -> Self {
        let mesh = WorldMesh::new(scene);
        let bvh = Bvh::new(&mesh.corners, &|_| false);
        Self { mesh, bvh }
    }
}

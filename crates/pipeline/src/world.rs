//! A scene as rays meet it.

use enfilade_geometry::Bvh;
use enfilade_scene::WorldMesh;

/// A scene as rays meet it, all of it solid.
pub(crate) struct World {
    pub mesh: WorldMesh,
    pub bvh: Bvh,
}

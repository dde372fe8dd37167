//! Boards and legs: the parts of which most wooden furniture is made.
//!
//! Their texture coordinates are metres with the grain along u, as [`crate::shape`] makes them.

use crate::shape::{Reshape, bevelled_box, lathe};
use enfilade_geometry::Mesh;
use enfilade_math::{Rng, Vec2, Vec3};

/// A bevelled board between two corners.
pub fn board(min: [f32; 3], max: [f32; 3], bevel: f32) -> Mesh {
    let (min, max) = (Vec3::from_array(min), Vec3::from_array(max));
    bevelled_box(max - min, bevel).moved(0.5 * (min + max))
}

/// Moves the grain of a board to a place of its own.
pub fn grained(mesh: Mesh, rng: &mut Rng) -> Mesh {
    mesh.uv_moved(Vec2::new(rng.range(0.0, 1.6), rng.range(0.0, 0.8)))
}

/// A round leg from the floor to `height`, its radii at the foot and at the top, whose foot is offset by `splay` from its top.
pub fn leg(height: f32, radii: [f32; 2], splay: Vec2) -> Mesh {
    let [foot, top] = radii;
    let rim = 0.25 * foot;
    let profile = [[0.0, 0.0], [foot - rim, 0.0], [foot, rim], [top, height], [0.0, height]].map(Vec2::from_array);
    lathe(&profile, 16).deformed(|p| p + (splay * (1.0 - p.z / height)).extend(0.0)).smoothed(40.0)
}

/// Cuts off what reaches below the floor: the slanting end of a leg.
pub fn standing(mut mesh: Mesh) -> Mesh {
    mesh.positions.iter_mut().for_each(|p| p.z = p.z.max(0.0));
    mesh
}

//! Level ceilings: plaster, bare concrete, or tiles of mineral fibre in a grid of white metal.

use crate::room::Room;
use crate::room::ceiling::GRID_BELOW;
use crate::room::kind::Ceiling;
use enfilade_furniture::shape::{Reshape, bevelled_box};
use enfilade_furniture::{Builder, CEILING_TILE_M, Finish, Object};
use enfilade_geometry::Mesh;
use enfilade_math::{Vec2, Vec3};

/// Width of the bars of a grid, metres.
const BAR: f32 = 0.024;
/// Height of the bars within the tiles, and how far they reach into walls, metres.
const WITHIN: f32 = 0.006;

/// Adds the ceiling of a room, whose slab is `sheet` in the space of `object`.
pub(super) fn add(b: &mut Builder, room: &Room, object: &Object, sheet: Mesh, sort: Ceiling) {
    match sort {
        Ceiling::Plaster => b.part(object, "plaster", sheet, Finish::CeilingPaint),
        Ceiling::Concrete => b.part(object, "slab", sheet, Finish::Concrete),
        Ceiling::Grid => {
            let uvs = sheet.positions.iter().map(|p| p.truncate()).collect();
            b.part(object, "tiles", Mesh { uvs, ..sheet }, Finish::MineralTile);
            b.part(object, "grid", grid(room), Finish::WhiteLacquer);
        }
    }
}

/// The bars of a grid, in the space of the ceiling.
fn grid(room: &Room) -> Mesh {
    let turn = Vec2::from_angle(-room.grain);
    let corners: Vec<Vec2> = room.outline.corners.iter().map(|p| turn.rotate(p.as_vec2() - room.box_center)).collect();
    let reach = corners.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    let count = (reach / CEILING_TILE_M) as i32 + 1;
    let z = room.size.z + 0.5 * (WITHIN - GRID_BELOW);
    let mut mesh = Mesh::default();
    for (axis, line) in [0, 1].into_iter().flat_map(|axis| (-count..=count).map(move |line| (axis, line))) {
        let at = CEILING_TILE_M * line as f32;
        for [low, high] in spans(&corners, axis, at) {
            let (length, middle) = (high - low + 2.0 * WITHIN, 0.5 * (low + high));
            // The bars of one direction are a little lower, so that no two faces lie in one plane.
            let drop = 0.0002 * axis as f32;
            let (size, place) = match axis {
                0 => (Vec3::new(BAR, length, WITHIN + GRID_BELOW), Vec3::new(at, middle, z)),
                _ => (Vec3::new(length, BAR, WITHIN + GRID_BELOW), Vec3::new(middle, at, z + drop)),
            };
            mesh = mesh.with(bevelled_box(size, 0.0008).moved(place));
        }
    }
    mesh
}

/// Where the line on which a coordinate has the value `at` is within a polygon.
fn spans(corners: &[Vec2], axis: usize, at: f32) -> Vec<[f32; 2]> {
    let other = 1 - axis;
    let mut cuts: Vec<f32> = (0..corners.len())
        .filter_map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            let t = (at - a[axis]) / (b[axis] - a[axis]);
            // A corner belongs to the edge that begins there.
            ((a[axis] <= at) != (b[axis] <= at)).then(|| a[other] + (b[other] - a[other]) * t)
        })
        .collect();
    cuts.sort_by(f32::total_cmp);
    cuts.chunks_exact(2).map(|pair| [pair[0], pair[1]]).filter(|[low, high]| high - low > BAR).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_the_grid_end_at_the_walls_around_a_corner() {
        let l = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]].map(Vec2::from);
        assert_eq!(spans(&l, 0, 0.6), [[0.0, 3.0]]);
        assert_eq!(spans(&l, 0, 2.4), [[0.0, 1.0]]);
        assert_eq!(spans(&l, 1, 1.8), [[0.0, 1.0]]);
        assert_eq!(spans(&l, 1, 4.2), [[0.0; 2]; 0]);
    }
}

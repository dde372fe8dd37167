//! The rooms of a scene that came without a plan, fitted to the surfaces that are labelled as walls, floors, ceilings, doors and windows.
//!
//! Storey by storey, seen from above: upright wall surfaces are gathered on straight lines (`lines.rs`), which cut the plan into convex cells
//! (`cells.rs`). A cell is inside where floor and ceiling cover it (`cover.rs`), and cells belong together unless there is wall on the edge
//! between them. What is left of the outlines is a polygon per room. Doors and windows are then assigned to the wall faces that they are in
//! (`openings.rs`), and how well all of that agrees with the surfaces is measured (`residual.rs`). The idea, cells of an arrangement of
//! wall lines joined where no wall is seen, is from Mura et al. 2014 ("Automatic room detection and reconstruction in cluttered indoor
//! environments with complex room layouts").

mod cells;
mod cover;
mod grid;
mod kinds;
mod lines;
mod openings;
mod outline;
mod plane_ids;
mod residual;
mod storeys;
mod surfaces;

pub use plane_ids::write_planes;
pub use surfaces::{LabelledTriangle, labelled_triangles};

use cells::Cells;
use cover::Cover;
use enfilade_math::DVec2;
use enfilade_scene::{RoomOutline, Rooms, WallFace};
use kinds::Kinds;
use lines::WallLine;
use openings::WALL_THICKNESS_M;
use outline::edges;
use storeys::Storey;

/// The rooms, walls, doors and windows of a scene, from its labelled surfaces; `None` where they enclose no room.
///
/// Walls are straight and upright, floors and ceilings level, rooms have one outline without holes. Passages that are wider than 1.3 m and
/// have no door make one room of two. How doors are hinged, and details of things beyond their class, are not found.
pub fn fit_rooms(triangles: &[LabelledTriangle]) -> Option<Rooms> {
    let mut rooms = Rooms::default();
    let mut kinds = Kinds::new(triangles);
    for storey in storeys::find(triangles) {
        add_rooms(&mut rooms, &storey, &mut kinds);
    }
    if rooms.outlines.is_empty() {
        return None;
    }
    tell_inner_walls(&mut rooms.walls);
    rooms.openings = openings::find(&rooms.walls, triangles);
    rooms.fit = Some(residual::of(&rooms, triangles));
    Some(rooms)
}

/// Adds the rooms of a storey, from left to right.
fn add_rooms(rooms: &mut Rooms, storey: &Storey<'_>, kinds: &mut Kinds) {
    let lines = WallLine::find(storey);
    let Some(cover) = Cover::new(storey) else { return };
    let cells = Cells::new(&lines, &cover);
    for outline in cells.rooms(&lines, &cover) {
        let ceiling_z_m = storey.ceiling_z_m(&outline);
        let polygon: Vec<[f64; 2]> = outline.iter().map(|corner| corner.to_array()).collect();
        let (kind, name) = kinds.of_room(&outline, [storey.floor_z_m, ceiling_z_m]);
        let room = RoomOutline { name, kind, polygon, floor_z_m: storey.floor_z_m, ceiling_z_m };
        let behind: Vec<(f64, bool)> = edges(&outline).map(|edge| (lines::thickness_behind(&lines, edge), true)).collect();
        rooms.push_room(room, &behind);
    }
}

/// Marks faces that have another room's face close behind them, back to back, as inner walls; the thickness is their distance.
fn tell_inner_walls(walls: &mut [WallFace]) {
    let faces = walls.to_vec();
    for wall in walls {
        let inward = DVec2::from(wall.inward);
        let behind = |other: &&WallFace| {
            let shared = [other.from, other.to].map(|p| wall.along_m(DVec2::from(p).extend(0.0)));
            let overlap = shared[0].max(shared[1]).min(wall.length_m()) - shared[0].min(shared[1]).max(0.0);
            other.room != wall.room && inward.dot(other.inward.into()) < -0.99 && overlap > 0.1 * wall.length_m()
        };
        let apart = |other: &WallFace| -wall.distance_m(DVec2::from(other.from).extend(0.0));
        let nearest = faces.iter().filter(behind).map(apart).filter(|&m| (0.0..=WALL_THICKNESS_M).contains(&m)).min_by(f64::total_cmp);
        if let Some(thickness_m) = nearest {
            (wall.thickness_m, wall.outer) = (thickness_m, false);
        }
    }
}

#[cfg(test)]
mod tests;

//! The shell of a room: walls with their openings, floor, ceiling, skirting.
//!
//! Each room has its own half of the walls between rooms, so that both faces of a wall can have their own finish; outer walls belong
//! to the room whole. The halves keep a hair's breadth apart; linings of doors and passages cover it.

mod boards;
mod ceiling;
mod clip;
mod finish;
mod measures;
mod polygon;
mod slopes;

pub use finish::ShellFinish;

use crate::room::{Filling, Room, Side, Wall};
use boards::planks;
use enfilade_furniture::shape::{Reshape, slab_with_openings};
use enfilade_furniture::{Builder, Class, Door, Finish, Passage, RoomKind, Window, board, family_of, pose};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use measures::{OVERLAP, SKIRTING, THIN_OVERLAP, UNDER_WALLS, depth, holes};

/// Families of the things that fill openings.
const OPENINGS: [&str; 3] = ["window", "door", "passage"];
/// Prefixes of names of parts that each room has once.
const SHEETS: [&str; 3] = ["floor_", "ceiling_", "skirting_"];
/// The walls of a room, as their names end.
const SIDES: [&str; 4] = ["south", "east", "north", "west"];

/// Adds walls, floor, ceiling, skirting, windows and doors of `room`; there is no skirting behind what is built in.
pub fn build(b: &mut Builder, room: &Room, finish: &ShellFinish, built_in: &[(Wall, [f32; 2])], rng: &mut Rng) {
    for wall in room.walls() {
        let side = Side::facing(room.inward(wall));
        let object = b.object(&format!("wall_{}_{}", room.kind.name(), side.name()), Class::Wall, room.wall_pose(wall));
        let surface = finish.accent.filter(|(w, _)| *w == wall).map_or(finish.walls, |(_, f)| f);
        let mesh = if room.rectangular { slab(room, side) } else { polygon::slab(room, wall) };
        b.part(&object, "plaster", mesh.uv_moved(Vec2::new(rng.range(0.0, 2.0), rng.range(0.0, 2.0))), surface);
    }
    if room.rectangular {
        floor_and_ceiling(b, room, finish, rng);
    } else {
        polygon::floor_and_ceiling(b, room, finish, rng);
    }
    if !room.kind.wet() {
        skirting(b, room, built_in);
    }
    for opening in &room.openings {
        match opening.filling {
            Filling::Window { sashes } => Window { sashes }.build(b, &room.wall_opening(opening)),
            Filling::Door(leaf) => Door { leaf }.build(b, &room.wall_opening(opening)),
            Filling::Passage { lined: true } => Passage.build(b, &room.wall_opening(opening)),
            Filling::Passage { lined: false } | Filling::DoorBack => {}
        }
    }
}

fn floor_and_ceiling(b: &mut Builder, room: &Room, finish: &ShellFinish, rng: &mut Rng) {
    let at = pose(f64::from(room.center.x), f64::from(room.center.y), 0.0, 0.0);
    let reach = |side: Side| depth(&room.face(side.wall()).backs[0]);
    let (low, high) = (Vec2::new(reach(Side::West), reach(Side::South)), Vec2::new(reach(Side::East), reach(Side::North)));
    let half = 0.5 * room.size.truncate();
    let sheet = |z0: f32, z1: f32| board([-half.x - low.x, -half.y - low.y, z0], [half.x + high.x, half.y + high.y, z1], 0.001);
    let ceiling = b.object(&format!("ceiling_{}", room.kind.name()), Class::Ceiling, at);
    ceiling::add(b, room, &ceiling, sheet(room.size.z, room.size.z + 0.2), finish.ceiling);
    let floor = b.object(&format!("floor_{}", room.kind.name()), Class::Floor, at);
    if finish.floor == Finish::PlankFloor {
        let half = half + UNDER_WALLS;
        b.part(&floor, "planks", planks([-half, half], rng).smoothed(20.0), finish.floor);
    } else {
        let u = half + UNDER_WALLS;
        b.part(&floor, "covering", board([-u.x, -u.y, -0.0195], [u.x, u.y, 0.0], 0.0005), finish.floor);
    }
    b.part(&floor, "screed", sheet(-0.3, -0.02), Finish::CeilingPaint);
}

/// True for objects of the shell: its pieces reach into each other, and carry everything else.
pub fn is_shell(object: &str) -> bool {
    is_shell_family(family_of(object))
}

/// True for the names of families that [`build`] makes: `wall_living_south`, `floor_hall`, `window`, but not `wall_lamp` or `window_seat`.
fn is_shell_family(family: &str) -> bool {
    let room = |name: &str| RoomKind::from_name(name).is_some();
    let wall = |name: &str| name.rsplit_once('_').is_some_and(|(kind, side)| room(kind) && SIDES.contains(&side));
    let piece = |of: &str| family.strip_prefix(of);
    OPENINGS.contains(&family) || piece("wall_").is_some_and(wall) || SHEETS.iter().any(|sheet| piece(sheet).is_some_and(room))
}

fn slab(room: &Room, side: Side) -> Mesh {
    let back = |side: Side| &room.face(side.wall()).backs[0];
    let corner = |other: Side| match (side.along().x == 0.0, back(other).outer) {
        (false, _) => depth(back(other)),
        (true, true) => OVERLAP,
        (true, false) => THIN_OVERLAP,
    };
    // A wall's x axis runs from the wall before it to the one after it, counter-clockwise.
    let (before, after) = (corner(side.turned(3)), corner(side.turned(1)));
    let shift = 0.5 * (after - before);
    let height = [-OVERLAP, room.size.z + OVERLAP];
    let holes = holes(room, side.wall(), shift);
    slab_with_openings(room.length(side.wall()) + before + after, height, depth(back(side)), &holes).moved(Vec3::new(shift, 0.0, 0.0))
}

fn skirting(b: &mut Builder, room: &Room, built_in: &[(Wall, [f32; 2])]) {
    let object = b.object(&format!("skirting_{}", room.kind.name()), Class::OtherStructure, DAffine3::IDENTITY);
    let mut counts = [0; 4];
    for wall in room.walls() {
        let side = Side::facing(room.inward(wall));
        let length = 0.5 * room.length(wall);
        let half = if !room.rectangular {
            polygon::beyond(room, wall).map(|beyond| length + beyond)
        } else if side.along().x == 0.0 {
            [length - (SKIRTING.x + 0.0005); 2]
        } else {
            [length; 2]
        };
        let mut ways: Vec<[f32; 2]> = room.ways().filter(|o| o.wall == wall).map(|o| [o.x[0] - 0.054, o.x[1] + 0.054]).collect();
        ways.extend(built_in.iter().filter(|(w, _)| *w == wall).map(|(_, x)| *x));
        ways.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut from = -half[0];
        let mut runs = Vec::new();
        for [low, high] in ways.into_iter().chain([[half[1], half[1]]]) {
            runs.push([from, low]);
            from = from.max(high);
        }
        for run in runs.iter().filter(|r| r[1] - r[0] > 0.02) {
            counts[side as usize] += 1;
            let mesh = board([run[0], -0.002, -0.002], [run[1], SKIRTING.x, SKIRTING.y], 0.004);
            b.part_at(&object, &format!("{}_{}", side.name(), counts[side as usize]), mesh, room.wall_pose(wall), Finish::WhitePaint);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::is_shell_family;

    #[test]
    fn the_shell_is_told_by_whole_names() {
        let shell = ["wall_living_south", "floor_hall", "ceiling_childrens", "skirting_study", "window", "door", "passage"];
        let other = ["wall_lamp", "wall_shelf", "wall_clock", "floor_lamp", "floor_cushion", "ceiling_lamp", "door_mat", "window_seat"];
        assert!(shell.iter().all(|family| is_shell_family(family)));
        assert!(!other.iter().any(|family| is_shell_family(family)));
    }
}

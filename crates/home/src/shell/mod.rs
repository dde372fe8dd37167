//! The shell of a room: walls with their openings, floor, ceiling, skirting.
//!
//! Each room has its own half of the walls between rooms, so that both faces of a wall can have their own finish; outer walls belong
//! to the room whole. The halves keep a hair's breadth apart; linings of doors and passages cover it.

mod polygon;

use crate::room::{Back, Filling, Room, Side, Wall};
use enfilade_furniture::shape::{Reshape, slab_with_openings};
use enfilade_furniture::{Builder, Class, Door, Finish, Passage, RoomKind, Window, board, family_of, pose};
use enfilade_geometry::Mesh;
use enfilade_math::{DAffine3, Rng, Vec2, Vec3};
use enfilade_textures::FLOOR_STRIPS;

/// Overlap of floor, walls and ceiling, metres, so that no light comes through the joints.
const OVERLAP: f32 = 0.1;
/// The overlap at walls between rooms, which are thin.
const THIN_OVERLAP: f32 = 0.03;
/// Half the air between the two halves of a wall.
const AIR: f32 = 0.0005;
/// Overlap of floor coverings and walls, metres.
const UNDER_WALLS: f32 = 0.04;
/// Thickness and height of skirting boards, metres.
const SKIRTING: Vec2 = Vec2::new(0.014, 0.085);

/// Families of the things that fill openings.
const OPENINGS: [&str; 3] = ["window", "door", "passage"];
/// Prefixes of names of parts that each room has once.
const SHEETS: [&str; 3] = ["floor_", "ceiling_", "skirting_"];
/// The walls of a room, as their names end.
const SIDES: [&str; 4] = ["south", "east", "north", "west"];

/// The finishes of the surfaces of a room's shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellFinish {
    /// Walls.
    pub walls: Finish,
    /// One wall may differ.
    pub accent: Option<(Wall, Finish)>,
    /// Planks are laid as single boards; any other finish covers the floor as one sheet.
    pub floor: Finish,
}

impl ShellFinish {
    /// The usual finish of a kind of room. `shape` decides what changes meshes: whether the floor is laid of boards. `look` decides the
    /// covering of a floor without boards, and the finish of the accent wall.
    pub fn usual(kind: RoomKind, accent: Option<Wall>, shape: &mut Rng, look: &mut Rng) -> Self {
        use RoomKind::{Hall, Kitchen, Laundry};
        let boards = match kind {
            Kitchen => 0.4,
            Hall => 0.5,
            _ if kind.wet() => 0.0,
            _ => 0.65,
        };
        let boards = shape.next_f32() < boards;
        let coverings: &[Finish] = match kind {
            Kitchen | Hall => &[Finish::FloorTile, Finish::FloorTile, Finish::Terrazzo, Finish::Concrete, Finish::ParquetFloor],
            Laundry => &[Finish::FloorTile, Finish::Concrete],
            _ if kind.wet() => &[Finish::FloorTile, Finish::FloorTile, Finish::FloorTile, Finish::Terrazzo, Finish::Concrete],
            RoomKind::Bedroom | RoomKind::Children => &[Finish::Carpet, Finish::ParquetFloor],
            _ => &[Finish::ParquetFloor, Finish::ParquetFloor, Finish::Concrete],
        };
        let floor = if boards { Finish::PlankFloor } else { coverings[look.below(coverings.len())] };
        let walls = if kind == RoomKind::Bathroom { Finish::WallTile } else { Finish::WallPaint };
        let colored = match kind {
            RoomKind::Living | RoomKind::Bedroom | RoomKind::Children => 1.0,
            RoomKind::Dining | RoomKind::Study | Hall => 0.5,
            _ => 0.0,
        };
        let accents = [Finish::AccentWallPaint, Finish::AccentWallPaint, Finish::AccentWallPaint, Finish::Wallpaper, Finish::Plaster];
        let done = if look.next_f32() < 0.04 { Finish::Brick } else { accents[look.below(accents.len())] };
        Self { walls, accent: accent.filter(|_| look.next_f32() < colored).map(|wall| (wall, done)), floor }
    }
}

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
    b.part(&ceiling, "plaster", sheet(room.size.z, room.size.z + 0.2), Finish::CeilingPaint);
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

/// Depth of the part of a piece of wall that belongs to the room, metres.
fn depth(back: &Back) -> f32 {
    if back.outer { back.thickness } else { 0.5 * back.thickness - AIR }
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

/// The openings of a wall, measured from the point `middle` of its x axis.
fn holes(room: &Room, wall: Wall, middle: f32) -> Vec<[f32; 4]> {
    let of_wall = room.openings.iter().filter(|o| o.wall == wall);
    of_wall.map(|o| [o.x[0] - middle, o.x[1] - middle, if o.z[0] <= 0.0 { -OVERLAP } else { o.z[0] }, o.z[1]]).collect()
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

/// Floorboards along x over a rectangle, laid in staggered rows with bevelled joints; without normals.
fn planks([low, high]: [Vec2; 2], rng: &mut Rng) -> Mesh {
    /// Width of a board, metres.
    const WIDTH: f32 = 0.165;
    /// Width and depth of the bevel along its edges, metres.
    const BEVEL: Vec2 = Vec2::new(0.0016, 0.0012);
    let mut mesh = Mesh::default();
    let mut y = low.y;
    while y < high.y {
        let y1 = (y + WIDTH).min(high.y);
        let mut x = low.x;
        let mut length = rng.range(0.5, 1.8);
        while x < high.x {
            let x1 = if high.x - x - length < 0.35 { high.x } else { x + length };
            let strip = (rng.below(FLOOR_STRIPS) as f32 + 0.03) / FLOOR_STRIPS as f32;
            let start = Vec2::new(rng.range(0.0, 2.0 - (x1 - x).min(1.99)), strip);
            plank(&mut mesh, [x, x1], [y, y1], BEVEL, start, rng.below(2) == 0);
            x = x1;
            length = rng.range(1.1, 1.6);
        }
        y = y1;
    }
    mesh
}

/// One floorboard with its top at z = 0: a raised field inside four bevels that go down to the joints.
fn plank(mesh: &mut Mesh, x: [f32; 2], y: [f32; 2], bevel: Vec2, uv: Vec2, turned: bool) {
    let base = mesh.positions.len() as u32;
    for (inset, z) in [(0.0, -bevel.y), (bevel.x, 0.0)] {
        for (cx, cy) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let shift = |c: usize| if c == 0 { inset } else { -inset };
            let p = Vec3::new(x[cx] + shift(cx), y[cy] + shift(cy), z);
            mesh.positions.push(p);
            let q = Vec2::new(p.x - x[0], p.y - y[0]);
            let q = if turned { Vec2::new(x[1] - x[0], y[1] - y[0]) - q } else { q };
            mesh.uvs.push(uv + Vec2::new(q.x, q.y * 0.7));
        }
    }
    let mut quad = |a: u32, b: u32, c: u32, d: u32| {
        mesh.triangles.extend([[base + a, base + b, base + c], [base + a, base + c, base + d]]);
    };
    quad(4, 5, 6, 7);
    (0..4).for_each(|k| quad(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k));
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

//! The finishes of a room's shell.

use crate::room::Wall;
use enfilade_furniture::{Finish, RoomKind};
use enfilade_math::Rng;

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

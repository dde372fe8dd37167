//! The finishes of a room's shell.

use crate::room::Wall;
use crate::room::kind::{self, Ceiling};
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
    /// The ceiling, where it is level.
    pub ceiling: Ceiling,
}

impl ShellFinish {
    /// The usual finish of a kind of room. `shape` decides what changes meshes: whether the floor is laid of boards. `look` decides the
    /// covering of a floor without boards, and the finish of the accent wall.
    pub fn usual(kind: RoomKind, accent: Option<Wall>, shape: &mut Rng, look: &mut Rng) -> Self {
        let shell = &kind::row(kind).shell;
        let boards = shape.next_f32() < shell.boards;
        let floor = if boards { Finish::PlankFloor } else { shell.coverings[look.below(shell.coverings.len())] };
        let accents = [Finish::AccentWallPaint, Finish::AccentWallPaint, Finish::AccentWallPaint, Finish::Wallpaper, Finish::Plaster];
        let done = if look.next_f32() < 0.04 { Finish::Brick } else { accents[look.below(accents.len())] };
        Self {
            walls: shell.walls,
            accent: accent.filter(|_| look.next_f32() < shell.accent).map(|wall| (wall, done)),
            floor,
            ceiling: shell.ceiling,
        }
    }
}

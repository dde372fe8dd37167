//! Further things of a living room: corner sofas, chesterfields and day beds, poufs, shelves, fireplaces and stoves, blinds, lamps on
//! ceiling and wall, clocks, and music.

mod blind;
mod ceiling_lamp;
mod chesterfield;
mod clock;
mod corner_sofa;
mod day_bed;
mod hearth;
mod music;
mod pouf;
mod shelf;
mod wall_lamp;

pub use blind::{Blind, BlindKind};
pub use ceiling_lamp::CeilingLamp;
pub use chesterfield::Chesterfield;
pub use clock::WallClock;
pub use corner_sofa::CornerSofa;
pub use day_bed::DayBed;
pub use hearth::{Fireplace, Stove};
pub use music::{GameConsole, RecordPlayer, Speaker};
pub use pouf::{FloorCushion, Pouf};
pub use shelf::{CubeShelf, WallShelf};
pub use wall_lamp::WallLamp;

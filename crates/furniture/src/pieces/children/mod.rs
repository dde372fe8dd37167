//! A child's room: cots, low tables, chairs and chests, toys, plush animals, globes and instruments.

mod crib;
mod globe;
mod instrument;
mod play_table;
mod plush;
mod toy;
mod toy_chest;

pub use crib::Crib;
pub use globe::Globe;
pub use instrument::{Guitar, MusicKeyboard};
pub use play_table::{PlayTable, ToyChair};
pub use plush::PlushBear;
pub use toy::Toy;
pub use toy_chest::ToyChest;

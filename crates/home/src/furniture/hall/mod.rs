//! Where people come in.

mod bags;
mod boxes;
mod coats;
mod console;
mod shoes;

pub use bags::{Backpack, Handbag, ShoppingBag, Suitcase};
pub use boxes::{CardboardBox, StorageBox};
pub use coats::{CoatHooks, CoatStand, UmbrellaStand};
pub use console::{Console, KeyBoard, TallMirror};
pub use shoes::{ShoeCabinet, Shoes};

//! The hall: coat hooks and stands with coats, shoes and their cabinet, bags, boxes, consoles, tall mirrors and boards for keys.

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

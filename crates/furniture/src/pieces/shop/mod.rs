//! Shops, cafés and libraries: shelving with goods and books, counters and what is on them, rails, tables.

mod counter;
mod fixture;
mod gondola;
mod goods;

pub use counter::{CakeCase, Counter, EspressoMachine, Till};
pub use fixture::{BistroTable, BottleFridge, ClothesRail, DisplayTable};
pub use gondola::{BookAisle, Gondola};

//! The things that stand, hang and lie in a home: one file per family, or a folder for the families of one kind of room.
//!
//! A piece of furniture lives in its own space: the middle of its footprint on the floor is the origin, x is to the right,
//! y to the front, z up.

mod armchair;
pub mod bathroom;
pub mod bedroom;
mod boards;
mod book;
mod bookshelf;
mod catalogue;
#[cfg(test)]
mod catalogue_tests;
mod ceiling_dome;
mod chair;
pub mod children;
pub mod clutter;
mod coffee_table;
mod curtain;
pub mod dining;
mod dining_table;
mod door;
mod electric;
mod foliage;
pub mod form;
pub mod gym;
pub mod hall;
pub mod joinery;
#[cfg(test)]
mod joint_tests;
pub mod kitchen;
mod lamp;
pub mod laundry;
pub mod left;
pub mod living;
mod low_table;
pub mod office;
mod opening;
mod ornament;
mod piece;
#[cfg(test)]
mod piece_tests;
mod plant;
mod radiator;
mod rug;
pub mod school;
mod seating;
pub mod shop;
mod side_table;
mod sofa;
pub mod soft;
pub mod store;
pub mod study;
mod style;
#[cfg(test)]
mod style_tests;
#[cfg(test)]
mod surface_tests;
pub mod tableware;
mod television;
mod wall_art;
mod window;

pub use crate::surface::{CONTACT, Surface, on};
pub use armchair::Armchair;
pub use boards::{board, grained, leg, standing};
pub use bookshelf::Bookshelf;
pub use catalogue::{FAMILIES, Family, Place, family_named};
pub use ceiling_dome::CeilingDome;
pub use chair::Chair;
pub use coffee_table::CoffeeTable;
pub use curtain::Curtains;
pub use dining_table::DiningTable;
pub use door::{Door, Leaf, Passage};
pub use electric::{Socket, Switch};
pub use foliage::{FlowerVase, Foliage, HangingPlant};
pub use lamp::{FloorLamp, Pendant, TableLamp};
pub use opening::WallOpening;
pub use ornament::{Basket, BookStack, Bowl, Candles, Magazines, Mug, Tray, Vase};
pub use piece::Furniture;
pub use plant::Plant;
pub use radiator::Radiator;
pub use rug::Rug;
pub use side_table::SideTable;
pub use sofa::Sofa;
pub use television::{TelevisionBench, TelevisionSet};
pub use wall_art::{Mirror, PictureOnWall};
pub use window::Window;

//! The bedroom: beds and their bedding, nightstands, chests of drawers, wardrobes, dressing tables, benches, and clothes on hangers or
//! folded.

mod bed;
mod bed_frame;
mod bedding;
mod bunk;
mod clothes;
mod drawers;
mod dressing;
mod frames;
mod garment;
mod upholstered;
mod wardrobe;
mod wooden;

pub use bed_frame::Bed;
pub use clothes::{FoldedClothes, hang_garment};
pub use drawers::{Dresser, Nightstand};
pub use dressing::{Bench, DressingTable, LaundryBasket};
pub use garment::Garment;
pub use wardrobe::Wardrobe;

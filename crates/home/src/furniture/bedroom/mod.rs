//! The bedroom: beds and their bedding, nightstands, chests of drawers, wardrobes, dressing tables, benches, and clothes on hangers or
//! folded.

mod bed;
mod bedding;
mod clothes;
mod drawers;
mod dressing;
mod garment;
mod wardrobe;

pub use bed::{Bed, BedFrame};
pub use bedding::{Bedding, Cover};
pub use clothes::{FoldedClothes, hang_garment, heap};
pub use drawers::{DrawerBody, Dresser, Nightstand};
pub use dressing::{Bench, DressingTable, LaundryBasket};
pub use garment::Garment;
pub use wardrobe::{Wardrobe, WardrobeDoors};

//! Things in a kitchen and on a laid table: crockery, glasses, pots, provisions, small machines.

mod cookware;
mod crockery;
mod cutlery;
mod glass;
mod household;
mod machine;
mod pantry;
mod produce;

pub use cookware::{Cookware, CuttingBoard, KnifeBlock, UtensilJar};
pub(super) use crockery::plate;
pub use crockery::{Crockery, shelf_of_crockery};
pub use cutlery::{Piece, PlaceSetting};
pub use glass::Drinkware;
pub use household::{KitchenRoll, WasteBin};
pub use machine::KitchenMachine;
pub use pantry::{Bottle, Jar, SpiceRack};
pub use produce::{Bread, FruitBowl, HerbPot};

//! What people leave lying about: books, devices, baskets, cloths, games, ornaments.

mod books;
mod cable;
mod decor;
mod device;
mod soft;

pub use books::{BookRow, MagazineRack, OpenBook};
pub use cable::Cable;
pub use decor::{BoardGame, Figurine, PhotoFrame, PillarCandles, StorageBasket, TissueBox};
pub use device::{Phone, RemoteControl, Tablet};
pub use soft::{FoldedBlanket, ScatterCushion};

use super::{Bowl, Candles, FlowerVase, Furniture, Plant, Vase};
use enfilade_math::Rng;

/// Something to look at that is at most `headroom` high.
pub fn decoration(headroom: f32, rng: &mut Rng) -> Box<dyn Furniture> {
    loop {
        let thing: Box<dyn Furniture> = match rng.below(9) {
            0 => Box::new(Vase { height: rng.range(0.14, 0.26), belly: rng.range(0.05, 0.075), branches: 0 }),
            1 => Box::new(Bowl { radius: rng.range(0.07, 0.1) }),
            2 => Box::new(Plant::small(rng.range(0.08, 0.11), rng.range(0.045, 0.055))),
            3 => Box::new(Candles { count: 1 + rng.below(2) }),
            4 => Box::new(PhotoFrame::random(rng)),
            5 => Box::new(Figurine::random(rng)),
            6 => Box::new(PillarCandles::random(rng)),
            7 => Box::new(StorageBasket::random(rng)),
            _ => Box::new(FlowerVase::random(rng)),
        };
        if thing.size().z < headroom {
            return thing;
        }
    }
}

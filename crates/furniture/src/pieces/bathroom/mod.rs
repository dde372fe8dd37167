//! The bathroom: tubs, showers, washbasins and toilets with their fittings, mirror cabinets, towels, mats and small things.

mod bathtub;
mod ceramic;
mod linen;
mod mirror_cabinet;
mod small;
pub(crate) mod tap;
mod toilet;
mod washbasin;

pub use bathtub::{Bathtub, Shower};
pub use linen::{BathMat, FoldedTowels, TowelRadiator, TowelRail, TowelShelf};
pub use mirror_cabinet::MirrorCabinet;
pub use small::{PaperHolder, PedalBin, SoapDispenser, ToiletBrush, Toiletries, ToothbrushMug};
pub use toilet::Toilet;
pub use washbasin::Washbasin;

//! What is made of a dataset on request, beside the outputs of its stages: one table, and one rule for what is out of date.
//!
//! A product consists of parts, each with files of its own: one for the dataset, for a scene, a camera or a frame. A record in the work
//! folder, `.enfilade/SCENE/products/NAME.json` (of the dataset as a whole `.enfilade/.products/NAME.json`), keeps what was asked for and,
//! of each part, a key of everything that it was made from. A part is fresh as long as that key is the same and its files are there in full
//! length. What is stale stays on disk; `verify` does not judge it; [`make_stale`] and every run make it again, as it was asked for.

mod adopt;
mod choice;
mod flow;
mod make;
mod options;
mod pairs;
mod product;
mod record;
mod relit;
mod request;
mod rooms;
mod sensors;
mod sources;
mod stale;
mod surfaces;
mod table;
#[cfg(test)]
mod tests;
mod tracks;
mod whole;
mod words;

pub(crate) use adopt::adopt;
pub use choice::FrameChoice;
pub use flow::FlowPairs;
pub use make::{Made, MakeOptions, make, make_stale};
pub(crate) use make::{bring_up_to_date, try_out};
pub(crate) use options::SURFACES;
pub use options::{ProductOptions, make_products};
pub use pairs::{PairsRequest, choose_pairs_of};
pub use product::Product;
pub(crate) use record::Place;
pub(crate) use relit::mixes_for_later;
pub use relit::{MixRequest, read_mixes};
pub use request::Request;
pub use stale::{OutOfDate, out_of_date};
pub(crate) use stale::{not_judged, told_out_of_date};
pub use table::{PRODUCTS, ProductSpec, Scope, When};
pub use whole::write_statistics;
pub(crate) use whole::{Pictures, pictures, update_sheet, update_statistics};

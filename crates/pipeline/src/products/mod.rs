//! Products of a dataset that are made on request, beside the outputs of its stages: one table, and one rule for what is out of date.
//!
//! A product consists of parts with separate files: one for the dataset, for a scene, a camera or a frame. A record in the work folder,
//! `.enfilade/SCENE/products/NAME.json` (for the dataset as a whole `.enfilade/.products/NAME.json`), has the requests and, for each part,
//! a key of everything that it was made from. A part is fresh as long as that key is the same and its files exist in full length. Stale
//! parts stay on disk; `verify` does not judge them; [`make_stale`] and every run make them again, as requested.

mod adopt;
mod always;
mod flow;
mod lists;
mod make;
mod options;
mod pairs;
mod record;
mod relit;
mod rooms;
mod sensors;
mod sources;
mod stale;
mod surfaces;
mod table;
#[cfg(test)]
mod tests;
mod tracks;
mod update;
mod whole;
mod words;

pub(crate) use adopt::adopt;
pub use always::write_statistics;
pub(crate) use always::{Pictures, pictures, update_sheet, update_statistics};
pub(crate) use make::{bring_up_to_date, try_out};
pub use make::{choose_pairs_of, make, make_stale};
pub use options::make_products;
pub(crate) use record::Place;
pub use relit::read_mixes;
pub use stale::{OutOfDate, out_of_date};
pub(crate) use stale::{not_judged, told_out_of_date};
pub use table::{PRODUCTS, ProductSpec, When};
pub use update::{Made, MakeOptions};

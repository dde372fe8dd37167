//! Requests for products: their names, options and frames. Requests are plain data in configurations and records.

mod choice;
mod options;
mod product;
mod requests;

pub use choice::FrameChoice;
pub(crate) use options::ProductKeys;
pub use options::ProductOptions;
pub use product::{Product, Scope};
pub use requests::{FlowPairs, MixRequest, PairsRequest, Request};

//! What somebody asks of products: their names, options and frames. Requests are plain data, which configurations and records hold.

mod choice;
mod limits;
mod product;
mod requests;

pub use choice::FrameChoice;
pub(crate) use limits::{MOST_SURFACES, SURFACES, checked};
pub use product::{Product, Scope};
pub use requests::{FlowPairs, MixRequest, PairsRequest, Request};

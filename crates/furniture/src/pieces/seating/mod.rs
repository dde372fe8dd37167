//! Upholstered seats and seats with an open frame, from which sofas and easy chairs are made: one table of styles for each. The sitter looks
//! to +y.

mod arms;
mod back;
mod bentwood;
mod chaise;
mod feet;
mod frame;
mod loose;
mod quilt;
mod rods;
mod styles;
mod upholstered;

pub use bentwood::BentwoodChair;
pub use chaise::ChaiseLongue;
pub use feet::skirt;
pub use frame::OpenFrame;
pub use loose::LooseSofa;
pub use quilt::{buttoned, upright};
pub use rods::RodChair;
pub use styles::{EASY_CHAIRS, EASY_FRAMES, SOFA_FRAMES, SOFAS};
pub use upholstered::Upholstered;

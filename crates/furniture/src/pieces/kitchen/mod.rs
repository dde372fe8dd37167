//! Fitted kitchens: units on a grid of 60 cm, their worktop, and the appliances built into them.
//!
//! Sizes follow EN 1116 (coordinating sizes for kitchen furniture and appliances): units 600 mm deep in widths of a few hundred
//! millimetres, worktops 900 mm high, at least 500 mm free below wall units and 650 mm between a hob and its hood.

mod appliance;
mod fitted;
mod front;
mod island;
mod refrigerator;
mod run;
mod sink;
mod unit;

pub use fitted::FittedKitchen;
pub use front::{Handle, KitchenStyle};
pub use island::{Fixture, KitchenIsland};
pub use refrigerator::Refrigerator;
pub use run::{Above, Run};
pub use unit::Unit;

/// Depth of the worktop, metres.
pub const DEPTH: f32 = 0.60;
/// How far handles protrude beyond the worktop's front edge, metres.
const HANDLES: f32 = 0.03;
/// Height of the worktop's surface, metres.
pub const WORKTOP: f32 = 0.91;
/// Thickness of the worktop, metres.
const THICKNESS: f32 = 0.038;
/// Height of the plinth, and the distance by which it is set back for the toes, metres.
const PLINTH: [f32; 2] = [0.13, 0.055];
/// Depth of a unit's box, without its front, metres.
const BOX: f32 = 0.555;
/// Lower and upper edge of wall units, metres: 54 cm are free above the worktop.
const WALL_UNIT: [f32; 2] = [1.45, 2.17];
/// Depth of wall units with their fronts, metres.
const WALL_DEPTH: f32 = 0.36;
/// Upper edge of tall units, metres: the same as for wall units.
pub const TALL: f32 = 2.17;

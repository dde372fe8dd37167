//! Storerooms and workshops: racks with boxes, a bench with tools, a ladder.

mod rack;
mod workshop;

pub use rack::SteelRack;
pub use workshop::{StepLadder, ToolBoard, Workbench};

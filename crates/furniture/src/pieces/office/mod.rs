//! Offices and what public buildings share: lights of their ceilings, cabinets, tables for meetings, displays, machines, signs.

mod cabinet;
mod ceiling_panel;
mod conference_table;
mod display;
mod machine;
mod partition;
mod safety;
mod tube_lamp;

pub use cabinet::OfficeCabinet;
pub use ceiling_panel::CeilingPanel;
pub use conference_table::ConferenceTable;
pub use display::{ProjectionScreen, Projector, WallDisplay};
pub use machine::{ComputerCase, Copier, WaterDispenser};
pub use partition::Partition;
pub use safety::{ExitSign, Extinguisher};
pub use tube_lamp::{Around, TubeLamp};

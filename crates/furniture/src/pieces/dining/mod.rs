//! The dining room: long tables, chairs, stools and benches, sideboards and glass cabinets.

mod bench;
mod chairs;
mod glass_cabinet;
mod long_kind;
mod long_table;
mod sideboard;
mod stand;
mod stool;

pub use bench::DiningBench;
pub use chairs::{ShellChair, SpindleChair, UpholsteredChair};
pub use glass_cabinet::GlassCabinet;
pub use long_kind::LongTable;
pub use sideboard::Sideboard;
pub use stool::BarStool;

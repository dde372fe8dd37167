//! The study: desks, office chairs, computers and the small things around them.

mod computer;
mod desk;
mod desk_lamp;
mod office_chair;
mod stationery;
mod storage;
mod wall_board;

pub use computer::{Keyboard, Laptop, Monitor, Mouse, Printer};
pub use desk::{Computer, Desk, DeskStand};
pub use desk_lamp::DeskLamp;
pub use office_chair::OfficeChair;
pub use stationery::{PaperStack, PenCup};
pub use storage::FilingCabinet;
pub use wall_board::WallBoard;

//! Schools: chairs and tables of classrooms, boards to write on, lockers.

mod class_board;
mod locker;
mod stacking_chair;
mod student_desk;

pub use class_board::{BoardSheet, ClassBoard};
pub use locker::Lockers;
pub use stacking_chair::StackingChair;
pub use student_desk::StudentDesk;

//! Labels: from a table that people write to the class of every part, and from there to label images and boxes.
//!
//! Labels never enter the renderer. A [`LabelTable`] assigns classes to the parts or materials of a scene;
//! [`LabelTable::assign`] applies it to the parts of a scene; [`join`] turns entity ids into label images. Changing the table
//! therefore costs a join, not a rendering. If people cut parts into pieces, [`Pieces`] determines the piece that a pixel shows.
//! [`annotation`] has what people labelled. [`rooms`] finds rooms in what is labelled as walls, floors and ceilings.

pub mod annotation;
mod assign;
pub mod boxes;
mod doubts;
pub mod instances;
mod join;
mod pieces;
pub mod rooms;
mod rows;
mod table;

pub use assign::{LabelReport, UnlabelledPart, UnmatchedRow};
pub use doubts::{Doubts, doubts};
pub use join::{JoinError, join};
pub use pieces::Pieces;
pub use table::{LabelTable, Row, Subject, TableError, class_name, write_part_table, write_table};

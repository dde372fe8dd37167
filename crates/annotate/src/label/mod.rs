//! Labelling the parts of a scene.
//!
//! [`App::open`] loads a scene, [`routes`] answers its page. A part can be split, so what is labelled is called a piece. The way of an
//! edit: a page sends an [`action`](self), which is decided (rays say what is visible, filters and expansion what is selected) into an
//! edit that says everything, which is appended to the log, brought to the disk, done, and announced to every page. So the state is what
//! the log says, whatever happens to the page or the program; Hypersim's files are written from it shortly after.

mod action;
mod app;
mod camera;
mod change;
mod clock;
mod events;
pub(crate) mod geometry;
mod log;
mod pieces;
mod progress;
mod routes;
mod save;
mod selection;
mod session;
mod shape;
mod source;
mod split;
mod stroke;
mod suggestions;
mod worklog;

pub use app::{AnnotateOptions, App, OpenError};
pub use routes::routes;

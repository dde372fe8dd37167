//! The page on which people label the parts of a scene.
//!
//! [`App::open`] loads a scene, [`routes`] answers its page. What is labelled is called a piece: a part of the scene, or a piece of a part
//! that was split.
//!
//! An edit is made as follows. A page sends an action (`action.rs`). Rays find the visible faces, filters and expansion find the selected
//! pieces, and the action becomes an edit that needs no further decision (`enfilade_label::annotation`). The edit is appended to the log
//! and flushed to disk (`log.rs`), applied to the pieces (`session.rs`), and announced to every page (`events.rs`). The log alone
//! determines the state, whatever happens to the page or the program. The label stage makes the tables of a dataset's scene from it; other
//! tables are written shortly after (`save.rs`). Reviews of pieces are not labels and have a separate log (`review.rs`).

mod action;
mod again;
mod answer;
mod app;
mod author;
mod camera;
mod carry;
mod change;
mod clock;
mod congruence;
mod earlier;
mod events;
mod face_colors;
mod json_lines;
mod log;
mod options;
mod part_shapes;
mod pieces;
mod planned;
mod progress;
mod review;
mod routes;
mod save;
mod scene;
mod scene_error;
mod selection;
mod session;
mod shape;
mod split;
mod stroke;
mod suggestions;
mod surfaces;
mod unsplit;
mod viewpoint;
mod without_log;
mod worklog;

pub use app::{App, OpenError};
pub use options::AnnotateOptions;
pub use routes::routes;

use enfilade_serve::Page;

/// The page, to serve beside its [`routes`].
pub const PAGE: Page = Page::new::<Files>("/annotate/");

#[derive(rust_embed::RustEmbed)]
#[folder = "web"]
struct Files;

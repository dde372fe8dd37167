//! The page on which people look at a dataset: its contents as JSON, its layers as raw arrays, its space as points and cubes.
//!
//! Everything is read at the moment of the request, so a dataset that is still being rendered can be watched. Nothing is ever
//! written. Layers are sent to the page as stored and are coloured there, on the graphics card: only the page knows names and colours of
//! values, and changing the exposure needs no request.
//!
//! Names in addresses are checked before they become paths (`place.rs`), and a path that leads out of the dataset's folder by a symbolic
//! link is refused (`access.rs`).

mod access;
mod cache;
mod camera;
mod catalogue;
mod class_shares;
mod classes;
mod decoded_layer;
mod derived;
mod derived_files;
#[cfg(test)]
mod derived_tests;
mod described;
mod faults;
mod files;
mod frame;
mod gallery;
mod layers;
mod mesh;
mod pairs;
mod pairs_of_scene;
mod picture;
mod picture_spec;
mod place;
mod points;
mod problems;
mod report;
mod routes;
mod scene;
mod shares;
mod space;
mod stored_picture;
mod summary;
#[cfg(test)]
mod tests;
mod thumbnail;
mod tone_mapped;
mod tracks;
mod viewer;

pub use routes::router;
pub use viewer::Viewer;

use enfilade_serve::Page;

/// The page, to serve beside its [`routes`](router()).
pub const PAGE: Page = Page::new::<Files>("/view/");

#[derive(rust_embed::RustEmbed)]
#[folder = "web"]
struct Files;

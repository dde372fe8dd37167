//! Labelling scenes through the routes, as the page does.

mod editing;
mod keeping;
mod people;
mod relabel;
mod requests;
mod room;

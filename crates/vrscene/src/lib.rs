//! V-Ray's scene description, the text of `.vrscene` files, as a document that is read, edited and written without loss.
//!
//! A file is a sequence of plugins, `#include` and `#time` lines, and the text between them. [`Document::parse`] finds where each begins
//! and ends and keeps the bytes; unedited parts are written back byte for byte, including unknown plugins and comments. The value of a
//! parameter is decoded on request ([`Parameter::value`]), so that a file with hundreds of megabytes of packed meshes opens in the time of
//! one pass over its bytes.
//!
//! ```text
//! #include "materials.vrscene"
//! Node chair@node_1 {
//!   transform=TransformHex("0000803F…");
//!   geometry=mesh_1;                                    // the name of another plugin
//!   visible=interpolate((0, 1), (10, 0));               // keyframes: (frame, value)
//! }
//! ```
//!
//! Text is bytes: exporters write names and paths in the encoding of their machine.

mod document;
mod error;
mod includes;
mod packed;
mod plugin;
mod scan;
mod transform;
mod value;
mod write;

pub use document::{Document, Include, Item, Time};
pub use error::{Place, SceneTextError};
pub use includes::{IncludeError, add_include, inline_includes};
pub use plugin::{Parameter, Plugin};
pub use transform::{Matrix, Transform, Vector};
pub use value::Value;

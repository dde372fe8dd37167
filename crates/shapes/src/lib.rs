//! 3D shape prediction, the task of Mesh R-CNN (Gkioxari et al., ICCV 2019) on Pix3D (Sun et al., CVPR 2018): the layout of its files,
//! and its metrics.
//!
//! Camera space is Pix3D's and PyTorch3D's: x left, y up, z forward. A model's vertices v are at R v + t in camera space, and a point there
//! is projected to (w/2 − f x/z, h/2 − f y/z), counted from the upper left corner of the image. Nothing in the task depends on the unit of
//! length.
//!
//! [`Document`] is the JSON that Mesh R-CNN reads; [`ingest_pix3d`] makes it from Pix3D as it is published. [`Voxels`] are its `.mat`
//! files. [`compare`] and [`judge`] follow Mesh R-CNN's evaluation.

mod average_precision;
mod classes;
mod error;
mod ingest;
mod judge;
mod kdtree;
mod layout;
mod mat;
mod surface;
mod voxelize;
mod voxels;

pub use average_precision::{Precision, average_precision, summarize};
pub use classes::{CATEGORIES, category_from_nyu40, category_id};
pub use error::ShapesError;
pub use ingest::{Ingested, MISMATCHED, ingest_pix3d};
pub use judge::{Found, Judged, Mask, Rules, Truth, judge};
pub use layout::{Annotation, Category, Document, Excluded, Image, Info, Reason, Rendered};
pub use surface::{Agreement, CompareConfig, Comparison, Surface, compare};
pub use voxels::Voxels;

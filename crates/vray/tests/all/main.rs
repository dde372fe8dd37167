//! V-Ray's scenes edited, and its images as frames of a dataset.

mod dataset;
mod edits;
mod hypersim;

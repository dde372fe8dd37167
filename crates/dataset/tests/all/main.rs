//! Datasets on disk: written, read, damaged.

mod analytic;
mod damaged;
mod damaged_arrays;
mod dataset;
mod hypersim_cameras;
mod hypersim_release;

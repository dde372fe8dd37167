//! Looking at a dataset.

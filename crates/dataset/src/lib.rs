//! The dataset on disk: Hypersim's layout, manifest, readers and writers.

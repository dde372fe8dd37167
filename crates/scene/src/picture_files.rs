//! The original files of a scene's pictures, for exporters: copying a file takes no time and loses nothing.

use std::collections::BTreeMap;
use std::sync::Arc;

/// A picture file as it was read, compressed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// The media type: `image/png` or `image/jpeg`, the two that every program reads.
    pub media_type: &'static str,
    /// The file.
    pub bytes: Arc<[u8]>,
}

/// Files by index into `Scene::images`. A picture without a file was generated, or had another format.
pub type PictureFiles = BTreeMap<u32, PictureFile>;

//! What a scene's pictures were before they were decoded, for whoever writes them again: a file that is passed on costs no time and loses
//! nothing.

use std::collections::BTreeMap;

/// A picture as it came, compressed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    /// The media type: `image/png` or `image/jpeg`, the two that every program reads.
    pub media_type: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

/// Files by index into `Scene::images`. A picture without one was made, or came in another form.
pub type PictureFiles = BTreeMap<u32, PictureFile>;

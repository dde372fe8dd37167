//! The glTF document in the making: its lists, which grow while the scene is gone through.

use super::buffer::Buffer;
use enfilade_scene::PictureFiles;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Lists of the file that grow while the scene is gone through.
pub(super) struct Document<'f> {
    /// Files of the scene's pictures.
    pub files: &'f PictureFiles,
    pub buffer: Buffer,
    pub meshes: Vec<Value>,
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    pub samplers: Vec<Value>,
    pub images: Vec<Value>,
    pub nodes: Vec<Value>,
    pub cameras: Vec<Value>,
    pub lights: Vec<Value>,
    pub animations: Vec<Value>,
    pub extensions: BTreeSet<&'static str>,
    /// glTF images by picture of the scene and use.
    pub pictures: BTreeMap<(u32, TextureUse), usize>,
    pub notes: Vec<String>,
}

impl<'f> Document<'f> {
    /// An empty one, into which pictures go as they are in `files` where they can.
    pub fn new(files: &'f PictureFiles) -> Self {
        Self {
            files,
            buffer: Buffer::default(),
            meshes: Vec::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            samplers: Vec::new(),
            images: Vec::new(),
            nodes: Vec::new(),
            cameras: Vec::new(),
            lights: Vec::new(),
            animations: Vec::new(),
            extensions: BTreeSet::new(),
            pictures: BTreeMap::new(),
            notes: Vec::new(),
        }
    }
}

/// The meaning of a picture's values in glTF, which depends on where the texture is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum TextureUse {
    /// Colours, sRGB-encoded.
    Color,
    /// Numbers.
    Data,
}

//! The frames that one machine makes, where several make a dataset together.

use crate::error::Error;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

/// Frames of one trajectory.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Part {
    /// Name of the scene.
    pub scene: String,
    /// Name of the trajectory.
    pub camera: String,
    /// Numbers of the frames.
    pub frames: BTreeSet<u32>,
}

/// The part of a scene that is made here, the flag that ends it, and the callback for finished frames.
pub(crate) struct Shift<'a> {
    pub part: &'a Part,
    /// Ends the work at the next occasion.
    pub stop: &'a AtomicBool,
    /// Receives every frame that was rendered, by trajectory and number.
    pub rendered: &'a (dyn Fn(&str, u32) -> Result<(), Error> + Sync),
}

impl Shift<'_> {
    /// True for the frames that are made here.
    pub fn has(&self, camera: &str, frame: u32) -> bool {
        self.part.camera == camera && self.part.frames.contains(&frame)
    }
}

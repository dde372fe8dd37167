use crate::{Dataset, DatasetError};

/// How long a frame took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// Elapsed seconds.
    pub wall_s: f64,
    /// Seconds of all threads together.
    pub cpu_s: f64,
}

impl Dataset {
    /// How long each frame took when it was last rendered, by scene, camera and frame number.
    ///
    /// # Errors
    /// When the table cannot be read.
    pub fn read_times(&self) -> Result<std::collections::BTreeMap<(String, String, u32), FrameTime>, DatasetError> {
        todo!()
    }
}

use crate::{Dataset, DatasetError, FrameRecord, FrameTime, LabelRecord};
use enfilade_frame::Frame;
use enfilade_scene::{Intrinsics, Pose};

/// What a frame was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameInfo {
    /// Seed of the random numbers.
    pub seed: u64,
    /// Samples per pixel.
    pub samples: u32,
    /// Hash of everything that the frame's values depend on; a frame with another hash is not complete.
    pub config_hash: String,
    /// Where the camera stood; its frame number is the frame's.
    pub pose: Pose,
    /// Image size and calibration.
    pub intrinsics: Intrinsics,
}

impl Dataset {
    /// Writes a rendered frame: all its layers, then the commit record. The frame's number is that of the pose.
    ///
    /// An older frame of that number, and its labels, cease to exist before the new files take their places, so that what is
    /// there is never a mixture. Frames may be written from several threads at once.
    ///
    /// # Errors
    /// When a file cannot be written. Then the frame does not count as complete, and the temporary files are gone.
    pub fn write_frame(&self, scene: &str, camera: &str, frame: &Frame, info: &FrameInfo, time: FrameTime) -> Result<FrameRecord, DatasetError> {
        todo!()
    }

    /// Writes the layers that `labels` has (`semantic`, `semantic_instance`) for frame number `frame`, then their record.
    /// `labels_hash` names the tables they were joined from.
    ///
    /// # Errors
    /// As [`Dataset::write_frame`].
    pub fn write_label_layers(&self, scene: &str, camera: &str, frame: u32, labels: &Frame, labels_hash: &str) -> Result<LabelRecord, DatasetError> {
        todo!()
    }

    /// True when the frame was made with `config_hash` and all its files are there in full length.
    pub fn frame_is_complete(&self, scene: &str, camera: &str, frame: u32, config_hash: &str) -> bool {
        todo!()
    }

    /// True when the frame's label layers were joined from the tables `labels_hash` and are there in full length.
    pub fn labels_are_complete(&self, scene: &str, camera: &str, frame: u32, labels_hash: &str) -> bool {
        todo!()
    }

    /// The commit record of a frame; `None` when it has none.
    ///
    /// # Errors
    /// When the record cannot be read or understood.
    pub fn frame_record(&self, scene: &str, camera: &str, frame: u32) -> Result<Option<FrameRecord>, DatasetError> {
        todo!()
    }

    /// The commit record of a frame's labels; `None` when it has none.
    ///
    /// # Errors
    /// When the record cannot be read or understood.
    pub fn label_record(&self, scene: &str, camera: &str, frame: u32) -> Result<Option<LabelRecord>, DatasetError> {
        todo!()
    }

    /// Removes the temporary files that a killed run left in a camera's folders. Call it before frames are written, when no
    /// other process writes to this camera.
    ///
    /// # Errors
    /// When a folder cannot be read or a file cannot be removed.
    pub fn remove_temporaries(&self, scene: &str, camera: &str) -> Result<(), DatasetError> {
        todo!()
    }
}

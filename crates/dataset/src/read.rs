use crate::{Dataset, DatasetError};
use enfilade_frame::{Frame, Layer, Values};

impl Dataset {
    /// The names of the scenes, sorted.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn scenes(&self) -> Result<Vec<String>, DatasetError> {
        todo!()
    }

    /// The names of a scene's cameras: those of `metadata_cameras.csv`, or without that file the camera folders, sorted.
    ///
    /// # Errors
    /// When the scene is not there or cannot be read.
    pub fn cameras(&self, scene: &str) -> Result<Vec<String>, DatasetError> {
        todo!()
    }

    /// The numbers of a camera's complete frames, ascending.
    ///
    /// A frame of ours is complete when its commit record and all the record's files are there. Where a camera has no records at
    /// all (Hypersim's own data), a frame counts when it has any layer.
    ///
    /// # Errors
    /// When a folder or record cannot be read.
    pub fn frame_numbers(&self, scene: &str, camera: &str) -> Result<Vec<u32>, DatasetError> {
        todo!()
    }

    /// One layer as it is stored; Hypersim's own depth and position are `F16`, ours `F32`.
    ///
    /// # Errors
    /// When the file is missing, damaged, or not an image of the layer's channels.
    pub fn read_layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> Result<Values, DatasetError> {
        todo!()
    }

    /// The given layers of a frame. Values in half precision become single precision where the layer's spec says so.
    ///
    /// # Errors
    /// As [`Dataset::read_layer`], and when the layers differ in size.
    pub fn read_frame(&self, scene: &str, camera: &str, frame: u32, layers: &[Layer]) -> Result<Frame, DatasetError> {
        todo!()
    }

    /// True when the frame has a file for `layer`.
    pub fn has_layer(&self, scene: &str, camera: &str, frame: u32, layer: Layer) -> bool {
        self.layout().layer(scene, camera, frame, layer).is_file()
    }
}

//! V-Ray's images: OpenEXR files with render elements, read as layers of a frame.

use crate::Run;
use enfilade_vray::VrayImage;
use std::path::Path;

/// Reads an image of the seeds' size, and what a frame is made of.
pub fn image(folder: &Path) -> Run {
    let file = folder.join("frame.0000.exr");
    Box::new(move |bytes| {
        std::fs::write(&file, bytes).expect("a folder that can be written");
        if let Ok(image) = VrayImage::read(&file, [3, 2]) {
            drop((image.triples(""), image.triples("VRayNormals"), image.ids("VRayNodeID")));
        }
    })
}

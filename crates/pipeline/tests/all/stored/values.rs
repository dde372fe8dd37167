//! A short form of a stored dataset's contents: a checksum of the decoded values of every layer.

use enfilade_dataset::Dataset;
use enfilade_frame::LAYERS;
use std::collections::BTreeMap;

/// By `SCENE/CAMERA/FRAME/LAYER`, the BLAKE3 of the layer's values, little-endian, row by row.
///
/// # Panics
/// When something cannot be read.
pub fn checksums(dataset: &Dataset) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for scene in dataset.scenes().unwrap() {
        for camera in dataset.cameras(&scene).unwrap() {
            for frame in dataset.frame_numbers(&scene, &camera).unwrap() {
                for spec in LAYERS.iter().filter(|spec| dataset.has_layer(&scene, &camera, frame, spec.layer)) {
                    let read = dataset.read_frame(&scene, &camera, frame, &[spec.layer]).unwrap();
                    let hash = blake3::hash(read.get(spec.layer).unwrap().as_bytes()).to_hex().to_string();
                    found.insert(format!("{scene}/{camera}/{frame}/{}", spec.name), hash);
                }
            }
        }
    }
    found
}

//! Reading what is there of a frame.

use enfilade_dataset::{Dataset, DatasetError};
use enfilade_frame::{Frame, Layer};

/// The layers of a frame that are there or can be computed; an empty frame of one pixel when none is. Positions are left out where nothing
/// states their unit.
pub(super) fn read_present(dataset: &Dataset, scene: &str, camera: &str, frame: u32, wanted: &[Layer]) -> Result<Frame, DatasetError> {
    let has_unit = || !dataset.is_released(scene) || !dataset.meters_per_asset_unit(scene).is_err_and(|error| error.is_not_found());
    let is_there = |layer: Layer| dataset.gives_layer(scene, camera, frame, layer) && (layer != Layer::Position || has_unit());
    let there: Vec<Layer> = wanted.iter().copied().filter(|&layer| is_there(layer)).collect();
    if there.is_empty() { Ok(Frame::new(1, 1)) } else { dataset.read_frame(scene, camera, frame, &there) }
}

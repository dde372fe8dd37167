//! What the frames of a dataset show of each instance, found and stored.

use super::{Solid, frame_instances};
use enfilade_dataset::{Dataset, DatasetError, InstanceView};
use enfilade_frame::Layer;
use enfilade_scene::{CameraView, Counted, Cx};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

/// Writes what the frames of a camera show of each instance, and the amodal masks, which replace all older ones; returns the files. Frames
/// in `made` already have their result of [`view_instances`], which is not computed again. `solids` gives what a frame shows: it is the same
/// in all frames where nothing moves.
///
/// # Errors
/// When a file cannot be read or written.
pub fn write_instances(
    dataset: &Dataset,
    [scene, camera]: [&str; 2],
    frames: &BTreeSet<u32>,
    made: &BTreeMap<u32, Vec<InstanceView>>,
    solids: &(dyn Fn(u32) -> Arc<Vec<Solid>> + Sync),
    cx: &dyn Cx,
) -> Result<Vec<PathBuf>, DatasetError> {
    let counted = Counted::new(cx, "frames", frames.len());
    let one = |&number: &u32| {
        counted.unit(|| match made.get(&number) {
            Some(views) => Ok(views.clone()),
            None => view_instances(dataset, [scene, camera], number, &solids(number)),
        })
    };
    dataset.remove_amodal_masks(scene, camera, made.keys().copied())?;
    let numbers: Vec<u32> = frames.iter().copied().collect();
    let views: Vec<Vec<InstanceView>> = enfilade_parallel::try_map(&numbers, one)?;
    dataset.write_instance_views(scene, camera, &views.concat())?;
    let masks = frames.iter().map(|&frame| dataset.layout().amodal_masks(scene, camera, frame));
    Ok(masks.chain([dataset.layout().frame_instances(scene, camera)]).collect())
}

/// Finds what one frame shows of each instance, and writes its amodal masks.
///
/// # Errors
/// As [`write_instances`], and when the trajectory has no such frame.
pub fn view_instances(
    dataset: &Dataset,
    [scene, camera]: [&str; 2],
    number: u32,
    solids: &[Solid],
) -> Result<Vec<InstanceView>, DatasetError> {
    let (with, trajectory) = (dataset.read_camera(scene, camera)?, dataset.read_trajectory(scene, camera)?);
    let Some(index) = trajectory.poses.iter().position(|pose| pose.frame == number) else { return Ok(Vec::new()) };
    let seen = dataset.read_layer(scene, camera, number, Layer::SemanticInstance)?;
    let view = CameraView::of_frame(&with, &trajectory.poses, index);
    let (views, masks) = frame_instances(solids, &view, number, &seen);
    dataset.write_amodal_masks(scene, camera, number, &masks)?;
    Ok(views)
}

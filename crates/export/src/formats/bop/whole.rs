//! What the stage `boxes` knows of instances as if nothing hid them.

use crate::ExportError;
use crate::instances::Instance;
use crate::selected_frames::{SelectedFrames, Track, View};
use enfilade_dataset::{AmodalMasks, DatasetError, InstanceView, PixelArea};
use enfilade_frame::Frame;
use std::collections::BTreeMap;

/// Visibility of instances in a camera's frames, by frame and instance number.
pub(super) type Known = BTreeMap<(u32, i16), InstanceView>;

/// An instance as if nothing hid it.
pub(super) struct Whole {
    /// Pixels of the whole instance, also those beyond the image.
    pub area: PixelArea,
    /// 255 on those in the image, 0 elsewhere.
    pub mask: Vec<u8>,
}

/// Results of the stage `boxes`; empty for Hypersim's own data.
pub(super) fn known_instances(selected: &SelectedFrames<'_>, track: &Track) -> Result<Known, ExportError> {
    let views = match selected.dataset.read_instance_views(&track.scene, &track.name) {
        Err(error) if error.is_not_found() => Vec::new(),
        views => views?,
    };
    Ok(views.into_iter().map(|view| ((view.frame, view.instance), view)).collect())
}

pub(super) fn visible_area(frame: &Frame, instance: &Instance) -> PixelArea {
    let [x_min, y_min, x_max, y_max] = instance.extent(frame.width).map(|place| place as i32);
    PixelArea { pixels: instance.pixels.len() as u64, bounds: [x_min, y_min, x_max + 1, y_max + 1] }
}

/// The whole of an instance that the frame shows; the visible part where no more is known of this frame. Labels that were made again since
/// are noticed by what is visible.
pub(super) fn whole(
    selected: &SelectedFrames<'_>,
    view: View<'_>,
    frame: &Frame,
    instance: &Instance,
    known: &Known,
    masks: &AmodalMasks,
) -> Result<Whole, ExportError> {
    let (number, visible) = (instance.number, visible_area(frame, instance));
    let found = known.get(&(view.frame(), number)).filter(|found| found.visible == visible && masks.size == [frame.height, frame.width]);
    let mask = masks.instances.iter().find(|mask| mask.semantic_instance_id == number);
    let (Some(found), Some(mask)) = (found, mask) else { return Ok(Whole { area: visible, mask: instance.mask(frame) }) };
    let damaged = || DatasetError::Text {
        path: selected.dataset.layout().amodal_masks(&view.track.scene, &view.track.name, view.frame()),
        problem: format!(
            "the runs of instance {number} do not fill the {}x{} pixels of the image; delete it and run the boxes stage again",
            frame.width, frame.height
        ),
    };
    Ok(Whole { area: found.full, mask: of_runs(&mask.counts, masks.size).ok_or_else(damaged)? })
}

/// The mask of runs outside and inside by turns, which go down the columns; `None` when they do not fill it.
fn of_runs(runs: &[u32], [height, width]: [u32; 2]) -> Option<Vec<u8>> {
    let [height, width] = [height as usize, width as usize];
    let mut mask = vec![0; height * width];
    let mut end = 0;
    for (i, &run) in runs.iter().enumerate() {
        let begin = end;
        end += run as usize;
        if end > mask.len() {
            return None;
        }
        if i % 2 == 1 {
            (begin..end).for_each(|place| mask[place % height * width + place / height] = 255);
        }
    }
    (end == mask.len()).then_some(mask)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_become_a_mask_only_when_they_fill_it() {
        // 3 columns, 2 rows.
        assert_eq!(of_runs(&[0, 2, 3, 1], [2, 3]).unwrap(), [255, 0, 0, 255, 0, 255]);
        for damaged in [&[0, 2, 3][..], &[0, 2, 3, 2], &[u32::MAX, u32::MAX], &[]] {
            assert_eq!(of_runs(damaged, [2, 3]), None, "{damaged:?}");
        }
    }
}

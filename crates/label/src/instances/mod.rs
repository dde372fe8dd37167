//! What a frame shows of every instance: its visible pixels, the pixels it would have if nothing hid it, and how much the image cuts off.
//!
//! Visible pixels are counted in `semantic_instance`. Whole objects are seen alone, with the rays of the renderer: through the pixel
//! centres of the same camera at the same moment, and beyond the image's border as far as [`Canvas`] goes. So every visible pixel belongs
//! to the whole, and cameras of every model, including rolling shutters, are treated alike. Objects are solid: parts of a leaf that an
//! alpha texture cuts out count as part of the whole.

mod canvas;
mod solid;
mod stored;

pub use canvas::Canvas;
pub use solid::{Solid, solids};
pub use stored::{view_instances, write_instances};

use canvas::Silhouette;
use enfilade_dataset::{AmodalMask, AmodalMasks, InstanceView, PixelArea};
use enfilade_frame::Values;
use enfilade_scene::CameraView;
use std::collections::BTreeMap;

/// What frame number `frame` shows of each instance with a pixel in the image, hidden or not, in ascending order; and the masks of the
/// whole objects in the same order.
///
/// `instances` is the frame's `semantic_instance`.
pub fn frame_instances(solids: &[Solid], view: &CameraView<'_>, frame: u32, instances: &Values) -> (Vec<InstanceView>, AmodalMasks) {
    let [width, height] = view.camera().size();
    let visible = visible_areas(instances, width);
    let mut masks = AmodalMasks { size: [height, width], ..AmodalMasks::default() };
    let mut views = Vec::new();
    for (solid, silhouette) in solids.iter().zip(Canvas::of(view.camera()).silhouettes(solids, view)) {
        let Silhouette { full, mut inside } = silhouette;
        if inside.is_empty() {
            continue;
        }
        inside.sort_unstable();
        let seen = visible.get(&solid.instance).copied().unwrap_or_default();
        let inside_pixels = inside.len() as u64;
        views.push(InstanceView { frame, instance: solid.instance, semantic: solid.semantic, visible: seen, full, inside_pixels });
        masks.instances.push(AmodalMask { semantic_instance_id: solid.instance, counts: run_lengths(&inside, width * height) });
    }
    (views, masks)
}

/// The pixels of every instance in an image of instance numbers.
pub fn visible_areas(instances: &Values, width: u32) -> BTreeMap<i16, PixelArea> {
    let mut areas: BTreeMap<i16, PixelArea> = BTreeMap::new();
    for i in 0..instances.len() {
        let instance = instances.get(i) as i16;
        if instance >= 1 {
            let (x, y) = ((i % width as usize) as i32, (i / width as usize) as i32);
            let area = areas.entry(instance).or_default();
            *area = area.with(x, y);
        }
    }
    areas
}

/// Lengths of runs outside and inside by turns, of `total` places of which the ascending `inside` are inside.
pub fn run_lengths(inside: &[u32], total: u32) -> Vec<u32> {
    let mut counts = Vec::new();
    let mut end = 0;
    for &place in inside {
        match counts.last_mut() {
            Some(run) if place == end => *run += 1,
            _ => counts.extend([place - end, 1]),
        }
        end = place + 1;
    }
    if end < total || counts.is_empty() {
        counts.push(total - end);
    }
    counts
}

#[cfg(test)]
mod tests;

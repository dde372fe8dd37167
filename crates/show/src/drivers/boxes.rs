//! Previews of boxes: every kind that a dataset has, drawn over its frames.

use super::present::read_present;
use crate::overlay::{DrawnBox, draw_boxes};
use crate::palette::{id_color, semantic_color};
use crate::picture::{Picture, jpeg};
use crate::preview::{Subject, preview};
use enfilade_dataset::{BoxKind, Dataset, DatasetError, write_bytes};
use enfilade_frame::tonemap::ToneMap;
use enfilade_frame::{Frame, Layer, Pass, Values};
use enfilade_label::class_name;
use enfilade_label::instances::visible_areas;
use enfilade_math::{DAffine3, OrientedBox};
use enfilade_scene::{CameraView, Counted, Cx, Labels};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Instances that show fewer pixels than this share of the image are drawn without text.
const TEXT_SHARE: f64 = 1e-3;

/// Draws every kind of box that the dataset has over the given frames, and returns the files: none where boxes, cameras or poses are not
/// there, as in parts of Hypersim's archives. Only instances that a frame shows are drawn over it; without label tables (Hypersim's public
/// files) they have no class.
///
/// # Errors
/// When a file cannot be read or written.
pub fn preview_boxes(dataset: &Dataset, scene: &str, camera: &str, frames: &[u32], cx: &dyn Cx) -> Result<Vec<PathBuf>, DatasetError> {
    let read = |kind: BoxKind| optional(dataset.read_boxes(scene, kind).map(|boxes| (kind, boxes))).transpose();
    let boxes: Vec<(BoxKind, Vec<Option<OrientedBox>>)> = BoxKind::ALL.into_iter().filter_map(read).collect::<Result<_, _>>()?;
    if boxes.is_empty() {
        return Ok(Vec::new());
    }
    let (Some(with), Some(trajectory)) = (optional(dataset.read_camera(scene, camera))?, optional(dataset.read_trajectory(scene, camera))?)
    else {
        return Ok(Vec::new());
    };
    let labels = optional(dataset.read_label_tables(scene))?.unwrap_or_default();
    let bodies = dataset.read_filmed_bodies(scene, camera)?;
    let counted = Counted::new(cx, "overlays", frames.len());
    let one = |&number: &u32| -> Result<Vec<PathBuf>, DatasetError> {
        let Some(index) = trajectory.poses.iter().position(|pose| pose.frame == number) else { return Ok(Vec::new()) };
        let view = CameraView::of_frame(&with, &trajectory.poses, index);
        let wanted = [Layer::Color, Layer::RenderEntityId, Layer::DepthMeters, Layer::SemanticInstance];
        let frame = read_present(dataset, scene, camera, number, &wanted)?;
        let mut files = Vec::new();
        let Some(backdrop) = Backdrop::new(&frame, &labels) else { return Ok(files) };
        for (kind, boxes) in &boxes {
            let moved = bodies.as_ref().map(|bodies| moved(boxes, &bodies.at(number).instances(&labels.parts)));
            let picture = backdrop.overlay(&view, moved.as_ref().unwrap_or(boxes));
            let path = dataset.layout().preview(scene, camera, number, Pass::Final, &format!("bb_{}.jpg", kind.name()));
            write_bytes(&path, picture)?;
            files.push(path);
        }
        Ok(files)
    };
    let files: Vec<Vec<PathBuf>> = enfilade_parallel::try_map(frames, |number| counted.unit(|| one(number)))?;
    Ok(files.into_iter().flatten().collect())
}

/// The boxes of a moment: what moves takes its box along, and things whose parts go different ways have none.
fn moved(boxes: &[Option<OrientedBox>], maps: &BTreeMap<i16, Option<DAffine3>>) -> Vec<Option<OrientedBox>> {
    let carry = |shape: OrientedBox, map: &DAffine3| OrientedBox {
        center: map.transform_point3(shape.center),
        world_from_box: map.matrix3 * shape.world_from_box,
        ..shape
    };
    let at = |(instance, shape): (i16, &Option<OrientedBox>)| match maps.get(&instance) {
        Some(map) => map.as_ref().zip(*shape).map(|(map, shape)| carry(shape, map)),
        None => *shape,
    };
    (0..).zip(boxes).map(at).collect()
}

/// `None` if the file does not exist.
fn optional<T>(read: Result<T, DatasetError>) -> Result<Option<T>, DatasetError> {
    match read {
        Err(error) if error.is_not_found() => Ok(None),
        read => read.map(Some),
    }
}

/// The picture that boxes are drawn over, with its data.
struct Backdrop<'a> {
    picture: Picture,
    depth: &'a Values,
    /// Instances in the frame: number and class of each, and whether it is large enough for text.
    instances: Vec<(i16, i16, bool)>,
}

impl<'a> Backdrop<'a> {
    /// `None` without the layers for it.
    fn new(frame: &'a Frame, labels: &Labels) -> Option<Self> {
        let (depth, instances) = (frame.get(Layer::DepthMeters)?, frame.get(Layer::SemanticInstance)?);
        let picture = preview(Subject::ToneMapped, frame, ToneMap::of_frame(frame)?)?.picture;
        let shown = visible_areas(instances, frame.width).into_iter().map(|(instance, area)| {
            let class = labels.parts.iter().find(|label| label.instance == instance).map_or(-1, |label| label.semantic);
            (instance, class, area.pixels as f64 >= TEXT_SHARE * frame.pixels() as f64)
        });
        Some(Self { picture, depth, instances: shown.collect() })
    }

    /// The boxes of what the frame shows, over the frame, as JPEG.
    fn overlay(&self, view: &CameraView<'_>, boxes: &[Option<OrientedBox>]) -> Vec<u8> {
        let drawn = self.instances.iter().filter_map(|&(instance, class, large)| {
            let shape = (*boxes.get(instance as usize)?)?;
            let color = if class >= 1 { semantic_color(class) } else { id_color(instance) };
            let text = if large { format!("{} {instance}", class_name(class)) } else { String::new() };
            Some(DrawnBox { shape, color, text })
        });
        jpeg(&draw_boxes(&self.picture, self.depth, view, &drawn.collect::<Vec<_>>()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;

    #[test]
    fn three_overlays_of_a_frame_are_written_and_show_boxes() {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let files = preview_boxes(&dataset, "room", "cam_00", &[0, 1], &Quiet).unwrap();
        assert_eq!(files.len(), 6);
        assert!(files[0].ends_with("scene_cam_00_final_preview/frame.0000.bb_axis_aligned.jpg"));
        let picture = image::open(&files[0]).unwrap().into_rgb8();
        let blue = picture.pixels().filter(|p| p.0[2] > p.0[0].saturating_add(60)).count();
        assert!(blue > 40, "{blue} pixels have the blue of the mirror's box");
    }
}

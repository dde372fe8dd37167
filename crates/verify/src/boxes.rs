//! Laws of bounding boxes and of the table of what frames show of instances.

use super::View;
use super::card::Card;
use super::law::Law;
use super::read::readable;
use super::rounding::beyond;
use enfilade_dataset::{BodyPlaces, BoxKind, Dataset, DatasetError, InstanceView};
use enfilade_frame::vector;
use enfilade_frame::{Frame, Layer};
use enfilade_label::instances::visible_areas;
use enfilade_math::{DMat3, DVec3, OrientedBox};

/// The boxes of a kind; entry i is instance i.
pub(super) type Boxes = Vec<Option<OrientedBox>>;

/// The kinds of boxes that the dataset has.
pub(super) fn read_boxes(dataset: &Dataset, scene: &str, card: &mut Card) -> Vec<(BoxKind, Boxes)> {
    let read = |kind: BoxKind| Some((kind, readable(card, there(dataset.read_boxes(scene, kind))?)?));
    BoxKind::ALL.into_iter().filter_map(read).collect()
}

/// `None` for a file that does not exist.
pub(super) fn there<T>(read: Result<T, DatasetError>) -> Option<Result<T, DatasetError>> {
    (!read.as_ref().is_err_and(DatasetError::is_not_found)).then_some(read)
}

/// Checks the laws that concern only the boxes; `boxes` has one entry per kind that the dataset has, in the order of [`BoxKind::ALL`].
pub(super) fn check_boxes(boxes: &[(BoxKind, Boxes)], scene: &str, card: &mut Card) {
    for (kind, instance, shape) in boxes.iter().flat_map(|(kind, boxes)| present(boxes).map(move |(i, b)| (kind, i, b))) {
        let at = || format!("{scene}: {} box of instance {instance}", kind.name());
        let r = shape.world_from_box;
        let off_identity = (r.transpose() * r - DMat3::IDENTITY).to_cols_array().iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        card.observe(Law::BoxAxes, off_identity.max((r.determinant() - 1.0).abs()), at);
        let sound = shape.extents.is_finite() && shape.center.is_finite() && shape.extents.min_element() >= 0.0;
        let flat_at_most = sound && shape.extents.max_element() > 0.0;
        card.observe(Law::BoxExtents, if flat_at_most { 0.0 } else { 1.0 }, at);
    }
    let [(_, axis_aligned), (_, upright), (_, least)] = boxes else { return };
    for (instance, shape) in present(least) {
        let others = [axis_aligned, upright].map(|boxes| boxes.get(instance).copied().flatten());
        let smallest = others.iter().flatten().map(OrientedBox::volume).fold(f64::INFINITY, f64::min);
        let excess = (shape.volume() - smallest) / shape.extents.max_element().powi(3);
        card.observe(Law::BoxLeast, excess.max(0.0), || format!("{scene}: object_aligned_3d box of instance {instance}"));
    }
}

fn present(boxes: &Boxes) -> impl Iterator<Item = (usize, &OrientedBox)> {
    boxes.iter().enumerate().filter_map(|(i, shape)| Some((i, shape.as_ref()?)))
}

/// Checks that the visible points of each instance in a frame are within its boxes, which are those at rest.
pub(super) fn check_positions(
    boxes: &[(BoxKind, Boxes)],
    frame: &Frame,
    (view, places): (&View<'_>, BodyPlaces<'_>),
    place: &str,
    card: &mut Card,
) {
    let (Some(positions), Some(instances)) = (frame.get(Layer::Position), frame.get(Layer::SemanticInstance)) else { return };
    let entities = frame.get(Layer::RenderEntityId);
    let center = view.camera.pose().position;
    let y_of = |pixel: usize| (pixel / frame.width as usize) as f64 + 0.5;
    for (kind, boxes) in boxes {
        let beyond = |pixel: usize| {
            let instance = instances.get(pixel);
            let shown: DVec3 = vector(positions, pixel);
            // The boxes are those of the shapes at rest.
            let p = entities.map_or(Some(shown), |entities| places.in_row(y_of(pixel)).at_rest(entities.get(pixel) as i64, shown))?;
            let shape = (instance >= 1.0).then(|| boxes.get(instance as usize).copied().flatten());
            let open = view.rounding.of_position(shown).length();
            shape.map(|shape| shape.map_or(f64::INFINITY, |shape| beyond(shape.distance_beyond(p), open) / shown.distance(center).max(1.0)))
        };
        let worst = (0..instances.len()).filter_map(|pixel| Some((pixel, beyond(pixel)?))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((pixel, value)) = worst {
            let (x, y, instance) = (pixel % frame.width as usize, pixel / frame.width as usize, instances.get(pixel));
            card.observe(Law::BoxContains, value.max(0.0), || {
                format!("{place} pixel ({x}, {y}): instance {instance} is beyond its {} box", kind.name())
            });
        }
    }
}

/// Checks the rows of a frame against its `semantic_instance`.
pub(super) fn check_views(views: &[InstanceView], frame: &Frame, number: u32, place: &str, card: &mut Card) {
    let Some(instances) = frame.get(Layer::SemanticInstance) else { return };
    let mut seen = visible_areas(instances, frame.width);
    let mut wrong: Vec<i16> = Vec::new();
    for view in views.iter().filter(|view| view.frame == number) {
        if seen.remove(&view.instance).unwrap_or_default() != view.visible {
            wrong.push(view.instance);
        }
        let shares = view.visible.pixels <= view.inside_pixels && view.inside_pixels <= view.full.pixels;
        card.observe(Law::InstanceWhole, if shares { 0.0 } else { 1.0 }, || {
            let (visible, inside, full) = (view.visible.pixels, view.inside_pixels, view.full.pixels);
            format!("{place}: instance {} shows {visible} pixels of {inside} in the image and {full} in all", view.instance)
        });
    }
    wrong.extend(seen.keys());
    card.observe(Law::InstanceCounts, wrong.len() as f64, || format!("{place}: instances {wrong:?}"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rounding;
    use enfilade_dataset::PixelArea;
    use enfilade_scene::{Camera, CameraView};
    use enfilade_testroom as testroom;

    fn mirror() -> OrientedBox {
        OrientedBox { center: DVec3::new(0.0, 2.0, 1.5), world_from_box: DMat3::IDENTITY, extents: DVec3::new(1.0, 0.0, 1.0) }
    }

    fn failures(change: impl Fn(&mut [OrientedBox; 3])) -> Vec<Law> {
        let mut shapes = [mirror(); 3];
        change(&mut shapes);
        let boxes: Vec<_> = BoxKind::ALL.into_iter().zip(shapes.map(|shape| vec![None, Some(shape)])).collect();
        let (camera, pose) = (Camera::from(testroom::intrinsics()), testroom::pose());
        let mut card = Card::default();
        check_boxes(&boxes, "room", &mut card);
        let (camera, rounding) = (CameraView::still(&camera, &pose), Rounding::default());
        let view = View { camera, rounding, denoised: true, released: false, entities: 3, labels: None, pieces: &[], last_class: 40 };
        check_positions(&boxes, &testroom::frame(&pose), (&view, BodyPlaces::default()), "frame", &mut card);
        card.failures()
    }

    #[test]
    fn boxes_that_are_skewed_inverted_too_large_or_too_small_are_found() {
        assert_eq!(failures(|_| ()), []);
        assert_eq!(failures(|b| b[1].world_from_box.x_axis.x = -1.0), [Law::BoxAxes], "mirrored");
        assert_eq!(failures(|b| b[0].extents.y = -1e-9), [Law::BoxExtents]);
        assert_eq!(failures(|b| b[2].extents.y = 0.1), [Law::BoxLeast]);
        assert_eq!(failures(|b| b[1].extents.x = 0.9), [Law::BoxContains]);
    }

    #[test]
    fn tables_that_count_otherwise_than_the_image_are_found() {
        let frame = testroom::frame(&testroom::pose());
        let area = visible_areas(frame.get(Layer::SemanticInstance).unwrap(), frame.width)[&1];
        let good = InstanceView { frame: 0, instance: 1, semantic: 19, visible: area, full: area, inside_pixels: area.pixels };
        let failures = |views: &[InstanceView]| {
            let mut card = Card::default();
            check_views(views, &frame, 0, "frame", &mut card);
            card.failures()
        };
        assert_eq!(failures(&[good]), []);
        assert_eq!(failures(&[]), [Law::InstanceCounts], "a row is missing");
        assert_eq!(failures(&[InstanceView { visible: PixelArea { pixels: 1, ..area }, ..good }]), [Law::InstanceCounts]);
        assert_eq!(failures(&[InstanceView { inside_pixels: area.pixels - 1, ..good }]), [Law::InstanceWhole]);
    }
}

//! The law of surfaces along rays: they go from near to far, begin with what the frame shows, and have the classes of their parts.

use super::View;
use super::card::Card;
use super::law::Law;
use super::read::readable;
use enfilade_dataset::{Dataset, Surfaces};
use enfilade_frame::{Frame, Layer};
use enfilade_math::DVec3;

/// Distances that differ by this share are the same.
const SAME: f64 = 1e-4;
/// Lengths of normals are off by no more: float16.
const UNIT: f64 = 2e-3;

/// Checks the surfaces along the rays of a frame, where it has them.
pub(super) fn check(dataset: &Dataset, [scene, camera]: [&str; 2], number: u32, frame: &Frame, view: &View<'_>, card: &mut Card) {
    if !dataset.has_surfaces(scene, camera, number) {
        return;
    }
    let Some(surfaces) = readable(card, dataset.read_surfaces(scene, camera, number)) else { return };
    let place = format!("{scene}/{camera}/frame.{number:04}");
    let size = [frame.height as usize, frame.width as usize];
    if surfaces.size != size {
        card.observe(Law::RaySurfaces, f64::INFINITY, || format!("{place}: surfaces of {}x{}", surfaces.size[1], surfaces.size[0]));
        return;
    }
    let wrong: Vec<(usize, &str)> =
        (0..frame.pixels()).filter_map(|pixel| Some((pixel, problem(&surfaces, pixel, frame, view)?))).collect();
    card.observe(Law::RaySurfaces, wrong.len() as f64, || match wrong.first() {
        Some((pixel, what)) => format!("{place} pixel ({}, {}): {what}", pixel % size[1], pixel / size[1]),
        None => place.clone(),
    });
}

/// The problem with a pixel, if any.
fn problem(surfaces: &Surfaces, pixel: usize, frame: &Frame, view: &View<'_>) -> Option<&'static str> {
    let own = pixel * surfaces.count..(pixel + 1) * surfaces.count;
    let mut last_m = 0.0;
    let mut is_over = false;
    for i in own.clone() {
        let (distance_m, entity, side) = (f64::from(surfaces.distance_m[i]), surfaces.entity[i], surfaces.side[i]);
        let normal = [0, 1, 2].map(|axis| surfaces.normal_world[3 * i + axis].to_f64());
        if entity == -1 {
            if !distance_m.is_nan() || side != 0 || surfaces.semantic[i] != -1 || !normal.iter().all(|v| v.is_nan()) {
                return Some("something is told of no surface");
            }
            is_over = true;
            continue;
        }
        if is_over || distance_m.is_nan() || distance_m < last_m {
            return Some("surfaces do not go from near to far");
        }
        if !(1..=view.entities as i64).contains(&i64::from(entity)) || !(1..=2).contains(&side) {
            return Some("no such part, or no such side");
        }
        if (normal.iter().map(|v| v * v).sum::<f64>().sqrt() - 1.0).abs() > UNIT {
            return Some("a normal is not of unit length");
        }
        if view
            .labels
            .is_some_and(|labels| labels.parts.get(entity as usize - 1).is_some_and(|label| label.semantic != surfaces.semantic[i]))
        {
            return Some("a class is not that of the part");
        }
        last_m = distance_m;
    }
    let (first, bent) = (own.start, f64::from(surfaces.bent_distance_m[pixel]));
    let shown = |layer: Layer| frame.get(layer).map(|values| values.get(pixel));
    if shown(Layer::RenderEntityId).is_some_and(|entity| entity != f64::from(surfaces.entity[first])) {
        return Some("the first surface is not the one that the frame shows");
    }
    let first_m = f64::from(surfaces.distance_m[first]);
    if shown(Layer::DepthMeters).is_some_and(|shown_m| (shown_m - first_m).abs() > SAME * first_m) {
        return Some("the first surface is not at the distance that the frame shows");
    }
    // A way that is bent is at least as long as that to the first surface.
    let (end, p) = (surfaces.bent_entity[pixel], DVec3::from([0, 1, 2].map(|axis| f64::from(surfaces.bent_position[3 * pixel + axis]))));
    if bent.is_nan() != (end == -1) || bent.is_nan() != p.is_nan() || !(-1..=view.entities as i64).contains(&i64::from(end)) || end == 0 {
        return Some("the way through glass ends on no part");
    }
    let (eye, _) = view.camera.row_placement((pixel / frame.width as usize) as f64 + 0.5);
    if bent < first_m * (1.0 - SAME) || eye.distance(p) > bent * (1.0 + SAME) {
        return Some("the way through glass is shorter than that to the first surface, or than the distance to its end");
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::f16;
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;

    fn failures(change: impl Fn(&mut Surfaces, usize)) -> Vec<Law> {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let mut surfaces = dataset.read_surfaces("room", "cam_00", 0).unwrap();
        change(&mut surfaces, testroom::pixel_of(&testroom::frame(&testroom::pose()), 1));
        dataset.write_surfaces("room", "cam_00", 0, surfaces).unwrap();
        crate::verify_scene(&dataset, "room", &Quiet).unwrap().failures().map(|law| law.law).collect()
    }

    #[test]
    fn surfaces_that_are_out_of_order_or_of_other_parts_are_found() {
        assert_eq!(failures(|_, _| ()), []);
        assert_eq!(failures(|s, pixel| s.distance_m.swap(2 * pixel, 2 * pixel + 1)), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.entity[2 * pixel] = 2), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.semantic[2 * pixel + 1] = 7), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.side[2 * pixel] = 0), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.normal_world[6 * pixel] = f16::ONE), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.bent_distance_m[pixel] *= 0.5), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.bent_position[3 * pixel] += 100.0), [Law::RaySurfaces]);
        assert_eq!(failures(|s, pixel| s.bent_entity[pixel] = -1), [Law::RaySurfaces]);
    }
}

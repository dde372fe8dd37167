//! The laws of flow between any two frames: it leads to the place where the second frame's camera sees the surface that the first shows,
//! and the visibility agrees with distances where these decide it.

use super::card::Card;
use super::law::Law;
use super::many_views::Listed;
use enfilade_dataset::FramePair;
use enfilade_frame::{Values, vector};
use enfilade_math::{DVec2, DVec3};
use enfilade_scene::CameraView;

/// Flow is compared if it ends at most this many image sizes beyond the second one's borders: close to the plane of a camera, rounding of a
/// distance can move the image of a point by any number of pixels.
const BEYOND: f64 = 1.0;

/// The layers that lead from the first frame of a pair to the second; images of the first.
pub(super) struct PairLayers {
    /// Pixels.
    pub flow: Values,
    /// Metres.
    pub moved: Values,
    pub seen: Values,
}

/// Checks the layers of a pair; they must be of the first frame's size.
pub(super) fn check(pair: &FramePair, layers: &PairLayers, [first, second]: [&Listed<'_>; 2], card: &mut Card) {
    let width = first.view.camera().size()[0] as usize;
    let (mut worst, mut contradictions, mut pixels) = ((0.0, 0), 0, 0);
    for pixel in 0..first.distances.len() {
        let (x, y) = ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let off = match first.point(x, y, pixel) {
            None => is_empty(layers, pixel),
            Some(p) => {
                // Where parts that deform go is not in the tables.
                let Some(then) = first.places().carry_to(y, (&second.places(), &second.view), first.part(pixel), p) else { continue };
                pixels += 1;
                contradictions += usize::from(second.contradicts(then, layers.seen.get(pixel) == 1.0));
                off(layers, pixel, [&first.view, &second.view], (x, y), [p, then])
            }
        };
        if off > worst.0 || off.is_nan() {
            worst = (if off.is_nan() { f64::INFINITY } else { off }, pixel);
        }
    }
    let name = |(camera, frame): &(String, u32)| format!("{camera}/frame.{frame:04}");
    let from_to = || format!("{}/{} to {}", pair.scene, name(&pair.first), name(&pair.second));
    card.observe(Law::PairFlow, worst.0, || format!("{} pixel ({}, {})", from_to(), worst.1 % width, worst.1 / width));
    let share = contradictions as f64 / pixels.max(1) as f64;
    card.observe(Law::PairVisibility, share, || format!("{}: {contradictions} of {pixels} pixels", from_to()));
}

/// 0 where nothing is known of a pixel that shows nothing.
fn is_empty(layers: &PairLayers, pixel: usize) -> f64 {
    let empty = layers.flow.get(2 * pixel).is_nan() && layers.moved.get(3 * pixel).is_nan() && layers.seen.get(pixel) == 0.0;
    if empty { 0.0 } else { f64::INFINITY }
}

/// How far flow and scene flow are off, as a share of their lengths from 1 px and 1 m on.
fn off(layers: &PairLayers, pixel: usize, [from, to]: [&CameraView<'_>; 2], (x, y): (f64, f64), [p_world, p_then]: [DVec3; 2]) -> f64 {
    let stored = DVec2::new(layers.flow.get(2 * pixel), layers.flow.get(2 * pixel + 1));
    let there = to.project(p_then);
    let [width, height] = to.camera().size().map(f64::from);
    let within = |(x, y): &(f64, f64), beyond: f64| {
        (-beyond * width..(1.0 + beyond) * width).contains(x) && (-beyond * height..(1.0 + beyond) * height).contains(y)
    };
    let flow = match there.filter(|there| within(there, BEYOND)) {
        Some((to_x, to_y)) if !stored.is_nan() => stored.distance(DVec2::new(to_x - x, to_y - y)) / stored.length().max(1.0),
        Some(there) if within(&there, 0.0) => f64::INFINITY,
        // At the border of what the second camera has an image of, beyond its picture, rounding decides.
        _ => 0.0,
    };
    let row = there.map_or(y, |(_, row)| row.clamp(0.0, height));
    let in_camera = |view: &CameraView<'_>, p: DVec3, row: f64| {
        let (position, world_from_camera) = view.row_placement(row);
        world_from_camera.transpose() * (p - position)
    };
    let moved: DVec3 = vector(&layers.moved, pixel);
    let expected = in_camera(to, p_then, row) - in_camera(from, p_world, y);
    flow.max(moved.distance(expected) / moved.length().max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_dataset::Dataset;
    use enfilade_frame::{Frame, Layer};
    use enfilade_scene::Quiet;
    use enfilade_testroom as testroom;

    const LAYERS: [Layer; 3] = [Layer::OpticalFlow, Layer::SceneFlow, Layer::FlowVisibility];

    fn failures(change: impl Fn(&mut Frame)) -> Vec<Law> {
        let folder = tempfile::tempdir().unwrap();
        let dataset: Dataset = testroom::dataset(folder.path());
        let pair = dataset.pairs_with_layers("room", "cam_00").unwrap().remove(0);
        let mut frame = Frame::new(64, 48);
        LAYERS.iter().for_each(|&layer| frame.insert(layer, dataset.read_pair_layer(&pair, layer).unwrap().1));
        change(&mut frame);
        dataset.write_pair_layers(&pair, &frame).unwrap();
        let report = crate::verify_scene(&dataset, "room", &Quiet).unwrap();
        report.failures().map(|law| law.law).collect()
    }

    #[test]
    fn flow_that_leads_elsewhere_is_found_and_nothing_else() {
        let seen = 24 * 64 + 30;
        assert_eq!(failures(|_| ()), []);
        assert_eq!(failures(|frame| testroom::set(frame, Layer::OpticalFlow, seen, &[3.0, 0.0])), [Law::PairFlow]);
        assert_eq!(failures(|frame| testroom::set(frame, Layer::OpticalFlow, seen, &[f64::NAN; 2])), [Law::PairFlow]);
        assert_eq!(failures(|frame| testroom::set(frame, Layer::SceneFlow, seen, &[0.3, 0.0, 0.0])), [Law::PairFlow]);
        let hide = |frame: &mut Frame| (seen..seen + 64).for_each(|pixel| testroom::set(frame, Layer::FlowVisibility, pixel, &[0.0]));
        assert_eq!(failures(hide), [Law::PairVisibility]);
    }
}

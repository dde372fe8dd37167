//! The law of covisibility: what is stored lies between what the frames' distances leave open.
//!
//! The stored grid of each listed frame is carried into each other one. A point is seen for sure where none of the sixteen pixels around
//! its image shows anything nearer, and hidden for sure where all of them show something clearly nearer; outside of the image it is not
//! seen. Between the two a ray through the scene has decided, which nothing that is stored can repeat.

use super::card::Card;
use super::law::Law;
use enfilade_dataset::{Covisibility, CovisibleFrame};
use enfilade_frame::Values;
use enfilade_math::DVec3;
use enfilade_scene::CameraView;
use rayon::prelude::*;

/// A surface hides a point for sure when it is nearer than this share of the point's distance.
const HIDES: f64 = 0.98;
/// A surface is before a point at most when it is nearer than this share of its distance: half of what rays leave before their end.
const BEFORE: f64 = 0.9995;
/// Pixels on each side of a point's image, in both directions, that are looked at.
const AROUND: f64 = 2.0;

/// A frame of the list as it is stored.
pub(super) struct Listed<'a> {
    pub view: CameraView<'a>,
    /// Metres, by pixel of the view; NaN where nothing was hit.
    pub distances: Values,
}

/// How many points of a frame another one sees for sure, and how many it does not.
#[derive(Default)]
struct Certain {
    seen: usize,
    unseen: usize,
}

/// Checks the matrix of a scene; `read` gives a listed frame, or `None` where it is not there any more.
pub(super) fn check<'a>(scene: &str, stored: &Covisibility, read: impl Fn(&CovisibleFrame) -> Option<Listed<'a>> + Sync, card: &mut Card) {
    check_range(scene, stored, card);
    let grid = |frame: &CovisibleFrame| read(frame).map(|listed| listed.points(frame.grid_step_px));
    let grids: Vec<Option<Vec<DVec3>>> = stored.frames.par_iter().map(grid).collect();
    for (frame, points) in stored.frames.iter().zip(&grids).filter_map(|(frame, points)| Some((frame, points.as_ref()?))) {
        let off = points.len().abs_diff(frame.surface_pixels as usize) as f64 / f64::from(frame.surface_pixels.max(1));
        card.observe(Law::Covisibility, off, || {
            format!(
                "{scene}/{}: {} pixels of its grid show a surface, {} when it was counted",
                name(frame),
                points.len(),
                frame.surface_pixels
            )
        });
    }
    let column = |(by, frame): (usize, &CovisibleFrame)| {
        let mut card = Card::default();
        let Some(listed) = grids[by].as_ref().and_then(|_| read(frame)) else { return card };
        for (of, points) in grids.iter().enumerate().filter_map(|(of, points)| Some((of, points.as_ref().filter(|p| !p.is_empty())?))) {
            let (certain, n, share) = (listed.certain(points), points.len() as f64, f64::from(stored.share(of, by)));
            let (least, most) = (certain.seen as f64 / n, 1.0 - certain.unseen as f64 / n);
            card.observe(Law::Covisibility, (least - share).max(share - most).max(0.0), || {
                let pair = format!("{scene}/{} seen by {}", name(&stored.frames[of]), name(frame));
                format!("{pair}: {share:.4}, distances tell {least:.4} to {most:.4}")
            });
        }
        card
    };
    let cards: Vec<Card> = stored.frames.par_iter().enumerate().map(column).collect();
    cards.into_iter().for_each(|found| card.merge(found));
}

/// Shares lie on [0, 1], and a frame sees what it shows.
fn check_range(scene: &str, stored: &Covisibility, card: &mut Card) {
    for (of, frame) in stored.frames.iter().enumerate() {
        let at = || format!("{scene}/{}", name(frame));
        for by in 0..stored.frames.len() {
            let share = f64::from(stored.share(of, by));
            let expected = if of == by { 1.0 } else { share.clamp(0.0, 1.0) };
            let is_sentinel = frame.surface_pixels == 0 && share.is_nan();
            card.observe(Law::Covisibility, if is_sentinel { 0.0 } else { (share - expected).abs() }, at);
        }
    }
}

fn name(frame: &CovisibleFrame) -> String {
    format!("{}/frame.{:04}", frame.camera, frame.frame)
}

impl Listed<'_> {
    /// The surface points of a grid of pixels, world, metres.
    fn points(&self, step_px: u32) -> Vec<DVec3> {
        let [width, height] = self.view.camera().size();
        let point = |[column, row]: [u32; 2]| self.point(f64::from(column) + 0.5, f64::from(row) + 0.5, (row * width + column) as usize);
        CovisibleFrame::grid([width, height], step_px).filter_map(point).collect()
    }

    /// The surface point that a pixel with its centre at (x, y) shows, world, metres.
    pub(super) fn point(&self, x: f64, y: f64, pixel: usize) -> Option<DVec3> {
        let distance = self.distances.get(pixel);
        let ray = self.view.centre_ray(x, y).filter(|_| distance.is_finite())?;
        Some(ray.origin + ray.direction * distance)
    }

    /// Whether a point that is said to be seen in this frame, or not to be, is hidden or seen there for sure.
    pub(super) fn contradicts(&self, p_world: DVec3, is_seen: bool) -> bool {
        let certain = self.certain(&[p_world]);
        if is_seen { certain.unseen > 0 } else { certain.seen > 0 }
    }

    /// How many of the points this frame sees for sure, and how many not.
    fn certain(&self, points: &[DVec3]) -> Certain {
        let mut certain = Certain::default();
        for &p in points {
            match self.nearest_and_farthest(p) {
                Some((distance, near, _)) if near >= BEFORE * distance => certain.seen += 1,
                Some((distance, _, far)) if far >= HIDES * distance => (),
                _ => certain.unseen += 1,
            }
        }
        certain
    }

    /// Distance of a world point from the camera, and the least and the greatest of the pixels around its image; void is infinitely far.
    /// `None` outside of the image.
    fn nearest_and_farthest(&self, p_world: DVec3) -> Option<(f64, f64, f64)> {
        let [width, height] = self.view.camera().size();
        let (x, y) = self.view.project(p_world)?;
        if x < 0.0 || y < 0.0 || x >= f64::from(width) || y >= f64::from(height) {
            return None;
        }
        let distance = self.view.row_placement(y).0.distance(p_world);
        let span = |at: f64, side: u32| {
            let first = (at - 0.5).floor() - (AROUND - 1.0);
            (first.max(0.0) as u32)..=((first + 2.0 * AROUND - 1.0) as u32).min(side - 1)
        };
        let (mut near, mut far) = (f64::INFINITY, 0.0f64);
        for row in span(y, height) {
            for column in span(x, width) {
                let stored = self.distances.get((row * width + column) as usize);
                let stored = if stored.is_nan() { f64::INFINITY } else { stored };
                (near, far) = (near.min(stored), far.max(stored));
            }
        }
        Some((distance, near, far))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::Layer;
    use enfilade_scene::{Camera, Quiet};
    use enfilade_testroom as testroom;

    /// The worst of the law after `change`.
    fn worst(change: impl Fn(&mut Covisibility)) -> f64 {
        let folder = tempfile::tempdir().unwrap();
        let dataset = testroom::dataset(folder.path());
        let mut stored = dataset.read_covisibility("room").unwrap();
        change(&mut stored);
        dataset.write_covisibility("room", &stored).unwrap();
        let report = crate::verify_scene(&dataset, "room", &Quiet).unwrap();
        report.laws.iter().find(|law| law.law == Law::Covisibility).unwrap().worst.unwrap_or(f64::INFINITY)
    }

    #[test]
    fn what_is_true_passes_and_what_is_changed_does_not() {
        assert!(worst(|_| ()) < 1e-6);
        assert!((worst(|stored| stored.shares[1] -= 0.05) - 0.05).abs() < 0.01, "less than is seen for sure");
        assert!(worst(|stored| stored.shares[2] = 1.0) > Law::Covisibility.spec().bound, "more than lies inside the image");
        assert!((worst(|stored| stored.shares[3] = 0.9) - 0.1).abs() < 1e-6, "the diagonal");
        assert!(worst(|stored| stored.shares[1] = f32::NAN) == f64::INFINITY);
        assert!(worst(|stored| stored.frames[0].surface_pixels -= 100) > 0.03);
        assert!(worst(|stored| stored.frames[0].frame = 7) < 1e-6, "frames that are gone are not compared");
    }

    #[test]
    fn a_point_is_certain_only_where_all_pixels_around_it_agree() {
        let (camera, pose) = (Camera::from(testroom::intrinsics()), testroom::pose());
        let mut frame = testroom::frame(&pose);
        let of = |frame: &enfilade_frame::Frame, scale: f64| {
            let distances = frame.get(Layer::DepthMeters).unwrap().clone();
            let listed = Listed { view: CameraView::still(&camera, &pose), distances };
            let points: Vec<DVec3> = listed.points(8).iter().map(|p| pose.position + (*p - pose.position) * scale).collect();
            let certain = listed.certain(&points);
            (certain.seen, certain.unseen, points.len())
        };
        let (seen, unseen, all) = of(&frame, 0.9);
        assert!(seen > all * 9 / 10 && unseen == 0, "before the surfaces: {seen} of {all}");
        let (seen, unseen, _) = of(&frame, 1.5);
        assert!(unseen > all * 9 / 10 && seen == 0, "behind them: {unseen} of {all}");
        // One far pixel in eight by eight leaves the points around it open.
        for pixel in (0..64 * 48).filter(|i| i % 64 % 8 == 4 && i / 64 % 8 == 4) {
            testroom::set(&mut frame, Layer::DepthMeters, pixel, &[1e3]);
        }
        let listed = Listed { view: CameraView::still(&camera, &pose), distances: frame.get(Layer::DepthMeters).unwrap().clone() };
        let p = pose.position + 9.0 * (pose.look_at - pose.position);
        assert!(listed.nearest_and_farthest(p).is_some_and(|(distance, near, far)| near < HIDES * distance && far > distance));
    }
}

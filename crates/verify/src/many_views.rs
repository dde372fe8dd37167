//! The law of covisibility: stored shares are within the bounds that follow from the frames' distances.
//!
//! The stored grid of each listed frame is carried into each other one. A point is certainly seen if none of the sixteen pixels around its
//! image shows anything nearer, or if they all show one plane that contains the point. It is certainly hidden if all of them show something
//! clearly nearer, and outside of the image it is not seen. In all other cases a ray through the scene has decided, which stored data
//! cannot repeat.

use super::card::Card;
use super::law::Law;
use enfilade_dataset::{BodyPlaces, Covisibility, CovisibleFrame};
use enfilade_frame::Values;
use enfilade_math::DVec3;
use enfilade_scene::CameraView;
use std::sync::OnceLock;

/// A surface certainly hides a point if it is nearer than this share of the point's distance.
const HIDES: f64 = 0.98;
/// A surface may be in front of a point only if it is nearer than this share of its distance: half of the gap that rays leave before their
/// end.
const BEFORE: f64 = 0.9995;
/// Pixels show one plane, and a point is in it, if their distance from it along the ray is at most this share of the ray's length: half of
/// the gap that rays leave before their end. The far side of a lampshade is farther off.
const PLANE: f64 = 5e-4;
/// Least cosine of the angle between a plane's normal and the ray to it at which it counts: 87 degrees.
const GRAZING: f64 = 0.05;
/// Pixels on each side of a point's image, in both directions, that are looked at.
const AROUND: u32 = 2;

/// Number of points that may be behind something, or in front of it, that is thinner than a pixel. It matters if few points are counted.
pub(super) const BETWEEN_SAMPLES: usize = 2;

/// A stored frame.
pub(super) struct Listed<'a> {
    pub view: CameraView<'a>,
    /// Metres, by pixel of the view; NaN where nothing was hit.
    pub distances: Values,
    /// The part that each pixel shows, as `render_entity_id` numbers it, and where what moves is; `None` where nothing in the scene does.
    pub moving: Option<(Values, BodyPlaces<'a>)>,
    /// The surface points of all pixels, computed on first use; NaN where there is none.
    shown: OnceLock<Vec<DVec3>>,
}

/// A surface point: the image coordinate of the row that shows it, its part, its place in the world.
type Shown = (f64, i64, DVec3);

/// The surface points of a frame's grid, and where what moves is.
type Grid<'a> = (Vec<Shown>, BodyPlaces<'a>);

/// Numbers of points of a frame that another one certainly sees, and certainly does not see.
#[derive(Default)]
struct Certain {
    seen: usize,
    unseen: usize,
}

/// Checks the matrix of a scene; `read` returns a listed frame, or `None` if it no longer exists.
pub(super) fn check<'a>(scene: &str, stored: &Covisibility, read: impl Fn(&CovisibleFrame) -> Option<Listed<'a>> + Sync, card: &mut Card) {
    check_range(scene, stored, card);
    let grid = |frame: &CovisibleFrame| read(frame).map(|listed| (listed.points(frame.grid_step_px), listed.places()));
    let grids: Vec<Option<Grid<'a>>> = enfilade_parallel::map(&stored.frames, grid);
    for (frame, (points, _)) in stored.frames.iter().zip(&grids).filter_map(|(frame, points)| Some((frame, points.as_ref()?))) {
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
    let column = |by: usize| {
        let (frame, mut card) = (&stored.frames[by], Card::default());
        let Some(listed) = grids[by].as_ref().and_then(|_| read(frame)) else { return card };
        let of_frames =
            grids.iter().enumerate().filter_map(|(of, grid)| Some((of, grid.as_ref().filter(|(points, _)| !points.is_empty())?)));
        for (of, (points, places)) in of_frames {
            let (certain, n, share) = (listed.certain((points, *places)), points.len() as f64, f64::from(stored.share(of, by)));
            let share_of = |points: usize| points.saturating_sub(BETWEEN_SAMPLES) as f64 / n;
            let (least, most) = (share_of(certain.seen), 1.0 - share_of(certain.unseen));
            card.observe(Law::Covisibility, (least - share).max(share - most).max(0.0), || {
                let pair = format!("{scene}/{} seen by {}", name(&stored.frames[of]), name(frame));
                format!("{pair}: {share:.4}, distances tell {least:.4} to {most:.4}")
            });
        }
        card
    };
    let cards: Vec<Card> = enfilade_parallel::map_up_to(stored.frames.len(), column);
    cards.into_iter().for_each(|found| card.merge(found));
}

/// Checks that shares are in [0, 1], and that a frame sees its own surfaces.
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

impl<'a> Listed<'a> {
    /// A list from a view and its distances.
    pub(super) fn new(view: CameraView<'a>, distances: Values) -> Self {
        Self { view, distances, moving: None, shown: OnceLock::new() }
    }

    /// The part that a pixel shows; 0 where nothing in the scene moves.
    pub(super) fn part(&self, pixel: usize) -> i64 {
        self.moving.as_ref().map_or(0, |(parts, _)| parts.get(pixel) as i64)
    }

    /// Where what moves is in the frame.
    pub(super) fn places(&self) -> BodyPlaces<'a> {
        self.moving.as_ref().map_or_else(BodyPlaces::default, |(_, places)| *places)
    }

    /// The surface points of a grid of pixels.
    fn points(&self, step_px: u32) -> Vec<Shown> {
        let [width, height] = self.view.camera().size();
        let point = |[column, row]: [u32; 2]| {
            let pixel = (row * width + column) as usize;
            let y = f64::from(row) + 0.5;
            Some((y, self.part(pixel), self.point(f64::from(column) + 0.5, y, pixel)?))
        };
        CovisibleFrame::grid([width, height], step_px).filter_map(point).collect()
    }

    /// The surface point that a pixel with its centre at (x, y) shows, world, metres.
    pub(super) fn point(&self, x: f64, y: f64, pixel: usize) -> Option<DVec3> {
        let distance = self.distances.get(pixel);
        let ray = self.view.centre_ray(x, y).filter(|_| distance.is_finite())?;
        Some(ray.origin + ray.direction * distance)
    }

    /// Whether the recorded visibility `is_seen` of a point in this frame is certainly wrong.
    pub(super) fn contradicts(&self, p_world: DVec3, is_seen: bool) -> bool {
        self.surely_seen(p_world) == Some(!is_seen)
    }

    /// Numbers of the points that this frame certainly sees, and certainly does not see.
    fn certain(&self, (points, places): (&[Shown], BodyPlaces<'_>)) -> Certain {
        let mut certain = Certain::default();
        let here = |&(y, part, p): &Shown| places.carry_to(y, (&self.places(), &self.view), part, p);
        for seen in points.iter().filter_map(|shown| self.surely_seen(here(shown))) {
            *(if seen { &mut certain.seen } else { &mut certain.unseen }) += 1;
        }
        certain
    }

    /// Whether this frame sees a world point; `None` where its pixels leave that open.
    fn surely_seen(&self, p_world: DVec3) -> Option<bool> {
        let [width, height] = self.view.camera().size();
        let at = self.view.project(p_world).filter(|(x, y)| *x >= 0.0 && *y >= 0.0 && *x < f64::from(width) && *y < f64::from(height));
        let Some((x, y)) = at else { return Some(false) };
        let eye = self.view.row_placement(y).0;
        let distance = eye.distance(p_world);
        // The first pixel of the block; at the border it is a smaller one.
        let [left, top] = [x, y].map(|at| (at - 0.5).floor() as i64 - i64::from(AROUND) + 1);
        let span = |first: i64, side: u32| first.max(0) as u32..(first + 2 * i64::from(AROUND)).min(i64::from(side)) as u32;
        let block = || span(top, height).flat_map(|row| span(left, width).map(move |column| (row * width + column) as usize));
        let (mut near, mut far) = (f64::INFINITY, 0.0f64);
        for pixel in block() {
            let stored = self.distances.get(pixel);
            let stored = if stored.is_nan() { f64::INFINITY } else { stored };
            (near, far) = (near.min(stored), far.max(stored));
        }
        if far < HIDES * distance {
            return Some(false);
        }
        (near >= BEFORE * distance || self.is_plane(block(), p_world, eye)).then_some(true)
    }

    /// Whether the surface points of a block of pixels are in one plane with a point, and the plane is not seen edge-on.
    fn is_plane(&self, block: impl Iterator<Item = usize>, p_world: DVec3, eye: DVec3) -> bool {
        let shown = self.shown.get_or_init(|| self.all_points());
        let points: Vec<DVec3> = block.map(|pixel| shown[pixel]).collect();
        let side = 2 * AROUND as usize;
        if points.len() != side * side {
            return false;
        }
        let diagonals = [points[side * side - 1] - points[0], points[side * (side - 1)] - points[side - 1]];
        let Some(normal) = diagonals[0].cross(diagonals[1]).try_normalize() else { return false };
        let (middle, away) = (points.iter().sum::<DVec3>() / points.len() as f64, p_world - eye);
        let across = normal.dot(away).abs();
        let in_plane = |p: &DVec3| normal.dot(*p - middle).abs() <= PLANE * across;
        across > GRAZING * away.length() && points.iter().chain([&p_world]).all(in_plane)
    }

    fn all_points(&self) -> Vec<DVec3> {
        let width = self.view.camera().size()[0] as usize;
        let centre = |pixel: usize| ((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let point = |pixel: usize| self.point(centre(pixel).0, centre(pixel).1, pixel).unwrap_or(DVec3::NAN);
        (0..self.distances.len()).map(point).collect()
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
        assert!(worst(|stored| stored.shares[1] *= 0.7) > Law::Covisibility.spec().bound, "less than is seen for sure");
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
            let listed = Listed::new(CameraView::still(&camera, &pose), frame.get(Layer::DepthMeters).unwrap().clone());
            let points: Vec<Shown> =
                listed.points(8).iter().map(|(y, part, p)| (*y, *part, pose.position + (*p - pose.position) * scale)).collect();
            let certain = listed.certain((&points, BodyPlaces::default()));
            [certain.seen, certain.unseen, points.len()].map(|n| n as f64)
        };
        let [seen, unseen, all] = of(&frame, 1.0);
        assert!(seen > 0.7 * all && unseen == 0.0, "in the planes of floor and wall: {seen} of {all}");
        let [seen, unseen, _] = of(&frame, 0.9);
        assert!(seen > 0.7 * all && unseen == 0.0, "before the surfaces: {seen} of {all}");
        let [seen, unseen, _] = of(&frame, 1.5);
        assert!(unseen > 0.9 * all && seen == 0.0, "behind them: {unseen} of {all}");
        // One far pixel in every four by four leaves all open that is not before it.
        for pixel in (0..64 * 48).filter(|i| i % 64 % 4 == 2 && i / 64 % 4 == 2) {
            testroom::set(&mut frame, Layer::DepthMeters, pixel, &[1e3]);
        }
        let listed = Listed::new(CameraView::still(&camera, &pose), frame.get(Layer::DepthMeters).unwrap().clone());
        assert_eq!(listed.surely_seen(pose.position + 9.0 * (pose.look_at - pose.position)), None);
    }
}

//! Two views of one scene must show the same surfaces where both see them.
//!
//! Each pixel of one frame is carried into the other by distance, calibration and pose, and with what it shows where that moves. There it is between four pixel centres, which a
//! smooth surface passes at their stored distances. There are three cases. It is beyond them, and something hides it. It is between them,
//! and then part, instance and diffuse reflectance must be the same. Or it is in front of them, so that the second frame looks through a
//! surface that the first one sees. Checked in both directions, these are all possible contradictions.
//!
//! The tolerance is only the uncertainty of the samples. The span of the four distances is the slope of the surface over a pixel, and its
//! curvature follows from the neighbours that were carried along. Relief finer than a pixel may, where the normals turn at all, be half a
//! pixel deep and as near as the pixels around show it. The rest is float32. Pixels are compared where both frames resolve the surface: the
//! pixels around are of one part, their normals turn by less than 30 degrees, their images are evenly spaced, and a pixel of the second
//! frame covers at most two of the first, which excludes edges, pleats and things that fall between the samples. A surface that is seen
//! from behind in the second frame may be another part there: the other side of something thin, such as the lid behind a screen. Surfaces
//! with opacity or holes have no reflectance of their own, because a part of it belongs to the surfaces behind.

use super::card::Card;
use super::law::Law;
use super::rounding::Rounding;
use enfilade_dataset::BodyPlaces;
use enfilade_frame::vector;
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::{DMat2, DVec2, DVec3};
use enfilade_scene::CameraView;
use serde::{Deserialize, Serialize};

/// The layers that are compared.
pub(super) const COMPARED: [Layer; 5] =
    [Layer::DepthMeters, Layer::NormalWorld, Layer::RenderEntityId, Layer::SemanticInstance, Layer::DiffuseReflectance];

/// Pixels around a pixel that must be of its part, and the most of them that a pixel of the other frame may cover.
const REACH: usize = 2;
/// Depth of relief that may fall between the samples, pixels: pleats, grooves, leaves.
const RELIEF_PX: f64 = 0.5;
/// Images of pixels in a row are evenly spaced if the middle one is off by less than half a pixel.
const EVEN_PX: f64 = 0.5;
/// Cosine of the largest angle between normals of adjacent pixels without a fold between them: 30 degrees.
const UNFOLDED: f64 = 0.866;
/// Cosine of that angle where the surface is flat: one degree.
const FLAT: f64 = 0.99985;
/// Rounding of float32 in vertices, distances and directions, each half a unit in the last place, with room for slanted triangles.
const ROUNDING: f64 = 1e-6;
/// Reflectances are stored as float16, and averages over pixels are sums of a few samples.
const REFLECTANCE_ROUNDING: f64 = 1.0 / 512.0;
/// Least number of compared pixels for a statement about a pair.
const FEWEST: u64 = 256;
/// Number of pixels of a pair that may disagree because a leaf or a fold is finer than a pixel though all samples around are of one part.
/// It matters only for small pictures, where the bounds are a pixel or two.
const BETWEEN_SAMPLES: u64 = 12;
/// A point counts as seen by the other frame if the surface shown there is at least at this share of its distance.
const SEEN: f64 = 0.99;

/// A frame for comparison with others.
pub(super) struct Sight<'a> {
    pub frame: &'a Frame,
    /// The frame's camera and pose.
    pub view: CameraView<'a>,
    /// How its distances were rounded.
    pub rounding: Rounding,
    /// By part: true if its reflectance partly belongs to the surfaces behind it, which each view shows at another place.
    pub partly_there: &'a [bool],
    /// Where what moves is in the frame.
    pub places: BodyPlaces<'a>,
}

/// Result of the comparison of two frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairValues {
    /// Name of the scene.
    pub scene: String,
    /// Camera and frame number of the first.
    pub first: (String, u32),
    /// Camera and frame number of the second.
    pub second: (String, u32),
    /// Share of the first one's surface points that the second sees; `None` when it has none.
    pub overlap: Option<f64>,
    /// Pixels of both whose distances were compared, and how many of them the other frame looks through.
    pub distance: Compared,
    /// Pixels whose part and instance were compared, and how many differ.
    pub ids: Compared,
    /// Pixels whose diffuse reflectance was compared, and how many differ.
    pub reflectance: Compared,
}

/// A number of pixels that were compared, and how many disagree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "plain words")]
pub struct Compared {
    pub pixels: u64,
    pub disagree: u64,
}

impl PairValues {
    /// The largest share of disagreeing pixels.
    pub fn worst_share(&self) -> f64 {
        [self.distance, self.ids, self.reflectance].map(Compared::share).into_iter().fold(0.0, f64::max)
    }
}

impl Compared {
    /// Share of the pixels that disagree, except for the few that things between the samples explain.
    fn share(self) -> f64 {
        self.disagree.saturating_sub(BETWEEN_SAMPLES) as f64 / self.pixels.max(1) as f64
    }

    fn count(&mut self, disagrees: bool) {
        self.pixels += 1;
        self.disagree += u64::from(disagrees);
    }

    fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.disagree += other.disagree;
    }
}

/// Compares two frames of `scene` in both directions. Frames without distances or part numbers, or of another size than their camera's,
/// have nothing to compare.
pub(super) fn compare(scene: &str, names: [(&str, u32); 2], sights: [&Sight<'_>; 2], card: &mut Card) -> Option<PairValues> {
    let [a, b] = [Raster::new(sights[0])?, Raster::new(sights[1])?];
    let (there, back) = (a.compare_with(&b), b.compare_with(&a));
    let mut sum = there.clone();
    for (sum, back) in [(&mut sum.distance, back.distance), (&mut sum.ids, back.ids), (&mut sum.reflectance, back.reflectance)] {
        sum.add(back);
    }
    let [first, second] = names.map(|(camera, frame)| (camera.to_string(), frame));
    for (law, compared, faults) in [
        (Law::TwoViewDistance, sum.distance, [&there.first_faults[0], &back.first_faults[0]]),
        (Law::TwoViewIds, sum.ids, [&there.first_faults[1], &back.first_faults[1]]),
        (Law::TwoViewReflectance, sum.reflectance, [&there.first_faults[2], &back.first_faults[2]]),
    ] {
        if compared.pixels < FEWEST {
            continue;
        }
        card.observe(law, compared.share(), || {
            let which = if faults[0].is_some() { [&first, &second] } else { [&second, &first] };
            let what = faults.into_iter().flatten().next().map_or(String::new(), |what| format!(": {what}"));
            let [from, to] = which.map(|(camera, frame)| format!("{camera}/frame.{frame:04}"));
            format!("{scene}/{from} in {to}, {} of {} pixels{what}", compared.disagree, compared.pixels)
        });
    }
    let overlap = (there.of_surfaces > 0).then(|| there.seen as f64 / there.of_surfaces as f64);
    Some(PairValues { scene: scene.into(), first, second, overlap, distance: sum.distance, ids: sum.ids, reflectance: sum.reflectance })
}

/// One frame of a comparison.
struct Raster<'a> {
    width: usize,
    height: usize,
    view: CameraView<'a>,
    rounding: Rounding,
    distance: &'a Values,
    /// By pixel, unit length; (0, 0, 0) where there is none.
    normals: Option<Vec<DVec3>>,
    ids: &'a Values,
    instances: Option<&'a Values>,
    /// Part and instance that each pixel shows; without instances 0 for these.
    shown: Vec<(i16, i16)>,
    /// Only of cameras in focus and at rest: lens and shutter blur it.
    reflectance: Option<&'a Values>,
    partly_there: &'a [bool],
    places: BodyPlaces<'a>,
}

/// Result of one direction.
#[derive(Clone, Default)]
struct Direction {
    distance: Compared,
    ids: Compared,
    reflectance: Compared,
    of_surfaces: u64,
    seen: u64,
    /// The first contradiction of each kind.
    first_faults: [Option<String>; 3],
}

/// A surface point, its image in the other frame, and its distance from that camera, both in metres.
#[derive(Clone, Copy)]
struct Image {
    point: DVec3,
    at: DVec2,
    distance: f64,
}

/// A pixel's image with data derived from the pixels around it.
struct Carried {
    image: Image,
    /// How far the surface may leave the plane between the images: second differences of the distance, and relief.
    bend: f64,
    /// Pixels of the other frame per pixel here.
    jacobian: DMat2,
}

impl<'a> Raster<'a> {
    fn new(sight: &Sight<'a>) -> Option<Self> {
        let frame = sight.frame;
        let camera = sight.view.camera();
        let sharp = camera.lens.is_none() && camera.shutter.is_none();
        (camera.size() == [frame.width, frame.height]).then_some(())?;
        let (ids, instances) = (frame.get(Layer::RenderEntityId)?, frame.get(Layer::SemanticInstance));
        let shown = |pixel: usize| (ids.get(pixel) as i16, instances.map_or(0, |instances| instances.get(pixel) as i16));
        Some(Self {
            width: frame.width as usize,
            height: frame.height as usize,
            view: sight.view,
            rounding: sight.rounding,
            distance: frame.get(Layer::DepthMeters)?,
            normals: frame
                .get(Layer::NormalWorld)
                .map(|values| (0..frame.pixels()).map(|i| vector(values, i).normalize_or_zero()).collect()),
            ids,
            instances,
            shown: (0..frame.pixels()).map(shown).collect(),
            reflectance: frame.get(Layer::DiffuseReflectance).filter(|_| sharp),
            partly_there: sight.partly_there,
            places: sight.places,
        })
    }

    fn compare_with(&self, other: &Raster<'_>) -> Direction {
        let images = self.images(other);
        let mut found = Direction::default();
        for pixel in 0..images.len() {
            if self.ids.get(pixel) == -1.0 {
                continue;
            }
            found.of_surfaces += 1;
            let Some(image) = images[pixel] else { continue };
            let Some(cell) = other.cell(image.at) else { continue };
            let farthest = cell.iter().map(|&k| other.distance.get(k)).fold(0.0, f64::max);
            found.seen += u64::from(image.distance * SEEN <= farthest);
            if let Some(carried) = self.carried(&images, pixel) {
                self.judge(other, pixel, &carried, &cell, &mut found);
            }
        }
        found
    }

    /// The image of each pixel's surface point in the other camera.
    fn images(&self, other: &Raster<'_>) -> Vec<Option<Image>> {
        let image = |pixel: usize| {
            let (x, y) = ((pixel % self.width) as f64 + 0.5, (pixel / self.width) as f64 + 0.5);
            let distance = self.distance.get(pixel);
            let ray = self.view.centre_ray(x, y).filter(|_| self.ids.get(pixel) != -1.0 && distance.is_finite())?;
            let p = ray.origin + ray.direction * distance;
            other.see(self.places.carry_to(y, (&other.places, &other.view), self.ids.get(pixel) as i64, p)?)
        };
        (0..self.width * self.height).map(image).collect()
    }

    /// The image of a point; with a rolling shutter, as the row that sees it does.
    fn see(&self, p: DVec3) -> Option<Image> {
        let at = self.view.project(p)?;
        let distance = self.view.row_placement(at.1).0.distance(p);
        Some(Image { point: p, at: DVec2::new(at.0, at.1), distance })
    }

    /// The four pixels whose centres are around an image point; `None` beyond the outermost centres.
    fn cell(&self, at: DVec2) -> Option<[usize; 4]> {
        let corner = (at - 0.5).floor();
        let inside = corner.x >= 0.0 && corner.y >= 0.0 && corner.x + 1.0 < self.width as f64 && corner.y + 1.0 < self.height as f64;
        let first = inside.then(|| corner.y as usize * self.width + corner.x as usize)?;
        Some([first, first + 1, first + self.width, first + self.width + 1])
    }

    /// The image of the surface of `pixel` with data derived from the pixels around; `None` if they do not all show one even surface.
    fn carried(&self, images: &[Option<Image>], pixel: usize) -> Option<Carried> {
        if !self.is_of_one_part(pixel) {
            return None;
        }
        let [image, left, right, up, down] =
            [pixel, pixel - REACH, pixel + REACH, pixel - REACH * self.width, pixel + REACH * self.width].map(|k| images[k]);
        let (image, left, right, up, down) = (image?, left?, right?, up?, down?);
        let off = |a: Image, b: Image| 0.5 * (a.at + b.at) - image.at;
        if off(left, right).abs().max_element().max(off(up, down).abs().max_element()) >= EVEN_PX {
            return None;
        }
        let bend = |a: Image, b: Image| (a.distance + b.distance - 2.0 * image.distance).abs();
        let per_pixel = 1.0 / (2 * REACH) as f64;
        let jacobian = DMat2::from_cols((right.at - left.at) * per_pixel, (down.at - up.at) * per_pixel);
        let inverse = jacobian.inverse();
        let resolved = inverse.is_finite() && largest_row(&inverse) <= REACH as f64;
        let step = [left, right, up, down].map(|beside| beside.point.distance(image.point)).into_iter().fold(0.0, f64::max) / REACH as f64;
        let alike = self.least_cosine(pixel);
        let relief = if alike < FLAT { RELIEF_PX * step } else { 0.0 };
        let bend = bend(left, right) + bend(up, down) + relief;
        (resolved && alike >= UNFOLDED).then_some(Carried { image, bend, jacobian })
    }

    /// Least distance of a pixel's surface among the pixels around that show it too, because a pleat may be between any two; infinite where
    /// it is flat.
    fn nearest_relief(&self, pixel: usize) -> f64 {
        let around = || self.around(pixel).filter(|&k| self.shown[k] == self.shown[pixel]);
        let turns = |k: usize| self.normals.as_ref().is_some_and(|normals| normals[pixel].dot(normals[k]) < FLAT);
        if around().any(turns) { around().map(|k| self.distance.get(k)).fold(f64::INFINITY, f64::min) } else { f64::INFINITY }
    }

    /// Cosine of the largest angle between a pixel's normal and those around it; 1 without normals.
    fn least_cosine(&self, pixel: usize) -> f64 {
        let Some(normals) = &self.normals else { return 1.0 };
        self.around(pixel).map(|k| normals[pixel].dot(normals[k])).fold(1.0, f64::min)
    }

    /// Whether all pixels around are there and of the pixel's part, and of the same piece of it if it was cut.
    fn is_of_one_part(&self, pixel: usize) -> bool {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let inside = x >= REACH && y >= REACH && x + REACH < self.width && y + REACH < self.height;
        inside && self.around(pixel).all(|k| self.shown[k] == self.shown[pixel])
    }

    /// The pixels at most `REACH` from one, itself among them.
    fn around(&self, pixel: usize) -> impl Iterator<Item = usize> {
        let (x, y, width) = (pixel % self.width, pixel / self.width, self.width);
        let span = |at: usize, side: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(side);
        let columns = span(x, width);
        span(y, self.height).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// Compares a pixel with the four of the other frame around its image.
    fn judge(&self, other: &Raster<'_>, pixel: usize, carried: &Carried, cell: &[usize; 4], found: &mut Direction) {
        let id = other.ids.get(cell[0]);
        if id == -1.0 || cell.iter().any(|&k| other.shown[k] != other.shown[cell[0]]) {
            return;
        }
        let shown = cell.map(|k| other.distance.get(k));
        let (least, most) = shown.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &d| (a.min(d), b.max(d)));
        let distance = carried.image.distance;
        // Both distances are rounded, and the first moves the image too, which counts as often again at slants of 45 degrees and less.
        let halves = 2.0 * (self.rounding.of_distance(self.distance.get(pixel)) + other.rounding.of_distance(most));
        let open = carried.bend + ROUNDING * (distance + self.view.pose().position.length()) + halves;
        if distance > most + open {
            return; // hidden
        }
        let is_before = |surface: f64| distance < surface - open;
        let seen_through = is_before(least) && is_before(other.nearest_relief(cell[0]));
        found.distance.count(seen_through);
        let at = || format!("pixel ({}, {}), part {}", pixel % self.width, pixel / self.width, self.ids.get(pixel));
        if seen_through {
            found.first_faults[0].get_or_insert_with(|| format!("{} at {distance:.4} m before part {id} at {least:.4} m", at()));
            return;
        }
        let instances = self.instances.zip(other.instances);
        let differ = self.ids.get(pixel) != id || instances.is_some_and(|(mine, others)| mine.get(pixel) != others.get(cell[0]));
        if differ && self.faces_away(other, pixel, &carried.image) {
            return; // the other side of something that is thinner than the samples resolve
        }
        found.ids.count(differ);
        if differ {
            found.first_faults[1].get_or_insert_with(|| format!("{} is part {id} there", at()));
            return;
        }
        let is_partly_there = (id as usize).checked_sub(1).and_then(|part| self.partly_there.get(part)).is_some_and(|&is| is);
        if is_partly_there || largest_row(&carried.jacobian) > REACH as f64 {
            return;
        }
        if let Some([mine, others]) = self.reflectances(other, pixel, carried.image.at) {
            let apart = (0..3).any(|c| mine[c][0] > others[c][1] || others[c][0] > mine[c][1]);
            found.reflectance.count(apart);
            if apart {
                found.first_faults[2].get_or_insert_with(|| format!("{} has {mine:.3?}, there {others:.3?}", at()));
            }
        }
    }

    /// Whether the surface of a pixel turns its back to the other camera; not known without normals.
    fn faces_away(&self, other: &Raster<'_>, pixel: usize, image: &Image) -> bool {
        let to_other = other.view.row_placement(image.at.y).0 - image.point;
        let turned = |normal: DVec3| {
            let [here, there] = [&self.places, &other.places].map(|places| places.world_from_rest(self.ids.get(pixel) as i64));
            here.zip(there).map_or(normal, |(here, there)| there.transform_vector3(here.inverse().transform_vector3(normal)))
        };
        self.normals.as_ref().is_some_and(|normals| turned(normals[pixel]).dot(to_other) < 0.0)
    }

    /// The least and greatest reflectance around a pixel and around its image, by channel. Each of the two regions contains a whole pixel
    /// of the other frame, so the mean there is between the extremes here. `None` if a region is not of one part.
    fn reflectances(&self, other: &Raster<'_>, pixel: usize, at: DVec2) -> Option<[[[f64; 2]; 3]; 2]> {
        let (mine, others) = (self.reflectance?, other.reflectance?);
        let there = at.y as usize * other.width + at.x as usize;
        other.is_of_one_part(there).then(|| [self.extremes(mine, pixel), other.extremes(others, there)])
    }

    fn extremes(&self, values: &Values, pixel: usize) -> [[f64; 2]; 3] {
        let mut extremes = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for k in self.around(pixel) {
            for (c, [least, most]) in extremes.iter_mut().enumerate() {
                let value = values.get(3 * k + c);
                (*least, *most) = (least.min(value * (1.0 - REFLECTANCE_ROUNDING)), most.max(value * (1.0 + REFLECTANCE_ROUNDING)));
            }
        }
        extremes
    }
}

/// Largest change of one coordinate by a step of one pixel in both directions.
fn largest_row(m: &DMat2) -> f64 {
    (m.x_axis.abs() + m.y_axis.abs()).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::DMat3;
    use enfilade_scene::{Camera, Pose, Shutter};
    use enfilade_testroom as testroom;

    /// Two views of the analytic corner, and their stated cameras.
    struct Case {
        frames: [Frame; 2],
        poses: [Pose; 2],
        camera: Camera,
        partly_there: Vec<bool>,
    }

    impl Case {
        fn new() -> Self {
            let pose = |frame, x: f64, y: f64| {
                let from = DVec3::new(x, y, 1.5);
                Pose::look_at(frame, from, DVec3::new(-0.2, 1.0, 1.0), DVec3::new(0.02, 0.0, 1.0)).unwrap()
            };
            let poses = [pose(0, 0.3, -3.0), pose(1, 1.1, -2.6)];
            let frames = [0, 1].map(|i| testroom::frame(&poses[i]));
            Self { frames, poses, camera: testroom::intrinsics().into(), partly_there: Vec::new() }
        }

        fn compare(&self) -> (PairValues, Card) {
            let mut card = Card::default();
            let values = compare("room", [("cam_00", 0), ("cam_00", 1)], [&self.sight(0), &self.sight(1)], &mut card).unwrap();
            (values, card)
        }

        fn sight(&self, i: usize) -> Sight<'_> {
            let view = CameraView::still(&self.camera, &self.poses[i]);
            Sight {
                frame: &self.frames[i],
                view,
                rounding: Rounding::default(),
                partly_there: &self.partly_there,
                places: BodyPlaces::default(),
            }
        }
    }

    /// The laws that fail after `change`.
    fn failures(change: impl Fn(&mut Case)) -> Vec<Law> {
        let mut case = Case::new();
        change(&mut case);
        case.compare().1.failures()
    }

    /// Rewrites a layer of a frame, value by value.
    fn map(frame: &mut Frame, layer: Layer, change: impl Fn(f64) -> f64) {
        let old = frame.get(layer).unwrap();
        let new = (0..old.len()).map(|i| change(old.get(i))).collect();
        frame.insert(layer, testroom::store(layer, new));
    }

    #[test]
    fn two_views_of_one_room_agree() {
        let (values, card) = Case::new().compare();
        assert_eq!(card.failures(), []);
        assert!(values.distance.pixels > 1000 && values.ids.pixels > 1000 && values.reflectance.pixels > 500, "{values:?}");
        assert_eq!([values.distance, values.ids, values.reflectance].map(|compared| compared.disagree), [0; 3]);
        assert!(values.overlap.is_some_and(|share| (0.5..1.0).contains(&share)), "{values:?}");
    }

    #[test]
    fn wrong_poses_units_and_axes_are_found() {
        assert_eq!(failures(|c| c.poses[1].position.y += 0.1), [Law::TwoViewDistance]);
        // Along the wall only the mirror reveals a shift.
        assert_eq!(failures(|c| c.poses[1].position.x += 0.8), [Law::TwoViewIds]);
        assert_eq!(failures(|c| c.poses[1].world_from_camera *= DMat3::from_rotation_y(0.05)), [Law::TwoViewDistance]);
        let axis = |c: &mut Case| c.poses[1].world_from_camera *= DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
        assert!(failures(axis).contains(&Law::TwoViewDistance));
        let planar = |c: &mut Case| {
            for frame in &mut c.frames {
                let z = frame.get(Layer::DepthZMeters).unwrap().clone();
                frame.insert(Layer::DepthMeters, z);
            }
        };
        assert_eq!(failures(planar), [Law::TwoViewDistance]);
        for unit in [0.5, 0.9, 1.1, 1000.0] {
            let scaled = |c: &mut Case| c.frames.iter_mut().for_each(|frame| map(frame, Layer::DepthMeters, |d| unit * d));
            assert!(failures(scaled).contains(&Law::TwoViewDistance), "{unit}");
        }
    }

    #[test]
    fn other_parts_and_reflectances_are_found() {
        assert_eq!(failures(|c| map(&mut c.frames[1], Layer::RenderEntityId, |id| if id == 1.0 { 2.0 } else { id })), [Law::TwoViewIds]);
        assert_eq!(failures(|c| map(&mut c.frames[0], Layer::SemanticInstance, |id| if id == -1.0 { 7.0 } else { id })), [Law::TwoViewIds]);
        let darker = |c: &mut Case| map(&mut c.frames[1], Layer::DiffuseReflectance, |a| 0.9 * a);
        assert_eq!(failures(darker), [Law::TwoViewReflectance]);
        let of_nets = |c: &mut Case| {
            darker(c);
            c.partly_there = vec![true; 2];
        };
        assert_eq!(failures(of_nets), [], "what is behind a net is another thing in every view");
    }

    /// The frame of a camera before a wall in pleats of that width and depth, metres.
    fn pleats(pose: &Pose, camera: &Camera, [width, depth]: [f64; 2]) -> Frame {
        let (turn, height) = (std::f64::consts::TAU / width, 0.5 * depth);
        let (mut distances, mut normals) = (Vec::new(), Vec::new());
        for pixel in 0..64 * 48 {
            let ray = CameraView::still(camera, pose).centre_ray(f64::from(pixel % 64) + 0.5, f64::from(pixel / 64) + 0.5).unwrap();
            let depth = |t: f64| 2.0 + height * (turn * (ray.origin.x + t * ray.direction.x)).sin();
            let distance = (0..100).fold(0.0, |t, _| 0.5 * (t + (depth(t) - ray.origin.y) / ray.direction.y));
            let slope = height * turn * (turn * (ray.origin.x + distance * ray.direction.x)).cos();
            distances.push(distance);
            normals.extend(DVec3::new(slope, -1.0, 0.0).normalize().to_array());
        }
        let mut frame = Frame::new(64, 48);
        let ids = vec![1.0; distances.len()];
        for (layer, values) in [(Layer::DepthMeters, distances), (Layer::NormalWorld, normals), (Layer::RenderEntityId, ids)] {
            frame.insert(layer, testroom::store(layer, values));
        }
        frame
    }

    #[test]
    fn pleats_that_fall_between_the_samples_are_no_contradiction() {
        for size in [[0.15, 0.02], [0.1, 0.12], [0.13, 0.12]] {
            let mut case = Case::new();
            case.frames = [0, 1].map(|i| pleats(&case.poses[i], &case.camera, size));
            let (values, card) = case.compare();
            assert_eq!(card.failures(), [], "{size:?}: {values:?}");
            assert!(values.distance.pixels > 300 && values.distance.disagree == 0, "{size:?}: {values:?}");
        }
    }

    /// The frame of a camera before a plate 2 mm thick, whose front is part 1 and whose back is part 2, or the other way around.
    fn plate(pose: &Pose, camera: &Camera, in_order: bool) -> Frame {
        let (mut distances, mut normals, mut ids) = (Vec::new(), Vec::new(), Vec::new());
        let is_front = pose.position.y < 0.0;
        let (y, normal) = if is_front { (0.0, DVec3::NEG_Y) } else { (0.002, DVec3::Y) };
        for pixel in 0..64 * 48 {
            let ray = CameraView::still(camera, pose).centre_ray(f64::from(pixel % 64) + 0.5, f64::from(pixel / 64) + 0.5).unwrap();
            let distance = (y - ray.origin.y) / ray.direction.y;
            let is_hit = distance > 0.0;
            distances.push(if is_hit { distance } else { f64::NAN });
            normals.extend(if is_hit { normal } else { DVec3::NAN }.to_array());
            let id = if is_front == in_order { 1.0 } else { 2.0 };
            ids.push(if is_hit { id } else { -1.0 });
        }
        let mut frame = Frame::new(64, 48);
        for (layer, values) in [(Layer::DepthMeters, distances), (Layer::NormalWorld, normals), (Layer::RenderEntityId, ids)] {
            frame.insert(layer, testroom::store(layer, values));
        }
        frame
    }

    #[test]
    fn the_other_side_of_a_thin_thing_may_be_another_part_and_the_same_side_may_not() {
        let from = |frame, x: f64, y: f64| Pose::look_at(frame, DVec3::new(x, y, 1.5), DVec3::new(0.0, 0.0, 1.5), DVec3::Z).unwrap();
        let mut case = Case::new();
        case.poses = [from(0, 1.5, -0.7), from(1, 1.5, 0.7)];
        case.frames = [0, 1].map(|i| plate(&case.poses[i], &case.camera, true));
        assert_eq!(case.compare().1.failures(), []);
        case.poses[1] = from(1, 1.4, -0.8);
        case.frames[1] = plate(&case.poses[1], &case.camera, false);
        assert_eq!(case.compare().1.failures(), [Law::TwoViewIds]);
    }

    /// The frame of a view of an empty room of 6 × 6 × 3 m, whose sides are its parts.
    fn room(view: &CameraView<'_>) -> Frame {
        let (low, high) = (DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, 3.0, 3.0));
        let (mut distances, mut ids) = (Vec::new(), Vec::new());
        for pixel in 0..64 * 48 {
            let ray = view.centre_ray(f64::from(pixel % 64) + 0.5, f64::from(pixel / 64) + 0.5).unwrap();
            let far = DVec3::select(ray.direction.cmpgt(DVec3::ZERO), high, low);
            let to_sides = (far - ray.origin) / ray.direction;
            let axis = (0..3usize).min_by(|&a, &b| to_sides[a].total_cmp(&to_sides[b])).unwrap();
            distances.push(to_sides[axis]);
            ids.push((1 + 2 * axis + usize::from(ray.direction[axis] > 0.0)) as f64);
        }
        let mut frame = Frame::new(64, 48);
        for (layer, values) in [(Layer::DepthMeters, distances), (Layer::RenderEntityId, ids)] {
            frame.insert(layer, testroom::store(layer, values));
        }
        frame
    }

    #[test]
    fn frames_of_a_rolling_shutter_agree_however_fast_the_camera_turns() {
        let shutter = Shutter { exposure_s: 0.01, readout_s: 0.03, frame_time_s: 1.0 / 30.0 };
        let camera = Camera { shutter: Some(shutter), ..testroom::intrinsics().into() };
        for pitch_deg in [-30f64, -45.0] {
            let poses = [0u32, 1].map(|frame| {
                let (sin, cos) = (pitch_deg.to_radians() * f64::from(frame)).sin_cos();
                let position = DVec3::new(0.2, -1.0, 1.6) + f64::from(frame) * DVec3::new(0.05, 0.02, 0.01);
                Pose::look_at(frame, position, position + DVec3::new(0.0, cos, sin), DVec3::Z).unwrap()
            });
            let views = [0, 1].map(|index| CameraView::of_frame(&camera, &poses, index));
            let frames = [room(&views[0]), room(&views[1])];
            let sight = |i: usize| Sight {
                frame: &frames[i],
                view: views[i],
                rounding: Rounding::default(),
                partly_there: &[],
                places: BodyPlaces::default(),
            };
            let mut card = Card::default();
            let values = compare("room", [("cam_00", 0), ("cam_00", 1)], [&sight(0), &sight(1)], &mut card).unwrap();
            assert_eq!(card.failures(), [], "{pitch_deg}: {values:?}");
            assert!(values.distance.pixels > 1500 && values.distance.disagree == 0, "{pitch_deg}: {values:?}");
        }
    }

    #[test]
    fn what_is_hidden_is_no_contradiction() {
        let board = |c: &mut Case| {
            // Something before the second camera, not seen by the first.
            map(&mut c.frames[1], Layer::DepthMeters, |_| 1.5);
            map(&mut c.frames[1], Layer::RenderEntityId, |_| 3.0);
        };
        let mut case = Case::new();
        board(&mut case);
        let there = {
            let [a, b] = [case.sight(0), case.sight(1)];
            Raster::new(&a).unwrap().compare_with(&Raster::new(&b).unwrap())
        };
        assert_eq!((there.distance.pixels, there.seen), (0, 0));
        // But the first camera looks through it.
        assert_eq!(case.compare().1.failures(), [Law::TwoViewDistance]);
    }
}

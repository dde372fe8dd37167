//! Gates that need only geometry layers: what a view shows, independent of its light.

use super::{Gate, GateValues};
use enfilade_frame::vector;
use enfilade_frame::{Frame, Layer};
use enfilade_math::DVec3;

/// Columns of the lattice of pixels whose planes are compared; rows follow from the shape of the image. A share is known to about a
/// hundredth, since a plane's border cuts at most a few cells per row.
const COLUMNS: usize = 64;

/// Points are in one plane if the cosine between their normals is at least this (1.8 degrees), and each is this near to the plane of the
/// other, in metres: coarser than float16 stores a normal, finer than a picture or carpet is thick.
const SAME_NORMAL: f64 = 0.9995;
const SAME_OFFSET_M: f64 = 0.01;

/// Error of a direction whose parts are stored as float16, per metre across: half a unit in the last place of three values near 1.
const NORMAL_ROUNDING: f64 = 4.3e-4;

/// The values of [`Gate::DepthRange`], [`Gate::InvalidShare`] and [`Gate::PlaneShare`], as far as the layers are there.
///
/// In `seeing` of the pixels the camera sees at all; the others, as those outside of a fisheye's image circle, count for nothing.
pub fn view_values(frame: &Frame, seeing: usize) -> GateValues {
    let mut values = GateValues::new();
    let seeing = seeing.max(1) as f64;
    let depth = frame.get(Layer::DepthZMeters).or(frame.get(Layer::DepthMeters));
    if let (Some(depth), Some(ids)) = (depth, frame.get(Layer::RenderEntityId)) {
        let good: Vec<f64> = (0..ids.len()).filter(|&i| ids.get(i) != -1.0 && depth.get(i).is_finite()).map(|i| depth.get(i)).collect();
        values.insert(Gate::InvalidShare, (1.0 - good.len() as f64 / seeing).max(0.0));
        let (least, greatest) = good.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &d| (a.min(d), b.max(d)));
        values.insert(Gate::DepthRange, (greatest - least).max(0.0));
    }
    let of_seeing = frame.pixels() as f64 / seeing;
    values.extend(largest_plane_share(frame).map(|share| (Gate::PlaneShare, (share * of_seeing).min(1.0))));
    values
}

/// Share of the image that the largest plane fills, over all parts in it; `None` without positions or normals.
///
/// Normals are the triangles' where the frame has them, else the smooth ones.
pub fn largest_plane_share(frame: &Frame) -> Option<f64> {
    let normals = frame.get(Layer::NormalGeometricWorld).or(frame.get(Layer::NormalWorld))?;
    let positions = frame.get(Layer::Position)?;
    let (lattice, all) = lattice(frame);
    let point = |i: usize| PlanePoint { position_m: vector(positions, i), normal: vector(normals, i) };
    let mut rest: Vec<PlanePoint> = lattice.map(point).filter(|p| p.position_m.is_finite() && p.normal.is_finite()).collect();
    let mut largest = 0;
    while rest.len() > largest {
        let (of, before) = (rest[0], rest.len());
        rest.retain(|point| !of.is_coplanar(point));
        largest = largest.max(before - rest.len());
        if before == rest.len() {
            rest.remove(0); // a normal of length zero is on no plane, not even its own
        }
    }
    Some(largest as f64 / all as f64)
}

/// Pixels in rows and columns of even distance, and how many they are.
fn lattice(frame: &Frame) -> (impl Iterator<Item = usize>, usize) {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let step = width.div_ceil(COLUMNS).max(1);
    let (columns, rows) = (width.div_ceil(step), height.div_ceil(step));
    // In the middle of each cell, which the border may cut.
    let middle = move |cell: usize, size: usize| (cell * step + step / 2).min(size - 1);
    let pixels = (0..rows).flat_map(move |y| (0..columns).map(move |x| middle(y, height) * width + middle(x, width)));
    (pixels, columns * rows)
}

/// A point of a surface.
#[derive(Clone, Copy)]
struct PlanePoint {
    position_m: DVec3,
    normal: DVec3,
}

impl PlanePoint {
    fn is_coplanar(&self, other: &Self) -> bool {
        let step = other.position_m - self.position_m;
        let reach = SAME_OFFSET_M + NORMAL_ROUNDING * step.length();
        let near = |n: DVec3| step.dot(n).abs() <= reach;
        self.normal.dot(other.normal) >= SAME_NORMAL && near(self.normal) && near(other.normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_scene::Pose;
    use enfilade_testroom as testroom;

    /// The analytic corner from `from`, looking along `toward`.
    fn corner(from: DVec3, toward: DVec3) -> Frame {
        testroom::frame(&Pose::look_at(0, from, from + toward, DVec3::new(0.0, 0.1, 1.0)).unwrap())
    }

    fn share_of(frame: &Frame, holds: impl Fn(f64) -> bool) -> f64 {
        let ids = frame.get(Layer::RenderEntityId).unwrap();
        (0..ids.len()).filter(|&i| holds(ids.get(i))).count() as f64 / ids.len() as f64
    }

    #[test]
    fn floor_wall_and_void_are_measured() {
        let frame = testroom::frame(&testroom::pose());
        let values = view_values(&frame, frame.pixels());
        let void = share_of(&frame, |id| id == -1.0);
        assert!(void > 0.0 && (values[&Gate::InvalidShare] - void).abs() < 1e-12);
        // The mirror is in the wall's plane, like a picture on a wall.
        let plane = share_of(&frame, |id| id == 1.0).max(share_of(&frame, |id| id >= 2.0));
        assert!((values[&Gate::PlaneShare] - plane).abs() < 1e-12, "{values:?} {plane}");
        let depth = frame.get(Layer::DepthZMeters).unwrap();
        let depths = || (0..depth.len()).map(|i| depth.get(i)).filter(|d| d.is_finite());
        let range = depths().fold(0.0, f64::max) - depths().fold(f64::INFINITY, f64::min);
        assert!((values[&Gate::DepthRange] - range).abs() < 1e-12);
    }

    #[test]
    fn a_bare_floor_is_one_plane_of_no_depth() {
        let frame = corner(DVec3::new(0.0, -6.0, 1.5), DVec3::NEG_Z);
        let values = view_values(&frame, frame.pixels());
        assert_eq!((values[&Gate::PlaneShare], values[&Gate::InvalidShare]), (1.0, 0.0));
        assert!(values[&Gate::DepthRange] < 1e-6 && !Gate::DepthRange.passes(values[&Gate::DepthRange]), "{values:?}");
        assert!(!Gate::PlaneShare.passes(values[&Gate::PlaneShare]));
    }

    #[test]
    fn a_view_of_nothing_is_invalid_and_has_no_depth() {
        let frame = corner(DVec3::new(0.0, 0.0, 1.5), DVec3::Z);
        let values = view_values(&frame, frame.pixels());
        assert_eq!((values[&Gate::PlaneShare], values[&Gate::InvalidShare], values[&Gate::DepthRange]), (0.0, 1.0, 0.0));
    }

    #[test]
    fn large_images_are_measured_on_a_lattice() {
        let frame = Frame::new(1024, 768);
        let (pixels, count) = lattice(&frame);
        let pixels: Vec<usize> = pixels.collect();
        assert_eq!((pixels.len(), count), (64 * 48, 64 * 48));
        assert_eq!(pixels[..2], [8 * 1024 + 8, 8 * 1024 + 24]);
        assert_eq!(lattice(&Frame::new(3, 1)).0.collect::<Vec<_>>(), [0, 1, 2]);
    }
}

//! Boundaries where one surface ends in front of another.

use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::DVec3;
use enfilade_scene::{CameraRay, CameraView};

/// A neighbour within this fraction of the distance of one's own plane is on the same surface.
const JUMP: f64 = 0.03;

/// Codes of the layer `occlusion_boundary`, row by row.
pub(super) fn boundaries(view: &CameraView<'_>, frame: &Frame) -> Vec<u8> {
    let [width, height] = view.camera().size().map(i64::from);
    let layer = |layer: Layer| frame.get(layer).unwrap_or_else(|| panic!("the frame lacks {}", layer.spec().name));
    let (depth, normal): (&Values, &Values) = (layer(Layer::DepthMeters), layer(Layer::NormalWorld));
    let at = |x: i64, y: i64| {
        let pixel = (y * width + x) as usize;
        let CameraRay { origin, direction } = view.centre_ray(x as f64 + 0.5, y as f64 + 0.5)?;
        let normal = DVec3::from([0, 1, 2].map(|axis| normal.get(3 * pixel + axis)));
        Some(Seen { origin, direction, distance: depth.get(pixel), normal })
    };
    let code = |index: i64| {
        let (x, y) = (index % width, index / width);
        let Some(here) = at(x, y) else { return 0 };
        let neighbours = [(-1, 0), (1, 0), (0, -1), (0, 1)].map(|(dx, dy)| (x + dx, y + dy));
        let inside = |(x, y): &(i64, i64)| (0..width).contains(x) && (0..height).contains(y);
        let codes = neighbours.iter().filter(|p| inside(p)).filter_map(|&(x, y)| Some(here.beside(&at(x, y)?)));
        // Between two edges a pixel is near to one and far from the other: being in front counts.
        codes.filter(|code| *code > 0).min().unwrap_or(0)
    };
    enfilade_parallel::map_up_to((width * height) as usize, |pixel| code(pixel as i64))
}

/// The surface that one pixel shows.
struct Seen {
    origin: DVec3,
    direction: DVec3,
    /// NaN for nothing.
    distance: f64,
    normal: DVec3,
}

impl Seen {
    /// 1 when this is in front of its neighbour across a jump, 2 behind one, 0 where the surface continues.
    fn beside(&self, other: &Self) -> u8 {
        match (self.distance.is_nan(), other.distance.is_nan()) {
            (true, true) => 0,
            (true, false) => 2,
            (false, true) => 1,
            (false, false) if self.is_apart(other) => 1 + u8::from(self.distance > other.distance),
            (false, false) => 0,
        }
    }

    /// Whether there is a jump between the two: each is off the other's plane, and the two planes do not meet between them.
    fn is_apart(&self, other: &Self) -> bool {
        let (here, there) = (self.plane_along(other) - other.distance, other.plane_along(self) - self.distance);
        // Seen from its edge, a plane is anywhere.
        let off = |gap: f64, distance: f64| gap.is_nan() || gap.abs() > JUMP * distance;
        let meet = here * there > 0.0;
        off(here, other.distance) && off(there, self.distance) && !meet
    }

    /// Intersection of the plane at this point with the ray of another pixel.
    fn plane_along(&self, other: &Self) -> f64 {
        let p = self.origin + self.distance * self.direction;
        (p - other.origin).dot(self.normal) / other.direction.dot(self.normal)
    }
}

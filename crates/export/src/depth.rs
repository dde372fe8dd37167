//! Depth as other programs want it: planar, in millimetres, and 0 where there is none.

use crate::ExportError;
use crate::calibration::Calibration;
use crate::selected_frames::{SelectedFrames, View};
use enfilade_frame::{Frame, Layer};

/// The layers that depth is made from.
pub(crate) const DEPTH: [Layer; 2] = [Layer::DepthMeters, Layer::DepthZMeters];

/// Depth along the viewing axis of K for every pixel, metres; NaN where nothing was hit.
///
/// `depth_z_meters` where it is there and means this axis, else `depth_meters` (the distance along the ray, as in Hypersim) times
/// the cosine between the pixel's ray and the axis. `frame` has at least one of them.
pub(crate) fn planar_m(
    selected: &SelectedFrames<'_>,
    view: View<'_>,
    calibration: &Calibration,
    frame: &Frame,
) -> Result<Vec<f64>, ExportError> {
    if let (Some(depth_z), true) = (frame.get(Layer::DepthZMeters), calibration.is_straight()) {
        return Ok((0..depth_z.len()).map(|i| depth_z.get(i)).collect());
    }
    let distance = distance_m(selected, view, frame)?;
    let ray = |i: usize| pixel_ray(view, frame, i);
    Ok((0..frame.pixels()).map(|i| ray(i).map_or(f64::NAN, |ray| distance[i] * calibration.forward(ray))).collect())
}

/// Distance from the camera centre along the ray of every pixel, metres; NaN where nothing was hit.
pub(crate) fn distance_m(selected: &SelectedFrames<'_>, view: View<'_>, frame: &Frame) -> Result<Vec<f64>, ExportError> {
    let depth = frame.get(Layer::DepthMeters);
    let missing = || selected.unsuitable(view.name(), "it needs the layer depth_meters here; render it, or add it to --layers");
    let depth = depth.ok_or_else(missing)?;
    Ok((0..depth.len()).map(|i| depth.get(i)).collect())
}

/// The ray of pixel `i` in the camera's space.
fn pixel_ray(view: View<'_>, frame: &Frame, i: usize) -> Option<enfilade_math::DVec3> {
    let (x, y) = (i % frame.width as usize, i / frame.width as usize);
    view.track.camera.projection.ray(x as f64 + 0.5, y as f64 + 0.5)
}

/// Metres to the nearest whole millimetre of a 16-bit picture; 0 for NaN, infinity, what is not in front of the camera, and what
/// is beyond 65.535 m.
pub(crate) fn millimetres(depth_m: f64) -> u16 {
    whole_units(depth_m, 1000.0)
}

/// A depth in units of which `per_metre` make a metre, as [`millimetres`].
pub(crate) fn whole_units(depth_m: f64, per_metre: f64) -> u16 {
    let units = (depth_m * per_metre).round();
    if units > 0.0 && units <= f64::from(u16::MAX) { units as u16 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn millimetres_are_rounded_and_what_cannot_be_said_is_zero() {
        assert_eq!([1.2344, 1.2346, 0.0006, 65.535].map(millimetres), [1234, 1235, 1, 65535]);
        assert_eq!([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0004, 65.536].map(millimetres), [0; 6]);
    }
}

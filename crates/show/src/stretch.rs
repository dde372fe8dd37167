//! Layers whose values are stretched over a range to be visible: depth, position, flow.
//!
//! A range extends from the 1st percentile of the finite values to the 99th, of one frame, or of several for pictures that are shown one
//! after the other.

use crate::palette::{direction_color, viridis};
use crate::picture::{Preview, byte, from_pixels};
use enfilade_frame::{Frame, Layer, Values};
use enfilade_math::quantile;

/// The kind of value that is stretched in a layer, pixel by pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// One number, in colours from dark to bright.
    Length,
    /// Three numbers, as red, green and blue.
    Vector,
    /// A direction in the image as hue, and how far as saturation.
    Flow,
}

/// The range of each number that a layer shows; `None` when no value is finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch(Vec<Option<[f64; 2]>>);

const fn kind(layer: Layer) -> Option<Kind> {
    match layer {
        Layer::DepthMeters | Layer::DepthZMeters | Layer::DepthBehindMeters | Layer::DepthBeyondMeters => Some(Kind::Length),
        Layer::Position | Layer::SceneFlow => Some(Kind::Vector),
        Layer::OpticalFlow => Some(Kind::Flow),
        _ => None,
    }
}

/// True for layers that are stretched.
pub const fn is_stretched(layer: Layer) -> bool {
    kind(layer).is_some()
}

/// The values that a stretched layer shows for every `step`-th pixel: one list of finite values per component.
pub fn shown_values(layer: Layer, values: &Values, step: usize) -> Vec<Vec<f64>> {
    let pixels = (0..values.len() / layer.spec().channels).step_by(step.max(1));
    let finite = |value: &dyn Fn(usize) -> f64| pixels.clone().map(value).filter(|v| v.is_finite()).collect::<Vec<f64>>();
    match kind(layer) {
        None => Vec::new(),
        Some(Kind::Length) => vec![finite(&|i| values.get(i))],
        Some(Kind::Vector) => (0..3).map(|c| finite(&|i| values.get(3 * i + c))).collect(),
        Some(Kind::Flow) => vec![finite(&|i| values.get(2 * i).hypot(values.get(2 * i + 1)))],
    }
}

impl Stretch {
    /// The range over all values of [`shown_values`].
    pub fn over(mut values: Vec<Vec<f64>>) -> Self {
        Self(values.iter_mut().map(|values| Some([quantile(values, 0.01)?, quantile(values, 0.99)?])).collect())
    }
}

/// Lengths as viridis, from the near end of the range (dark) to the far one (bright).
pub(crate) fn lengths(values: &Values, frame: &Frame, stretch: &Stretch) -> Preview {
    let Some([low, high]) = stretch.0[0] else { return nothing(frame, "no depth") };
    let picture = from_pixels(frame.width, frame.height, |i| {
        let v = values.get(i);
        let [r, g, b] = viridis(place([low, high], v));
        if v.is_finite() { [r, g, b, 255] } else { [0; 4] }
    });
    Preview { picture, note: format!("{} to {} m", short(low), short(high)) }
}

/// Vectors as red, green and blue for x, y and z, each over its range.
pub(crate) fn vectors(values: &Values, frame: &Frame, stretch: &Stretch) -> Preview {
    let ranges = [0, 1, 2].map(|c| stretch.0[c].unwrap_or([0.0, 1.0]));
    let picture = from_pixels(frame.width, frame.height, |i| {
        let v = [0, 1, 2].map(|c| place(ranges[c], values.get(3 * i + c)));
        if v.iter().all(|v| !v.is_nan()) { [byte(v[0]), byte(v[1]), byte(v[2]), 255] } else { [0; 4] }
    });
    let axis = |(name, [low, high]): (&str, &[f64; 2])| format!("{name} {} to {}", short(*low), short(*high));
    Preview { picture, note: format!("{} m", ["x", "y", "z"].into_iter().zip(&ranges).map(axis).collect::<Vec<_>>().join(", ")) }
}

/// Hue is the direction (red right, then yellow-green down, cyan left, violet up), saturation the length, up to the end of the range.
pub(crate) fn flow(values: &Values, frame: &Frame, stretch: &Stretch) -> Preview {
    let Some([_, longest]) = stretch.0[0] else { return nothing(frame, "no next frame") };
    let picture = from_pixels(frame.width, frame.height, |i| {
        let [x, y] = [values.get(2 * i), values.get(2 * i + 1)];
        let [r, g, b] = direction_color(y.atan2(x), x.hypot(y) / longest.max(f64::MIN_POSITIVE));
        if x.is_finite() && y.is_finite() { [r, g, b, 255] } else { [0; 4] }
    });
    Preview { picture, note: format!("0 to {longest:.1} px") }
}

/// Position of a value on a range, 0 to 1 inside of it.
fn place([low, high]: [f64; 2], value: f64) -> f64 {
    (value - low) / (high - low).max(f64::MIN_POSITIVE)
}

fn nothing(frame: &Frame, note: &str) -> Preview {
    Preview { picture: from_pixels(frame.width, frame.height, |_| [0; 4]), note: note.into() }
}

/// A length in metres with as many digits as a glance needs.
fn short(v: f64) -> String {
    if v.abs() < 10.0 { format!("{v:.2}") } else { format!("{v:.1}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::{Subject, preview_over};
    use enfilade_frame::tonemap::ToneMap;

    fn frame_of(distances: [f32; 4]) -> Frame {
        let mut frame = Frame::new(4, 1);
        frame.insert(Layer::DepthMeters, Values::F32(distances.into()));
        frame
    }

    fn show_depth(frame: &Frame, stretch: Option<&Stretch>) -> Preview {
        preview_over(Subject::Layer(Layer::DepthMeters), frame, ToneMap::default(), stretch).unwrap()
    }

    #[test]
    fn a_distance_has_one_colour_in_all_frames_of_one_range() {
        let frames = [frame_of([1.0, 2.0, 3.0, f32::NAN]), frame_of([3.0, 4.0, 5.0, 6.0])];
        let all =
            frames.iter().map(|f| shown_values(Layer::DepthMeters, f.get(Layer::DepthMeters).unwrap(), 1).remove(0)).collect::<Vec<_>>();
        let stretch = Stretch::over(vec![all.concat()]);
        let [first, second] = [0, 1].map(|i| show_depth(&frames[i], Some(&stretch)));
        assert_eq!(first.picture.get_pixel(2, 0), second.picture.get_pixel(0, 0));
        assert_eq!(first.note, second.note);
        assert_ne!(show_depth(&frames[0], None).picture.get_pixel(2, 0), show_depth(&frames[1], None).picture.get_pixel(0, 0));
        assert_eq!(first.picture.get_pixel(3, 0).0, [0; 4]);
    }

    #[test]
    fn a_frame_without_values_is_empty() {
        assert_eq!(show_depth(&frame_of([f32::NAN; 4]), None).note, "no depth");
    }
}

//! A picture in a few numbers, from which the page chooses a range of values to show.

use super::picture_spec::PictureSpec;
use enfilade_dataset::Elements;
use enfilade_frame::tonemap::brightness;
use serde::Serialize;

/// Percentiles are taken of this many pixels at most, evenly spread; the extremes and the mean are of all.
const SAMPLED_PIXELS: usize = 1 << 16;

/// Which percentiles, of 100.
const PERCENTILES: [u32; 7] = [1, 5, 25, 50, 75, 95, 99];

/// Statistics of a picture's values. A colour counts as its brightness (0.3 R + 0.59 G + 0.11 B), a vector as its length.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// `value`, `brightness` or `length`.
    pub of: &'static str,
    /// Smallest and largest; `None` when no pixel has a number.
    pub range: Option<[f64; 2]>,
    /// Mean of the pixels that have one.
    pub mean: Option<f64>,
    /// The 1st, 5th, 25th, 50th, 75th, 95th and 99th percentile of a sample of the pixels.
    pub percentiles: Vec<f64>,
    /// Pixels without a number: NaN or infinite.
    pub without: usize,
    /// The scale of radiance that shows the 90th percentile of this frame's color at 0.8; absent if a table has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tone_scale: Option<f64>,
}

impl Summary {
    /// The summary of the elements of a picture.
    pub fn new(spec: &PictureSpec, values: &Elements) -> Self {
        let channels = spec.channels;
        let of = match (channels, spec.space) {
            (1, _) => "value",
            (_, space) if space.contains("RGB") => "brightness",
            _ => "length",
        };
        match values {
            Elements::F16(v) => Self::of_pixels(of, channels, v, |x| f64::from(x.to_f32())),
            Elements::F32(v) => Self::of_pixels(of, channels, v, |x| f64::from(*x)),
            Elements::F64(v) => Self::of_pixels(of, channels, v, |x| *x),
            Elements::I16(v) => Self::of_pixels(of, channels, v, |x| f64::from(*x)),
            Elements::I64(v) => Self::of_pixels(of, channels, v, |x| *x as f64),
            Elements::U8(v) => Self::of_pixels(of, channels, v, |x| f64::from(*x)),
        }
    }

    fn of_pixels<T>(of: &'static str, channels: usize, values: &[T], number: impl Fn(&T) -> f64) -> Self {
        let pixels = values.len() / channels;
        let stride = pixels.div_ceil(SAMPLED_PIXELS).max(1);
        let mut sample = Vec::with_capacity(pixels / stride + 1);
        let (mut low, mut high, mut sum, mut without) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0);
        for (i, pixel) in values.chunks_exact(channels).enumerate() {
            let value = match (of, pixel) {
                ("brightness", [r, g, b]) => brightness([number(r), number(g), number(b)]),
                ("length", vector) => vector.iter().map(|x| number(x) * number(x)).sum::<f64>().sqrt(),
                (_, value) => number(&value[0]),
            };
            if !value.is_finite() {
                without += 1;
                continue;
            }
            low = low.min(value);
            high = high.max(value);
            sum += value;
            if i % stride == 0 {
                sample.push(value);
            }
        }
        sample.sort_unstable_by(f64::total_cmp);
        let at = |percent: u32| sample.get((sample.len().saturating_sub(1) as f64 * f64::from(percent) / 100.0).round() as usize);
        let with = pixels - without;
        Self {
            of,
            range: (with > 0).then_some([low, high]),
            mean: (with > 0).then(|| sum / with as f64),
            percentiles: PERCENTILES.iter().filter_map(|&percent| at(percent).copied()).collect(),
            without,
            tone_scale: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_frame::Layer;

    #[test]
    fn extremes_mean_and_percentiles_leave_nan_out() {
        let mut metres: Vec<f32> = (0..=100).map(|i| i as f32).collect();
        metres.push(f32::NAN);
        let summary = Summary::new(&Layer::DepthMeters.into(), &Elements::F32(metres));
        assert_eq!((summary.of, summary.range, summary.mean, summary.without), ("value", Some([0.0, 100.0]), Some(50.0), 1));
        assert_eq!(summary.percentiles, [1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0]);
        let empty = Summary::new(&Layer::DepthMeters.into(), &Elements::F32(vec![f32::NAN]));
        assert_eq!((empty.range, empty.mean, empty.percentiles.len()), (None, None, 0));
    }

    #[test]
    fn colours_count_as_brightness_and_vectors_as_length() {
        let flow = Summary::new(&Layer::OpticalFlow.into(), &Elements::F32(vec![3.0, 4.0]));
        assert_eq!((flow.of, flow.range), ("length", Some([5.0, 5.0])));
        let color = Summary::new(&Layer::Color.into(), &Elements::F32(vec![1.0, 0.0, 0.0]));
        assert_eq!((color.of, color.range), ("brightness", Some([0.3, 0.3])));
    }
}

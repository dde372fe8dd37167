//! Images of another size: means over the area of each new pixel, or the nearest old pixel.

use crate::sample::Image;
use enfilade_frame::{Values, f16};
use half::slice::HalfFloatSliceExt;

/// The image of `height` × `width` pixels in which each has the mean over its area.
///
/// Integers are left to [`nearest`]. An area in which a value is not finite has none.
pub(crate) fn averaged(image: &Image, height: usize, width: usize) -> Image {
    let mean = |values: &[f32]| mean_over_areas(values, [image.height, image.width, image.channels], [height, width]);
    let values = match &image.values {
        Values::F16(v) => {
            let mut wide = vec![0.0; v.len()];
            v.convert_to_f32_slice(&mut wide);
            Values::F16(mean(&wide).into_iter().map(f16::from_f32).collect())
        }
        Values::F32(v) => Values::F32(mean(v)),
        Values::I16(_) | Values::U8(_) => return nearest(image, height, width),
    };
    Image { height, width, values, ..*image }
}

/// The image of `height` × `width` pixels in which each has the value of the pixel that its centre falls on.
pub(crate) fn nearest(image: &Image, height: usize, width: usize) -> Image {
    fn pick<T: Copy>(values: &[T], image: &Image, height: usize, width: usize) -> Vec<T> {
        let mut out = Vec::with_capacity(height * width * image.channels);
        for y in 0..height {
            let from = (2 * y + 1) * image.height / (2 * height) * image.width;
            for x in 0..width {
                let at = (from + (2 * x + 1) * image.width / (2 * width)) * image.channels;
                out.extend_from_slice(&values[at..at + image.channels]);
            }
        }
        out
    }
    let values = match &image.values {
        Values::F16(v) => Values::F16(pick(v, image, height, width)),
        Values::F32(v) => Values::F32(pick(v, image, height, width)),
        Values::I16(v) => Values::I16(pick(v, image, height, width)),
        Values::U8(v) => Values::U8(pick(v, image, height, width)),
    };
    Image { height, width, values, ..*image }
}

/// Means along columns, then along rows.
fn mean_over_areas(values: &[f32], [rows, columns, channels]: [usize; 3], [height, width]: [usize; 2]) -> Vec<f32> {
    let mut tall = vec![0.0; rows * width * channels];
    let across: Vec<_> = (0..width).map(|x| shares(x, width, columns)).collect();
    for (out, row) in tall.chunks_exact_mut(width * channels).zip(values.chunks_exact(columns * channels)) {
        for (pixel, shares) in out.chunks_exact_mut(channels).zip(&across) {
            for &(from, share) in shares {
                pixel.iter_mut().zip(&row[from * channels..]).for_each(|(sum, value)| *sum += share * value);
            }
        }
    }
    let mut out = vec![0.0; height * width * channels];
    for (y, line) in out.chunks_exact_mut(width * channels).enumerate() {
        for (from, share) in shares(y, height, rows) {
            let row = &tall[from * width * channels..(from + 1) * width * channels];
            line.iter_mut().zip(row).for_each(|(sum, value)| *sum += share * value);
        }
    }
    out
}

/// Which of `old` pixels pixel `at` of `new` covers, and with which share of its length; the shares sum to 1.
fn shares(at: usize, new: usize, old: usize) -> Vec<(usize, f32)> {
    // In units of 1 / (new · old) of the side.
    let (start, end) = (at * old, (at + 1) * old);
    let covered = |pixel: usize| end.min((pixel + 1) * new) - start.max(pixel * new);
    (start / new..end.div_ceil(new)).map(|pixel| (pixel, covered(pixel) as f32 / old as f32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(height: usize, width: usize, values: Vec<f32>) -> Image {
        Image { height, width, channels: values.len() / (height * width), values: Values::F32(values) }
    }

    #[test]
    fn averages_are_means_over_areas() {
        let ramp = image(2, 3, vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!(averaged(&ramp, 1, 1).values, Values::F32(vec![2.5]));
        assert_eq!(averaged(&ramp, 2, 3), ramp);
        let Values::F32(halves) = averaged(&ramp, 1, 2).values else { unreachable!() };
        // The left half covers column 0 and half of column 1.
        assert!((halves[0] - (1.5 + 0.5 * 2.5) / 1.5).abs() < 1e-6 && (halves[1] - (0.5 * 2.5 + 3.5) / 1.5).abs() < 1e-6, "{halves:?}");
        let larger = averaged(&ramp, 4, 6);
        assert_eq!(averaged(&larger, 2, 3), ramp);
    }

    #[test]
    fn the_nearest_pixel_is_the_one_under_the_centre() {
        let numbers = image(4, 4, (0..16).map(|v| v as f32).collect());
        assert_eq!(nearest(&numbers, 2, 2).values, Values::F32(vec![5.0, 7.0, 13.0, 15.0]));
        assert_eq!(nearest(&numbers, 4, 4), numbers);
        assert_eq!(nearest(&numbers, 1, 8).values.len(), 8);
    }
}

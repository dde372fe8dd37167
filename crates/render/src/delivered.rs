//! Where a picture that will be denoised needs its samples.
//!
//! A denoiser takes the noise of even surfaces away by itself. What it leaves is at edges of light, in reflections and behind glass, and the
//! noise of what was rendered says little of it. So the first samples of every pixel make two pictures that are independent of each other,
//! both are denoised, and where they differ more samples are needed: dual-buffer estimation, as Rousselle, Knaus & Zwicker 2012, "Adaptive
//! Rendering with Non-Local Means Filtering", guide theirs.

use enfilade_denoise::{Denoiser, Noisy, filtered};
use enfilade_frame::{NOISE_FLOOR, f16};
use enfilade_math::Rgb;
use enfilade_parallel::map_up_to;

/// The squared error of a denoised pixel falls with this power of the samples around it, about: 0.7 to 0.8 in six rooms.
const FALL: f64 = 0.75;
/// The error of a pixel is told by those within `REACH` rows and columns but not within `OWN`. So what it shows itself hardly influences how
/// many samples it gets, and its mean stays what it is.
const REACH: usize = 6;
const OWN: usize = 1;

/// What the first samples of a pixel say.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Halves {
    /// Mean colour of each half of the samples.
    pub colors: [Rgb; 2],
    /// Diffuse reflectance.
    pub reflectance: [f16; 3],
    /// Normal with bumps, in the world; 0 where nothing is.
    pub normal: [f16; 3],
}

/// What each pixel is to be counted with, row by row: with samples in proportion to it, the least error is left in the denoised picture.
pub(crate) fn errors([width, height]: [u32; 2], pixels: &[Halves]) -> Vec<f64> {
    // Denoise both pictures, guided by what is known of the surfaces so far.
    let channels = |of: fn(&Halves) -> [f16; 3]| pixels.iter().flat_map(|pixel| of(pixel).map(f16::to_f32)).collect::<Vec<f32>>();
    let albedo = channels(|pixel| pixel.reflectance);
    let normal = filtered(&channels(|pixel| pixel.normal), width as usize);
    let denoiser = Denoiser::built_in();
    let pictures = [0, 1].map(|half| {
        let color: Vec<f32> = pixels.iter().flat_map(|pixel| pixel.colors[half].to_array()).collect();
        let noisy = Noisy { width, height, color: &color, albedo: &albedo, normal: &normal };
        denoiser.filter(&noisy).expect("the network in the binary has no errors")
    });

    // With n samples an error e becomes e / n^FALL. The sum is least where n goes with this power of e.
    let differences = around(&differences(&pictures), width as usize, height as usize);
    differences.into_iter().map(|e| e.powf(1.0 / (1.0 + FALL))).collect()
}

/// The squared difference of each pixel, in relation to its brightness.
fn differences([a, b]: &[Vec<f32>; 2]) -> Vec<f64> {
    let sum: f64 = a.iter().chain(b).map(|&v| f64::from(v)).sum();
    let floor = NOISE_FLOOR * sum / (a.len() + b.len()).max(1) as f64;
    let square = |(&a, &b): (&f32, &f32)| {
        let (a, b) = (f64::from(a), f64::from(b));
        if a == b { 0.0 } else { ((a - b) / (0.5 * (a + b) + floor)).powi(2) }
    };
    a.chunks(3).zip(b.chunks(3)).map(|(a, b)| a.iter().zip(b).map(square).sum()).collect()
}

/// The mean of the values around each pixel.
fn around(values: &[f64], width: usize, height: usize) -> Vec<f64> {
    // Sums over all rows above and columns to the left (Crow 1984, "Summed-area tables for texture mapping").
    let mut sums = vec![0.0; (width + 1) * (height + 1)];
    for y in 0..height {
        let mut row = 0.0;
        for x in 0..width {
            row += values[y * width + x];
            sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
        }
    }

    // Of the square around a pixel, what is not in the smaller one.
    let square = |x: usize, y: usize, reach: usize| {
        let (left, right) = (x.saturating_sub(reach), (x + reach + 1).min(width));
        let (top, bottom) = (y.saturating_sub(reach), (y + reach + 1).min(height));
        let sum = |x: usize, y: usize| sums[y * (width + 1) + x];
        (sum(right, bottom) - sum(left, bottom) - sum(right, top) + sum(left, top), (right - left) * (bottom - top))
    };
    map_up_to(width * height, |p| {
        let (x, y) = (p % width, p / width);
        let ((all, count), (own, own_count)) = (square(x, y, REACH), square(x, y, OWN));
        ((all - own) / (count - own_count).max(1) as f64).max(0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_counts_around_its_pixel_and_not_in_it() {
        let (width, height) = (20, 16);
        let mut values = vec![0.0; width * height];
        values[8 * width + 10] = 144.0;
        let found = around(&values, width, height);
        let at = |x: usize, y: usize| found[y * width + x];
        assert_eq!((at(10, 8), at(11, 9), at(17, 8), at(10, 1)), (0.0, 0.0, 0.0, 0.0));
        // Of 13×13 pixels without 3×3, less what lies outside.
        assert_eq!((at(10, 6), at(12, 8)), (144.0 / (13.0 * 13.0 - 9.0), 144.0 / (13.0 * 13.0 - 9.0)));
        assert_eq!(at(4, 2), 144.0 / (11.0 * 9.0 - 9.0));
    }

    #[test]
    fn errors_are_where_two_denoised_pictures_differ() {
        // Noise that a denoiser takes away, alike everywhere, and a bright square that only one half has found.
        let (width, height) = (64, 48);
        let noise = |p: u32| (p.wrapping_mul(2_654_435_761) >> 16) as f32 / 65536.0;
        let pixel = |p: u32| {
            let (x, y) = (p % width, p / width);
            let found = if (40..52).contains(&x) && (20..30).contains(&y) { 2.0 } else { 0.0 };
            let colors = [Rgb::splat(0.4 + 0.2 * noise(2 * p)), Rgb::splat(0.4 + 0.2 * noise(2 * p + 1) + found)];
            Halves { colors, reflectance: [f16::from_f32(0.5); 3], normal: [f16::ZERO, f16::ZERO, f16::ONE] }
        };
        let found = errors([width, height], &(0..width * height).map(pixel).collect::<Vec<_>>());
        let at = |x: u32, y: u32| found[(y * width + x) as usize];
        assert!(at(46, 25) > 5.0 * at(10, 10) && at(10, 10) > 0.0, "{} and {}", at(46, 25), at(10, 10));
        assert!(at(46, 25) > 5.0 * at(10, 40), "{} and {}", at(46, 25), at(10, 40));
    }

    #[test]
    fn pictures_that_are_alike_have_no_error() {
        let pixel = Halves { colors: [Rgb::BLACK; 2], ..Halves::default() };
        assert_eq!(errors([12, 9], &[pixel; 108]), [0.0; 108]);
    }
}

//! The pixels of an image sensor: from light to numbers, with noise, behind a mosaic of colours.

use enfilade_math::Rng;

/// Above this many electrons their Poisson distribution is replaced by a normal one: its skewness is a tenth there.
const MANY_ELECTRONS: f64 = 100.0;

/// Properties of a sensor's pixels. Light of 1 saturates them.
pub(crate) struct Pixels {
    /// Electrons of a saturated pixel; `None`: no noise.
    pub full_well: Option<f64>,
    /// Electrons.
    pub read_noise: f64,
    /// `None`: values are not rounded.
    pub bits: Option<u8>,
}

impl Pixels {
    /// A pixel's reading of its light, 0 to 1.
    fn measure(&self, light: f32, rng: &mut Rng) -> f32 {
        let light = f64::from(light).clamp(0.0, 1.0);
        let noisy = self.full_well.map_or(light, |full_well| {
            let electrons = poisson(light * full_well, rng) + if self.read_noise > 0.0 { self.read_noise * rng.normal() } else { 0.0 };
            (electrons / full_well).clamp(0.0, 1.0)
        });
        let whole = |bits: u8| {
            let largest = f64::from((1u32 << bits) - 1);
            (noisy * largest).round() / largest
        };
        self.bits.map_or(noisy, whole) as f32
    }

    /// Three values of every pixel.
    pub fn all(&self, light: &[[f32; 3]], rng: &Rng) -> Vec<[f32; 3]> {
        let measure = |i: usize| {
            let mut rng = rng.fork(i as u64);
            light[i].map(|v| self.measure(v, &mut rng))
        };
        enfilade_parallel::map_up_to(light.len(), measure)
    }

    /// Value of every pixel that its place in the mosaic lets through.
    pub fn mosaic(&self, [width, _]: [usize; 2], light: &[[f32; 3]], rng: &Rng) -> Vec<f32> {
        let measure = |i: usize| self.measure(light[i][channel(i % width, i / width)], &mut rng.fork(i as u64));
        enfilade_parallel::map_up_to(light.len(), measure)
    }
}

/// The colour of a place of the mosaic: red at even rows and columns, blue at odd ones, green elsewhere.
const fn channel(x: usize, y: usize) -> usize {
    x % 2 + y % 2
}

/// Three values of every pixel: its own, and of other colours the mean of those among the eight neighbours.
pub(crate) fn demosaiced([width, height]: [usize; 2], values: &[f32]) -> Vec<[f32; 3]> {
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let (mut sums, mut counts) = ([0.0f32; 3], [0.0f32; 3]);
        for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
            for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                let c = channel(u, v);
                (sums[c], counts[c]) = (sums[c] + values[v * width + u], counts[c] + 1.0);
            }
        }
        let own = channel(x, y);
        [0, 1, 2].map(|c| if c == own || counts[c] == 0.0 { values[i] } else { sums[c] / counts[c] })
    };
    enfilade_parallel::map_up_to(values.len(), pixel)
}

/// A number of events that are independent of each other, of a mean.
fn poisson(mean: f64, rng: &mut Rng) -> f64 {
    if mean > MANY_ELECTRONS {
        return (mean + mean.sqrt() * rng.normal()).round().max(0.0);
    }
    // The events of one unit of time are as many as exponential waits fit into it (Knuth 1969, The Art of Computer Programming, 3.4.1).
    let none = (-mean).exp();
    let (mut count, mut product) = (0.0, rng.next_f64());
    while product > none {
        (count, product) = (count + 1.0, product * rng.next_f64());
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_the_mean_and_the_variance_of_poisson() {
        for mean in [0.0, 0.4, 7.0, 99.0, 101.0, 5000.0] {
            let n = 20_000;
            let counts: Vec<f64> = (0..n).map(|i| poisson(mean, &mut Rng::new(3).fork(i))).collect();
            let found = counts.iter().sum::<f64>() / n as f64;
            let variance = counts.iter().map(|count| (count - found).powi(2)).sum::<f64>() / n as f64;
            // Five standard errors.
            assert!((found - mean).abs() <= 5.0 * (mean / n as f64).sqrt(), "mean {found} of {mean}");
            assert!((variance - mean).abs() <= 5.0 * ((2.0 * mean * mean + mean) / n as f64).sqrt(), "variance {variance} of {mean}");
        }
    }

    #[test]
    fn a_grey_surface_survives_the_mosaic() {
        let ideal = Pixels { full_well: None, read_noise: 0.0, bits: None };
        let light = vec![[0.25f32, 0.5, 0.75]; 5 * 4];
        let mosaic = ideal.mosaic([5, 4], &light, &Rng::new(0));
        assert_eq!([mosaic[0], mosaic[1], mosaic[5], mosaic[6]], [0.25, 0.5, 0.5, 0.75]);
        assert_eq!(demosaiced([5, 4], &mosaic), light);
    }

    #[test]
    fn values_are_whole_numbers_of_their_bits_and_saturate() {
        let pixels = Pixels { full_well: None, read_noise: 0.0, bits: Some(2) };
        let values = [-1.0, 0.1, 0.2, 0.6, 7.0].map(|v| pixels.measure(v, &mut Rng::new(0)));
        assert_eq!(values, [0.0, 0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]);
    }
}

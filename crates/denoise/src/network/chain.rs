//! Consecutive layers of one resolution, computed in bands of rows so that intermediate values stay in the cache.

use super::block::{Shape, Tensor};
use super::convolution::{Convolution, Kept, Source, Workshop};

/// Least number of tiles of 4×4 pixels in a band, whatever the number of threads: the values between layers of 64 channels, as at the
/// finest level, then take 6 MB.
const TILES: usize = 1536;
/// Least number of rows of tiles in a band, of which two are moved from one to the next.
const ROWS: usize = 8;
/// Least number of tiles for each thread.
const TILES_PER_THREAD: usize = 112;

/// The values of the last of `layers`, of which the first reads `sources` and each other one the one before.
///
/// Each layer follows a row of tiles behind the one before, which it needs a row of pixels more of. Where bands end changes no value.
pub(super) fn chain(workshop: &Workshop, layers: &[Convolution], sources: &[Source<'_>], kept: Kept) -> Tensor {
    let tiles = TILES.max(TILES_PER_THREAD * rayon::current_num_threads());
    let columns = sources[0].size()[0].div_ceil(4);
    in_bands(workshop, layers, sources, kept, tiles.div_ceil(columns).max(ROWS))
}

/// Runs layers as [`chain`] does, in bands of `band` rows of tiles, or of as many as there are layers.
fn in_bands(workshop: &Workshop, layers: &[Convolution], sources: &[Source<'_>], kept: Kept, band: usize) -> Tensor {
    let [width, height] = sources[0].size();
    let (rows, band) = (height.div_ceil(4), band.max(layers.len()));
    let (last, inner) = layers.split_last().expect("a chain has a layer");
    // A window is read from a row of tiles before the band on, or more where the last band ends.
    let window = height.min(4 * (band + layers.len()));
    let mut windows: Vec<Tensor> =
        inner.iter().map(|layer| Tensor::new(Shape { channels: layer.outputs(), width, height: window })).collect();
    let [pooled_width, pooled_height] = if kept == Kept::All { [width, height] } else { [width / 2, height / 2] };
    let mut output = Tensor::new(Shape { channels: last.outputs(), width: pooled_width, height: pooled_height });
    // Rows of tiles that each layer has.
    let mut done = vec![0; layers.len()];
    while done[inner.len()] < rows {
        let mut end = rows.min(done[0] + band);
        for (index, layer) in layers.iter().enumerate() {
            if index > 0 && end < rows {
                end -= 1;
            }
            let (before, after) = windows.split_at_mut(index);
            let between = before.last().map(|tensor| [Source { tensor, doubled: false }]);
            let sources = between.as_ref().map_or(sources, |between| between);
            if let Some(window) = after.first_mut() {
                window.scroll(4 * done[index + 1], (4 * done[index]).min(height));
                if end == rows {
                    window.clear_below(height);
                }
                layer.apply(workshop, sources, Kept::All, [width, height], done[index]..end, window);
            } else {
                layer.apply(workshop, sources, kept, [width, height], done[index]..end, &mut output);
            }
            done[index] = end;
        }
    }
    output
}

#[cfg(test)]
mod tests {
    use super::super::block::LANES;
    use super::super::instructions::Instructions;
    use super::*;

    /// Numbers between −1 and 1, of multiples of 1/64, by a place and a purpose.
    fn number(place: usize, purpose: usize) -> f32 {
        let x = (place * 977 + purpose * 7919 + 13).wrapping_mul(2_654_435_761) >> 7;
        (x % 129) as f32 / 64.0 - 1.0
    }

    fn tensor(channels: usize, width: usize, height: usize) -> Tensor {
        let mut tensor = Tensor::new(Shape { channels, width, height });
        for channel in 0..channels {
            for y in 0..height {
                for x in 0..width {
                    let place = tensor.shape.bordered(channel / LANES, x + 1, y + 1);
                    tensor.data[place].0[channel % LANES] = number((channel * height + y) * width + x, channels);
                }
            }
        }
        tensor
    }

    fn layer(inputs: usize, outputs: usize) -> (Convolution, Vec<f32>, Vec<f32>) {
        let weights: Vec<f32> = (0..9 * inputs * outputs).map(|i| number(i, outputs)).collect();
        let bias: Vec<f32> = (0..outputs).map(|i| number(i, inputs)).collect();
        (Convolution::new(inputs, outputs, &weights, &bias), weights, bias)
    }

    /// A value of what a layer reads, 0 outside.
    fn read(sources: &[Source<'_>], mut channel: usize, x: isize, y: isize) -> f64 {
        let [width, height] = sources[0].size();
        if x < 0 || y < 0 || x as usize >= width || y as usize >= height {
            return 0.0;
        }
        for Source { tensor, doubled } in sources {
            if channel < tensor.shape.channels {
                let at = |v: isize| if *doubled { v as usize / 2 } else { v as usize };
                return tensor.row(channel / LANES, at(y))[at(x)].0[channel % LANES].into();
            }
            channel -= tensor.shape.channels;
        }
        unreachable!("no source has the channel")
    }

    /// A layer as it is defined, in double precision.
    fn value(sources: &[Source<'_>], weights: &[f32], bias: &[f32], output: usize, x: usize, y: usize) -> f64 {
        let inputs = weights.len() / bias.len() / 9;
        let mut sum = f64::from(bias[output]);
        for input in 0..inputs {
            for (i, &weight) in weights[9 * (output * inputs + input)..][..9].iter().enumerate() {
                let (dx, dy) = (i as isize % 3 - 1, i as isize / 3 - 1);
                sum += f64::from(weight) * read(sources, input, x as isize + dx, y as isize + dy);
            }
        }
        sum.max(0.0)
    }

    fn assert_defined(sources: &[Source<'_>], outputs: usize, kept: Kept) {
        let inputs = sources.iter().map(|source| source.tensor.shape.channels).sum();
        let (convolution, weights, bias) = layer(inputs, outputs);
        let layers = [convolution];
        for instructions in Instructions::available() {
            let found = chain(&Workshop::new(instructions), &layers, sources, kept);
            let Shape { channels, width, height } = found.shape;
            assert_eq!(channels, outputs);
            for (output, y, x) in (0..outputs).flat_map(|o| (0..height).flat_map(move |y| (0..width).map(move |x| (o, y, x)))) {
                let of = |x, y| value(sources, &weights, &bias, output, x, y);
                let expected = match kept {
                    Kept::All => of(x, y),
                    Kept::Greatest => {
                        let (x, y) = (2 * x, 2 * y);
                        of(x, y).max(of(x + 1, y)).max(of(x, y + 1)).max(of(x + 1, y + 1))
                    }
                };
                let found = f64::from(found.row(output / LANES, y)[x].0[output % LANES]);
                let name = instructions.name();
                assert!((found - expected).abs() < 1e-4 * inputs as f64, "{name}: {output} at {x},{y}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn a_layer_is_the_convolution_it_is_defined_as() {
        for (inputs, outputs, width, height) in [(1, 1, 1, 1), (9, 3, 2, 7), (20, 32, 5, 4), (33, 50, 9, 3), (16, 16, 64, 1)] {
            assert_defined(&[Source { tensor: &tensor(inputs, width, height), doubled: false }], outputs, Kept::All);
        }
    }

    #[test]
    fn a_layer_reads_what_was_pooled_twice_in_each_direction_beside_another() {
        for (width, height) in [(1, 1), (3, 2), (4, 5)] {
            let (coarse, fine) = (tensor(32, width, height), tensor(9, 2 * width, 2 * height));
            let sources = [Source { tensor: &coarse, doubled: true }, Source { tensor: &fine, doubled: false }];
            assert_defined(&sources, 20, Kept::All);
        }
    }

    #[test]
    fn pooling_keeps_the_greatest_of_four_pixels() {
        for (width, height) in [(2, 2), (6, 4), (10, 14)] {
            assert_defined(&[Source { tensor: &tensor(17, width, height), doubled: false }], 33, Kept::Greatest);
        }
    }

    #[test]
    fn bands_change_no_bit() {
        let layers = [layer(9, 32).0, layer(32, 20).0, layer(20, 3).0];
        for (width, height) in [(6, 4), (12, 50), (4, 96)] {
            let (input, workshop) = (tensor(9, width, height), Workshop::new(Instructions::best()));
            let with = |band| in_bands(&workshop, &layers, &[Source { tensor: &input, doubled: false }], Kept::All, band);
            let whole = with(100);
            assert!(whole.data.iter().any(|block| block.0[0] > 0.0));
            for band in [1, 4, 7] {
                assert!(with(band).data == whole.data, "{width}x{height} in bands of {band}");
            }
        }
    }
}

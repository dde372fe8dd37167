//! Convolution with 3×3 weights, four by four pixels at a time, by Winograd's algorithm.
//!
//! A tile of 4×4 output pixels depends on 6×6 input pixels. Both are polynomials of two variables; their values at 6×6 points turn
//! the convolution into 36 products instead of 144, which sums over channels as matrix products do. Lavin and Gray 2016, "Fast
//! Algorithms for Convolutional Neural Networks", F(4×4, 3×3), points 0, ±1, ±2 and infinity. Every output value is computed by the
//! same operations in the same order, whatever the tiles are gathered to and whichever instructions do it.

use super::block::{Block, LANES};
use super::simd::Simd;

/// Points of a tile.
pub(super) const POINTS: usize = 36;

/// Bᵀd: the values of one row or column of an input tile at the points.
#[inline(always)]
fn input_points<S: Simd>(s: S, d: [S::Lanes; 6]) -> [S::Lanes; 6] {
    let (two, four, minus_two, minus_four, minus_five) = (s.splat(2.0), s.splat(4.0), s.splat(-2.0), s.splat(-4.0), s.splat(-5.0));
    let even = s.fma(minus_four, d[2], d[4]);
    let odd = s.fma(minus_four, d[1], d[3]);
    let (even_2, odd_2) = (s.sub(d[4], d[2]), s.sub(d[3], d[1]));
    [
        s.fma(minus_five, d[2], s.fma(four, d[0], d[4])),
        s.add(even, odd),
        s.sub(even, odd),
        s.fma(two, odd_2, even_2),
        s.fma(minus_two, odd_2, even_2),
        s.fma(minus_five, d[3], s.fma(four, d[1], d[5])),
    ]
}

/// Aᵀm: four output values of a row or column from the values at the points.
#[inline(always)]
fn output_values<S: Simd>(s: S, m: [S::Lanes; 6]) -> [S::Lanes; 4] {
    let (two, four, eight) = (s.splat(2.0), s.splat(4.0), s.splat(8.0));
    let (sum, difference) = (s.add(m[1], m[2]), s.sub(m[1], m[2]));
    let (sum_2, difference_2) = (s.add(m[3], m[4]), s.sub(m[3], m[4]));
    [
        s.add(s.add(m[0], sum), sum_2),
        s.fma(two, difference_2, difference),
        s.fma(four, sum_2, sum),
        s.add(s.fma(eight, difference_2, difference), m[5]),
    ]
}

/// G g Gᵀ: 3×3 weights (rows of columns) at the points.
pub(super) fn weight_points(g: [[f64; 3]; 3]) -> [f64; POINTS] {
    let points = |[a, b, c]: [f64; 3]| {
        let (sum, sum_2) = (a + c, a + 4.0 * c);
        [a / 4.0, -(sum + b) / 6.0, (b - sum) / 6.0, (sum_2 + 2.0 * b) / 24.0, (sum_2 - 2.0 * b) / 24.0, c]
    };
    let rows = g.map(points);
    let mut at = [0.0; POINTS];
    for x in 0..6 {
        for (y, value) in points(rows.map(|row| row[x])).into_iter().enumerate() {
            at[6 * y + x] = value;
        }
    }
    at
}

/// Positions of the six rows or columns of a tile's input among the stored ones: each stored, or doubled by upsampling.
pub(super) const STORED: [usize; 6] = [0, 1, 2, 3, 4, 5];
/// See [`STORED`]: pixel −1 is in the pixel before, 0 and 1 are one pixel, and so on.
pub(super) const DOUBLED: [usize; 6] = [0, 1, 1, 2, 2, 3];

/// Writes the 6×6 input pixels of a tile at the points: to `out[0]`, `out[stride]` and so on. `pixels` begins with the first of
/// them; rows are `pitch` apart; `at` is [`STORED`] or [`DOUBLED`].
#[inline(always)]
pub(super) fn transform_input<S: Simd>(s: S, pixels: &[Block], pitch: usize, at: [usize; 6], out: &mut [Block], stride: usize) {
    let mut rows: [&[Block]; 6] = [&[]; 6];
    for y in 0..6 {
        rows[y] = &pixels[at[y] * pitch..][..at[5] + 1];
    }
    let zero = s.splat(0.0);
    let mut columns = [[zero; 6]; 6];
    for x in 0..6 {
        let mut column = [zero; 6];
        for y in 0..6 {
            column[y] = s.load(&rows[y][at[x]]);
        }
        let column = input_points(s, column);
        for y in 0..6 {
            columns[y][x] = column[y];
        }
    }
    let mut points = out.chunks_mut(stride);
    for y in 0..6 {
        let row = input_points(s, columns[y]);
        for x in 0..6 {
            s.store(row[x], &mut points.next().expect("there is room for every point")[0]);
        }
    }
}

/// The 4×4 output pixels of a tile, from the sums at the points, which are `stride` apart: with the bias added, and 0 where negative.
#[inline(always)]
pub(super) fn transform_output<S: Simd>(s: S, sums: &[Block], stride: usize, bias: &Block) -> [[S::Lanes; 4]; 4] {
    let (bias, zero) = (s.load(bias), s.splat(0.0));
    let mut points = sums.chunks(stride);
    let mut columns = [[zero; 6]; 4];
    for y in 0..6 {
        let mut row = [zero; 6];
        for x in 0..6 {
            row[x] = s.load(&points.next().expect("there is a sum for every point")[0]);
        }
        let row = output_values(s, row);
        for x in 0..4 {
            columns[x][y] = row[x];
        }
    }
    let mut tile = [[zero; 4]; 4];
    for x in 0..4 {
        let column = output_values(s, columns[x]);
        for y in 0..4 {
            tile[y][x] = s.max(s.add(column[y], bias), zero);
        }
    }
    tile
}

/// At one point: the sums over input channels, for `TILES` tiles and `BLOCKS` blocks of output channels.
///
/// `values` contains a run of at least `TILES` blocks for every block of input channels, `stride` apart; `weights` one block per input
/// channel for each block of output channels. The sums of a block of channels go to `out`, `out_stride` after those of the one before.
#[inline(always)]
pub(super) fn multiply<S: Simd, const TILES: usize, const BLOCKS: usize>(
    s: S,
    values: &[Block],
    stride: usize,
    weights: [&[Block]; BLOCKS],
    out: &mut [Block],
    out_stride: usize,
) {
    let zero = s.splat(0.0);
    let mut sums = [[zero; TILES]; BLOCKS];
    let channels = weights[0].len();
    let mut run = values;
    let mut first = 0;
    while first < channels {
        let tiles: &[Block; TILES] = run.first_chunk().expect("a run has a block for every tile");
        for lane in 0..(channels - first).min(LANES) {
            let mut w = [zero; BLOCKS];
            for b in 0..BLOCKS {
                w[b] = s.load(&weights[b][first + lane]);
            }
            for t in 0..TILES {
                let value = s.splat(tiles[t].0[lane]);
                for b in 0..BLOCKS {
                    sums[b][t] = s.fma(value, w[b], sums[b][t]);
                }
            }
        }
        first += LANES;
        run = run.get(stride..).unwrap_or(&[]);
    }
    for b in 0..BLOCKS {
        let out: &mut [Block; TILES] = out[b * out_stride..].first_chunk_mut().expect("there is room for every tile");
        for t in 0..TILES {
            s.store(sums[b][t], &mut out[t]);
        }
    }
}

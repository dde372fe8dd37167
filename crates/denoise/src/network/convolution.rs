//! A layer: its weights as the kernels read them, and how its tiles are shared out among threads.

use super::block::{Block, LANES, Shape, Tensor, zeros};
use super::instructions::{Instructions, Kernel};
use super::pixels::Pixels;
use super::simd::Simd;
use super::winograd::{DOUBLED, POINTS, STORED, multiply, transform_input, transform_output, weight_points};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard};

/// Weights of 3×3 pixels, biases, and the rectifier.
pub(super) struct Convolution {
    inputs: usize,
    outputs: usize,
    /// Per block of output channels, point and input channel.
    weights: Vec<Block>,
    bias: Vec<Block>,
}

/// The input of a layer: all channels of a tensor, each pixel once, or four times (two by two).
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub tensor: &'a Tensor,
    pub doubled: bool,
}

impl Source<'_> {
    /// Width and height of the layer that reads it.
    pub fn size(&self) -> [usize; 2] {
        let Shape { width, height, .. } = self.tensor.shape;
        if self.doubled { [2 * width, 2 * height] } else { [width, height] }
    }
}

/// The treatment of a layer's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kept {
    All,
    /// The greatest of two by two pixels.
    Greatest,
}

impl Convolution {
    /// A layer from `weights`, in the order output channel, input channel, row, column, and one bias per output channel.
    pub fn new(inputs: usize, outputs: usize, weights: &[f32], bias: &[f32]) -> Self {
        assert_eq!((weights.len(), bias.len()), (9 * inputs * outputs, outputs));
        let blocks = outputs.div_ceil(LANES);
        let mut packed = zeros(blocks * POINTS * inputs);
        packed.par_chunks_mut(POINTS * inputs).enumerate().for_each(|(block, packed)| {
            for lane in 0..LANES.min(outputs - LANES * block) {
                for input in 0..inputs {
                    let first = 9 * ((LANES * block + lane) * inputs + input);
                    let weight = |y: usize| std::array::from_fn(|x| f64::from(weights[first + 3 * y + x]));
                    for (point, value) in weight_points([weight(0), weight(1), weight(2)]).into_iter().enumerate() {
                        packed[point * inputs + input].0[lane] = value as f32;
                    }
                }
            }
        });
        let mut padded = zeros(blocks);
        bias.iter().enumerate().for_each(|(i, &value)| padded[i / LANES].0[i % LANES] = value);
        Self { inputs, outputs, weights: packed, bias: padded }
    }

    /// Output channels.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Computes the layer's values in some rows of tiles into `output`, where it reads `sources` one after the other. `size` is the
    /// width and height of all its values, before they are pooled.
    pub fn apply(
        &self,
        workshop: &Workshop,
        sources: &[Source<'_>],
        kept: Kept,
        size: [usize; 2],
        rows: Range<usize>,
        output: &mut Tensor,
    ) {
        let run = Run::new(self, workshop.instructions, sources, kept, size, rows);
        let pixels = Pixels::new(output);
        (0..run.tiles.len().div_ceil(run.share)).into_par_iter().for_each(|index| {
            let mut scratch = workshop.scratch(&run);
            let first = run.tiles.start + index * run.share;
            workshop.instructions.run(Part { run: &run, first, scratch: &mut scratch, pixels: &pixels });
            workshop.spares().push(scratch);
        });
    }
}

/// The buffers and instructions that layers are computed with.
pub(super) struct Workshop {
    instructions: Instructions,
    /// Buffers that no thread uses at the moment.
    spare: Mutex<Vec<Scratch>>,
}

/// The buffers of one thread.
#[derive(Default)]
struct Scratch {
    /// Per point, block of input channels and tile.
    values: Vec<Block>,
    /// Per point, block of output channels and tile.
    sums: Vec<Block>,
}

impl Workshop {
    pub fn new(instructions: Instructions) -> Self {
        Self { instructions, spare: Mutex::default() }
    }

    fn spares(&self) -> MutexGuard<'_, Vec<Scratch>> {
        self.spare.lock().expect("no thread panics while it holds the lock")
    }

    fn scratch(&self, run: &Run<'_>) -> Scratch {
        let spare = self.spares().pop();
        let mut scratch = spare.unwrap_or_default();
        let fit = |blocks: &mut Vec<Block>, count: usize| {
            if blocks.len() < count {
                *blocks = zeros(count);
            }
        };
        fit(&mut scratch.values, POINTS * run.stride());
        fit(&mut scratch.sums, POINTS * run.sum_stride());
        scratch
    }
}

/// Values shared by the tiles of a layer that are computed in one run.
struct Run<'a> {
    layer: &'a Convolution,
    sources: &'a [Source<'a>],
    kept: Kept,
    /// Size of the layer's values before they are pooled.
    width: usize,
    height: usize,
    /// Tiles per row of all the layer's.
    columns: usize,
    /// The tiles, counted row by row.
    tiles: Range<usize>,
    /// Number of tiles that a thread works on at a time.
    share: usize,
    /// Blocks of output channels that it works on at a time.
    blocks: usize,
}

impl<'a> Run<'a> {
    fn new(
        layer: &'a Convolution,
        instructions: Instructions,
        sources: &'a [Source<'a>],
        kept: Kept,
        [width, height]: [usize; 2],
        rows: Range<usize>,
    ) -> Self {
        let (_, others) = sources.split_last().expect("a layer has a source");
        let channels = |source: &Source<'_>| source.tensor.shape.channels;
        assert!(others.iter().all(|source| channels(source) % LANES == 0), "only the last source may have an unfilled block");
        assert_eq!(sources.iter().map(channels).sum::<usize>(), layer.inputs, "channels");
        let columns = width.div_ceil(4);
        let tiles = rows.start * columns..rows.end * columns;
        // Where tiles are few, every thread gets some.
        let even = tiles.len().div_ceil(rayon::current_num_threads()).next_multiple_of(instructions.tiles());
        let (share, blocks) = (even.min(instructions.tiles_at_a_time()), instructions.blocks().min(layer.bias.len()));
        Self { layer, sources, kept, width, height, columns, tiles, share, blocks }
    }

    /// Distance of two points in the input: odd, so that points do not compete for the same lines of the cache.
    fn stride(&self) -> usize {
        let blocks: usize = self.sources.iter().map(|source| source.tensor.shape.blocks()).sum();
        (blocks * self.share) | 1
    }

    /// Distance of two points in the sums: odd, for the same reason.
    fn sum_stride(&self) -> usize {
        (self.blocks * self.share) | 1
    }
}

/// The unit of work of a thread: a share of the tiles, from `first` on.
struct Part<'a> {
    run: &'a Run<'a>,
    first: usize,
    scratch: &'a mut Scratch,
    pixels: &'a Pixels<'a>,
}

impl Kernel for Part<'_> {
    #[inline(always)]
    fn run<S: Simd, const TILES: usize, const BLOCKS: usize>(mut self, s: S) {
        self.inputs(s);
        let blocks = self.run.layer.bias.len();
        let mut first = 0;
        while first + BLOCKS <= blocks {
            self.outputs::<S, TILES, BLOCKS>(s, first);
            first += BLOCKS;
        }
        for block in first..blocks {
            self.outputs::<S, TILES, 1>(s, block);
        }
    }
}

impl Part<'_> {
    /// Place in the part, column and row of each tile.
    fn tiles(&self) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
        let (first, columns) = (self.first, self.run.columns);
        let end = (first + self.run.share).min(self.run.tiles.end);
        (first..end).map(move |tile| (tile - first, tile % columns, tile / columns))
    }

    /// All channels of all tiles at the points.
    #[inline(always)]
    fn inputs<S: Simd>(&mut self, s: S) {
        let (stride, mut block) = (self.run.stride(), 0);
        for source in self.run.sources {
            let Tensor { shape, top, data } = source.tensor;
            for channels in 0..shape.blocks() {
                for (place, x, y) in self.tiles() {
                    let out = &mut self.scratch.values[block * self.run.share + place..];
                    if source.doubled {
                        transform_input(s, &data[shape.bordered(channels, 2 * x, 2 * y - top)..], shape.pitch(), DOUBLED, out, stride);
                    } else {
                        transform_input(s, &data[shape.bordered(channels, 4 * x, 4 * y - top)..], shape.pitch(), STORED, out, stride);
                    }
                }
                block += 1;
            }
        }
    }

    /// `BLOCKS` blocks of output channels, from the block `first` on, of all tiles.
    #[inline(always)]
    fn outputs<S: Simd, const TILES: usize, const BLOCKS: usize>(&mut self, s: S, first: usize) {
        let (run, layer, Scratch { values, sums }) = (self.run, self.run.layer, &mut *self.scratch);
        let (stride, sum_stride) = (run.stride(), run.sum_stride());
        let count = run.share.min(run.tiles.end - self.first);
        for point in 0..POINTS {
            let mut weights: [&[Block]; BLOCKS] = [&[]; BLOCKS];
            for b in 0..BLOCKS {
                weights[b] = &layer.weights[((first + b) * POINTS + point) * layer.inputs..][..layer.inputs];
            }
            for t in (0..count).step_by(TILES) {
                let (values, sums) = (&values[point * stride + t..], &mut sums[point * sum_stride + t..]);
                multiply::<S, TILES, BLOCKS>(s, values, run.share, weights, sums, run.share);
            }
        }
        for b in 0..BLOCKS {
            for (place, x, y) in self.tiles() {
                let tile = transform_output(s, &self.scratch.sums[b * run.share + place..], sum_stride, &layer.bias[first + b]);
                self.store(s, first + b, x, y, &tile);
            }
        }
    }

    /// Stores those pixels of the tile in column `x` and row `y` that are within the picture.
    #[inline(always)]
    fn store<S: Simd>(&self, s: S, block: usize, x: usize, y: usize, tile: &[[S::Lanes; 4]; 4]) {
        let (columns, rows) = ((self.run.width - 4 * x).min(4), (self.run.height - 4 * y).min(4));
        match self.run.kept {
            Kept::All => {
                for row in 0..rows {
                    for column in 0..columns {
                        // SAFETY: tiles are disjoint, and each belongs to one part, which one thread works on.
                        unsafe { self.pixels.set(s, block, 4 * x + column, 4 * y + row, tile[row][column]) };
                    }
                }
            }
            Kept::Greatest => {
                for row in 0..rows / 2 {
                    for column in 0..columns / 2 {
                        let (upper, lower) = (&tile[2 * row], &tile[2 * row + 1]);
                        let above = s.max(upper[2 * column], upper[2 * column + 1]);
                        let below = s.max(lower[2 * column], lower[2 * column + 1]);
                        // SAFETY: as above.
                        unsafe { self.pixels.set(s, block, 2 * x + column, 2 * y + row, s.max(above, below)) };
                    }
                }
            }
        }
    }
}

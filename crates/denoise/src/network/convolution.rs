//! A layer: its weights as the kernels read them, and how its tiles are shared out among threads.

use super::block::{Block, LANES, Shape, Tensor, zeros};
use super::instructions::{Instructions, Kernel};
use super::simd::Simd;
use super::winograd::{DOUBLED, POINTS, STORED, multiply, transform_input, transform_output, weight_points};
use rayon::prelude::*;
use std::marker::PhantomData;
use std::sync::Mutex;

/// Weights of 3×3 pixels, biases, and the rectifier.
pub(super) struct Convolution {
    inputs: usize,
    outputs: usize,
    /// Per block of output channels, point and input channel.
    weights: Vec<Block>,
    bias: Vec<Block>,
}

/// What a layer reads: all channels of a tensor, each pixel once, or four times (two by two).
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub tensor: &'a Tensor,
    pub doubled: bool,
}

/// What becomes of a layer's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kept {
    All,
    /// The greatest of two by two pixels.
    Greatest,
}

impl Convolution {
    /// Of `weights`, in the order output channel, input channel, row, column, and one bias per output channel.
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

    /// The layer's values, where it reads `sources` one after the other. Tiles are spread over the threads of the current pool.
    pub fn apply(&self, instructions: Instructions, sources: &[Source<'_>], kept: Kept) -> Tensor {
        let run = Run::new(self, instructions, sources, kept);
        let (width, height) = (run.width, run.height);
        let mut output = Tensor::new(match kept {
            Kept::All => Shape { channels: self.outputs, width, height },
            Kept::Greatest => Shape { channels: self.outputs, width: width / 2, height: height / 2 },
        });
        let pixels = Pixels::new(&mut output);
        let spare: Mutex<Vec<Scratch>> = Mutex::new(Vec::new());
        let spares = || spare.lock().expect("no thread panics while it holds the lock");
        (0..run.count.div_ceil(run.tiles)).into_par_iter().for_each(|index| {
            let taken = spares().pop();
            let mut scratch = taken.unwrap_or_else(|| Scratch::new(&run));
            instructions.run(Part { run: &run, first: index * run.tiles, scratch: &mut scratch, pixels: &pixels });
            spares().push(scratch);
        });
        output
    }
}

/// What is common to all tiles of a layer.
struct Run<'a> {
    layer: &'a Convolution,
    sources: &'a [Source<'a>],
    kept: Kept,
    /// Size of the layer's values before they are pooled.
    width: usize,
    height: usize,
    /// Tiles per row, all tiles, and tiles that are worked on at a time.
    columns: usize,
    count: usize,
    tiles: usize,
    /// Blocks of output channels that are worked on at a time.
    blocks: usize,
}

impl<'a> Run<'a> {
    fn new(layer: &'a Convolution, instructions: Instructions, sources: &'a [Source<'a>], kept: Kept) -> Self {
        let (last, others) = sources.split_last().expect("a layer has a source");
        let channels = |source: &Source<'_>| source.tensor.shape.channels;
        assert!(others.iter().all(|source| channels(source) % LANES == 0), "only the last source may have an unfilled block");
        assert_eq!(sources.iter().map(channels).sum::<usize>(), layer.inputs, "channels");
        let scale = if last.doubled { 2 } else { 1 };
        let (width, height) = (scale * last.tensor.shape.width, scale * last.tensor.shape.height);
        let columns = width.div_ceil(4);
        let count = columns * height.div_ceil(4);
        // Small layers are shared out evenly.
        let share = count.div_ceil(rayon::current_num_threads()).next_multiple_of(instructions.tiles());
        let tiles = share.min(instructions.tiles_at_a_time());
        Self { layer, sources, kept, width, height, columns, count, tiles, blocks: instructions.blocks().min(layer.bias.len()) }
    }

    /// Distance of two points in the input: odd, so that points do not compete for the same lines of the cache.
    fn stride(&self) -> usize {
        self.sources.iter().map(|source| source.tensor.shape.blocks()).sum::<usize>() * self.tiles | 1
    }

    /// Likewise in the sums.
    fn sum_stride(&self) -> usize {
        self.blocks * self.tiles | 1
    }
}

/// What a thread works in.
struct Scratch {
    /// Per point, block of input channels and tile.
    values: Vec<Block>,
    /// Per point, block of output channels and tile.
    sums: Vec<Block>,
}

impl Scratch {
    fn new(run: &Run<'_>) -> Self {
        Self { values: zeros(POINTS * run.stride()), sums: zeros(POINTS * run.sum_stride()) }
    }
}

/// The pixels of a tensor, written by several threads.
struct Pixels<'a> {
    start: *mut Block,
    /// Blocks from `start` on.
    len: usize,
    shape: Shape,
    tensor: PhantomData<&'a mut Tensor>,
}

// SAFETY: all that threads do through it is to write pixels, each its own, as `set` asks of them.
unsafe impl Sync for Pixels<'_> {}

impl<'a> Pixels<'a> {
    fn new(tensor: &'a mut Tensor) -> Self {
        Self { start: tensor.data.as_mut_ptr(), len: tensor.data.len(), shape: tensor.shape, tensor: PhantomData }
    }

    /// Stores a pixel of a block of channels.
    ///
    /// # Safety
    /// No other thread reads or writes the pixel meanwhile.
    #[inline(always)]
    unsafe fn set<S: Simd>(&self, s: S, block: usize, x: usize, y: usize, value: S::Lanes) {
        let index = self.shape.bordered(block, x + 1, y + 1);
        assert!(index < self.len);
        // SAFETY: `index` lies within the tensor, which is borrowed for as long as `self`, and the pixel is this thread's.
        s.store(value, unsafe { &mut *self.start.add(index) });
    }
}

/// A row of tiles, from one that is a whole number of runs from the first.
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
        let end = (first + self.run.tiles).min(self.run.count);
        (first..end).map(move |tile| (tile - first, tile % columns, tile / columns))
    }

    /// All channels of all tiles at the points.
    #[inline(always)]
    fn inputs<S: Simd>(&mut self, s: S) {
        let (stride, mut block) = (self.run.stride(), 0);
        for source in self.run.sources {
            let (shape, data) = (source.tensor.shape, &source.tensor.data);
            for channels in 0..shape.blocks() {
                for (place, x, y) in self.tiles() {
                    let out = &mut self.scratch.values[block * self.run.tiles + place..];
                    if source.doubled {
                        transform_input(s, &data[shape.bordered(channels, 2 * x, 2 * y)..], shape.pitch(), DOUBLED, out, stride);
                    } else {
                        transform_input(s, &data[shape.bordered(channels, 4 * x, 4 * y)..], shape.pitch(), STORED, out, stride);
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
        let count = run.tiles.min(run.count - self.first);
        for point in 0..POINTS {
            let mut weights: [&[Block]; BLOCKS] = [&[]; BLOCKS];
            for b in 0..BLOCKS {
                weights[b] = &layer.weights[((first + b) * POINTS + point) * layer.inputs..][..layer.inputs];
            }
            for t in (0..count).step_by(TILES) {
                let (values, sums) = (&values[point * stride + t..], &mut sums[point * sum_stride + t..]);
                multiply::<S, TILES, BLOCKS>(s, values, run.tiles, weights, sums, run.tiles);
            }
        }
        for b in 0..BLOCKS {
            for (place, x, y) in self.tiles() {
                let tile = transform_output(s, &self.scratch.sums[b * run.tiles + place..], sum_stride, &layer.bias[first + b]);
                self.store(s, first + b, x, y, &tile);
            }
        }
    }

    /// Stores what lies within the picture of the tile in column `x` and row `y`.
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
                        let [upper, lower] = [&tile[2 * row], &tile[2 * row + 1]];
                        let [above, below] = [upper, lower].map(|values| s.max(values[2 * column], values[2 * column + 1]));
                        // SAFETY: as above.
                        unsafe { self.pixels.set(s, block, 2 * x + column, 2 * y + row, s.max(above, below)) };
                    }
                }
            }
        }
    }
}

//! Sixteen channels of one pixel, the unit in which everything is stored, and pictures of them.

use bytemuck::Zeroable;

/// Channels per block.
pub(super) const LANES: usize = 16;

/// Sixteen consecutive channels of a pixel, or the weights of sixteen consecutive output channels.
#[derive(Clone, Copy, Debug, PartialEq, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Block(pub [f32; LANES]);

/// `count` blocks of zeros.
pub(super) fn zeros(count: usize) -> Vec<Block> {
    bytemuck::zeroed_vec(count)
}

/// The size of a layer's values, and their order in memory: blocks of channels one after the other, each a picture row by row.
///
/// Each picture has a border of zeros: one pixel above and to the left; below and to the right one more than a tile of 4×4 pixels reaches
/// beyond it. So convolutions need no special case at the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape {
    pub channels: usize,
    pub width: usize,
    pub height: usize,
}

impl Shape {
    /// Blocks of channels; the last may be filled up with zeros.
    pub fn blocks(self) -> usize {
        self.channels.div_ceil(LANES)
    }

    /// Distance of two rows.
    pub fn pitch(self) -> usize {
        self.width.next_multiple_of(4) + 2
    }

    fn rows(self) -> usize {
        self.height.next_multiple_of(4) + 2
    }

    /// Index of the pixel (`x` − 1, `y` − 1) of a block of channels: (0, 0) is the corner of the border.
    pub fn bordered(self, block: usize, x: usize, y: usize) -> usize {
        (block * self.rows() + y) * self.pitch() + x
    }
}

/// The values of a layer, or some rows of them.
pub(super) struct Tensor {
    pub shape: Shape,
    /// The first row of the layer that is here; 0 where all are.
    pub top: usize,
    pub data: Vec<Block>,
}

impl Tensor {
    /// A tensor of zeros.
    pub fn new(shape: Shape) -> Self {
        Self { shape, top: 0, data: zeros(shape.blocks() * shape.rows() * shape.pitch()) }
    }

    /// The pixels of a row, without the border.
    pub fn row(&self, block: usize, y: usize) -> &[Block] {
        let start = self.shape.bordered(block, 1, y + 1 - self.top);
        &self.data[start..start + self.shape.width]
    }

    /// Moves the rows from `top` − 1 up to `end` of the layer to the beginning; the rows below them are overwritten later.
    pub fn scroll(&mut self, top: usize, end: usize) {
        let (shape, gone, left) = (self.shape, top - self.top, end + 1 - top);
        for block in 0..shape.blocks() {
            let start = shape.bordered(block, 0, gone);
            self.data.copy_within(start..start + left * shape.pitch(), shape.bordered(block, 0, 0));
        }
        self.top = top;
    }

    /// Makes the rows from `end` of the layer on zeros.
    pub fn clear_below(&mut self, end: usize) {
        let shape = self.shape;
        for block in 0..shape.blocks() {
            self.data[shape.bordered(block, 0, end + 1 - self.top)..shape.bordered(block + 1, 0, 0)].fill(Block([0.0; LANES]));
        }
    }
}

//! The pixels of a tile, and drawing one triangle into them.

use crate::bvh::lanes::{Sixteen, lane_of};
use crate::bvh::wide::Wide;

/// Pixels along the edge of a tile, and of the blocks that it is made of. A vector holds one value for each pixel of a block, or for
/// each block of a tile.
pub(super) const TILE: usize = 16;
pub(super) const BLOCK: usize = 4;

/// Marks pixels without a triangle in [`VisibilityBuffer::triangles`](super::VisibilityBuffer::triangles).
pub const NOTHING: u32 = u32::MAX;

/// Block and lane of a pixel of a tile.
#[inline(always)]
pub(super) fn block_and_lane(column: usize, row: usize) -> (usize, usize) {
    ((row / BLOCK) * BLOCK + column / BLOCK, (row % BLOCK) * BLOCK + column % BLOCK)
}

/// The pixels of a tile, block by block.
pub(super) struct Tile {
    /// Bits of the triangle's index: they travel as `f32` and are never computed with.
    pub triangles: [Sixteen<f32>; 16],
    pub inverse_z: [Sixteen<f32>; 16],
    /// The smallest of each block: what is farther away is hidden there.
    farthest: Sixteen<f32>,
}

impl Tile {
    /// A tile of which `columns` × `rows` pixels are in the image; the others are as good as covered.
    pub fn new(columns: usize, rows: usize) -> Self {
        let nothing = Sixteen([f32::from_bits(NOTHING); 16]);
        let mut tile =
            Self { triangles: [nothing; 16], inverse_z: [Sixteen([f32::INFINITY; 16]); 16], farthest: Sixteen([f32::INFINITY; 16]) };
        for row in 0..rows {
            for column in 0..columns {
                let (block, lane) = block_and_lane(column, row);
                tile.inverse_z[block].0[lane] = 0.0;
                tile.farthest.0[block] = 0.0;
            }
        }
        tile
    }
}

/// A function of the pixel that is linear over the tile: its value at the first pixel, and its steps to the right and down.
#[derive(Clone, Copy)]
pub(super) struct Linear<T> {
    pub first: T,
    pub right: T,
    pub down: T,
}

/// One triangle to be drawn into a tile.
pub(super) struct Drawn {
    pub id: u32,
    /// Positive inside.
    pub edges: [Linear<f32>; 3],
    /// Inverse depth of the triangle.
    pub z: Linear<f32>,
    /// The inverse depths of its corners. Where it is seen from its edge, rounding could put it anywhere.
    pub z_range: [f32; 2],
    /// The blocks in which it may cover a pixel.
    pub blocks: u32,
}

/// The value at a block's first pixel; the operations are those of [`Pixels::at_blocks`].
#[inline(always)]
fn at_block(f: &Linear<f32>, block: usize) -> f32 {
    let (x, y) = ((block % BLOCK * BLOCK) as f32, (block / BLOCK * BLOCK) as f32);
    f.first + (f.right * x + f.down * y)
}

/// A tile with the places of its blocks, and of the pixels in a block.
pub(super) struct Pixels<'a, W> {
    tile: &'a mut Tile,
    block_x: W,
    block_y: W,
    pixel_x: W,
    pixel_y: W,
    /// The smallest of the tile's inverse depths.
    farthest: f32,
}

impl<'a, W: Wide> Pixels<'a, W> {
    #[inline(always)]
    pub fn new(tile: &'a mut Tile) -> Self {
        const X: Sixteen<f32> = Sixteen([0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0]);
        const Y: Sixteen<f32> = Sixteen([0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0]);
        let (x, y, block) = (W::load(&X), W::load(&Y), W::splat(BLOCK as f32));
        Self { tile, block_x: x.mul(block), block_y: y.mul(block), pixel_x: x, pixel_y: y, farthest: 0.0 }
    }

    /// The smallest of the tile's inverse depths: a triangle with smaller ones everywhere is hidden.
    #[inline(always)]
    pub fn farthest(&self) -> f32 {
        self.farthest
    }

    /// Depth beyond which everything is hidden; infinite while a pixel shows nothing.
    #[inline(always)]
    pub fn farthest_z(&self) -> f32 {
        1.0 / self.farthest
    }

    /// Draws one triangle.
    #[inline(always)]
    pub fn draw(&mut self, triangle: &Drawn) {
        /// With fewer blocks, each is looked at: that is less work than finding out which can be left out.
        const MANY: u32 = 3;
        // Leave out blocks that the triangle does not reach or in which it is hidden.
        let Drawn { id, edges, z, z_range, blocks } = triangle;
        let mut reached = *blocks;
        if reached.count_ones() >= MANY {
            reached &= self.reached(triangle);
        }
        if reached == 0 {
            return;
        }

        // What the edge functions and the depth add from a block's first pixel to its others.
        let zero = W::splat(0.0);
        let pixels = [self.at_pixels(&edges[0]), self.at_pixels(&edges[1]), self.at_pixels(&edges[2])];
        let (pixels_z, min_z, max_z) = (self.at_pixels(z), W::splat(z_range[0]), W::splat(z_range[1]));
        let mut changed = false;
        while reached != 0 {
            let block = lane_of(&mut reached);
            // Pixels of the block inside the triangle and not behind what was drawn before.
            let weights = [
                W::splat(at_block(&edges[0], block)).add(pixels[0]),
                W::splat(at_block(&edges[1], block)).add(pixels[1]),
                W::splat(at_block(&edges[2], block)).add(pixels[2]),
            ];
            let z = W::splat(at_block(z, block)).add(pixels_z).max(min_z).min(max_z);
            let old = W::load(&self.tile.inverse_z[block]);
            let inside = zero.le(weights[0].min(weights[1]).min(weights[2])) & old.le(z);
            if inside == 0 {
                continue;
            }

            // At equal depth, the triangle with the lower index wins.
            let mut nearer = inside & !z.le(old);
            let mut level = inside & !nearer;
            while level != 0 {
                let lane = lane_of(&mut level);
                nearer |= u32::from(*id < self.tile.triangles[block].0[lane].to_bits() && old.store().0[lane] > 0.0) << lane;
            }
            if nearer == 0 {
                continue;
            }

            // Store depth and index.
            let new = z.select(nearer, old);
            self.tile.inverse_z[block] = new.store();
            let ids = W::load(&self.tile.triangles[block]);
            self.tile.triangles[block] = W::splat(f32::from_bits(*id)).select(nearer, ids).store();
            self.tile.farthest.0[block] = new.min_lane();
            changed = true;
        }
        if changed {
            self.farthest = W::load(&self.tile.farthest).min_lane();
        }
    }

    /// The blocks in which a triangle may cover a pixel and be seen.
    #[inline(always)]
    fn reached(&self, triangle: &Drawn) -> u32 {
        let zero = W::splat(0.0);
        let mut reached = W::load(&self.tile.farthest).le(W::splat(triangle.z_range[1]));
        for edge in &triangle.edges {
            reached &= zero.le(self.at_blocks(edge).add(Self::max_within_block(edge)));
        }
        reached
    }

    #[inline(always)]
    fn at_blocks(&self, f: &Linear<f32>) -> W {
        W::splat(f.first).add(W::splat(f.right).mul(self.block_x).add(W::splat(f.down).mul(self.block_y)))
    }

    #[inline(always)]
    fn at_pixels(&self, f: &Linear<f32>) -> W {
        W::splat(f.right).mul(self.pixel_x).add(W::splat(f.down).mul(self.pixel_y))
    }

    /// The largest amount that a pixel adds to its block's value.
    #[inline(always)]
    fn max_within_block(f: &Linear<f32>) -> W {
        let last = (BLOCK - 1) as f32;
        W::splat((f.right * last).max(0.0) + (f.down * last).max(0.0))
    }
}

//! The visibility buffer of a pinhole camera, drawn triangle by triangle: all pixels of a small image at once.
//!
//! A picture that is only asked "which triangle?" needs no rays. The hierarchy is walked once per tile of 16×16 pixels, the nearest
//! children first; a triangle is drawn into the tile by its three edge functions, which are linear in the pixel (Olano & Greer 1997,
//! "Triangle Scan Conversion using 2D Homogeneous Coordinates": no projection, so nothing is clipped), and what is behind everything drawn
//! so far is left out, whole subtrees at a time (Greene, Kass & Miller 1993, "Hierarchical Z-Buffer Visibility").
//!
//! Edge functions are made of sums and differences of the edge's ends alone, so two triangles that share an edge get values of
//! opposite sign in every bit: no pixel falls between them. The result does not depend on the machine: there is no fused
//! multiply-add, and of triangles at the same depth the one with the lowest index is seen.

mod frustum;
mod pinhole;
mod setup;
mod tile;

#[cfg(test)]
mod tests;

use super::hierarchy::{Bvh, Kernel};
use super::lanes::{self, lane_of};
use super::leaf::Leaf;
use super::node::LEAF;
use super::stack::{Room, Stack};
use super::wide::{self, Wide};
use frustum::{Frustum, Planes};
use setup::{Setup, Waiting};
use tile::{Pixels, TILE, Tile, block_and_lane};

pub use pinhole::PinholeRays;
pub use tile::NOTHING;

/// Triangle and depth of every pixel of an image; its memory serves for one image after the other.
///
/// ```
/// use enfilade_geometry::{Bvh, NOTHING, PinholeRays, VisibilityBuffer};
/// use enfilade_math::Vec3;
///
/// // A camera at the origin that looks along x, z up, with an opening of 90 degrees; a triangle 2 m ahead fills the lower left half.
/// let bvh = Bvh::new(&[[Vec3::new(2.0, 2.0, 2.0), Vec3::new(2.0, 2.0, -2.0), Vec3::new(2.0, -2.0, -2.0)]], &|_| false);
/// let (right, down) = (Vec3::new(0.0, -0.5, 0.0), Vec3::new(0.0, 0.0, -0.5));
/// let rays = PinholeRays { origin: Vec3::ZERO, corner: Vec3::new(1.0, 0.75, 0.75), right, down };
///
/// let mut image = VisibilityBuffer::new(4, 4);
/// image.draw(&bvh, &rays);
/// assert_eq!(image.triangles()[3], NOTHING);
/// assert_eq!((image.triangles()[12], image.inverse_z()[12]), (0, 0.5));
/// ```
pub struct VisibilityBuffer {
    width: usize,
    height: usize,
    triangles: Vec<u32>,
    inverse_z: Vec<f32>,
}

impl VisibilityBuffer {
    /// An image of `width` × `height` pixels in which nothing is seen.
    pub fn new(width: u32, height: u32) -> Self {
        let (width, height) = (width as usize, height as usize);
        Self { width, height, triangles: vec![NOTHING; width * height], inverse_z: vec![0.0; width * height] }
    }

    /// Pixels per row, and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The triangle seen in each pixel, row by row; [`NOTHING`] where there is none.
    pub fn triangles(&self) -> &[u32] {
        &self.triangles
    }

    /// One over the depth of each pixel along the optical axis, 1/m; 0 where nothing is seen.
    pub fn inverse_z(&self) -> &[f32] {
        &self.inverse_z
    }

    /// Draws everything that `bvh` holds, every triangle being solid and seen from both sides.
    ///
    /// # Panics
    /// When there are placements in the hierarchy: this is for triangles in world space.
    pub fn draw(&mut self, bvh: &Bvh, rays: &PinholeRays) {
        assert!(bvh.placed.is_empty(), "a hierarchy with placements cannot be drawn; build it of all triangles");
        let forward = rays.forward();
        for y in (0..self.height).step_by(TILE) {
            for x in (0..self.width).step_by(TILE) {
                let mut tile = Tile::new((self.width - x).min(TILE), (self.height - y).min(TILE));
                let frustum = Frustum::new(rays, forward, [x, y], bvh.largest_coordinate);
                bvh.draw_tile(&mut tile, &frustum);
                self.keep(&tile, x, y);
            }
        }
    }

    fn keep(&mut self, tile: &Tile, x: usize, y: usize) {
        for row in 0..TILE.min(self.height - y) {
            for column in 0..TILE.min(self.width - x) {
                let (block, lane) = block_and_lane(column, row);
                let pixel = (y + row) * self.width + x + column;
                self.triangles[pixel] = tile.triangles[block].0[lane].to_bits();
                self.inverse_z[pixel] = tile.inverse_z[block].0[lane];
            }
        }
    }
}

impl Bvh {
    #[inline]
    fn draw_tile(&self, tile: &mut Tile, frustum: &Frustum) {
        match self.kernel {
            Kernel::Portable => draw_tile::<wide::Pair<lanes::Portable>>(self, tile, frustum),
            // SAFETY: this kernel is chosen only where the processor has the features.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2 => unsafe { draw_tile_avx2(self, tile, frustum) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx512 => unsafe { draw_tile_avx512(self, tile, frustum) },
        }
    }
}

/// [`draw_tile`] compiled for AVX2.
///
/// # Safety
/// The processor must have AVX2 and BMI1.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1")]
unsafe fn draw_tile_avx2(bvh: &Bvh, tile: &mut Tile, frustum: &Frustum) {
    draw_tile::<wide::Pair<lanes::Avx2>>(bvh, tile, frustum);
}

/// [`draw_tile`] compiled for AVX-512.
///
/// # Safety
/// The processor must have the features.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
unsafe fn draw_tile_avx512(bvh: &Bvh, tile: &mut Tile, frustum: &Frustum) {
    draw_tile::<wide::Avx512>(bvh, tile, frustum);
}

/// Walks the hierarchy, nearest boxes first, and draws what is in the frustum and not hidden.
#[inline(always)]
fn draw_tile<W: Wide>(bvh: &Bvh, tile: &mut Tile, frustum: &Frustum) {
    if bvh.nodes.is_empty() {
        return;
    }

    // The tile's pyramid, its pixels, and the triangles that wait to be drawn.
    let (planes, setup) = (Planes::<W>::new(frustum), Setup::<W>::new(frustum));
    let (mut pixels, mut waiting) = (Pixels::<W>::new(tile), Waiting::new());
    let mut room = Room::new();
    let mut stack = Stack::new(&mut room);
    // Leaves are taken two at a time: a vector holds the triangles of both.
    let mut single: Option<Leaf<'_>> = None;
    let mut current = 0;
    loop {
        if current & LEAF != 0 {
            // A leaf: with the one before it, collect the triangles that may be seen; draw them when all lanes are full.
            // SAFETY: the builder makes children of existing nodes and leaves only.
            let leaf = unsafe { Leaf::at(&bvh.words, current) };
            match single.take() {
                None => single = Some(leaf),
                Some(other) => {
                    setup.screen([other, leaf], pixels.farthest(), &mut waiting);
                    if waiting.is_full() {
                        setup.draw(&mut waiting, &mut pixels);
                    }
                }
            }
        } else {
            // An inner node: continue with the nearest child in the pyramid that is not hidden, keep the others for later.
            // SAFETY: as above, and there is a root.
            let node = unsafe { bvh.nodes.get_unchecked(current as usize) };
            let (mut entered, z) = planes.enter(node, pixels.farthest_z());
            if entered != 0 {
                let mut all = entered;
                while all != 0 {
                    bvh.prefetch::<W>(node.children.0[lane_of(&mut all)]);
                }
                current = if entered & (entered - 1) == 0 {
                    node.children.0[lane_of(&mut entered)]
                } else {
                    z.push_by_distance(entered, &node.children, &mut stack)
                };
                continue;
            }
        }

        // The next child that is not hidden by what was drawn since it was put on the stack.
        let Some(child) = stack.pop_up_to(pixels.farthest_z()) else { break };
        current = child;
    }

    // The last leaf may be without a partner, and fewer triangles may wait than there are lanes.
    if let Some(leaf) = single {
        setup.screen([leaf, Leaf::NONE], pixels.farthest(), &mut waiting);
    }
    while !waiting.is_empty() {
        setup.draw(&mut waiting, &mut pixels);
    }
}

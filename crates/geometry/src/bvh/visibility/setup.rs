//! Triangles made ready to be drawn, sixteen at a time.

use super::frustum::{Frustum, wide};
use super::tile::{BLOCK, Drawn, Linear, Pixels, TILE};
use crate::bvh::lanes::{Sixteen, lane_of};
use crate::bvh::leaf::{FILTERED, Leaf};
use crate::bvh::node::WIDTH;
use crate::bvh::wide::Wide;

/// Numbers that are kept of a waiting triangle: three corners, first and last pixel, smallest and largest inverse depth, index.
const NUMBERS: usize = 16;

/// Triangles that may be seen, collected until there are enough for all lanes: most of those in the leaves that a tile reaches are not.
pub(super) struct Waiting {
    numbers: [Row; NUMBERS],
    len: usize,
}

#[repr(C, align(64))]
#[derive(Clone, Copy)]
struct Row([f32; 2 * WIDTH]);

impl Waiting {
    pub fn new() -> Self {
        Self { numbers: [Row([0.0; 2 * WIDTH]); NUMBERS], len: 0 }
    }

    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Enough for all lanes.
    pub fn is_full(&self) -> bool {
        self.len >= WIDTH
    }

    /// The first sixteen values of a number.
    #[inline(always)]
    fn first<W: Wide>(&self, number: usize) -> W {
        W::load(&self.values(number))
    }

    #[inline(always)]
    fn values(&self, number: usize) -> Sixteen<f32> {
        let mut values = Sixteen([0.0; WIDTH]);
        values.0.copy_from_slice(&self.numbers[number].0[..WIDTH]);
        values
    }

    /// Drops the first sixteen.
    #[inline(always)]
    fn drop_first(&mut self) {
        for Row(row) in &mut self.numbers {
            row.copy_within(WIDTH.., 0);
        }
        self.len = self.len.saturating_sub(WIDTH);
    }
}

/// Constants of a tile for sixteen triangles at once.
pub(super) struct Setup<W> {
    origin: [W; 3],
    corner: [W; 3],
    right: [W; 3],
    down: [W; 3],
    /// Take a point at depth 1 to its column and row in the tile, less [`Setup::offset`].
    pixel: [[W; 3]; 2],
    offset: [W; 2],
    forward: [W; 3],
}

/// Pixels and depths that sixteen triangles may cover: the first and last column and row of each, and the range of its inverse depths.
struct Extent<W> {
    first: [W; 2],
    last: [W; 2],
    min_inverse_z: W,
    max_inverse_z: W,
}

impl<W: Wide> Setup<W> {
    #[inline(always)]
    pub fn new(frustum: &Frustum) -> Self {
        let pixel = frustum.pixel;
        Self {
            origin: wide(frustum.origin),
            corner: wide(frustum.corner),
            right: wide(frustum.right),
            down: wide(frustum.down),
            pixel: [wide(pixel[0]), wide(pixel[1])],
            offset: [W::splat(pixel[0].dot(frustum.corner)), W::splat(pixel[1].dot(frustum.corner))],
            forward: wide(frustum.forward),
        }
    }

    /// Puts those triangles of two leaves among the waiting ones that may cover a pixel and are not behind everything drawn so far, whose
    /// smallest inverse depth is `farthest`. There must be room for sixteen.
    #[inline(always)]
    pub fn screen(&self, leaves: [Leaf<'_>; 2], farthest: f32, waiting: &mut Waiting) {
        // Bound the pixels that each triangle may cover, and its depth.
        let corners = [self.corner_of(leaves, 0), self.corner_of(leaves, 1), self.corner_of(leaves, 2)];
        let extent = self.extent(corners[0], corners[1], corners[2]);

        // Keep those that are not hidden, exist, and cover a pixel.
        let mut visible = W::splat(farthest).le(extent.max_inverse_z);
        visible &= leaves[0].lanes() | leaves[1].lanes() << 8;
        visible &= extent.first[0].le(extent.last[0]) & extent.first[1].le(extent.last[1]);
        if visible == 0 {
            return;
        }

        // Append them to the waiting ones, number by number.
        let at = waiting.len;
        for k in 0..3 {
            for axis in 0..3 {
                corners[k][axis].compress(visible, &mut waiting.numbers[3 * k + axis].0, at);
            }
        }
        for k in 0..2 {
            extent.first[k].compress(visible, &mut waiting.numbers[9 + k].0, at);
            extent.last[k].compress(visible, &mut waiting.numbers[11 + k].0, at);
        }
        extent.min_inverse_z.compress(visible, &mut waiting.numbers[13].0, at);
        extent.max_inverse_z.compress(visible, &mut waiting.numbers[14].0, at);
        while visible != 0 {
            let lane = lane_of(&mut visible);
            waiting.numbers[15].0[waiting.len & 31] = f32::from_bits(leaves[lane >> 3].id(lane & 7));
            waiting.len += 1;
        }
    }

    /// Draws the first sixteen of the waiting triangles, or all.
    #[inline(always)]
    pub fn draw(&self, waiting: &mut Waiting, pixels: &mut Pixels<W>) {
        // Load the corners, relative to the camera.
        let corner = |k: usize| [waiting.first::<W>(3 * k), waiting.first::<W>(3 * k + 1), waiting.first::<W>(3 * k + 2)];
        let (a, b, c) = (corner(0), corner(1), corner(2));

        // The plane of each triangle; it is left out when it passes through the camera.
        let normal = cross(minus(b, a), minus(c, a));
        let height = dot(normal, a);
        let mut drawn = if waiting.is_full() { 0xffff } else { (1 << waiting.len) - 1 };
        drawn &= height.ne(W::splat(0.0)) & height.le(height);
        let inverse = W::splat(1.0).div(height);

        // Edge functions, positive inside from whichever side the triangle is seen, and its inverse depth.
        let sign = W::splat(1.0).copysign(height);
        let edges = [store(&self.edge(b, c, sign)), store(&self.edge(c, a, sign)), store(&self.edge(a, b, sign))];
        let z = store(&self.linear([normal[0].mul(inverse), normal[1].mul(inverse), normal[2].mul(inverse)]));

        // Draw one triangle after the other.
        while drawn != 0 {
            let lane = lane_of(&mut drawn);
            let number = |number: usize| waiting.numbers[number].0[lane];
            pixels.draw(&Drawn {
                id: number(15).to_bits() & !FILTERED,
                edges: [at(&edges[0], lane), at(&edges[1], lane), at(&edges[2], lane)],
                z: at(&z, lane),
                z_range: [number(13), number(14)],
                blocks: blocks([number(9), number(10)], [number(11), number(12)]),
            });
        }
        waiting.drop_first();
    }

    /// Bounds on the pixels and depths of triangles. One that reaches behind the camera, or far beyond the image, may be anywhere.
    #[inline(always)]
    fn extent(&self, a: [W; 3], b: [W; 3], c: [W; 3]) -> Extent<W> {
        /// Farther away than this many pixels, rounding would move a corner by more than the margin.
        const FAR: f32 = 16384.0;
        const MARGIN: f32 = 1.0 / 64.0;
        let one = W::splat(1.0);
        let inverse = [one.div(dot(a, self.forward)), one.div(dot(b, self.forward)), one.div(dot(c, self.forward))];
        let min_inverse_z = inverse[0].min(inverse[1]).min(inverse[2]);
        let max_inverse_z = inverse[0].max(inverse[1]).max(inverse[2]);
        let mut known = W::splat(0.0).lt(min_inverse_z);
        let (mut low, mut high) = ([one; 2], [one; 2]);
        for k in 0..2 {
            let at = [
                dot(a, self.pixel[k]).mul(inverse[0]).sub(self.offset[k]),
                dot(b, self.pixel[k]).mul(inverse[1]).sub(self.offset[k]),
                dot(c, self.pixel[k]).mul(inverse[2]).sub(self.offset[k]),
            ];
            low[k] = at[0].min(at[1]).min(at[2]);
            high[k] = at[0].max(at[1]).max(at[2]);
            known &= W::splat(-FAR).le(low[k]) & high[k].le(W::splat(FAR));
        }
        let (zero, end) = (W::splat(0.0), W::splat((TILE - 1) as f32));
        let (mut first, mut last) = ([zero; 2], [end; 2]);
        for k in 0..2 {
            let (from, to) = (low[k].add(W::splat(0.5 - MARGIN)), high[k].sub(W::splat(0.5 - MARGIN)));
            first[k] = round(from.max(zero).min(W::splat(TILE as f32))).select(known, zero);
            last[k] = round(to.max(W::splat(-1.0)).min(end)).select(known, end);
        }
        Extent {
            first,
            last,
            min_inverse_z: min_inverse_z.select(known, zero),
            max_inverse_z: max_inverse_z.select(known, W::splat(f32::INFINITY)),
        }
    }

    #[inline(always)]
    fn corner_of(&self, [first, last]: [Leaf<'_>; 2], corner: usize) -> [W; 3] {
        // SAFETY: there are three axes.
        unsafe {
            [
                W::of_halves(first.rows(0)[corner], last.rows(0)[corner]).sub(self.origin[0]),
                W::of_halves(first.rows(1)[corner], last.rows(1)[corner]).sub(self.origin[1]),
                W::of_halves(first.rows(2)[corner], last.rows(2)[corner]).sub(self.origin[2]),
            ]
        }
    }

    /// The function of the ray that is zero in the plane of the camera centre, `p` and `q`: (p + q) × (q − p) is twice p × q, and
    /// turns its sign over exactly with their order.
    #[inline(always)]
    fn edge(&self, p: [W; 3], q: [W; 3], sign: W) -> Linear<W> {
        let sum = [p[0].add(q[0]), p[1].add(q[1]), p[2].add(q[2])];
        let normal = cross(sum, minus(q, p));
        self.linear([normal[0].mul(sign), normal[1].mul(sign), normal[2].mul(sign)])
    }

    #[inline(always)]
    fn linear(&self, normal: [W; 3]) -> Linear<W> {
        Linear { first: dot(normal, self.corner), right: dot(normal, self.right), down: dot(normal, self.down) }
    }
}

#[inline(always)]
fn minus<W: Wide>(p: [W; 3], q: [W; 3]) -> [W; 3] {
    [p[0].sub(q[0]), p[1].sub(q[1]), p[2].sub(q[2])]
}

#[inline(always)]
fn dot<W: Wide>(p: [W; 3], q: [W; 3]) -> W {
    p[0].mul(q[0]).add(p[1].mul(q[1])).add(p[2].mul(q[2]))
}

#[inline(always)]
fn cross<W: Wide>(p: [W; 3], q: [W; 3]) -> [W; 3] {
    [p[1].mul(q[2]).sub(p[2].mul(q[1])), p[2].mul(q[0]).sub(p[0].mul(q[2])), p[0].mul(q[1]).sub(p[1].mul(q[0]))]
}

/// The nearest whole number, of numbers up to some thousands.
#[inline(always)]
fn round<W: Wide>(v: W) -> W {
    let shift = W::splat(12_582_912.0);
    v.add(shift).sub(shift)
}

/// The blocks that hold the pixels from `first` to `last`, as bits.
#[inline(always)]
fn blocks(first: [f32; 2], last: [f32; 2]) -> u32 {
    let at = |v: f32| v as i32 as u32 / BLOCK as u32;
    let columns = (0xf << at(first[0])) & (0xf >> (3 - at(last[0]).min(3)));
    let rows = (0xffff << (4 * at(first[1]))) & (0xffff >> (12 - 4 * at(last[1]).min(3)));
    ((columns & 0xf) * 0x1111) & rows
}

#[inline(always)]
fn store<W: Wide>(f: &Linear<W>) -> Linear<Sixteen<f32>> {
    Linear { first: f.first.store(), right: f.right.store(), down: f.down.store() }
}

#[inline(always)]
fn at(f: &Linear<Sixteen<f32>>, lane: usize) -> Linear<f32> {
    Linear { first: f.first.0[lane], right: f.right.0[lane], down: f.down.0[lane] }
}

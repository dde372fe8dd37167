//! Eight triangles made ready to be drawn.

use super::frustum::Frustum;
use super::tile::{BLOCK, Drawn, Linear, Pixels, TILE};
use crate::bvh::lanes::{Eight, Lanes, lane_of};
use crate::bvh::node::{Block, FILTERED};
use crate::bvh::wide::Wide;
use enfilade_math::Vec3;

/// Makes the linear functions of eight triangles at once.
pub(super) struct Setup<L> {
    origin: [L; 3],
    corner: [L; 3],
    right: [L; 3],
    down: [L; 3],
    /// Take a point at depth 1 to its column and row in the tile, less [`Setup::offset`].
    pixel: [[L; 3]; 2],
    offset: [L; 2],
    forward: [L; 3],
}

/// Of eight triangles: the pixels of the tile among which all are that a triangle may cover, and the range of its inverse depths.
struct Extent<L> {
    first: [L; 2],
    last: [L; 2],
    least: L,
    greatest: L,
}

impl<L: Lanes> Setup<L> {
    #[inline(always)]
    pub fn new(frustum: &Frustum) -> Self {
        let pixel = frustum.pixel;
        Self {
            origin: splat(frustum.origin),
            corner: splat(frustum.corner),
            right: splat(frustum.right),
            down: splat(frustum.down),
            pixel: [splat(pixel[0]), splat(pixel[1])],
            offset: [L::splat(pixel[0].dot(frustum.corner)), L::splat(pixel[1].dot(frustum.corner))],
            forward: splat(frustum.forward),
        }
    }

    /// Draws the triangles of a block; true when any pixel changed.
    #[inline(always)]
    pub fn draw<W: Wide>(&self, block: &Block, pixels: &mut Pixels<W>) -> bool {
        let (a, b, c) = (self.corner_of(block, 0), self.corner_of(block, 1), self.corner_of(block, 2));
        let extent = self.extent(a, b, c);
        let mut visible = L::splat(pixels.farthest).le(extent.greatest);
        visible &= extent.first[0].le(extent.last[0]) & extent.first[1].le(extent.last[1]);
        if visible == 0 {
            return false;
        }
        let normal = cross(minus(b, a), minus(c, a));
        let height = dot(normal, a);
        visible &= height.ne(L::splat(0.0)) & height.le(height);
        let inverse = L::splat(1.0).div(height);
        // Positive inside the triangle, from whichever side it is seen.
        let sign = L::splat(1.0).copysign(height);
        let edges = [store(&self.edge(b, c, sign)), store(&self.edge(c, a, sign)), store(&self.edge(a, b, sign))];
        let z = store(&self.linear([normal[0].mul(inverse), normal[1].mul(inverse), normal[2].mul(inverse)]));
        let (first, last) = ([extent.first[0].store(), extent.first[1].store()], [extent.last[0].store(), extent.last[1].store()]);
        let (least, greatest) = (extent.least.store(), extent.greatest.store());
        let mut changed = false;
        while visible != 0 {
            let lane = lane_of(&mut visible) & 7;
            let triangle = Drawn {
                id: block.ids.0[lane] & !FILTERED,
                edges: [at(&edges[0], lane), at(&edges[1], lane), at(&edges[2], lane)],
                z: at(&z, lane),
                z_range: [least.0[lane], greatest.0[lane]],
                blocks: blocks([first[0].0[lane], first[1].0[lane]], [last[0].0[lane], last[1].0[lane]]),
            };
            changed |= pixels.draw(&triangle);
        }
        changed
    }

    /// A triangle that reaches behind the camera, or far beyond the image, may be anywhere.
    #[inline(always)]
    fn extent(&self, a: [L; 3], b: [L; 3], c: [L; 3]) -> Extent<L> {
        /// Farther away than this many pixels, rounding would move a corner by more than the margin.
        const FAR: f32 = 16384.0;
        const MARGIN: f32 = 1.0 / 64.0;
        let one = L::splat(1.0);
        let inverse = [one.div(dot(a, self.forward)), one.div(dot(b, self.forward)), one.div(dot(c, self.forward))];
        let least = inverse[0].min(inverse[1]).min(inverse[2]);
        let greatest = inverse[0].max(inverse[1]).max(inverse[2]);
        let mut known = L::splat(0.0).lt(least);
        let (mut low, mut high) = ([one; 2], [one; 2]);
        for k in 0..2 {
            let at = [
                dot(a, self.pixel[k]).mul(inverse[0]).sub(self.offset[k]),
                dot(b, self.pixel[k]).mul(inverse[1]).sub(self.offset[k]),
                dot(c, self.pixel[k]).mul(inverse[2]).sub(self.offset[k]),
            ];
            low[k] = at[0].min(at[1]).min(at[2]);
            high[k] = at[0].max(at[1]).max(at[2]);
            known &= L::splat(-FAR).le(low[k]) & high[k].le(L::splat(FAR));
        }
        let (zero, end) = (L::splat(0.0), L::splat((TILE - 1) as f32));
        let (mut first, mut last) = ([zero; 2], [end; 2]);
        for k in 0..2 {
            let (from, to) = (low[k].add(L::splat(0.5 - MARGIN)), high[k].sub(L::splat(0.5 - MARGIN)));
            first[k] = round(from.max(zero).min(L::splat(TILE as f32))).select(known, zero);
            last[k] = round(to.max(L::splat(-1.0)).min(end)).select(known, end);
        }
        Extent { first, last, least: least.select(known, zero), greatest: greatest.select(known, L::splat(f32::INFINITY)) }
    }

    #[inline(always)]
    fn corner_of(&self, block: &Block, corner: usize) -> [L; 3] {
        let [x, y, z] = &block.corners[corner];
        [L::load(x).sub(self.origin[0]), L::load(y).sub(self.origin[1]), L::load(z).sub(self.origin[2])]
    }

    /// The function of the ray that is zero in the plane of the camera centre, `p` and `q`: (p + q) × (q − p) is twice p × q, and
    /// turns its sign over exactly with their order.
    #[inline(always)]
    fn edge(&self, p: [L; 3], q: [L; 3], sign: L) -> Linear<L> {
        let sum = [p[0].add(q[0]), p[1].add(q[1]), p[2].add(q[2])];
        let normal = cross(sum, minus(q, p));
        self.linear([normal[0].mul(sign), normal[1].mul(sign), normal[2].mul(sign)])
    }

    #[inline(always)]
    fn linear(&self, normal: [L; 3]) -> Linear<L> {
        Linear { first: dot(normal, self.corner), right: dot(normal, self.right), down: dot(normal, self.down) }
    }
}

#[inline(always)]
fn splat<L: Lanes>(v: Vec3) -> [L; 3] {
    [L::splat(v.x), L::splat(v.y), L::splat(v.z)]
}

#[inline(always)]
fn minus<L: Lanes>(p: [L; 3], q: [L; 3]) -> [L; 3] {
    [p[0].sub(q[0]), p[1].sub(q[1]), p[2].sub(q[2])]
}

#[inline(always)]
fn dot<L: Lanes>(p: [L; 3], q: [L; 3]) -> L {
    p[0].mul(q[0]).add(p[1].mul(q[1])).add(p[2].mul(q[2]))
}

#[inline(always)]
fn cross<L: Lanes>(p: [L; 3], q: [L; 3]) -> [L; 3] {
    [p[1].mul(q[2]).sub(p[2].mul(q[1])), p[2].mul(q[0]).sub(p[0].mul(q[2])), p[0].mul(q[1]).sub(p[1].mul(q[0]))]
}

/// The nearest whole number, of numbers up to some thousands.
#[inline(always)]
fn round<L: Lanes>(v: L) -> L {
    let shift = L::splat(12_582_912.0);
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
fn store<L: Lanes>(f: &Linear<L>) -> Linear<Eight<f32>> {
    Linear { first: f.first.store(), right: f.right.store(), down: f.down.store() }
}

#[inline(always)]
fn at(f: &Linear<Eight<f32>>, lane: usize) -> Linear<f32> {
    Linear { first: f.first.0[lane], right: f.right.0[lane], down: f.down.0[lane] }
}

//! The way of one ray through the tree.

use super::build::{Block, FILTERED, MAX_STACK, Node};
use super::lanes::{Eight, Lanes};
use super::{Bvh, Hit};
use enfilade_math::Ray;
use std::mem::MaybeUninit;

/// A ray made ready: constants of the box test and of the triangle test.
struct Prepared {
    origin: [f32; 3],
    /// 1/direction, finite (see [`Prepared::new`]).
    inverse: [f32; 3],
    /// The origin moved back, for the planes by which the ray leaves boxes.
    behind: [f32; 3],
    /// The origin moved ahead, for the planes by which it enters them.
    ahead: [f32; 3],
    /// Per axis, which bound of a box the ray enters by: 0 (min) or 1 (max).
    enters_by: [usize; 3],
    /// The axes of the sheared space; the last is the one of the largest component of the direction.
    axes: [usize; 3],
    shear: [f32; 3],
}

impl Prepared {
    /// The triangle test moves corners by up to 3 ε of their distance from the origin, and the box test errs by up to 2 ε; a box must not
    /// be missed that holds a triangle accepted with those roundings (nor whose thickness is zero, nor in whose side the ray lies). So
    /// boxes grow on all sides by 6 ε of a bound of that distance, by moving the origin the other way.
    ///
    /// A component of the direction that is zero would make 0 · ∞ = NaN in the plane of a wall; its inverse is kept finite.
    #[inline(always)]
    fn new(ray: &Ray, largest_coordinate: f32) -> Self {
        const SLACK: f32 = 6.0 * f32::EPSILON;
        const MAX_INVERSE: f32 = 1e18;
        let (origin, d) = (ray.origin.to_array(), ray.direction.to_array());
        let size = d.map(f32::abs);
        let x_or_y = usize::from(size[1] > size[0]);
        let z = if size[2] > size[x_or_y] { 2 } else { x_or_y };
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][z];
        let inverse_z = 1.0 / d[z];
        let shear = [d[axes[0]] * inverse_z, d[axes[1]] * inverse_z, inverse_z];

        let limit = (MAX_INVERSE * inverse_z.abs()).min(f32::MAX);
        let slack = SLACK * (largest_coordinate + ray.origin.abs().max_element());
        let (mut inverse, mut behind, mut ahead, mut enters_by) = ([0.0; 3], [0.0; 3], [0.0; 3], [0; 3]);
        for k in 0..3 {
            let exact = 1.0 / d[k];
            inverse[k] = if exact.abs() < limit { exact } else { limit.copysign(d[k]) };
            behind[k] = origin[k] - slack.copysign(d[k]);
            ahead[k] = origin[k] + slack.copysign(d[k]);
            enters_by[k] = usize::from(d[k].is_sign_negative());
        }
        Self { origin, inverse, behind, ahead, enters_by, axes, shear }
    }
}

/// Boxes and leaves still to visit, with the parameter at which the ray enters them.
struct Stack {
    entries: [MaybeUninit<(u32, f32)>; MAX_STACK],
    len: usize,
}

// The traversal keeps at most seven entries per level of a tree of at most `MAX_DEPTH` levels, so `len` never reaches `MAX_STACK`.
impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; MAX_STACK], len: 0 }
    }

    /// Puts an entry in its place among those from `base` on, which are sorted with the nearest last.
    #[inline(always)]
    fn insert(&mut self, base: usize, child: u32, t: f32) {
        debug_assert!(self.len < MAX_STACK);
        let mut at = self.len;
        while at > base {
            // SAFETY: `at` is at most `len`, below which everything has been written.
            let below = unsafe { self.entries.get_unchecked(at - 1).assume_init() };
            if below.1 >= t {
                break;
            }
            // SAFETY: `at` is at most `len`, which is below `MAX_STACK`.
            unsafe { self.entries.get_unchecked_mut(at) }.write(below);
            at -= 1;
        }
        // SAFETY: as above.
        unsafe { self.entries.get_unchecked_mut(at) }.write((child, t));
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(u32, f32)> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: everything below the former `len` has been written.
        Some(unsafe { self.entries.get_unchecked(self.len).assume_init() })
    }
}

/// [`walk`] compiled for AVX2.
///
/// # Safety
/// The processor must have AVX2 and BMI1.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1")]
pub(super) unsafe fn walk_avx2<const ANY: bool, const ASK: bool, F: Fn(&Hit) -> bool>(bvh: &Bvh, ray: &Ray, accept: F) -> Option<Hit> {
    walk::<super::lanes::Avx2, ANY, ASK, F>(bvh, ray, accept)
}

/// The first hit, or with `ANY` any hit. With `ASK`, hits on filtered triangles count only when `accept` agrees.
#[inline(always)]
pub(super) fn walk<L: Lanes, const ANY: bool, const ASK: bool, F: Fn(&Hit) -> bool>(bvh: &Bvh, ray: &Ray, accept: F) -> Option<Hit> {
    if bvh.nodes.is_empty() {
        return None;
    }
    let prepared = Prepared::new(ray, bvh.largest_coordinate);
    let boxes = BoxTest::<L>::new(&prepared, ray.t_min);
    let triangles = TriangleTest::<L>::new(&prepared, ray.t_min);
    // Triangle 0 at t_max: a hit at exactly t_max is not better, as no triangle has a lower index.
    let mut best = Hit { t: ray.t_max, triangle: 0, u: 0.0, v: 0.0 };
    let mut found = false;
    let mut at = Meets { t: Eight([0.0; 8]), u: Eight([0.0; 8]), v: Eight([0.0; 8]) };
    let mut stack = Stack::new();
    let mut current = 0;
    loop {
        if let Some(block) = Node::leaf(current) {
            // The triangles of a leaf.
            // SAFETY: the builder makes children of existing nodes and blocks only.
            let block = unsafe { bvh.blocks.get_unchecked(block) };
            let mut met = triangles.meet(block, best.t, &mut at);
            while met != 0 {
                let lane = lane_of(&mut met);
                let (id, t) = (block.ids.0[lane], at.t.0[lane]);
                let hit = Hit { t, triangle: id & !FILTERED, u: at.u.0[lane], v: at.v.0[lane] };
                let better = t < best.t || (t == best.t && hit.triangle < best.triangle);
                if better && (!ASK || id & FILTERED == 0 || accept(&hit)) {
                    if ANY {
                        return Some(hit);
                    }
                    (best, found) = (hit, true);
                }
            }
        } else {
            // The boxes of a node: go on with the nearest, keep the others for later, the farthest deepest in the stack.
            // SAFETY: as above, and there is a root.
            let node = unsafe { bvh.nodes.get_unchecked(current as usize) };
            let (mut entered, t) = boxes.enter(node, best.t);
            if entered != 0 {
                let mut nearest = lane_of(&mut entered);
                if entered != 0 {
                    let base = stack.len;
                    while entered != 0 {
                        let other = lane_of(&mut entered);
                        let farther = if t.0[other] < t.0[nearest] { std::mem::replace(&mut nearest, other) } else { other };
                        stack.insert(base, node.children[farther], t.0[farther]);
                    }
                }
                current = node.children[nearest];
                continue;
            }
        }
        loop {
            let Some((child, t)) = stack.pop() else { return found.then_some(best) };
            if t <= best.t {
                current = child;
                break;
            }
        }
    }
}

/// Takes the lowest lane out of a mask that is not empty.
#[inline(always)]
fn lane_of(mask: &mut u32) -> usize {
    let lane = mask.trailing_zeros() as usize;
    *mask &= *mask - 1;
    lane & 7
}

/// The slab test with its constants in registers.
struct BoxTest<L> {
    inverse: [L; 3],
    behind: [L; 3],
    ahead: [L; 3],
    enters_by: [usize; 3],
    t_min: L,
}

// No closures and no `array::map` here and below: they would be compiled without AVX2 and called for every operation.
impl<L: Lanes> BoxTest<L> {
    #[inline(always)]
    fn new(ray: &Prepared, t_min: f32) -> Self {
        Self {
            inverse: splat(ray.inverse),
            behind: splat(ray.behind),
            ahead: splat(ray.ahead),
            enters_by: ray.enters_by,
            t_min: L::splat(t_min),
        }
    }

    /// Which children the ray enters at or before `limit`, and where.
    #[inline(always)]
    fn enter(&self, node: &Node, limit: f32) -> (u32, Eight<f32>) {
        let from = self.enters(node, 0).max(self.enters(node, 1)).max(self.enters(node, 2).max(self.t_min));
        let to = self.leaves(node, 0).min(self.leaves(node, 1)).min(self.leaves(node, 2).min(L::splat(limit)));
        (from.le(to), from.store())
    }

    #[inline(always)]
    fn enters(&self, node: &Node, axis: usize) -> L {
        L::load(&node.bounds[axis][self.enters_by[axis]]).sub(self.ahead[axis]).mul(self.inverse[axis])
    }

    #[inline(always)]
    fn leaves(&self, node: &Node, axis: usize) -> L {
        L::load(&node.bounds[axis][1 - self.enters_by[axis]]).sub(self.behind[axis]).mul(self.inverse[axis])
    }
}

#[inline(always)]
fn splat<L: Lanes>(v: [f32; 3]) -> [L; 3] {
    [L::splat(v[0]), L::splat(v[1]), L::splat(v[2])]
}

/// Where the ray meets the planes of eight triangles. Only the lanes named beside it mean anything.
struct Meets {
    t: Eight<f32>,
    u: Eight<f32>,
    v: Eight<f32>,
}

/// The watertight triangle test with its constants.
///
/// The triangle is sheared so that the ray is the z axis; then the origin of the xy plane is inside the projected triangle exactly when
/// its three edge functions have the same sign. Two triangles that share an edge compute the two products of its edge function alike
/// and subtract them the other way round, so the signs are opposite or both values are zero: there is no gap between them. A fused
/// multiply-add would round one of the products only and break that. Rounding turns no sign over but can make a value zero, which
/// [`settle_zeros`] looks into.
struct TriangleTest<L> {
    axes: [usize; 3],
    origin: [L; 3],
    shear: [L; 3],
    t_min: L,
}

impl<L: Lanes> TriangleTest<L> {
    #[inline(always)]
    fn new(ray: &Prepared, t_min: f32) -> Self {
        let [x, y, z] = ray.axes;
        Self {
            axes: ray.axes,
            origin: splat([ray.origin[x], ray.origin[y], ray.origin[z]]),
            shear: splat(ray.shear),
            t_min: L::splat(t_min),
        }
    }

    /// Triangles hit with `t_min < t <= limit`, and where.
    #[inline(always)]
    fn meet(&self, block: &Block, limit: f32, at: &mut Meets) -> u32 {
        let (a, b, c) = (self.sheared(block, 0), self.sheared(block, 1), self.sheared(block, 2));
        let mut weights = [edge(c, b), edge(a, c), edge(b, a)];
        let zero = L::splat(0.0);
        let lowest = weights[0].min(weights[1]).min(weights[2]);
        let highest = weights[0].max(weights[1]).max(weights[2]);
        let mut inside = zero.le(lowest) | highest.le(zero);
        if inside == 0 {
            return 0;
        }
        let zeros = inside & !(weights[0].ne(zero) & weights[1].ne(zero) & weights[2].ne(zero));
        let scale = L::splat(1.0).div(weights[0].add(weights[1]).add(weights[2]));
        weights = [weights[0].mul(scale), weights[1].mul(scale), weights[2].mul(scale)];
        if zeros != 0 {
            let corners = [[a[0].store(), a[1].store()], [b[0].store(), b[1].store()], [c[0].store(), c[1].store()]];
            let mut settled = [weights[0].store(), weights[1].store(), weights[2].store()];
            inside &= !settle_zeros(zeros, &corners, &mut settled);
            weights = [L::load(&settled[0]), L::load(&settled[1]), L::load(&settled[2])];
        }
        let t = weights[0].mul(a[2]).add(weights[1].mul(b[2])).add(weights[2].mul(c[2])).mul(self.shear[2]);
        let lanes = inside & self.t_min.lt(t) & t.le(L::splat(limit));
        *at = Meets { t: t.store(), u: weights[1].store(), v: weights[2].store() };
        lanes
    }

    #[inline(always)]
    fn sheared(&self, block: &Block, corner: usize) -> [L; 3] {
        let [x, y, z] = self.axes;
        let pz = L::load(&block.corners[corner][z]).sub(self.origin[2]);
        let px = L::load(&block.corners[corner][x]).sub(self.origin[0]).sub(self.shear[0].mul(pz));
        let py = L::load(&block.corners[corner][y]).sub(self.origin[1]).sub(self.shear[1].mul(pz));
        [px, py, pz]
    }
}

/// Twice the area of the triangle of the origin, `p` and `q`; the sign turns over exactly with their order.
#[inline(always)]
fn edge<L: Lanes>(p: [L; 3], q: [L; 3]) -> L {
    p[0].mul(q[1]).sub(p[1].mul(q[0]))
}

/// Decides again for triangles with an edge function of zero, in double precision, where products of `f32` are exact: the ray runs
/// through an edge (inside), or the products were rounded to the same number (either). Returns the lanes that are outside.
#[cold]
fn settle_zeros(mut lanes: u32, corners: &[[Eight<f32>; 2]; 3], weights: &mut [Eight<f32>; 3]) -> u32 {
    let mut outside = 0;
    while lanes != 0 {
        let lane = lane_of(&mut lanes);
        let edge = |p: usize, q: usize| {
            let at = |corner: usize, axis: usize| f64::from(corners[corner][axis].0[lane]);
            at(p, 0) * at(q, 1) - at(p, 1) * at(q, 0)
        };
        let exact = [edge(2, 1), edge(0, 2), edge(1, 0)];
        let sum: f64 = exact.iter().sum();
        let same_sign = exact.iter().all(|&w| w >= 0.0) || exact.iter().all(|&w| w <= 0.0);
        if !same_sign || sum == 0.0 {
            outside |= 1 << lane;
        }
        for (weight, exact) in weights.iter_mut().zip(exact) {
            weight.0[lane] = (exact / sum) as f32;
        }
    }
    outside
}

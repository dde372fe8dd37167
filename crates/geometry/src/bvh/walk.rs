//! The way of one ray through the tree.

use super::build::{Block, FILTERED, MAX_STACK, Node};
use super::lanes::{Eight, Lanes};
use super::{Bvh, Hit};
use enfilade_math::{Bounds3, Ray};
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
    /// boxes grow on all sides by 6 ε of the greatest distance or coordinate, by moving the origin the other way.
    ///
    /// A component of the direction that is zero would make 0 · ∞ = NaN in the plane of a wall; its inverse is kept finite.
    #[inline(always)]
    fn new(ray: &Ray, bounds: &Bounds3) -> Self {
        const SLACK: f32 = 6.0 * f32::EPSILON;
        const MAX_INVERSE: f32 = 1e18;
        let (origin, d) = (ray.origin.to_array(), ray.direction.to_array());
        let size = d.map(f32::abs);
        let z = match size {
            [x, y, z] if x > y && x > z => 0,
            [_, y, z] if y > z => 1,
            _ => 2,
        };
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let inverse_z = 1.0 / d[z];
        let shear = [d[axes[0]] * inverse_z, d[axes[1]] * inverse_z, inverse_z];

        let limit = (MAX_INVERSE * inverse_z.abs()).min(f32::MAX);
        let to_corners = (bounds.min - ray.origin).abs().max((bounds.max - ray.origin).abs());
        let slack = SLACK * to_corners.max(ray.origin.abs()).max_element();
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

impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; MAX_STACK], len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, child: u32, t: f32) {
        self.entries[self.len].write((child, t));
        self.len += 1;
    }

    /// Puts an entry in its place among those from `base` on, which are sorted with the nearest last.
    #[inline(always)]
    fn insert(&mut self, base: usize, child: u32, t: f32) {
        let mut at = self.len;
        while at > base {
            // SAFETY: everything below `len` has been written.
            let below = unsafe { self.entries[at - 1].assume_init() };
            if below.1 >= t {
                break;
            }
            self.entries[at].write(below);
            at -= 1;
        }
        self.entries[at].write((child, t));
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(u32, f32)> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: everything below the former `len` has been written.
        Some(unsafe { self.entries[self.len].assume_init() })
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
    let prepared = Prepared::new(ray, &bvh.bounds);
    let boxes = BoxTest::<L>::new(&prepared, ray.t_min);
    // Triangle 0 at t_max: a hit at exactly t_max is not better, as no triangle has a lower index.
    let mut best = Hit { t: ray.t_max, triangle: 0, u: 0.0, v: 0.0 };
    let mut found = false;
    let mut stack = Stack::new();
    let mut current = 0;
    loop {
        if let Some(block) = Node::leaf(current) {
            // The triangles of a leaf.
            if let Some((mut candidates, meets)) = meet::<L>(&bvh.blocks[block], ray, &prepared, best.t) {
                while candidates != 0 {
                    let lane = candidates.trailing_zeros() as usize;
                    candidates &= candidates - 1;
                    let (id, t) = (bvh.blocks[block].ids.0[lane], meets.t.0[lane]);
                    let hit = Hit { t, triangle: id & !FILTERED, u: meets.u.0[lane], v: meets.v.0[lane] };
                    let better = t < best.t || (t == best.t && hit.triangle < best.triangle);
                    if better && (!ASK || id & FILTERED == 0 || accept(&hit)) {
                        if ANY {
                            return Some(hit);
                        }
                        (best, found) = (hit, true);
                    }
                }
            }
        } else {
            // The boxes of a node: go on with the nearest, keep the others for later, the farthest deepest in the stack.
            let node = &bvh.nodes[current as usize];
            let (mut entered, t) = boxes.enter(node, best.t);
            if entered != 0 {
                let base = stack.len;
                while entered != 0 {
                    let lane = entered.trailing_zeros() as usize;
                    entered &= entered - 1;
                    stack.insert(base, node.children[lane], t.0[lane]);
                }
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

/// The slab test with its constants in registers.
struct BoxTest<L> {
    inverse: [L; 3],
    behind: [L; 3],
    ahead: [L; 3],
    enters_by: [usize; 3],
    t_min: L,
}

impl<L: Lanes> BoxTest<L> {
    #[inline(always)]
    fn new(ray: &Prepared, t_min: f32) -> Self {
        let splat = |v: [f32; 3]| v.map(|x| L::splat(x));
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
        let enter = |k: usize| L::load(&node.bounds[k][self.enters_by[k]]).sub(self.ahead[k]).mul(self.inverse[k]);
        let leave = |k: usize| L::load(&node.bounds[k][1 - self.enters_by[k]]).sub(self.behind[k]).mul(self.inverse[k]);
        let from = enter(0).max(enter(1)).max(enter(2).max(self.t_min));
        let to = leave(0).min(leave(1)).min(leave(2).min(L::splat(limit)));
        (from.le(to), from.store())
    }
}

/// Where the ray meets the planes of eight triangles. Only the lanes named beside it mean anything.
struct Meets {
    t: Eight<f32>,
    u: Eight<f32>,
    v: Eight<f32>,
}

/// The watertight triangle test: lanes with `t_min < t <= limit`, and the hits there.
///
/// The triangle is sheared so that the ray is the z axis; then the origin of the xy plane is inside the projected triangle exactly when
/// its three edge functions have the same sign. Two triangles that share an edge compute the two products of its edge function alike
/// and subtract them the other way round, so the signs are opposite or both values are zero: there is no gap between them. A fused
/// multiply-add would round one of the products only and break that. Rounding turns no sign over but can make a value zero, which
/// [`settle_zeros`] looks into.
#[inline(always)]
fn meet<L: Lanes>(block: &Block, ray: &Ray, prepared: &Prepared, limit: f32) -> Option<(u32, Meets)> {
    let [x, y, z] = prepared.axes;
    let origin = prepared.axes.map(|k| L::splat(prepared.origin[k]));
    let shear = prepared.shear.map(|s| L::splat(s));
    let corner = |c: usize| {
        let from_origin = |axis: usize, o: L| L::load(&block.corners[c][axis]).sub(o);
        let (px, py, pz) = (from_origin(x, origin[0]), from_origin(y, origin[1]), from_origin(z, origin[2]));
        [px.sub(shear[0].mul(pz)), py.sub(shear[1].mul(pz)), pz]
    };
    let (a, b, c) = (corner(0), corner(1), corner(2));
    let edge = |p: [L; 3], q: [L; 3]| p[0].mul(q[1]).sub(p[1].mul(q[0]));
    let (weight_a, weight_b, weight_c) = (edge(c, b), edge(a, c), edge(b, a));

    let zero = L::splat(0.0);
    let lowest = weight_a.min(weight_b).min(weight_c);
    let highest = weight_a.max(weight_b).max(weight_c);
    let mut inside = zero.le(lowest) | highest.le(zero);
    if inside == 0 {
        return None;
    }
    let scale = L::splat(1.0).div(weight_a.add(weight_b).add(weight_c));
    let mut weights = [weight_a.mul(scale), weight_b.mul(scale), weight_c.mul(scale)];
    let zeros = inside & !(weight_a.ne(zero) & weight_b.ne(zero) & weight_c.ne(zero));
    if zeros != 0 {
        let sheared = [a, b, c].map(|p| [p[0].store(), p[1].store()]);
        let mut settled = weights.map(|w| w.store());
        inside &= !settle_zeros(zeros, &sheared, &mut settled);
        weights = [L::load(&settled[0]), L::load(&settled[1]), L::load(&settled[2])];
    }
    let t = weights[0].mul(a[2]).add(weights[1].mul(b[2])).add(weights[2].mul(c[2])).mul(shear[2]);
    let lanes = inside & L::splat(ray.t_min).lt(t) & t.le(L::splat(limit));
    (lanes != 0).then(|| (lanes, Meets { t: t.store(), u: weights[1].store(), v: weights[2].store() }))
}

/// Decides again for triangles with an edge function of zero, in double precision, where products of `f32` are exact: the ray runs
/// through an edge (inside), or the products were rounded to the same number (either). Returns the lanes that are outside.
#[cold]
fn settle_zeros(mut lanes: u32, corners: &[[Eight<f32>; 2]; 3], weights: &mut [Eight<f32>; 3]) -> u32 {
    let mut outside = 0;
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize;
        lanes &= lanes - 1;
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

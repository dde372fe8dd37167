//! The traversal: the way of one ray through the tree, to its first hit or to any.

use super::hierarchy::Bvh;
use super::hit::Hit;
use super::lanes::{Eight, Lanes, Sixteen, lane_of};
use super::leaf::{FILTERED, Leaf, NO_WORDS, start_of};
use super::node::{LEAF, Node};
use super::placed::{LEAVE, PLACED, Placed};
use super::prepared::{Prepared, slack};
use super::stack::{Room, Stack};
use super::triangle::{Meets, TriangleTest};
use super::wide::Wide;
use enfilade_math::{Ray, Vec3A};

/// [`walk`] compiled for AVX2.
///
/// # Safety
/// The processor must have AVX2 and BMI1.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1")]
pub(super) unsafe fn walk_avx2<const ANY: bool, const ASK: bool, const SHARED: bool, F: Fn(&Hit) -> bool>(
    bvh: &Bvh,
    ray: &Ray,
    accept: F,
) -> Option<Hit> {
    use super::{lanes::Avx2, wide::Pair};
    walk::<Pair<Avx2>, Avx2, ANY, ASK, SHARED, F>(bvh, ray, accept)
}

/// [`walk`] compiled for AVX-512.
///
/// # Safety
/// The processor must have the features.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
pub(super) unsafe fn walk_avx512<const ANY: bool, const ASK: bool, const SHARED: bool, F: Fn(&Hit) -> bool>(
    bvh: &Bvh,
    ray: &Ray,
    accept: F,
) -> Option<Hit> {
    walk::<super::wide::Avx512, super::lanes::Avx2, ANY, ASK, SHARED, F>(bvh, ray, accept)
}

/// The first hit, or with `ANY` any hit. With `ASK`, hits on filtered triangles count only when `accept` agrees. `SHARED` must be true
/// where there are placements.
///
/// With `ANY` the order in which triangles are tested, and `accept` is asked, does not depend on the kernel.
#[inline(always)]
pub(super) fn walk<W: Wide, L: Lanes, const ANY: bool, const ASK: bool, const SHARED: bool, F: Fn(&Hit) -> bool>(
    bvh: &Bvh,
    ray: &Ray,
    accept: F,
) -> Option<Hit> {
    if bvh.nodes.is_empty() {
        return None;
    }

    // Prepare the ray for the tests of boxes and of triangles.
    let prepared = Prepared::new(ray, bvh.largest_coordinate);
    let mut boxes = BoxTest::<W>::new(&prepared, ray.t_min);
    let triangles = TriangleTest::<L>::new(ray);

    // The best hit so far. Triangle 0 at t_max: a hit at exactly t_max is not better, as no triangle has a lower index.
    let mut best = Hit { t: ray.t_max, triangle: 0, u: 0.0, v: 0.0 };
    let mut found = false;
    let mut at = Meets { t: Eight([0.0; 8]), u: Eight([0.0; 8]), v: Eight([0.0; 8]) };

    // Walk from the root: `current` is a node or a leaf, the stack has those that wait.
    let mut room = Room::new();
    let mut stack = Stack::new(&mut room);
    let mut current = 0;
    // With `SHARED`, the placement whose boxes are being visited.
    let mut inside: Option<&Placed> = None;
    loop {
        if SHARED && current >= LEAF | PLACED {
            // A placement begins or ends: from here on, boxes are tested by the ray as the mesh sees it, or by the ray itself again.
            inside = bvh.placed.get((current & !(LEAF | PLACED)) as usize);
            let seen = inside.map(|placed| placed.prepared(ray, slack(ray, bvh.largest_coordinate)));
            boxes = BoxTest::new(seen.as_ref().unwrap_or(&prepared), ray.t_min);
            if let Some(placed) = inside {
                stack.push(LEAVE, f32::NEG_INFINITY);
                current = placed.root;
                continue;
            }
        } else if current & LEAF != 0 {
            // A leaf: test its triangles, those of a placement in world space. SAFETY: the builder makes children of existing nodes and
            // leaves only.
            let leaf = unsafe { Leaf::at(&bvh.words, current) };
            let mut words;
            let leaf = match inside {
                Some(placed) if SHARED => {
                    words = NO_WORDS;
                    placed.in_world(leaf, &mut words)
                }
                _ => leaf,
            };

            // Of the triangles that the ray meets, keep the nearest; of several at one distance, the one with the lowest index.
            let mut met = triangles.meet(leaf, best.t, &mut at);
            let mut nearer = false;
            while met != 0 {
                let lane = lane_of(&mut met) & 7;
                let (id, t) = (leaf.id(lane), at.t.0[lane]);
                let hit = Hit { t, triangle: id & !FILTERED, u: at.u.0[lane], v: at.v.0[lane] };
                let better = t < best.t || (t == best.t && hit.triangle < best.triangle);
                if better && (!ASK || id & FILTERED == 0 || accept(&hit)) {
                    if ANY {
                        return Some(hit);
                    }
                    (best, found, nearer) = (hit, true, true);
                }
            }

            // What waits farther away than the new hit is no longer needed.
            if nearer {
                W::retain(&mut stack, best.t);
            }
        } else {
            // An inner node: test its boxes, continue with the nearest child (or, where any hit will do, the most promising), keep the others.
            // SAFETY: as above, and there is a root.
            let node = unsafe { bvh.nodes.get_unchecked(current as usize) };
            if let Some(next) = stack.last() {
                bvh.prefetch::<W>(next);
            }
            let (mut entered, t) = boxes.enter(node, best.t);
            if entered != 0 {
                current = if ANY {
                    W::push_in_order(entered, &node.children, &mut stack)
                } else if entered & (entered - 1) == 0 {
                    node.children.0[lane_of(&mut entered)]
                } else {
                    t.push_by_distance(entered, &node.children, &mut stack)
                };
                continue;
            }
        }

        // Nothing left to enter here: take the next child from the stack, or be done.
        let Some(child) = stack.pop() else { return found.then_some(best) };
        current = child;
    }
}

impl Bvh {
    /// Asks the processor to load a child, which may be visited soon.
    #[inline(always)]
    pub(super) fn prefetch<W: Wide>(&self, child: u32) {
        let start: *const u8 = if child & LEAF != 0 {
            self.words.as_ptr().wrapping_add(start_of(child)).cast()
        } else {
            self.nodes.as_ptr().wrapping_add(child as usize).cast()
        };
        for line in 0..LINES {
            W::prefetch(start.wrapping_add(64 * line));
        }
    }
}

/// Cache lines of a node; a leaf usually has four or fewer.
const LINES: usize = size_of::<Node>() / 64;

/// Bytes of one bound of all children.
const ROW: usize = size_of::<Sixteen<f32>>();

/// The slab test with its constants in registers.
struct BoxTest<W> {
    inverse: [W; 3],
    behind: [W; 3],
    ahead: [W; 3],
    /// Per axis, how many bytes after a node's first bound the row begins by which the ray enters boxes. The row by which it leaves them is
    /// the axis' other one, [`ROW`] bytes before or after.
    near: [usize; 3],
    t_min: W,
}

// No closures and no `array::map` here: they would be compiled without vector instructions and called for every operation.
impl<W: Wide> BoxTest<W> {
    #[inline(always)]
    fn new(ray: &Prepared, t_min: f32) -> Self {
        let [x, y, z] = ray.enters_by;
        Self {
            inverse: splat(ray.inverse),
            behind: splat(ray.behind),
            ahead: splat(ray.ahead),
            near: [ROW * x, ROW * (2 + y), ROW * (4 + z)],
            t_min: W::splat(t_min),
        }
    }

    /// The children that the ray enters at or before `limit`, and the distances.
    #[inline(always)]
    fn enter(&self, node: &Node, limit: f32) -> (u32, W) {
        let from = self.enters(node, 0).max(self.enters(node, 1)).max(self.enters(node, 2).max(self.t_min));
        let to = self.leaves(node, 0).min(self.leaves(node, 1)).min(self.leaves(node, 2).min(W::splat(limit)));
        (from.le(to), from)
    }

    #[inline(always)]
    fn enters(&self, node: &Node, axis: usize) -> W {
        W::load(self.bounds(node, self.near[axis])).sub(self.ahead[axis]).mul(self.inverse[axis])
    }

    #[inline(always)]
    fn leaves(&self, node: &Node, axis: usize) -> W {
        W::load(self.bounds(node, self.near[axis] ^ ROW)).sub(self.behind[axis]).mul(self.inverse[axis])
    }

    /// The row of bounds that begins `at` bytes after the first bound.
    #[inline(always)]
    fn bounds<'n>(&self, node: &'n Node, at: usize) -> &'n Sixteen<f32> {
        // SAFETY: `at` is one of the six multiples of `ROW` that `new` makes, or its neighbour within an axis.
        unsafe { &*node.bounds.as_ptr().byte_add(at).cast() }
    }
}

#[inline(always)]
fn splat<W: Wide>(v: Vec3A) -> [W; 3] {
    [W::splat(v.x), W::splat(v.y), W::splat(v.z)]
}

//! The light hierarchy: a binary tree over emitters, from which one is drawn by its importance to a point.
//!
//! Conty Estevez & Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", built by their surface
//! area–orientation heuristic and traversed with one random number, at each node towards the more important child. The upper
//! end of the tree is a *cut*: clusters, among which [`super::LightChoice`] chooses by what it has learned.

use super::bounds::{Emitters, LightBounds, Reach};
use super::sample::LightPoint;
use enfilade_math::{Bounds3, ONE_MINUS_EPSILON};

/// Candidate planes along an axis.
const BUCKETS: usize = 12;
/// Deeper down, nodes are halved by count, so that no arrangement of emitters makes the tree deep.
const MAX_DEPTH_BY_COST: u32 = 48;

/// A tree with one emitter a leaf.
#[derive(Debug)]
pub(super) struct LightTree<E: Emitters = LightBounds> {
    nodes: Vec<Node<E::Reach>>,
    /// Bounds of each node.
    bounds: Vec<E>,
    parents: Vec<u32>,
    leaf_of_emitter: Vec<u32>,
}

impl<E: Emitters> Default for LightTree<E> {
    fn default() -> Self {
        Self { nodes: Vec::new(), bounds: Vec::new(), parents: Vec::new(), leaf_of_emitter: Vec::new() }
    }
}

#[derive(Debug)]
struct Node<R> {
    reach: R,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// The first child is the next node.
    Inner {
        second: u32,
    },
    Leaf {
        emitter: u32,
    },
}

impl<E: Emitters> LightTree<E> {
    /// Builds the tree over emitters with positive power; the others are never drawn.
    pub fn new(emitters: &[E]) -> Self {
        let mut tree = Self { leaf_of_emitter: vec![u32::MAX; emitters.len()], ..Self::default() };
        let mut items: Vec<u32> = (0..emitters.len() as u32).filter(|&i| emitters[i as usize].power() > 0.0).collect();
        if !items.is_empty() {
            tree.build(emitters, &mut items, 0, u32::MAX);
        }
        tree
    }

    fn build(&mut self, emitters: &[E], items: &mut [u32], depth: u32, parent: u32) -> E {
        let index = self.nodes.len();
        self.parents.push(parent);
        if let [emitter] = *items {
            let bounds = emitters[emitter as usize];
            self.push(bounds, Kind::Leaf { emitter });
            self.leaf_of_emitter[emitter as usize] = index as u32;
            return bounds;
        }
        let middle = if depth < MAX_DEPTH_BY_COST { partition(emitters, items) } else { None };
        let middle = middle.unwrap_or(items.len() / 2);
        let (left, right) = items.split_at_mut(middle);
        // A placeholder until the children are known.
        self.push(emitters[left[0] as usize], Kind::Inner { second: 0 });
        let first = self.build(emitters, left, depth + 1, index as u32);
        let second_index = self.nodes.len() as u32;
        let second = self.build(emitters, right, depth + 1, index as u32);
        let bounds = first.union(&second);
        self.nodes[index] = Node { reach: bounds.reach(), kind: Kind::Inner { second: second_index } };
        self.bounds[index] = bounds;
        bounds
    }

    fn push(&mut self, bounds: E, kind: Kind) {
        self.nodes.push(Node { reach: bounds.reach(), kind });
        self.bounds.push(bounds);
    }

    /// At most `limit` nodes that together contain all emitters. Beginning with the root, the node with the largest power × size is split
    /// into its children, as long as it is larger than `smallest_m`.
    pub fn cut(&self, limit: usize, smallest_m: f32) -> Vec<u32> {
        let mut cut = if self.nodes.is_empty() { Vec::new() } else { vec![0u32] };
        let weight = |node: u32| {
            let bounds = &self.bounds[node as usize];
            let size = bounds.bounds().extent().length();
            if matches!(self.nodes[node as usize].kind, Kind::Leaf { .. }) || size < smallest_m { 0.0 } else { bounds.power() * size }
        };
        while cut.len() < limit {
            let heaviest = (0..cut.len()).max_by(|&a, &b| weight(cut[a]).total_cmp(&weight(cut[b])).then(b.cmp(&a)));
            let Some(heaviest) = heaviest.filter(|&i| weight(cut[i]) > 0.0) else { break };
            let Kind::Inner { second } = self.nodes[cut[heaviest] as usize].kind else { break };
            cut[heaviest] += 1;
            cut.insert(heaviest + 1, second);
        }
        cut
    }

    /// The entry of `cut` above each emitter, `u32::MAX` for emitters without power.
    pub fn cluster_of_emitter(&self, cut: &[u32]) -> Vec<u32> {
        let mut cluster_of_node = vec![u32::MAX; self.nodes.len()];
        for (cluster, &node) in cut.iter().enumerate() {
            cluster_of_node[node as usize] = cluster as u32;
        }
        for node in 0..self.nodes.len() {
            if cluster_of_node[node] == u32::MAX && self.parents[node] != u32::MAX {
                cluster_of_node[node] = cluster_of_node[self.parents[node] as usize];
            }
        }
        self.leaf_of_emitter.iter().map(|&leaf| cluster_of_node.get(leaf as usize).copied().unwrap_or(u32::MAX)).collect()
    }

    /// Importance of all emitters below `node`.
    #[inline]
    pub fn importance(&self, node: u32, at: &LightPoint) -> f32 {
        self.nodes[node as usize].reach.importance(at)
    }

    /// An emitter below `node`, its probability given the node, and `u` renewed. `None` when none can send light to the point.
    #[inline]
    pub fn sample(&self, node: u32, at: &LightPoint, mut u: f32) -> Option<(u32, f32, f32)> {
        let mut node = node;
        let mut probability = 1.0;
        loop {
            let second = match self.nodes[node as usize].kind {
                Kind::Leaf { emitter } => return Some((emitter, probability, u)),
                Kind::Inner { second } => second,
            };
            let first_probability = self.first_probability(node, second, at)?;
            if u < first_probability {
                u = (u / first_probability).min(ONE_MINUS_EPSILON);
                probability *= first_probability;
                node += 1;
            } else {
                let second_probability = 1.0 - first_probability;
                u = ((u - first_probability) / second_probability).min(ONE_MINUS_EPSILON);
                probability *= second_probability;
                node = second;
            }
        }
    }

    /// Probability with which [`LightTree::sample`] finds `emitter` below `node`.
    #[inline]
    pub fn pmf(&self, node: u32, at: &LightPoint, emitter: u32) -> f32 {
        let mut child = self.leaf_of_emitter[emitter as usize];
        if child == u32::MAX {
            return 0.0;
        }
        let mut probability = 1.0;
        while child != node {
            let parent = self.parents[child as usize];
            let Some(Node { kind: Kind::Inner { second }, .. }) = self.nodes.get(parent as usize) else { return 0.0 };
            let Some(first_probability) = self.first_probability(parent, *second, at) else { return 0.0 };
            probability *= if child == *second { 1.0 - first_probability } else { first_probability };
            child = parent;
        }
        probability
    }

    /// Probability of the first child.
    #[inline]
    fn first_probability(&self, node: u32, second: u32, at: &LightPoint) -> Option<f32> {
        let (a, b) = (self.importance(node + 1, at), self.importance(second, at));
        let sum = a + b;
        if sum > 0.0 && sum.is_finite() {
            Some(a / sum)
        } else if sum > 0.0 {
            // On top of a point light.
            Some(if a.is_finite() {
                0.0
            } else if b.is_finite() {
                1.0
            } else {
                0.5
            })
        } else {
            None
        }
    }
}

/// Orders `items` so that the cheapest split is between two of them, and returns how many come first. `None` when no plane
/// separates them.
fn partition<E: Emitters>(emitters: &[E], items: &mut [u32]) -> Option<usize> {
    let center = |i: u32| emitters[i as usize].bounds().center();
    let centers = Bounds3::from_points(items.iter().map(|&i| center(i)));
    let all = items.iter().fold(Bounds3::EMPTY, |b, &i| b.union(emitters[i as usize].bounds()));
    let extent = centers.extent();
    let bucket_of = |i: u32, axis: usize| {
        let at = (center(i)[axis] - centers.min[axis]) / extent[axis];
        ((at * BUCKETS as f32) as usize).min(BUCKETS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if extent[axis] <= 0.0 {
            continue;
        }
        let mut buckets: [Option<E>; BUCKETS] = [None; BUCKETS];
        for &i in items.iter() {
            let bucket = &mut buckets[bucket_of(i, axis)];
            *bucket = Some(bucket.map_or(emitters[i as usize], |b| b.union(&emitters[i as usize])));
        }
        // Long boxes are cut across.
        let stretch = all.extent().max_element() / all.extent()[axis].max(f32::MIN_POSITIVE);
        for plane in 1..BUCKETS {
            let (Some(a), Some(b)) = (united(&buckets[..plane]), united(&buckets[plane..])) else { continue };
            let cost = stretch * (side_cost(&a) + side_cost(&b));
            if best.is_none_or(|(lowest, ..)| cost < lowest) {
                best = Some((cost, axis, plane));
            }
        }
    }
    let (_, axis, plane) = best?;
    // A stable partition: the order within the halves is the order of the file.
    let (first, second): (Vec<u32>, Vec<u32>) = items.iter().partition(|&&i| bucket_of(i, axis) < plane);
    items[..first.len()].copy_from_slice(&first);
    items[first.len()..].copy_from_slice(&second);
    Some(first.len())
}

fn united<E: Emitters>(buckets: &[Option<E>]) -> Option<E> {
    buckets.iter().flatten().copied().reduce(|a, b| a.union(&b))
}

/// Power × orientation × surface area.
fn side_cost<E: Emitters>(side: &E) -> f32 {
    let e = side.bounds().extent();
    side.power() * side.orientation_measure() * (e.x * e.y + e.y * e.z + e.z * e.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{Rng, Vec3, warp};

    fn many(count: usize) -> Vec<LightBounds> {
        let mut rng = Rng::new(8);
        (0..count)
            .map(|i| {
                let p = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 8.0;
                let n = warp::sphere([rng.next_f32(), rng.next_f32()]);
                let bounds = Bounds3 { min: p, max: p + Vec3::splat(0.05) };
                match i % 7 {
                    0 => LightBounds::point(p, 1.0 + rng.next_f32()),
                    1 => LightBounds::cone(p, n, 1.0, 0.6),
                    2 => LightBounds::flat(bounds, n, 0.0, false),
                    _ => LightBounds::flat(bounds, n, 0.1 + rng.next_f32(), i % 2 == 0),
                }
            })
            .collect()
    }

    fn points() -> Vec<LightPoint> {
        let mut rng = Rng::new(2);
        (0..24)
            .map(|i| {
                let p = Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) * 12.0 - Vec3::splat(2.0);
                let n = if i % 3 == 0 { Vec3::ZERO } else { warp::sphere([rng.next_f32(), rng.next_f32()]) };
                LightPoint { p, n }
            })
            .collect()
    }

    #[test]
    fn probabilities_sum_to_one_in_every_cluster_and_are_those_of_the_sampler() {
        let emitters = many(1500);
        let tree = LightTree::new(&emitters);
        let cut = tree.cut(20, 0.1);
        assert_eq!(cut.len(), 20);
        let clusters = tree.cluster_of_emitter(&cut);
        for at in points() {
            for (cluster, &node) in cut.iter().enumerate() {
                let inside = (0..emitters.len()).filter(|&e| clusters[e] == cluster as u32);
                let sum: f64 = inside.map(|e| f64::from(tree.pmf(node, &at, e as u32))).sum();
                // All or, where no emitter of some branch can reach the point, less.
                assert!(sum < 1.0 + 1e-5, "{sum}");
                let mut given_up = 0.0;
                for k in 0..500 {
                    match tree.sample(node, &at, (k as f32 + 0.5) / 500.0) {
                        Some((e, p, renewed)) => {
                            assert_eq!(clusters[e as usize], cluster as u32);
                            assert!((p - tree.pmf(node, &at, e)).abs() <= 1e-6 * p);
                            assert!((0.0..1.0).contains(&renewed));
                        }
                        None => given_up += 1.0 / 500.0,
                    }
                }
                assert!((1.0 - sum - given_up).abs() < 0.15, "missing {} and given up {given_up}", 1.0 - sum);
            }
        }
    }

    #[test]
    fn emitters_without_power_are_in_no_cluster_and_an_empty_tree_has_no_cut() {
        let emitters = many(50);
        let tree = LightTree::new(&emitters);
        let clusters = tree.cluster_of_emitter(&tree.cut(8, 0.0));
        for (e, emitter) in emitters.iter().enumerate() {
            assert_eq!(clusters[e] == u32::MAX, emitter.power == 0.0);
        }
        assert!(LightTree::<LightBounds>::new(&[]).cut(8, 0.0).is_empty());
    }

    #[test]
    fn emitters_in_one_place_do_not_make_the_tree_deep() {
        let emitters = vec![LightBounds::point(Vec3::ONE, 1.0); 5000];
        let tree = LightTree::new(&emitters);
        let at = LightPoint { p: Vec3::ZERO, n: Vec3::ZERO };
        for e in [0, 77, 4999] {
            assert!((tree.pmf(0, &at, e) * 5000.0 - 1.0).abs() < 0.7);
        }
    }
}

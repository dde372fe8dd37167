//! From triangles to the eight-wide tree: pieces of triangles, a binary tree over them, and its collapse.

use super::lanes::Eight;
use enfilade_math::{Bounds3, Vec3};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{leaf_collapser::collapse, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::PlocBuilder;
use obvhs::splits::split_aabbs_preset;

/// Up to eight boxes and what is in them.
#[repr(C, align(64))]
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    /// Per axis the lower and the upper bounds. Unused places have the empty box.
    pub bounds: [[Eight<f32>; 2]; 3],
    /// A node, or with [`LEAF`] a block. Unused places lead to block 0, where a ray full of NaN does no harm.
    pub children: [u32; 8],
}

impl Node {
    const EMPTY: Self =
        Self { bounds: [[Eight([f32::INFINITY; 8]), Eight([f32::NEG_INFINITY; 8])]; 3], children: [LEAF; 8] };

    /// The block that `child` stands for, if it is a leaf.
    #[inline(always)]
    pub fn leaf(child: u32) -> Option<usize> {
        (child & LEAF != 0).then_some((child & !LEAF) as usize)
    }
}

const LEAF: u32 = 1 << 31;

/// Up to eight triangles.
#[repr(C, align(64))]
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Block {
    /// Per corner and axis. Unused places are NaN, which fails every comparison of the triangle test.
    pub corners: [[Eight<f32>; 3]; 3],
    /// Triangle index, with [`FILTERED`].
    pub ids: Eight<u32>,
}

/// Marks a triangle that asks the filter.
pub(super) const FILTERED: u32 = 1 << 31;

const LANES: usize = 8;

/// Deepest tree that the traversal's stack is made for. The collapse of a usual binary tree stays far below it; where it does not,
/// the tree is built again with halves of equal size, which are never deeper than this.
const MAX_DEPTH: usize = 32;

/// Room for seven waiting children on every level, and one.
pub(super) const MAX_STACK: usize = (LANES - 1) * MAX_DEPTH + 1;

/// The finished tree.
pub(super) struct Built {
    pub nodes: Vec<Node>,
    pub blocks: Vec<Block>,
    pub bounds: Bounds3,
}

/// Builds the tree over all triangles that have finite corners and an area.
pub(super) fn build(corners: &[[Vec3; 3]], filtered: &dyn Fn(u32) -> bool) -> Built {
    assert!(corners.len() < FILTERED as usize, "{} triangles, at most {} fit one hierarchy", corners.len(), FILTERED - 1);
    let hittable: Vec<u32> = (0..corners.len() as u32).filter(|&i| has_area(&corners[i as usize])).collect();
    if hittable.is_empty() {
        return Built { nodes: Vec::new(), blocks: Vec::new(), bounds: Bounds3::EMPTY };
    }
    let scale = Scale::of(corners, &hittable);
    let pieces = split(corners, &hittable, scale);
    let soup = Soup { corners, pieces: &pieces, filtered };
    soup.collapse(&binary_tree(&pieces, scale)).or_else(|| soup.collapse(&balanced_tree(&pieces))).expect("a balanced tree is not too deep")
}

/// True for finite triangles whose area is not zero. In double precision, where differences and products of `f32` are all but exact.
fn has_area(triangle: &[Vec3; 3]) -> bool {
    let [a, b, c] = triangle.map(|p| p.as_dvec3());
    let area = (b - a).cross(c - a).length_squared();
    triangle.iter().all(|p| p.is_finite()) && (area > 0.0)
}

/// A part of a triangle, known by its box.
#[derive(Clone, Copy, Debug)]
struct Piece {
    bounds: Bounds3,
    triangle: u32,
}

/// Cuts the boxes of large triangles (walls, floors) into tighter ones around parts of them.
///
/// The cuts are rounded; the boxes grow by more than that error, but never beyond the triangle.
fn split(corners: &[[Vec3; 3]], hittable: &[u32], scale: Scale) -> Vec<Piece> {
    let triangles: Vec<obvhs::triangle::Triangle> = hittable
        .iter()
        .map(|&i| corners[i as usize].map(|p| scale.apply(p).to_vec3a()))
        .map(|[v0, v1, v2]| obvhs::triangle::Triangle { v0, v1, v2 })
        .collect();
    let mut boxes: Vec<Aabb> = triangles.iter().map(|t| t.aabb()).collect();
    let mut owners: Vec<u32> = (0..triangles.len() as u32).collect();
    let areas = || boxes.iter().map(Aabb::half_area);
    let (mean, most) = (areas().sum::<f32>() / boxes.len() as f32, areas().fold(0.0, f32::max));
    if std::env::var("NOSPLIT").is_err() { split_aabbs_preset(&mut boxes, &mut owners, &triangles, mean, most); }

    std::iter::zip(boxes, owners)
        .map(|(part, owner)| {
            let triangle = hittable[owner as usize];
            let whole = Bounds3::from_points(corners[triangle as usize]);
            let error = 8.0 * f32::EPSILON * whole.min.abs().max(whole.max.abs());
            let min = (scale.undo(part.min.into()) - error).max(whole.min);
            let max = (scale.undo(part.max.into()) + error).min(whole.max);
            Piece { bounds: Bounds3 { min, max }, triangle }
        })
        .collect()
}

/// A power of two that brings all coordinates to about one, so that no area overflows or vanishes.
#[derive(Clone, Copy)]
struct Scale(f64);

impl Scale {
    fn of(corners: &[[Vec3; 3]], triangles: &[u32]) -> Self {
        let largest = triangles.iter().flat_map(|&i| corners[i as usize]).map(|p| p.abs().max_element()).fold(0.0, f32::max);
        let exponent_only = 0x7ff0_0000_0000_0000;
        Self(f64::from_bits((1.0 / f64::from(largest.max(f32::MIN_POSITIVE))).to_bits() & exponent_only))
    }

    fn apply(self, p: Vec3) -> Vec3 {
        (p.as_dvec3() * self.0).as_vec3()
    }

    fn undo(self, p: Vec3) -> Vec3 {
        (p.as_dvec3() / self.0).as_vec3()
    }
}

/// A binary tree over pieces; node 0 is the root.
struct Binary {
    nodes: Vec<BinaryNode>,
    /// Pieces in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Clone, Copy)]
struct BinaryNode {
    bounds: Bounds3,
    /// First of two children, or with `count > 0` the first place in the order.
    first: u32,
    count: u32,
}

/// A tree with little surface: clusters of near neighbours merged upward, then improved by moving subtrees (`obvhs`).
fn binary_tree(pieces: &[Piece], scale: Scale) -> Binary {
    if pieces.len() <= LANES {
        return balanced_tree(pieces);
    }
    let mut config = match std::env::var("CFG").as_deref() { Ok("slow") => BvhBuildParams::slow_build(), Ok("vslow") => BvhBuildParams::very_slow_build(), _ => BvhBuildParams::medium_build() };
    if let Ok(v) = std::env::var("TC") { config.collapse_traversal_cost = v.parse().unwrap(); }
    if let Ok(v) = std::env::var("RR") { config.reinsertion_batch_ratio = v.parse().unwrap(); }
    let boxes: Vec<Aabb> = pieces
        .iter()
        .map(|p| Aabb::new(scale.apply(p.bounds.min).to_vec3a(), scale.apply(p.bounds.max).to_vec3a()))
        .collect();
    let order = (0..pieces.len() as u32).collect();
    let mut tree = PlocBuilder::with_capacity(pieces.len()).build(
        config.ploc_search_distance,
        &boxes,
        order,
        config.sort_precision,
        config.search_depth_threshold,
    );
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, config.reinsertion_batch_ratio, None);
    collapse(&mut tree, config.max_prims_per_leaf, config.collapse_traversal_cost);
    optimizer.run(&mut tree, config.reinsertion_batch_ratio * config.post_collapse_reinsertion_batch_ratio_multiplier, None);

    let nodes =
        tree.nodes.iter().map(|n| BinaryNode { bounds: Bounds3::EMPTY, first: n.first_index, count: n.prim_count }).collect();
    let mut binary = Binary { nodes, order: tree.primitive_indices };
    binary.fit(pieces);
    binary
}

/// A tree whose halves differ by one piece at most: sorted along the longest axis and cut in the middle, again and again.
fn balanced_tree(pieces: &[Piece]) -> Binary {
    let root = BinaryNode { bounds: Bounds3::EMPTY, first: 0, count: pieces.len() as u32 };
    let mut binary = Binary { nodes: vec![root], order: (0..pieces.len() as u32).collect() };
    let mut next = 0;
    while next < binary.nodes.len() {
        let BinaryNode { first, count, .. } = binary.nodes[next];
        if count as usize > LANES {
            let range = &mut binary.order[first as usize..(first + count) as usize];
            let center = |i: u32| pieces[i as usize].bounds.center();
            let spread = Bounds3::from_points(range.iter().map(|&i| center(i))).extent();
            let axis = spread.max_position();
            range.sort_by(|&a, &b| center(a)[axis].total_cmp(&center(b)[axis]));
            let half = count / 2;
            let child = binary.nodes.len() as u32;
            binary.nodes.push(BinaryNode { bounds: Bounds3::EMPTY, first, count: half });
            binary.nodes.push(BinaryNode { bounds: Bounds3::EMPTY, first: first + half, count: count - half });
            binary.nodes[next] = BinaryNode { bounds: Bounds3::EMPTY, first: child, count: 0 };
        }
        next += 1;
    }
    binary.fit(pieces);
    binary
}

impl Binary {
    /// Computes the box of every node from the pieces below it.
    fn fit(&mut self, pieces: &[Piece]) {
        let mut parents_first = vec![0];
        let mut next = 0;
        while next < parents_first.len() {
            let node = self.nodes[parents_first[next]];
            if node.count == 0 {
                parents_first.extend([node.first as usize, node.first as usize + 1]);
            }
            next += 1;
        }
        for &i in parents_first.iter().rev() {
            let node = self.nodes[i];
            self.nodes[i].bounds = if node.count == 0 {
                self.nodes[node.first as usize].bounds.union(self.nodes[node.first as usize + 1].bounds)
            } else {
                self.bounds_of(pieces, node.first, node.count)
            };
        }
    }

    fn bounds_of(&self, pieces: &[Piece], first: u32, count: u32) -> Bounds3 {
        self.range(first, count).iter().fold(Bounds3::EMPTY, |b, &i| b.union(pieces[i as usize].bounds))
    }

    fn range(&self, first: u32, count: u32) -> &[u32] {
        &self.order[first as usize..(first + count) as usize]
    }
}

/// What the collapse works on.
struct Soup<'a> {
    corners: &'a [[Vec3; 3]],
    pieces: &'a [Piece],
    filtered: &'a dyn Fn(u32) -> bool,
}

impl Soup<'_> {
    /// Makes eight-wide nodes: a node's children are opened, the one with the largest surface first, until there are eight.
    ///
    /// `None` when the tree would be deeper than [`MAX_DEPTH`].
    fn collapse(&self, binary: &Binary) -> Option<Built> {
        let mut built = Built { nodes: vec![Node::EMPTY], blocks: Vec::new(), bounds: binary.nodes[0].bounds };
        let mut waiting = vec![(binary.nodes[0], 0, 1)];
        while let Some((root, slot, depth)) = waiting.pop() {
            if depth > MAX_DEPTH {
                return None;
            }
            let children = self.open_largest(binary, root);
            for (lane, child) in children.iter().enumerate() {
                for k in 0..3 {
                    built.nodes[slot].bounds[k][0].0[lane] = child.bounds.min[k];
                    built.nodes[slot].bounds[k][1].0[lane] = child.bounds.max[k];
                }
                built.nodes[slot].children[lane] = if is_block(child) {
                    built.blocks.push(self.block(binary.range(child.first, child.count)));
                    LEAF | (built.blocks.len() - 1) as u32
                } else {
                    waiting.push((*child, built.nodes.len(), depth + 1));
                    built.nodes.push(Node::EMPTY);
                    (built.nodes.len() - 1) as u32
                };
            }
        }
        Some(built)
    }

    fn open_largest(&self, binary: &Binary, root: BinaryNode) -> Vec<BinaryNode> {
        let mut children = vec![root];
        while children.len() < LANES {
            let openable = (0..children.len()).filter(|&i| !is_block(&children[i]));
            let Some(largest) = openable.max_by(|&a, &b| half_area(&children[a]).total_cmp(&half_area(&children[b]))) else { break };
            let [left, right] = self.halves(binary, &children[largest]);
            children[largest] = left;
            children.push(right);
        }
        children
    }

    /// The two children of a node; a leaf that is too large for a block is cut in the middle.
    fn halves(&self, binary: &Binary, node: &BinaryNode) -> [BinaryNode; 2] {
        if node.count == 0 {
            return [binary.nodes[node.first as usize], binary.nodes[node.first as usize + 1]];
        }
        let half = node.count / 2;
        [(node.first, half), (node.first + half, node.count - half)]
            .map(|(first, count)| BinaryNode { bounds: binary.bounds_of(self.pieces, first, count), first, count })
    }

    /// The triangles of up to eight pieces, each once.
    fn block(&self, pieces: &[u32]) -> Block {
        let mut triangles: Vec<u32> = pieces.iter().map(|&i| self.pieces[i as usize].triangle).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let mut block = Block { corners: [[Eight([f32::NAN; LANES]); 3]; 3], ids: Eight([0; LANES]) };
        for (lane, &triangle) in triangles.iter().enumerate() {
            for (c, corner) in self.corners[triangle as usize].iter().enumerate() {
                for k in 0..3 {
                    block.corners[c][k].0[lane] = corner[k];
                }
            }
            block.ids.0[lane] = if (self.filtered)(triangle) { triangle | FILTERED } else { triangle };
        }
        block
    }
}

fn is_block(node: &BinaryNode) -> bool {
    (1..=LANES as u32).contains(&node.count)
}

/// Half the surface of a node's box. In double precision, where it cannot overflow.
fn half_area(node: &BinaryNode) -> f64 {
    let e = node.bounds.extent().as_dvec3();
    e.x * e.y + e.y * e.z + e.z * e.x
}

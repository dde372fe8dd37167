//! From triangles to the eight-wide tree, by way of a binary one.

use super::lanes::Eight;
use enfilade_math::{Bounds3, Vec3};
use obvhs::aabb::Aabb;
use obvhs::bvh2::{leaf_collapser::collapse, node::Bvh2Node, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

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
    const EMPTY: Self = Self { bounds: [[Eight([f32::INFINITY; 8]), Eight([f32::NEG_INFINITY; 8])]; 3], children: [LEAF; 8] };

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
    let soup = Soup { corners, filtered };
    let tree = soup.binary_tree(&hittable);
    soup.collapse(&tree).or_else(|| soup.collapse(&soup.balanced_tree(&hittable))).expect("a balanced tree is not too deep")
}

/// True for finite triangles whose area is not zero. In double precision, where differences and products of `f32` are all but exact.
fn has_area(triangle: &[Vec3; 3]) -> bool {
    let [a, b, c] = triangle.map(|p| p.as_dvec3());
    triangle.iter().all(|p| p.is_finite()) && (b - a).cross(c - a).length_squared() > 0.0
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
}

/// A binary tree over triangles; node 0 is the root.
struct Binary {
    nodes: Vec<BinaryNode>,
    /// Triangles in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Clone, Copy)]
struct BinaryNode {
    bounds: Bounds3,
    /// First of two children, or with `count > 0` the first place in the order.
    first: u32,
    count: u32,
}

impl BinaryNode {
    fn children(first: u32) -> Self {
        Self { bounds: Bounds3::EMPTY, first, count: 0 }
    }

    fn leaf(first: u32, count: u32) -> Self {
        Self { bounds: Bounds3::EMPTY, first, count }
    }

    fn fits_a_block(&self) -> bool {
        (1..=LANES as u32).contains(&self.count)
    }

    /// Half the surface of the box. In double precision, where it cannot overflow.
    fn half_area(&self) -> f64 {
        let e = self.bounds.max.as_dvec3() - self.bounds.min.as_dvec3();
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

/// The triangles, and what is done with them on the way to the tree.
struct Soup<'a> {
    corners: &'a [[Vec3; 3]],
    filtered: &'a dyn Fn(u32) -> bool,
}

impl Soup<'_> {
    /// A tree with little surface: clusters of near neighbours merged upward, then improved by moving subtrees (`obvhs`).
    ///
    /// Subtrees of up to eight triangles become leaves, as testing eight costs the same as testing one. Cutting the boxes of large
    /// triangles was tried and brought nothing in rooms.
    fn binary_tree(&self, triangles: &[u32]) -> Binary {
        const MOVED_PER_ROUND: f32 = 0.2;
        const MOVED_AFTER_COLLAPSE: f32 = 0.4;
        const ROUNDS_OF_NEXT_NEIGHBOURS: usize = 2;
        if triangles.len() <= LANES {
            return self.balanced_tree(triangles);
        }
        let scale = Scale::of(self.corners, triangles);
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|&i| self.bounds_of(&[i]))
            .map(|b| Aabb::new(scale.apply(b.min).to_vec3a(), scale.apply(b.max).to_vec3a()))
            .collect();
        let order = (0..triangles.len() as u32).collect();
        let mut tree = PlocBuilder::with_capacity(triangles.len()).build(
            PlocSearchDistance::High,
            &boxes,
            order,
            SortPrecision::U128,
            ROUNDS_OF_NEXT_NEIGHBOURS,
        );
        let mut optimizer = ReinsertionOptimizer::default();
        optimizer.run(&mut tree, MOVED_PER_ROUND, None);
        collapse(&mut tree, LANES as u32, LANES as f32);
        optimizer.run(&mut tree, MOVED_AFTER_COLLAPSE, None);

        let node = |n: &Bvh2Node| {
            if n.prim_count == 0 { BinaryNode::children(n.first_index) } else { BinaryNode::leaf(n.first_index, n.prim_count) }
        };
        let mut binary = Binary {
            nodes: tree.nodes.iter().map(node).collect(),
            order: tree.primitive_indices.iter().map(|&i| triangles[i as usize]).collect(),
        };
        self.fit(&mut binary);
        binary
    }

    /// A tree whose halves differ by one triangle at most: sorted along the longest axis and cut in the middle, again and again.
    fn balanced_tree(&self, triangles: &[u32]) -> Binary {
        let mut binary = Binary { nodes: vec![BinaryNode::leaf(0, triangles.len() as u32)], order: triangles.to_vec() };
        let mut next = 0;
        while next < binary.nodes.len() {
            let BinaryNode { first, count, .. } = binary.nodes[next];
            if count as usize > LANES {
                let range = &mut binary.order[first as usize..(first + count) as usize];
                let center = |&i: &u32| self.bounds_of(&[i]).center();
                let axis = Bounds3::from_points(range.iter().map(center)).extent().max_position();
                range.sort_by(|a, b| center(a)[axis].total_cmp(&center(b)[axis]));
                let half = count / 2;
                binary.nodes[next] = BinaryNode::children(binary.nodes.len() as u32);
                binary.nodes.push(BinaryNode::leaf(first, half));
                binary.nodes.push(BinaryNode::leaf(first + half, count - half));
            }
            next += 1;
        }
        self.fit(&mut binary);
        binary
    }

    /// Computes the box of every node from the triangles below it.
    fn fit(&self, binary: &mut Binary) {
        let mut parents_first = vec![0];
        let mut next = 0;
        while next < parents_first.len() {
            let node = binary.nodes[parents_first[next]];
            if node.count == 0 {
                parents_first.extend([node.first as usize, node.first as usize + 1]);
            }
            next += 1;
        }
        for &i in parents_first.iter().rev() {
            let BinaryNode { first, count, .. } = binary.nodes[i];
            binary.nodes[i].bounds = if count == 0 {
                binary.nodes[first as usize].bounds.union(binary.nodes[first as usize + 1].bounds)
            } else {
                self.bounds_of(&binary.order[first as usize..(first + count) as usize])
            };
        }
    }

    fn bounds_of(&self, triangles: &[u32]) -> Bounds3 {
        Bounds3::from_points(triangles.iter().flat_map(|&i| self.corners[i as usize]))
    }

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
            for (lane, child) in self.open_largest(binary, root).into_iter().enumerate() {
                for k in 0..3 {
                    built.nodes[slot].bounds[k][0].0[lane] = child.bounds.min[k];
                    built.nodes[slot].bounds[k][1].0[lane] = child.bounds.max[k];
                }
                built.nodes[slot].children[lane] = if child.fits_a_block() {
                    built.blocks.push(self.block(&binary.order[child.first as usize..(child.first + child.count) as usize]));
                    LEAF | (built.blocks.len() - 1) as u32
                } else {
                    waiting.push((child, built.nodes.len(), depth + 1));
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
            let openable = (0..children.len()).filter(|&i| !children[i].fits_a_block());
            let Some(largest) = openable.max_by(|&a, &b| children[a].half_area().total_cmp(&children[b].half_area())) else { break };
            let [left, right] = self.halves(binary, children[largest]);
            children[largest] = left;
            children.push(right);
        }
        children
    }

    /// The two children of a node; a leaf that is too large for a block is cut in the middle.
    fn halves(&self, binary: &Binary, node: BinaryNode) -> [BinaryNode; 2] {
        if node.count == 0 {
            return [binary.nodes[node.first as usize], binary.nodes[node.first as usize + 1]];
        }
        let half = node.count / 2;
        [(node.first, half), (node.first + half, node.count - half)].map(|(first, count)| {
            let bounds = self.bounds_of(&binary.order[first as usize..(first + count) as usize]);
            BinaryNode { bounds, first, count }
        })
    }

    fn block(&self, triangles: &[u32]) -> Block {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Every inner node has a leaf of one triangle and the rest.
    fn chain(soup: &Soup, count: u32) -> Binary {
        let mut nodes = vec![BinaryNode::children(1)];
        for i in 0..count - 1 {
            let rest = if i + 2 == count { BinaryNode::leaf(i + 1, 1) } else { BinaryNode::children(2 * i + 3) };
            nodes.extend([BinaryNode::leaf(i, 1), rest]);
        }
        let mut binary = Binary { nodes, order: (0..count).collect() };
        soup.fit(&mut binary);
        binary
    }

    fn triangles(count: u32) -> Vec<[Vec3; 3]> {
        (0..count).map(|i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::Z * i as f32)).collect()
    }

    #[test]
    fn a_tree_too_deep_for_the_stack_is_refused_and_a_balanced_one_is_not() {
        let corners = triangles(400);
        let soup = Soup { corners: &corners, filtered: &|_| false };
        assert!(soup.collapse(&chain(&soup, 200)).is_some());
        assert!(soup.collapse(&chain(&soup, 400)).is_none());
        let all: Vec<u32> = (0..400).collect();
        assert!(soup.collapse(&soup.balanced_tree(&all)).is_some());
    }

    #[test]
    fn leaves_too_large_for_a_block_are_cut() {
        let corners = triangles(100);
        let soup = Soup { corners: &corners, filtered: &|i| i % 2 == 0 };
        let mut binary = Binary { nodes: vec![BinaryNode::leaf(0, 100)], order: (0..100).collect() };
        soup.fit(&mut binary);
        let built = soup.collapse(&binary).expect("shallow");
        let mut ids: Vec<u32> = Vec::new();
        for block in &built.blocks {
            let used = (0..LANES).filter(|&lane| block.corners[0][0].0[lane].is_finite());
            ids.extend(used.map(|lane| block.ids.0[lane]));
        }
        ids.sort_unstable_by_key(|id| id & !FILTERED);
        let expected: Vec<u32> = (0..100).map(|i| if i % 2 == 0 { i | FILTERED } else { i }).collect();
        assert_eq!(ids, expected);
    }

    #[test]
    fn the_same_triangles_give_the_same_tree() {
        let mut rng = enfilade_math::Rng::new(0);
        let mut p = || Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32());
        let corners: Vec<[Vec3; 3]> = (0..5000).map(|_| [p(), p(), p()]).collect();
        let (one, other) = (build(&corners, &|_| false), build(&corners, &|_| false));
        assert!(one.nodes == other.nodes && one.blocks.len() == other.blocks.len());
        assert!(std::iter::zip(&one.blocks, &other.blocks).all(|(a, b)| a.ids == b.ids));
    }
}

//! From triangles to a binary tree of boxes, and by [`collapse`](super::collapse) to the wide one.

use super::collapse::collapse;
use super::node::{Block, FILTERED, LANES, Node};
use enfilade_math::{Bounds3, Vec3};
use obvhs::aabb::Aabb;
use obvhs::bvh2::{leaf_collapser, node::Bvh2Node, reinsertion::ReinsertionOptimizer};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

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
    collapse(&soup, &tree).or_else(|| collapse(&soup, &soup.balanced_tree(&hittable))).expect("a balanced tree is not too deep")
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
pub(super) struct Binary {
    pub nodes: Vec<BinaryNode>,
    /// Triangles in the order of the leaves.
    pub order: Vec<u32>,
}

impl Binary {
    /// The nodes that can be reached from the root, every node after its children.
    pub fn children_first(&self) -> Vec<usize> {
        let mut nodes = vec![0];
        let mut next = 0;
        while next < nodes.len() {
            let node = self.nodes[nodes[next]];
            if node.count == 0 {
                nodes.extend([node.first as usize, node.first as usize + 1]);
            }
            next += 1;
        }
        nodes.reverse();
        nodes
    }
}

#[derive(Clone, Copy)]
pub(super) struct BinaryNode {
    pub bounds: Bounds3,
    /// First of two children, or with `count > 0` the first place in the order.
    pub first: u32,
    pub count: u32,
}

impl BinaryNode {
    pub fn children(first: u32) -> Self {
        Self { bounds: Bounds3::EMPTY, first, count: 0 }
    }

    pub fn leaf(first: u32, count: u32) -> Self {
        Self { bounds: Bounds3::EMPTY, first, count }
    }

    /// Half the surface of the box. In double precision, where it cannot overflow.
    pub fn half_area(&self) -> f64 {
        let e = self.bounds.max.as_dvec3() - self.bounds.min.as_dvec3();
        e.x * e.y + e.y * e.z + e.z * e.x
    }
}

/// The triangles, and what is done with them on the way to the tree.
pub(super) struct Soup<'a> {
    pub corners: &'a [[Vec3; 3]],
    pub filtered: &'a dyn Fn(u32) -> bool,
}

impl Soup<'_> {
    /// A tree with little surface: clusters of near neighbours merged upward, then improved by moving subtrees (`obvhs`).
    ///
    /// Small subtrees become leaves on the way, with a cost that leaves the last word to [`collapse`]; moving then costs less. Cutting the
    /// boxes of large triangles was tried and brought nothing in rooms.
    fn binary_tree(&self, triangles: &[u32]) -> Binary {
        const MOVED_PER_ROUND: f32 = 0.2;
        const MOVED_AFTER_COLLAPSE: f32 = 0.4;
        const BLOCK_COST_IN_TRIANGLES: f32 = 3.0;
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
            PlocSearchDistance::Low,
            &boxes,
            order,
            SortPrecision::U128,
            ROUNDS_OF_NEXT_NEIGHBOURS,
        );
        let mut optimizer = ReinsertionOptimizer::default();
        optimizer.run(&mut tree, MOVED_PER_ROUND, None);
        leaf_collapser::collapse(&mut tree, LANES as u32, BLOCK_COST_IN_TRIANGLES);
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
    pub fn balanced_tree(&self, triangles: &[u32]) -> Binary {
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
    pub fn fit(&self, binary: &mut Binary) {
        for i in binary.children_first() {
            let BinaryNode { first, count, .. } = binary.nodes[i];
            binary.nodes[i].bounds = if count == 0 {
                binary.nodes[first as usize].bounds.union(binary.nodes[first as usize + 1].bounds)
            } else {
                self.bounds_of(&binary.order[first as usize..(first + count) as usize])
            };
        }
    }

    /// Surface of a triangle that stops every ray; of one that is filtered, none.
    pub fn stopping_area(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.corners[triangle as usize].map(|p| p.as_dvec3());
        if (self.filtered)(triangle) { 0.0 } else { 0.5 * (b - a).cross(c - a).length() }
    }

    fn bounds_of(&self, triangles: &[u32]) -> Bounds3 {
        Bounds3::from_points(triangles.iter().flat_map(|&i| self.corners[i as usize]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

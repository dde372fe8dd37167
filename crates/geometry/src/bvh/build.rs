//! From triangles to a binary tree of boxes, and by [`collapse`](super::collapse) to the wide one.

use super::binary::{Binary, BinaryNode};
use super::collapse::{Plan, collapse};
use super::leaf::{BEYOND, LANES, MAX_TRIANGLES, WORDS};
use super::node::Node;
use super::pages::Pages;
use super::placed::{Placed, Placement};
use super::reinsertion::reinsert;
use super::soup::{PlacedBox, Soup, has_area};
use enfilade_math::{Bounds3, Vec3};
use obvhs::aabb::Aabb;
use obvhs::bvh2::{leaf_collapser, node::Bvh2Node};
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

/// The finished trees: the tree of the world, whose root is node 0, and the trees of the shared meshes.
pub(super) struct Built {
    pub nodes: Pages<Node>,
    /// Words of all leaves.
    pub words: Pages<u32>,
    pub placed: Vec<Placed>,
    pub bounds: Bounds3,
}

/// A tree before there is memory for it.
struct Tree<'a> {
    soup: Soup<'a>,
    binary: Binary,
    plan: Plan,
}

/// Builds the tree over all triangles that have finite corners and an area, and over placements of meshes. `numbers` are what hits report
/// for the triangles: their indices unless given.
pub(super) fn build(
    corners: &[[Vec3; 3]],
    numbers: Option<&[u32]>,
    filtered: &dyn Fn(u32) -> bool,
    meshes: &[Vec<[Vec3; 3]>],
    placements: &[Placement],
) -> Built {
    assert!(numbers.is_none_or(|numbers| numbers.len() == corners.len()), "as many numbers as triangles");

    // The tree of the world: over all triangles with an area, and over the boxes of all placements.
    let placed: Vec<PlacedBox> = placements.iter().map(|placement| PlacedBox::new(placement, &meshes[placement.mesh])).collect();
    let soup = Soup { corners, numbers, filtered, placed: &placed };
    let triangles = (0..corners.len() as u32).filter(|&i| has_area(&corners[i as usize]));
    let boxes = (0..placed.len()).filter(|&i| !placed[i].bounds.is_empty()).map(|i| (corners.len() + i) as u32);
    let Some(world) = tree(soup, triangles.chain(boxes).collect()) else {
        return Built { nodes: Pages::filled(Node::EMPTY, 0), words: Pages::filled(0, 0), placed: Vec::new(), bounds: Bounds3::EMPTY };
    };

    // The tree of each shared mesh. Corners on a line are kept: by rounding in the world they may have an area there.
    let apart = |[a, b, c]: &[Vec3; 3]| a != b && b != c && c != a;
    let of_meshes: Vec<Option<Tree>> = meshes
        .iter()
        .map(|mesh| {
            let soup = Soup { corners: mesh, numbers: None, filtered: &|_| false, placed: &[] };
            tree(soup, (0..mesh.len() as u32).filter(|&i| apart(&mesh[i as usize])).collect())
        })
        .collect();

    // Memory for all of them: the world's tree first, then the meshes'.
    let trees = || std::iter::once(&world).chain(of_meshes.iter().flatten());
    let mut nodes = Pages::filled(Node::EMPTY, trees().map(|tree| tree.plan.node_count()).sum());
    let triangle_count: usize = trees().map(|tree| tree.plan.triangle_count()).sum();
    assert!(triangle_count <= MAX_TRIANGLES, "{triangle_count} triangles to keep, at most {MAX_TRIANGLES} fit one hierarchy");
    let mut words = Pages::filled(0, WORDS * triangle_count.max(1) + BEYOND);

    // Write one tree after the other, and note where each begins.
    let (mut first_node, mut first_triangle) = (0, 0);
    let mut write = |tree: &Tree| {
        tree.plan.write(&tree.soup, &tree.binary, (&mut nodes, first_node), (&mut words, first_triangle));
        let root = first_node;
        first_node += tree.plan.node_count() as u32;
        first_triangle += tree.plan.triangle_count() as u32;
        (root, tree.binary.nodes[0].bounds)
    };
    let (_, bounds) = write(&world);
    // A mesh without triangles has an empty box, which no ray enters.
    let roots: Vec<(u32, Bounds3)> = of_meshes.iter().map(|tree| tree.as_ref().map_or((0, Bounds3::EMPTY), &mut write)).collect();
    let ready = placements.iter().map(|placement| (placement, roots[placement.mesh]));
    let placed = ready.map(|(placement, (root, bounds))| Placed::new(placement, root, bounds)).collect();
    Built { nodes, words, placed, bounds }
}

/// The tree over some members of a soup; `None` when there are none.
fn tree(soup: Soup<'_>, members: Vec<u32>) -> Option<Tree<'_>> {
    if members.is_empty() {
        return None;
    }
    let good = binary_tree(&soup, &members);
    let (binary, plan) = match collapse(&soup, &good) {
        Some(plan) => (good, plan),
        None => {
            let balanced = balanced_tree(&soup, &members);
            let plan = collapse(&soup, &balanced).expect("a balanced tree is not too deep");
            (balanced, plan)
        }
    };
    Some(Tree { soup, binary, plan })
}

/// A tree with little surface: clusters of near neighbours merged upward (`obvhs`), then improved by moving subtrees.
///
/// Small subtrees become leaves before any is moved, at a cost that leaves the final decision to [`collapse`]: moving single triangles
/// too took half as long again, and rays visited no fewer nodes in six rooms. Splitting the boxes of large triangles was tried and gained
/// nothing in rooms.
fn binary_tree(soup: &Soup, members: &[u32]) -> Binary {
    const LEAF_COST_IN_TRIANGLES: f32 = 0.5;
    const ROUNDS_OF_NEXT_NEIGHBOURS: usize = 0;
    if members.len() <= LANES {
        return balanced_tree(soup, members);
    }

    // Boxes at a scale at which no area overflows.
    let scale = Scale::of(soup.bounds_of(members));
    let boxes: Vec<Aabb> = members
        .iter()
        .map(|&i| soup.bounds_of(&[i]))
        .map(|b| Aabb::new(scale.apply(b.min).to_vec3a(), scale.apply(b.max).to_vec3a()))
        .collect();

    // Merge near neighbours upward, make small subtrees leaves, move subtrees to better places.
    let order = (0..members.len() as u32).collect();
    let mut tree = PlocBuilder::with_capacity(members.len()).build(
        PlocSearchDistance::Low,
        &boxes,
        order,
        SortPrecision::U128,
        ROUNDS_OF_NEXT_NEIGHBOURS,
    );
    drop(boxes);
    leaf_collapser::collapse(&mut tree, LANES as u32, LEAF_COST_IN_TRIANGLES);
    reinsert(&mut tree);

    // The same tree in our own nodes, with placements alone in their leaves.
    let node = |n: &Bvh2Node| {
        if n.prim_count == 0 { BinaryNode::children(n.first_index) } else { BinaryNode::leaf(n.first_index, n.prim_count) }
    };
    let mut binary = Binary {
        nodes: tree.nodes.iter().map(node).collect(),
        order: tree.primitive_indices.iter().map(|&i| members[i as usize]).collect(),
    };
    divide(soup, &mut binary);
    binary
}

/// A tree whose halves differ by one triangle at most: sorted along the longest axis and cut in the middle, again and again.
pub(super) fn balanced_tree(soup: &Soup, members: &[u32]) -> Binary {
    let mut binary = Binary { nodes: vec![BinaryNode::leaf(0, members.len() as u32)], order: members.to_vec() };
    divide(soup, &mut binary);
    binary
}

/// Halves the leaves until they are small enough, and every placement is alone; computes the boxes.
fn divide(soup: &Soup, binary: &mut Binary) {
    let mut next = 0;
    while next < binary.nodes.len() {
        let BinaryNode { first, count, .. } = binary.nodes[next];
        // Inner nodes have no members of their own.
        let range = if count == 0 { &mut [] } else { &mut binary.order[first as usize..(first + count) as usize] };
        if range.len() > LANES || range.len() > 1 && range.iter().any(|&i| soup.placement(i).is_some()) {
            let center = |&i: &u32| soup.bounds_of(&[i]).center();
            let axis = Bounds3::from_points(range.iter().map(center)).extent().max_position();
            range.sort_by(|a, b| center(a)[axis].total_cmp(&center(b)[axis]));
            let half = count / 2;
            binary.nodes[next] = BinaryNode::children(binary.nodes.len() as u32);
            binary.nodes.push(BinaryNode::leaf(first, half));
            binary.nodes.push(BinaryNode::leaf(first + half, count - half));
        }
        next += 1;
    }
    soup.fit(binary);
}

/// A power of two that brings all coordinates to about one, so that no area overflows or vanishes.
#[derive(Clone, Copy)]
struct Scale(f64);

impl Scale {
    fn of(bounds: Bounds3) -> Self {
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let exponent_only = 0x7ff0_0000_0000_0000;
        Self(f64::from_bits((1.0 / f64::from(largest.max(f32::MIN_POSITIVE))).to_bits() & exponent_only))
    }

    fn apply(self, p: Vec3) -> Vec3 {
        (p.as_dvec3() * self.0).as_vec3()
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
        let tree = || build(&corners, None, &|_| false, &[], &[]);
        let (one, other) = (tree(), tree());
        assert!(*one.nodes == *other.nodes && *one.words == *other.words);
    }
}

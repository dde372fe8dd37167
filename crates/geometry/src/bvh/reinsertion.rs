//! Moves subtrees of a binary tree to where they enlarge fewer boxes (Meister & Bittner 2018, "Parallel Reinsertion for Bounding Volume
//! Hierarchy Optimization").
//!
//! Every round finds the best new place of each of the largest nodes, in the tree as it is. Then the nodes that gain most move first; a
//! move that would touch the nodes of an earlier one waits for the next round.

use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, node::Bvh2Node, reinsertion::reinsert_node};
use std::cmp::Reverse;

/// Share of the nodes that are looked at in the first round; in round k it is a (2k + 1)th of that.
const LARGEST: f32 = 0.15;
const ROUNDS: usize = 16;

/// A node and where it should go.
struct Move {
    from: u32,
    to: u32,
    /// Decrease of the half areas of all boxes.
    gain: f32,
}

/// Moves subtrees. In the end, children come after their parents, in the order in which the tree is walked through.
pub(super) fn reinsert(tree: &mut Bvh2) {
    // Neighbours in space are neighbours in memory from here on.
    tree.reorder_in_stack_traversal_order();
    tree.init_parents_if_uninit();
    let half_area = |tree: &Bvh2, node: u32| tree.nodes[node as usize].aabb().half_area();
    let mut candidates: Vec<(u32, f32)> = (1..tree.nodes.len() as u32).map(|node| (node, 0.0)).collect();
    let mut touched = vec![false; tree.nodes.len()];
    let mut waiting = Vec::new();
    for round in 0..ROUNDS {
        // The largest nodes; ever fewer from round to round.
        let count = (tree.nodes.len() as f32 * LARGEST) as usize / (2 * round + 1);
        candidates.iter_mut().for_each(|(node, area)| *area = half_area(tree, *node));
        if count < candidates.len() {
            candidates.select_nth_unstable_by(count, |a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        }
        if round == 0 {
            candidates.truncate(count);
        }

        // The best new place of each, those that gain most first.
        let largest = candidates.iter().take(count);
        let mut moves: Vec<Move> = largest.filter_map(|&(node, _)| best_move(tree, node, &mut waiting)).collect();
        moves.sort_unstable_by_key(|m| (Reverse(m.gain.to_bits()), m.from));

        // Move them, unless a better move of this round has touched the same nodes.
        touched.fill(false);
        for Move { from, to, .. } in moves {
            let parent = |node: u32| tree.parents[node as usize];
            let concerned = [from, to, Bvh2Node::get_sibling_id32(from), parent(from), parent(to)].map(|node| node as usize);
            if concerned.iter().all(|&node| !touched[node]) {
                concerned.iter().for_each(|&node| touched[node] = true);
                reinsert_node(tree, from as usize, to as usize);
            }
        }
    }
    tree.reorder_in_stack_traversal_order();
}

/// The best new place of a node, if any is better than its own. Places beside its own ancestors are left out: with them boxes lost more
/// surface, yet rays visited 1 % more nodes. `waiting` is memory to work in, empty before and after.
///
/// Taking the node out removes its parent, which saves the parent's area and shrinks the boxes above. Putting it in again adds a parent
/// above its new sibling and enlarges the boxes above that. So beside or below a node, the gain is at most the gain so far less the moved
/// box's own area. Subtrees with the highest such bound are searched first, and none whose bound does not exceed the best gain found.
fn best_move(tree: &Bvh2, from: u32, waiting: &mut Vec<(u32, f32)>) -> Option<Move> {
    let nodes = tree.nodes.as_slice();
    let parent = |node: usize| tree.parents[node] as usize;
    let (mut sibling, mut pivot) = (Bvh2Node::get_sibling_id(from as usize), parent(from as usize));
    let mut search = Search { nodes, moved: *nodes[from as usize].aabb(), best: Move { from, to: 0, gain: 0.0 } };
    let own_area = search.moved.half_area();

    // From the node's sibling upward: `gain` is the area saved by taking the node out, in all boxes up to the box of `pivot`.
    let mut gain = nodes[pivot].aabb().half_area();
    let mut left_behind = *nodes[sibling].aabb();
    loop {
        let below = search.look(sibling, gain);
        if below - own_area > search.best.gain {
            waiting.push((sibling as u32, below));
        }
        while let Some((node, gain)) = waiting.pop() {
            if gain - own_area <= search.best.gain {
                continue;
            }
            let first = nodes[node as usize].first_index;
            let [left, right] = [first, first + 1].map(|child| (child, search.look(child as usize, gain)));
            let order = if left.1 > right.1 { [right, left] } else { [left, right] };
            waiting.extend(order.into_iter().filter(|&(_, below)| below - own_area > search.best.gain));
        }
        if pivot != parent(from as usize) {
            left_behind = left_behind.union(nodes[sibling].aabb());
            gain += nodes[pivot].aabb().half_area() - left_behind.half_area();
        }
        if pivot == 0 {
            break;
        }
        (sibling, pivot) = (Bvh2Node::get_sibling_id(pivot), parent(pivot));
    }
    // Its own place, beside its sibling, is no move.
    (search.best.gain > 0.0 && search.best.to != Bvh2Node::get_sibling_id32(from)).then_some(search.best)
}

struct Search<'a> {
    nodes: &'a [Bvh2Node],
    /// The box of the node that moves.
    moved: Aabb,
    best: Move,
}

impl Search<'_> {
    /// Tries the place beside a node, where `gain` is what is gained when its own box and those below are left out of account. Returns
    /// the same for its children; nothing for a leaf.
    #[inline]
    fn look(&mut self, node: usize, gain: f32) -> f32 {
        let bounds = self.nodes[node].aabb();
        let beside = gain - bounds.union(&self.moved).half_area();
        if beside > self.best.gain {
            (self.best.to, self.best.gain) = (node as u32, beside);
        }
        if self.nodes[node].is_leaf() { f32::NEG_INFINITY } else { beside + bounds.half_area() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use enfilade_math::{Rng, Vec3};
    use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
    use std::collections::HashSet;

    fn tree(count: usize) -> (Bvh2, Vec<Aabb>) {
        let mut rng = Rng::new(3);
        let mut point = || Vec3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()).to_vec3a();
        let mut any_box = || {
            let corner = point();
            Aabb::new(corner, corner + (point() * point()).powf(3.0))
        };
        let boxes: Vec<Aabb> = (0..count).map(|_| any_box()).collect();
        let order = (0..count as u32).collect();
        (PlocBuilder::new().build(PlocSearchDistance::Minimum, &boxes, order, SortPrecision::U64, 0), boxes)
    }

    fn whole_area(tree: &Bvh2) -> f64 {
        tree.nodes.iter().map(|node| f64::from(node.aabb().half_area())).sum()
    }

    #[test]
    fn a_tree_keeps_its_leaves_and_loses_area() {
        for count in [2, 3, 10, 3000] {
            let (mut tree, boxes) = tree(count);
            let before = whole_area(&tree);
            reinsert(&mut tree);
            let mut seen = HashSet::new();
            for (i, node) in tree.nodes.iter().enumerate() {
                if node.is_leaf() {
                    let member = tree.primitive_indices[node.first_index as usize];
                    assert!(node.prim_count == 1 && *node.aabb() == boxes[member as usize] && seen.insert(member));
                } else {
                    let first = node.first_index as usize;
                    assert!(first > i, "children come after their parents");
                    assert_eq!(*node.aabb(), tree.nodes[first].aabb().union(tree.nodes[first + 1].aabb()));
                }
            }
            assert_eq!(seen.len(), count);
            let after = whole_area(&tree);
            assert!(after <= before && (count < 3000 || after < 0.95 * before), "{before} before, {after} after");
        }
    }

    #[test]
    fn what_a_move_gains_is_foreseen() {
        let (mut tree, _) = tree(300);
        tree.init_parents_if_uninit();
        let mut moved = 0;
        for node in 1..tree.nodes.len() as u32 {
            let before = whole_area(&tree);
            let Some(Move { from, to, gain }) = best_move(&tree, node, &mut Vec::new()) else { continue };
            reinsert_node(&mut tree, from as usize, to as usize);
            let after = whole_area(&tree);
            assert!((before - after - f64::from(gain)).abs() < 1e-4 * before, "{gain} foreseen, {} gained", before - after);
            moved += 1;
        }
        assert!(moved > 50, "{moved} moved");
    }

    #[test]
    fn no_place_is_better_than_the_best() {
        let (mut tree, _) = tree(40);
        tree.init_parents_if_uninit();
        let before = whole_area(&tree);
        for from in 1..tree.nodes.len() {
            let best = best_move(&tree, from as u32, &mut Vec::new()).map_or(0.0, |m| f64::from(m.gain));
            let ancestors = |node: usize| {
                let parent = |&node: &usize| (node != 0).then(|| tree.parents[node] as usize);
                std::iter::successors(Some(node), parent).collect::<Vec<_>>()
            };
            let sibling = Bvh2Node::get_sibling_id(from);
            for to in (0..tree.nodes.len()).filter(|&to| to != sibling && !ancestors(from).contains(&to) && !ancestors(to).contains(&from))
            {
                let mut other = tree.clone();
                reinsert_node(&mut other, from, to);
                let gain = before - whole_area(&other);
                assert!(gain < best + 1e-4, "{from} beside {to} gains {gain}, the best {best}");
            }
        }
    }
}

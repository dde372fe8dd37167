//! From the binary tree to the wide one, with the lowest expected cost.
//!
//! It is decided bottom up: for every subtree, the lowest cost is computed for each number of children that it may become in the node
//! above it (Ylitie, Karras & Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", section 3). The cost is the usual one: the surface of every box that is visited.

use super::binary::{Binary, BinaryNode};
use super::leaf::{self, FILTERED, LANES, child_of, start_of};
use super::node::{LEAF, MAX_DEPTH, Node, WIDTH};
use super::placed::PLACED;
use super::soup::Soup;
use enfilade_math::Vec3;

/// The cheapest ways to put a subtree of the binary tree under a wide node, as 1, 2, … [`WIDTH`] of that node's children. Entry k of
/// each array is for k + 1 children.
struct Ways {
    cost: [f32; WIDTH],
    /// How many of the children are in the left half. Entry 0, where the subtree is a single child: how many children that one has itself,
    /// 0 when it is a leaf.
    left: [u8; WIDTH],
    /// The most children that it can become: the number of its leaves in the binary tree, up to [`WIDTH`].
    places: usize,
    triangles: u32,
    /// Surface that stops rays, per leaf that a ray must be tested against.
    yield_per_leaf: f32,
    /// Surface that stops rays.
    area: f64,
}

/// Visiting a node and visiting a leaf take about equally long.
const NODE_COST: f32 = 1.0;
const LEAF_COST: f32 = 1.0;

/// The plan of the wide tree, made before its memory is allocated.
pub(super) struct Plan {
    /// For each node its number and the end of its children among all.
    nodes: Vec<(u32, u32)>,
    children: Vec<Child>,
    triangle_count: usize,
}

struct Child {
    /// In the binary tree.
    node: u32,
    /// The value for [`Node::children`], counted from the tree's first node and first triangle.
    link: u32,
}

/// Plans the wide tree. `None` when it would be deeper than [`MAX_DEPTH`].
pub(super) fn collapse(soup: &Soup, binary: &Binary) -> Option<Plan> {
    let ways = ways(soup, binary);
    let mut plan = Plan { nodes: Vec::new(), children: Vec::new(), triangle_count: 0 };
    let mut node_count = 1;
    let mut waiting = vec![(0, 0, 1)];

    // From the root down: the children of every node, each a placement, a leaf, or a node that waits for its turn.
    while let Some((root, number, depth)) = waiting.pop() {
        if depth > MAX_DEPTH {
            return None;
        }
        for child in children(binary, &ways, root) {
            let link = if let Some(placement) = placement(soup, binary, child) {
                LEAF | PLACED | placement as u32
            } else if ways[child].left[0] == 0 {
                let (first, count) = (plan.triangle_count, ways[child].triangles as usize);
                plan.triangle_count += count;
                child_of(first as u32, count)
            } else {
                waiting.push((child, node_count, depth + 1));
                node_count += 1;
                node_count - 1
            };
            plan.children.push(Child { node: child as u32, link });
        }
        plan.nodes.push((number, plan.children.len() as u32));
    }
    Some(plan)
}

impl Plan {
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    pub fn triangle_count(&self) -> usize {
        self.triangle_count
    }

    /// Writes the tree from `first_node` and `first_triangle` on, where so far there are [`Node::EMPTY`] and zeros.
    pub fn write(&self, soup: &Soup, binary: &Binary, (nodes, first_node): (&mut [Node], u32), (words, first_triangle): (&mut [u32], u32)) {
        let mut start = 0;
        for &(number, end) in &self.nodes {
            let to = &mut nodes[(first_node + number) as usize];
            to.children.0.fill(LEAF | first_triangle);
            for (lane, &Child { node, link }) in self.children[start..end as usize].iter().enumerate() {
                let bounds = binary.nodes[node as usize].bounds;
                for k in 0..3 {
                    to.bounds[k][0].0[lane] = bounds.min[k];
                    to.bounds[k][1].0[lane] = bounds.max[k];
                }
                to.children.0[lane] = if link & LEAF == 0 {
                    first_node + link
                } else if link & PLACED != 0 {
                    link
                } else {
                    let link = first_triangle + link;
                    leaf::write(&triangles(soup, binary, node as usize), &mut words[start_of(link)..]);
                    link
                };
            }
            start = end as usize;
        }
    }
}

/// The children of a node, in ascending order of the surface that stops rays per leaf: rays that want any hit take the last first.
fn children(binary: &Binary, ways: &[Ways], root: usize) -> Vec<usize> {
    let mut chosen = Vec::with_capacity(WIDTH);
    let mut waiting = Vec::new();
    match ways[root].left[0] {
        0 => chosen.push(root),
        count => open(binary, ways, root, count, &mut waiting),
    }
    while let Some((node, count)) = waiting.pop() {
        if count == 1 {
            chosen.push(node);
        } else {
            open(binary, ways, node, count, &mut waiting);
        }
    }
    chosen.sort_by(|&a, &b| ways[a].yield_per_leaf.total_cmp(&ways[b].yield_per_leaf));
    chosen
}

/// Replaces a subtree that becomes `count` ≥ 2 children by its two halves.
fn open(binary: &Binary, ways: &[Ways], node: usize, count: u8, waiting: &mut Vec<(usize, u8)>) {
    let left = ways[node].left[usize::from(count) - 1];
    let first = binary.nodes[node].first as usize;
    waiting.extend([(first + 1, count - left), (first, left)]);
}

/// The ways of all nodes, every node after its children.
fn ways(soup: &Soup, binary: &Binary) -> Vec<Ways> {
    let whole = binary.nodes[0].half_area();
    let mut ways: Vec<Ways> = binary.nodes.iter().map(|_| Ways::NONE).collect();
    for i in binary.children_first() {
        let node = binary.nodes[i];
        let surface = (node.half_area() / whole) as f32;
        ways[i] = if node.count > 0 {
            let members = &binary.order[node.first as usize..(node.first + node.count) as usize];
            let area = members.iter().map(|&i| soup.stopping_area(i)).sum();
            match placement(soup, binary, i) {
                Some(placement) => Ways::of_placement(surface, soup.placed[placement].triangle_count, area),
                None => Ways::of_leaf(surface, node.count, area),
            }
        } else {
            Ways::of_halves(surface, &ways[node.first as usize], &ways[node.first as usize + 1])
        };
    }
    ways
}

impl Ways {
    const NONE: Self = Self { cost: [f32::INFINITY; WIDTH], left: [0; WIDTH], places: 1, triangles: 0, yield_per_leaf: 0.0, area: 0.0 };

    fn of_leaf(surface: f32, triangles: u32, area: f64) -> Self {
        let mut ways = Self { triangles, area, yield_per_leaf: area as f32, ..Self::NONE };
        ways.cost[0] = surface * LEAF_COST;
        ways
    }

    /// Not to be made one leaf with others, however few its triangles are.
    fn of_placement(surface: f32, triangles: usize, area: f64) -> Self {
        let triangles = triangles.max(LANES + 1) as u32;
        let mut ways = Self::of_leaf(surface, triangles, area);
        ways.yield_per_leaf = (area / f64::from(triangles.div_ceil(LANES as u32))) as f32;
        ways
    }

    fn of_halves(surface: f32, left: &Self, right: &Self) -> Self {
        let (triangles, area) = (left.triangles + right.triangles, left.area + right.area);
        let leaves = triangles.div_ceil(LANES as u32);
        let mut ways = Self { triangles, area, yield_per_leaf: (area / f64::from(leaves)) as f32, ..Self::NONE };
        ways.places = (left.places + right.places).min(WIDTH);
        (ways.cost, ways.left) = cheapest(left, right);
        // As a single child: an inner node with the cheapest number of children, or a leaf where the triangles fit one.
        let open = (2..=ways.places).min_by(|&a, &b| ways.cost[a - 1].total_cmp(&ways.cost[b - 1])).expect("two halves take two places");
        let as_node = ways.cost[open - 1] + surface * NODE_COST;
        let as_leaf = if leaves == 1 { surface * LEAF_COST } else { f32::INFINITY };
        (ways.cost[0], ways.left[0]) = if as_leaf <= as_node { (as_leaf, 0) } else { (as_node, open as u8) };
        ways
    }
}

/// The lowest cost of two halves for each number of children that they become together, and how many of these are in the left one.
///
/// Sums are made for all numbers at once, so that the compiler makes vectors of them.
fn cheapest(left: &Ways, right: &Ways) -> ([f32; WIDTH], [u8; WIDTH]) {
    let mut right_moved = [f32::INFINITY; 2 * WIDTH];
    right_moved[WIDTH..].copy_from_slice(&right.cost);
    let (mut cost, mut places_on_left) = ([f32::INFINITY; WIDTH], [1; WIDTH]);
    for on_left in 1..=left.places.min(WIDTH - 1) {
        let right: &[f32; WIDTH] = right_moved[WIDTH - on_left..].first_chunk().expect("more than a width");
        for k in 0..WIDTH {
            let sum = left.cost[on_left - 1] + right[k];
            let better = sum < cost[k];
            cost[k] = if better { sum } else { cost[k] };
            places_on_left[k] = if better { on_left as u32 } else { places_on_left[k] };
        }
    }
    (cost, places_on_left.map(|places| places as u8))
}

/// The placement that a node of the binary tree is, if it is one.
fn placement(soup: &Soup, binary: &Binary, node: usize) -> Option<usize> {
    let BinaryNode { first, count, .. } = binary.nodes[node];
    if count == 1 { soup.placement(binary.order[first as usize]) } else { None }
}

/// Numbers, with [`FILTERED`], and corners of the triangles below a node of the binary tree.
fn triangles(soup: &Soup, binary: &Binary, root: usize) -> Vec<(u32, [Vec3; 3])> {
    let triangle = |&triangle: &u32| {
        let number = soup.number(triangle);
        let id = if (soup.filtered)(number) { number | FILTERED } else { number };
        (id, soup.corners[triangle as usize])
    };
    let mut triangles = Vec::with_capacity(LANES);
    let mut waiting = vec![root];
    while let Some(i) = waiting.pop() {
        let node = binary.nodes[i];
        if node.count == 0 {
            waiting.extend([node.first as usize + 1, node.first as usize]);
        } else {
            triangles.extend(binary.order[node.first as usize..(node.first + node.count) as usize].iter().map(triangle));
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::super::build::balanced_tree;
    use super::super::leaf::{BEYOND, Leaf, WORDS};
    use super::*;
    use enfilade_math::Bounds3;

    fn triangles(count: u32) -> Vec<[Vec3; 3]> {
        (0..count).map(|i| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::Z * i as f32)).collect()
    }

    /// Every inner node has a leaf of eight triangles and the rest.
    fn chain(soup: &Soup, leaves: u32) -> Binary {
        let leaf = |i: u32| BinaryNode::leaf(8 * i, 8);
        let mut nodes = vec![BinaryNode::children(1)];
        for i in 0..leaves - 1 {
            let rest = if i + 2 == leaves { leaf(i + 1) } else { BinaryNode::children(2 * i + 3) };
            nodes.extend([leaf(i), rest]);
        }
        let mut binary = Binary { nodes, order: (0..8 * leaves).collect() };
        soup.fit(&mut binary);
        binary
    }

    #[test]
    fn a_tree_too_deep_for_the_stack_is_refused_and_a_balanced_one_is_not() {
        let corners = triangles(8 * 600);
        let soup = Soup { corners: &corners, filtered: &|_| false, numbers: None, placed: &[] };
        assert!(collapse(&soup, &chain(&soup, 400)).is_some());
        assert!(collapse(&soup, &chain(&soup, 600)).is_none());
        let all: Vec<u32> = (0..8 * 600).collect();
        assert!(collapse(&soup, &balanced_tree(&soup, &all)).is_some());
    }

    #[test]
    fn every_triangle_is_in_one_leaf_and_inside_all_boxes_above_it() {
        let corners = triangles(1000);
        let soup = Soup { corners: &corners, filtered: &|i| i % 2 == 0, numbers: None, placed: &[] };
        let all: Vec<u32> = (0..1000).collect();
        let binary = balanced_tree(&soup, &all);
        let plan = collapse(&soup, &binary).expect("shallow");
        let (mut nodes, mut words) = (vec![Node::EMPTY; plan.node_count()], vec![0; WORDS * plan.triangle_count() + BEYOND]);
        plan.write(&soup, &binary, (&mut nodes, 0), (&mut words, 0));
        let mut ids: Vec<u32> = Vec::new();
        let mut waiting = vec![(0, Bounds3 { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY })];
        while let Some((child, bounds)) = waiting.pop() {
            if child & LEAF != 0 {
                // SAFETY: it is one of the leaves that were written.
                let leaf = unsafe { Leaf::at(&words, child) };
                for lane in 0..leaf.count() {
                    ids.push(leaf.id(lane));
                    let triangle = corners[(leaf.id(lane) & !FILTERED) as usize];
                    for (corner, expected) in triangle.iter().enumerate() {
                        // SAFETY: there are three axes.
                        let found = [0, 1, 2].map(|axis| unsafe { leaf.rows(axis)[corner][lane] });
                        assert_eq!(found, expected.to_array());
                    }
                    assert!(triangle.iter().all(|p| p.cmpge(bounds.min).all() && p.cmple(bounds.max).all()));
                }
                continue;
            }
            let node = &nodes[child as usize];
            for lane in 0..WIDTH {
                let end = |side: usize| Vec3::from([0, 1, 2].map(|k| node.bounds[k][side].0[lane]));
                if end(0).cmple(end(1)).all() {
                    waiting.push((node.children.0[lane], Bounds3 { min: end(0).max(bounds.min), max: end(1).min(bounds.max) }));
                }
            }
        }
        ids.sort_unstable_by_key(|id| id & !FILTERED);
        let expected: Vec<u32> = (0..1000).map(|i| if i % 2 == 0 { i | FILTERED } else { i }).collect();
        assert_eq!(ids, expected);
    }

    #[test]
    fn triangles_share_a_leaf_where_that_is_cheaper() {
        // Beside a full leaf, two triangles close together make one leaf; two far apart make two.
        for (step, leaves) in [(0.1, 2), (1000.0, 3)] {
            let mut corners = triangles(8);
            corners.extend([0.0, step].map(|z| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p + Vec3::Z * z)));
            let soup = Soup { corners: &corners, filtered: &|_| false, numbers: None, placed: &[] };
            let halves = [BinaryNode::leaf(0, 8), BinaryNode::children(3), BinaryNode::leaf(8, 1), BinaryNode::leaf(9, 1)];
            let mut binary = Binary { nodes: vec![BinaryNode::children(1)], order: (0..10).collect() };
            binary.nodes.extend(halves);
            soup.fit(&mut binary);
            let plan = collapse(&soup, &binary).expect("shallow");
            assert_eq!(plan.children.iter().filter(|child| child.link & LEAF != 0).count(), leaves, "{step} apart");
        }
    }
}

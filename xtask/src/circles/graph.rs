//! Strongly connected components: which files, or modules, reach each other.

use std::collections::{BTreeMap, BTreeSet};

/// Imports between files or modules: (from, to) and the names.
pub type Imports<Node = usize> = BTreeMap<(Node, Node), BTreeSet<String>>;

/// The sets of two and more nodes that all reach each other, each in order.
pub fn circles<Node: Ord + Clone>(imports: &Imports<Node>) -> Vec<Vec<Node>> {
    let mut next: BTreeMap<&Node, BTreeSet<&Node>> = BTreeMap::new();
    for (from, to) in imports.keys() {
        next.entry(from).or_default().insert(to);
    }
    let reached: BTreeMap<&Node, BTreeSet<&Node>> = next.keys().map(|&node| (node, reachable(node, &next))).collect();
    let mut found: BTreeSet<Vec<Node>> = BTreeSet::new();
    for (&node, others) in &reached {
        let is_mutual = |other: &&Node| reached.get(other).is_some_and(|back| back.contains(node));
        let circle: Vec<Node> = others.iter().copied().filter(is_mutual).cloned().collect();
        if circle.len() > 1 {
            found.insert(circle);
        }
    }
    found.into_iter().collect()
}

/// All nodes that one reaches by at least one import.
fn reachable<'a, Node: Ord>(from: &'a Node, next: &BTreeMap<&'a Node, BTreeSet<&'a Node>>) -> BTreeSet<&'a Node> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(node) = open.pop() {
        open.extend(next.get(node).into_iter().flatten().copied().filter(|&other| reached.insert(other)));
    }
    reached
}

//! Strongly connected components: which files reach each other.

use std::collections::{BTreeMap, BTreeSet};

/// What each file imports from each other one: (from, to) and the names.
pub type Imports = BTreeMap<(usize, usize), BTreeSet<String>>;

/// The sets of two and more files that all reach each other, each in order.
pub fn circles(imports: &Imports) -> Vec<Vec<usize>> {
    let mut next: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for &(from, to) in imports.keys() {
        next.entry(from).or_default().insert(to);
    }
    let reached: BTreeMap<usize, BTreeSet<usize>> = next.keys().map(|&file| (file, reachable(file, &next))).collect();
    let mut found: BTreeSet<Vec<usize>> = BTreeSet::new();
    for (&file, others) in &reached {
        let circle: Vec<usize> =
            others.iter().copied().filter(|other| reached.get(other).is_some_and(|back| back.contains(&file))).collect();
        if circle.len() > 1 {
            found.insert(circle);
        }
    }
    found.into_iter().collect()
}

/// All files that one reaches by at least one import.
fn reachable(from: usize, next: &BTreeMap<usize, BTreeSet<usize>>) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(file) = open.pop() {
        open.extend(next.get(&file).into_iter().flatten().copied().filter(|&other| reached.insert(other)));
    }
    reached
}

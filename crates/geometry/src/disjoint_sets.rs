//! Sets without common elements, which grow together.

/// Sets of the numbers from 0: each number is a set at first. Tarjan, "Efficiency of a good but not linear set union algorithm", JACM 1975, with
/// paths that are halved on the way.
///
/// ```
/// use enfilade_geometry::DisjointSets;
///
/// let mut sets = DisjointSets::new(4);
/// sets.unite(3, 1);
/// assert_eq!((sets.root(3), sets.size(3), sets.root(2)), (1, 2, 2));
/// ```
#[derive(Clone, Debug)]
pub struct DisjointSets {
    parents: Vec<u32>,
    /// Number of elements, at roots.
    sizes: Vec<u32>,
}

impl DisjointSets {
    /// As many sets of one number each.
    pub fn new(count: usize) -> Self {
        Self { parents: (0..count as u32).collect(), sizes: vec![1; count] }
    }

    /// The lowest number of the set of `i`.
    pub fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let above = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = above;
            i = above;
        }
        i
    }

    /// Number of elements of the set of `i`.
    pub fn size(&mut self, i: u32) -> u32 {
        let root = self.root(i);
        self.sizes[root as usize]
    }

    /// Makes the sets of two numbers one; gives its root.
    pub fn unite(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.root(a), self.root(b));
        let (root, other) = (a.min(b), a.max(b));
        if root != other {
            self.parents[other as usize] = root;
            self.sizes[root as usize] += self.sizes[other as usize];
        }
        root
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_leave_the_same_remainder_become_one_set() {
        let mut sets = DisjointSets::new(100);
        (0..97).rev().for_each(|i| _ = sets.unite(i, i + 3));
        sets.unite(99, 0);
        for i in 0..100 {
            assert_eq!((sets.root(i), sets.size(i)), (i % 3, if i % 3 == 0 { 34 } else { 33 }));
        }
    }
}

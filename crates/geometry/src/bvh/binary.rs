//! The binary tree over triangles and placements that is built first; the wide tree is made of it.

use enfilade_math::Bounds3;

/// A binary tree over triangles and placements; node 0 is the root, and children come after their parents.
pub(super) struct Binary {
    pub nodes: Vec<BinaryNode>,
    /// Triangles and placements in the order of the leaves.
    pub order: Vec<u32>,
}

impl Binary {
    /// Every node after its children.
    pub fn children_first(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.nodes.len()).rev()
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

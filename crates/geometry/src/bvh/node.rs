//! The inner nodes of the tree: up to sixteen boxes.

use super::lanes::Sixteen;

/// Children of a node.
pub(super) const WIDTH: usize = 16;

/// Up to sixteen boxes and their children.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// Per axis the lower and the upper bounds. Unused places have the empty box.
    pub bounds: [[Sixteen<f32>; 2]; 3],
    /// A node, or with [`LEAF`] a leaf. Unused places lead to the first leaf, where a ray full of NaN does no harm.
    ///
    /// Where any hit will do, the last are visited first: they are likely to stop a ray for little work.
    pub children: Sixteen<u32>,
}

impl Node {
    pub const EMPTY: Self =
        Self { bounds: [[Sixteen([f32::INFINITY; WIDTH]), Sixteen([f32::NEG_INFINITY; WIDTH])]; 3], children: Sixteen([LEAF; WIDTH]) };
}

/// Marks a child that is a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// Deepest tree that the traversal's stack is made for. The collapse of a usual binary tree stays far below it; where it does not,
/// the tree is built again with halves of equal size, which are never deeper than this.
pub(super) const MAX_DEPTH: usize = 32;

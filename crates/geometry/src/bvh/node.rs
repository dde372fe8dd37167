//! What the tree is made of: nodes of up to sixteen boxes, blocks of up to eight triangles.

use super::lanes::{Eight, Sixteen};

/// Children of a node.
pub(super) const WIDTH: usize = 16;

/// Triangles of a block.
pub(super) const LANES: usize = 8;

/// Up to sixteen boxes and what is in them.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// Per axis the lower and the upper bounds. Unused places have the empty box.
    pub bounds: [[Sixteen<f32>; 2]; 3],
    /// A node, or with [`LEAF`] a block. Unused places lead to block 0, where a ray full of NaN does no harm.
    ///
    /// Where any hit will do, the last are visited first: they are those that are likely to stop a ray for little work.
    pub children: Sixteen<u32>,
}

impl Node {
    pub const EMPTY: Self =
        Self { bounds: [[Sixteen([f32::INFINITY; WIDTH]), Sixteen([f32::NEG_INFINITY; WIDTH])]; 3], children: Sixteen([LEAF; WIDTH]) };

    /// The block that `child` stands for, if it is a leaf.
    #[inline(always)]
    pub fn leaf(child: u32) -> Option<usize> {
        (child & LEAF != 0).then_some((child & !LEAF) as usize)
    }
}

/// Marks a child that is a block.
pub(super) const LEAF: u32 = 1 << 31;

/// Up to eight triangles.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    /// Per corner and axis. Unused places are NaN, which fails every comparison of the triangle test.
    pub corners: [[Eight<f32>; 3]; 3],
    /// Triangle index, with [`FILTERED`].
    pub ids: Eight<u32>,
}

impl Block {
    pub const EMPTY: Self = Self { corners: [[Eight([f32::NAN; LANES]); 3]; 3], ids: Eight([0; LANES]) };
}

/// Marks a triangle that asks the filter.
pub(super) const FILTERED: u32 = 1 << 31;

/// Deepest tree that the traversal's stack is made for. The collapse of a usual binary tree stays far below it; where it does not,
/// the tree is built again with halves of equal size, which are never deeper than this.
pub(super) const MAX_DEPTH: usize = 32;

//! The ray-tracing hierarchy: which triangle does a ray meet first, and does it meet any?
//!
//! A tree of boxes with up to sixteen children per node and up to eight triangles per leaf, so that one vector instruction tests all
//! children of a node or all triangles of a leaf at once (Wald, Benthin & Boulos 2008, "Getting Rid of Packets"). The triangle test is
//! watertight (Woop, Benthin & Wald 2013): a ray cannot slip between two triangles that share an edge. What a ray hits does not
//! depend on the machine: AVX-512 or AVX2 is used where the processor has it, and the plain path gives the same bits.

mod binary;
mod build;
mod collapse;
mod hierarchy;
mod hit;
mod lanes;
mod leaf;
mod node;
mod pages;
mod placed;
mod prepared;
mod queries;
mod reinsertion;
mod soup;
mod stack;
mod triangle;
mod visibility;
mod walk;
mod wide;

#[cfg(test)]
mod tests;

pub use hierarchy::Bvh;
pub use hit::Hit;
pub use placed::Placement;
pub use visibility::{NOTHING, PinholeRays, VisibilityBuffer};

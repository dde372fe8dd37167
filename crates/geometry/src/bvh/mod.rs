//! The ray-tracing hierarchy: which triangle does a ray meet first, and does it meet any?
//!
//! A tree of boxes with up to sixteen children per node and up to eight triangles per leaf, so that one vector instruction tests all
//! children or all triangles of a place at once (Wald, Benthin & Boulos 2008, "Getting Rid of Packets"). The triangle test is
//! watertight (Woop, Benthin & Wald 2013): a ray cannot slip between two triangles that share an edge. What a ray hits does not
//! depend on the machine: AVX-512 or AVX2 is used where the processor has it, and the plain path gives the same bits.

mod binary;
mod build;
mod collapse;
mod lanes;
mod leaf;
mod node;
mod pages;
mod placed;
mod prepared;
mod reinsertion;
mod stack;
mod triangle;
mod visibility;
mod walk;
mod wide;

#[cfg(test)]
mod tests;

use enfilade_math::{Bounds3, Ray, Vec3};
use leaf::FILTERED;
use node::Node;
use pages::Pages;
use placed::Placed;

pub use placed::Placement;
pub use visibility::{NOTHING, PinholeRays, VisibilityBuffer};

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Parameter on the ray, strictly between its `t_min` and `t_max`.
    pub t: f32,
    /// Index of the triangle in the order given to [`Bvh::new`], or its number among those given to [`Bvh::with_placements`].
    pub triangle: u32,
    /// Barycentric weight of corner 1, in [0, 1].
    pub u: f32,
    /// Barycentric weight of corner 2, in [0, 1]; corner 0 has the weight 1 − u − v.
    pub v: f32,
}

/// A hierarchy over triangles. Both sides of a triangle are hit; its edges belong to it; triangles without area are never hit.
///
/// Of several triangles at the same distance the one with the lowest index is reported.
pub struct Bvh {
    /// The root is node 0; empty when there is nothing to hit.
    nodes: Pages<Node>,
    /// Of all leaves.
    words: Pages<u32>,
    /// What leaves with [`placed::PLACED`] lead to.
    placed: Vec<Placed>,
    bounds: Bounds3,
    /// The greatest absolute value of a coordinate.
    largest_coordinate: f32,
    triangle_count: usize,
    kernel: Kernel,
}

/// Which compiled traversal to call.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kernel {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Kernel {
    fn best_here() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::is_x86_feature_detected as has;
            let wide = has!("avx512f") && has!("avx512vl") && has!("bmi2") && has!("lzcnt") && has!("popcnt");
            if has!("avx2") && has!("bmi1") {
                return if wide { Self::Avx512 } else { Self::Avx2 };
            }
        }
        Self::Portable
    }
}

impl Hit {
    /// Weights of the three corners.
    #[inline]
    pub fn weights(&self) -> [f32; 3] {
        [1.0 - self.u - self.v, self.u, self.v]
    }
}

impl Bvh {
    /// Triangles that fit one hierarchy; those of a mesh with placements count once.
    pub const MOST_TRIANGLES: usize = leaf::MOST_TRIANGLES;

    /// Builds the hierarchy of `corners`, in which triangle i asks the filter of the `_filtered` queries when `filtered(i)`.
    ///
    /// The same triangles give the same hierarchy, whatever the number of threads. About one CPU second per million triangles for a
    /// room, two where they are many millions and fit no cache.
    ///
    /// # Panics
    /// With more than [`Bvh::MOST_TRIANGLES`].
    pub fn new(corners: &[[Vec3; 3]], filtered: &dyn Fn(u32) -> bool) -> Self {
        Self::of(corners, None, filtered, &[], &[])
    }

    /// Builds the hierarchy of triangles, and of meshes that are kept once for all their placements. Rays hit the same triangles at the
    /// same parameters, bit for bit, as in a hierarchy of all triangles in the world, only a little later. (But for triangles that are
    /// lines: rounding in the world may give them an area, or take it.)
    ///
    /// `numbers` are what hits report for the `corners`. They and the numbers of the placements' triangles must differ.
    ///
    /// # Panics
    /// When there are not as many numbers as corners, when a placement has no mesh, with more than
    /// [`Bvh::MOST_TRIANGLES`] in meshes and corners, and with 2³¹ or more in the world.
    pub fn with_placements(
        corners: &[[Vec3; 3]],
        numbers: &[u32],
        filtered: &dyn Fn(u32) -> bool,
        meshes: &[Vec<[Vec3; 3]>],
        placements: &[Placement],
    ) -> Self {
        Self::of(corners, Some(numbers), filtered, meshes, placements)
    }

    fn of(
        corners: &[[Vec3; 3]],
        numbers: Option<&[u32]>,
        filtered: &dyn Fn(u32) -> bool,
        meshes: &[Vec<[Vec3; 3]>],
        placements: &[Placement],
    ) -> Self {
        let triangle_count = corners.len() + placements.iter().map(|placement| meshes[placement.mesh].len()).sum::<usize>();
        assert!(triangle_count < FILTERED as usize, "{triangle_count} triangles, at most {} fit one hierarchy", FILTERED - 1);
        let built = build::build(corners, numbers, filtered, meshes, placements);
        Self {
            nodes: built.nodes,
            words: built.words,
            placed: built.placed,
            bounds: built.bounds,
            largest_coordinate: built.bounds.min.abs().max(built.bounds.max.abs()).max_element(),
            triangle_count,
            kernel: Kernel::best_here(),
        }
    }

    /// The first hit with `t_min < t < t_max`, every triangle being solid.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.query::<false, false, _>(ray, |_| true)
    }

    /// True when anything is hit with `t_min < t < t_max`, every triangle being solid.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.query::<true, false, _>(ray, |_| true).is_some()
    }

    /// The first hit that is on an unfiltered triangle or that `accept` returns true for.
    ///
    /// `accept` is asked about candidates in no particular order, also about some that lie behind the hit in the end; its answer
    /// must depend on the hit alone.
    #[inline]
    pub fn closest_filtered<F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> Option<Hit> {
        self.query::<false, true, F>(ray, accept)
    }

    /// True when there is a hit on an unfiltered triangle or one that `accept` returns true for.
    #[inline]
    pub fn occluded_filtered<F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> bool {
        self.query::<true, true, F>(ray, accept).is_some()
    }

    /// The box around all triangles that can be hit; empty when there are none.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// The number of triangles given, those without area included.
    pub fn triangle_count(&self) -> usize {
        self.triangle_count
    }

    /// Size of the hierarchy in memory, in bytes.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.words) + size_of_val(&*self.placed)
    }

    #[inline]
    fn query<const ANY: bool, const ASK: bool, F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> Option<Hit> {
        if self.placed.is_empty() { self.walk::<ANY, ASK, false, F>(ray, accept) } else { self.walk::<ANY, ASK, true, F>(ray, accept) }
    }

    #[inline]
    fn walk<const ANY: bool, const ASK: bool, const SHARED: bool, F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> Option<Hit> {
        match self.kernel {
            Kernel::Portable => walk::walk::<wide::Pair<lanes::Portable>, lanes::Portable, ANY, ASK, SHARED, F>(self, ray, accept),
            // SAFETY: this kernel is chosen only where the processor has the features.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2 => unsafe { walk::walk_avx2::<ANY, ASK, SHARED, F>(self, ray, accept) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx512 => unsafe { walk::walk_avx512::<ANY, ASK, SHARED, F>(self, ray, accept) },
        }
    }
}

//! The hierarchy itself: its contents, its construction from triangles and placements, and queries about it.
//!
//! Rays are asked in [`queries`](super::queries), pictures are drawn in [`visibility`](super::visibility).

use super::build;
use super::leaf::{self, FILTERED};
use super::node::Node;
use super::pages::Pages;
use super::placed::{Placed, Placement};
use enfilade_math::{Bounds3, Vec3};

/// A hierarchy over triangles. Both sides of a triangle are hit; its edges belong to it; triangles without area are never hit.
///
/// Of several triangles at the same distance the one with the lowest index is reported.
///
/// ```
/// use enfilade_geometry::Bvh;
/// use enfilade_math::{Ray, Vec3};
///
/// // Two triangles, one above the other, and a ray that looks up at them from below.
/// let triangle = |z: f32| [Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z)];
/// let bvh = Bvh::new(&[triangle(3.0), triangle(2.0)], &|_| false);
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 0.0), Vec3::Z);
///
/// let hit = bvh.closest(&ray).unwrap();
/// assert_eq!((hit.triangle, hit.t), (1, 2.0));
/// assert_eq!(hit.weights(), [0.25, 0.25, 0.5]);
/// assert!(!bvh.occluded(&Ray { t_max: 2.0, ..ray }));
/// ```
///
/// Triangles that the second argument marks, such as leaves cut out of a picture, are hit only where a filter accepts the hit. The others
/// are solid:
///
/// ```
/// # use enfilade_geometry::Bvh;
/// # use enfilade_math::{Ray, Vec3};
/// # let triangle = |z: f32| [Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z)];
/// # let ray = Ray::new(Vec3::new(0.25, 0.5, 0.0), Vec3::Z);
/// let bvh = Bvh::new(&[triangle(3.0), triangle(2.0)], &|triangle| triangle == 1);
/// let hit = bvh.closest_filtered(&ray, |hit| hit.u > 0.9).unwrap();
/// assert_eq!(hit.triangle, 0);
/// ```
pub struct Bvh {
    /// The root is node 0; empty when there is nothing to hit.
    pub(super) nodes: Pages<Node>,
    /// The words of all leaves, one leaf after the other; see [`super::leaf`].
    pub(super) words: Pages<u32>,
    /// The placements that children marked with [`super::placed::PLACED`] lead to.
    pub(super) placed: Vec<Placed>,
    bounds: Bounds3,
    /// The greatest absolute value of a coordinate.
    pub(super) largest_coordinate: f32,
    triangle_count: usize,
    pub(super) kernel: Kernel,
}

/// The compiled traversal to call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kernel {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Kernel {
    /// The widest that the processor has.
    pub(super) fn best_here() -> Self {
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

impl Bvh {
    /// Triangles that fit one hierarchy; those of a mesh with placements count once.
    pub const MAX_TRIANGLES: usize = leaf::MAX_TRIANGLES;

    /// Builds the hierarchy of `corners`, in which triangle i asks the filter of the `_filtered` queries when `filtered(i)`.
    ///
    /// The same triangles give the same hierarchy, whatever the number of threads. About one CPU second per million triangles for a
    /// room, two where they are many millions and fit no cache.
    ///
    /// # Panics
    /// With more than [`Bvh::MAX_TRIANGLES`].
    pub fn new(corners: &[[Vec3; 3]], filtered: &dyn Fn(u32) -> bool) -> Self {
        Self::of(corners, None, filtered, &[], &[])
    }

    /// Builds the hierarchy of triangles, and of meshes that are kept once for all their placements. Rays hit the same triangles at the
    /// same parameters, bit for bit, as in a hierarchy of all triangles in the world, at a little more cost. (But for triangles that are
    /// lines: rounding in the world may give them an area, or take it.)
    ///
    /// `numbers` are what hits report for the `corners`. They and the numbers of the placements' triangles must differ.
    ///
    /// # Panics
    /// When there are not as many numbers as corners, when a placement has no mesh, with more than
    /// [`Bvh::MAX_TRIANGLES`] in meshes and corners, and with 2³¹ or more in the world.
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
}

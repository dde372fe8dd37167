//! Queries of rays to the hierarchy: the first hit, or whether there is any; among solid triangles, or also those that a filter accepts.
//!
//! Each query is compiled once for every kind of processor, and the hierarchy's [`Kernel`] selects the one that runs.

use super::hierarchy::{Bvh, Kernel};
use super::hit::Hit;
use super::lanes::Portable;
use super::walk::walk;
#[cfg(target_arch = "x86_64")]
use super::walk::{walk_avx2, walk_avx512};
use super::wide::Pair;
use enfilade_math::Ray;

impl Bvh {
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
    /// `accept` is asked about candidates in no particular order, also about some behind the final hit; its answer must depend on the hit
    /// alone.
    #[inline]
    pub fn closest_filtered<F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> Option<Hit> {
        self.query::<false, true, F>(ray, accept)
    }

    /// True when there is a hit on an unfiltered triangle or one that `accept` returns true for.
    #[inline]
    pub fn occluded_filtered<F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> bool {
        self.query::<true, true, F>(ray, accept).is_some()
    }

    #[inline]
    fn query<const ANY: bool, const ASK: bool, F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> Option<Hit> {
        if self.placed.is_empty() { self.walk::<ANY, ASK, false, F>(ray, accept) } else { self.walk::<ANY, ASK, true, F>(ray, accept) }
    }

    #[inline]
    fn walk<const ANY: bool, const ASK: bool, const SHARED: bool, F: Fn(&Hit) -> bool>(&self, ray: &Ray, accept: F) -> Option<Hit> {
        match self.kernel {
            Kernel::Portable => walk::<Pair<Portable>, Portable, ANY, ASK, SHARED, F>(self, ray, accept),
            // SAFETY: this kernel is chosen only where the processor has the features.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2 => unsafe { walk_avx2::<ANY, ASK, SHARED, F>(self, ray, accept) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx512 => unsafe { walk_avx512::<ANY, ASK, SHARED, F>(self, ray, accept) },
        }
    }
}

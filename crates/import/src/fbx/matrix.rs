//! Placements of ufbx as ours.

use enfilade_math::{DAffine3, DVec3};
use ufbx::Matrix;

/// A matrix of the library as ours.
pub(super) fn affine(m: &Matrix) -> DAffine3 {
    DAffine3::from_cols(
        DVec3::new(m.m00, m.m10, m.m20),
        DVec3::new(m.m01, m.m11, m.m21),
        DVec3::new(m.m02, m.m12, m.m22),
        DVec3::new(m.m03, m.m13, m.m23),
    )
}

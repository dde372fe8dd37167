//! Channels of layers as vectors.

use crate::Values;
use enfilade_math::DVec3;

/// The three channels of a pixel.
pub fn vector(values: &Values, pixel: usize) -> DVec3 {
    DVec3::new(values.get(3 * pixel), values.get(3 * pixel + 1), values.get(3 * pixel + 2))
}

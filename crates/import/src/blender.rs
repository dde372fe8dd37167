//! The meaning of numbers that Blender writes into both FBX and USD files.

/// The angle from which its spots dim; they are dark from the angle `outer_rad` on, and dim over the share `blend` of 1 − cos(outer).
pub(crate) fn spot_inner_rad(outer_rad: f64, blend: f64) -> f64 {
    2.0 * ((0.5 * outer_rad).sin() * (1.0 - blend).sqrt()).asin()
}

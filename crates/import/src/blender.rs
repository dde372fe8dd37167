//! What Blender means by numbers that it writes into FBX and USD files alike.

/// Where its spots begin to dim, which are dark from the angle `outer_rad` on: over the share `blend` of 1 − cos(outer).
pub(crate) fn spot_inner_rad(outer_rad: f64, blend: f64) -> f64 {
    2.0 * ((0.5 * outer_rad).sin() * (1.0 - blend).sqrt()).asin()
}

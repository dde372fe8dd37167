//! Roughness of diffuse surfaces as other renderers state it, for the model that the scene has.

/// The roughness of [`Bsdf::RoughDiffuse`](enfilade_scene::Bsdf::RoughDiffuse) for Oren and Nayar's model with facets whose angles have
/// the variance `s2` (radians squared): the one with their ratio of retro-reflecting to Lambertian light.
pub(crate) fn oren_nayar(s2: f32) -> f32 {
    (0.45 * s2 / (s2 + 0.09) / (1.0 - 0.5 * s2 / (s2 + 0.33))).clamp(0.0, 1.0)
}

//! Lights without a surface: points, spots and parallel light.

use super::bounds::LightBounds;
use super::{LightPoint, LightSample};
use enfilade_math::{Onb, Rgb, Vec3, warp};
use enfilade_scene::Light;

/// What the hierarchy knows of a light at a point; `None` for light from far away.
pub(super) fn light_bounds(light: &Light) -> Option<LightBounds> {
    match light {
        Light::Point { position, intensity, .. } => Some(LightBounds::point(*position, intensity.luminance())),
        Light::Spot { position, direction, intensity, outer_rad, .. } => {
            Some(LightBounds::cone(*position, *direction, intensity.luminance(), *outer_rad))
        }
        Light::Profile { position, web_from_world, intensity, web, .. } => {
            let power = intensity.luminance() * web.peak_candela();
            let axis = web_from_world.transpose() * Vec3::NEG_Z;
            Some(LightBounds::cone(*position, axis, power, web.widest_deg().to_radians()))
        }
        Light::Directional { .. } => None,
    }
}

/// Light from a source without surface.
pub(super) fn sample(light: &Light, at: &LightPoint, u: [f32; 2]) -> Option<LightSample> {
    let towards = |position: Vec3, intensity: Rgb| {
        let to_light = position - at.p;
        let distance_squared = to_light.length_squared();
        let wi = to_light.try_normalize()?;
        Some(LightSample { wi, target: Some(position), radiance: Some(intensity / distance_squared), pdf: 1.0, is_delta: true })
    };
    match light {
        Light::Point { position, intensity, .. } => towards(*position, *intensity),
        Light::Spot { position, direction, intensity, inner_rad, outer_rad, .. } => {
            let sample = towards(*position, *intensity)?;
            let falloff = spot_falloff((-sample.wi).dot(*direction), *inner_rad, *outer_rad);
            (falloff > 0.0).then(|| LightSample { radiance: sample.radiance.map(|r| r * falloff), ..sample })
        }
        Light::Profile { position, web_from_world, intensity, web, .. } => {
            let sample = towards(*position, *intensity)?;
            let candela = web.candela(*web_from_world * -sample.wi);
            (candela > 0.0).then(|| LightSample { radiance: sample.radiance.map(|r| r * candela), ..sample })
        }
        Light::Directional { direction, irradiance, angular_radius_rad, .. } => {
            if *angular_radius_rad <= 0.0 {
                return Some(LightSample { wi: -*direction, target: None, radiance: Some(*irradiance), pdf: 1.0, is_delta: true });
            }
            let limit = one_minus_cos_of(*angular_radius_rad);
            let wi = Onb::from_z(-*direction).to_world(warp::cone(u, limit)).normalize();
            let pdf = warp::cone_pdf(limit);
            Some(LightSample { wi, target: None, radiance: Some(*irradiance * pdf), pdf, is_delta: false })
        }
    }
}

/// Radiance and density per solid angle of the disk of a directional light in the unit direction `d`.
#[inline]
pub(super) fn disk(light: &Light, d: Vec3) -> Option<(Rgb, f32)> {
    let Light::Directional { direction, irradiance, angular_radius_rad, .. } = light else { return None };
    // 1 − cos of the angle between, without cancellation.
    let one_minus_cos = 0.5 * (d + *direction).length_squared();
    let limit = one_minus_cos_of(*angular_radius_rad);
    (*angular_radius_rad > 0.0 && one_minus_cos <= limit).then(|| {
        let pdf = warp::cone_pdf(limit);
        (*irradiance * pdf, pdf)
    })
}

/// Full within the inner angle, none beyond the outer, glTF's smooth square between (KHR_lights_punctual).
fn spot_falloff(cos: f32, inner_rad: f32, outer_rad: f32) -> f32 {
    let (inner, outer) = (inner_rad.cos(), outer_rad.cos());
    if inner <= outer {
        return if cos >= outer { 1.0 } else { 0.0 };
    }
    ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
}

/// 1 − cos(angle), precise for small angles.
fn one_minus_cos_of(angle_rad: f32) -> f32 {
    let s = (0.5 * angle_rad).sin();
    2.0 * s * s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spot_is_full_inside_and_dark_outside() {
        assert_eq!(spot_falloff(1.0, 0.2, 0.5), 1.0);
        assert_eq!(spot_falloff(0.6f32.cos(), 0.2, 0.5), 0.0);
        let between = spot_falloff(0.35f32.cos(), 0.2, 0.5);
        assert!(between > 0.0 && between < 1.0);
    }
}

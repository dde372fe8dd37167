//! Lights without a surface: point, spot and profile lights, and distant lights with or without a disk.

use super::bounds::LightBounds;
use super::sample::{LightPoint, LightSample};
use enfilade_math::{Onb, Rgb, Vec3, angle, warp};
use enfilade_scene::{Light, SpotFalloff};

/// The bounds of a point light for the hierarchy; `None` for a distant light.
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

/// Samples a light without a surface. `u` is uniform on [0,1)², and only disks need it.
pub(super) fn sample(light: &Light, at: &LightPoint, u: [f32; 2]) -> Option<LightSample> {
    let towards = |position: Vec3, intensity: Rgb| {
        let to_light = position - at.p;
        let distance_squared = to_light.length_squared();
        let wi = to_light.try_normalize()?;
        Some(LightSample { is_delta: true, ..LightSample::new(wi, Some(position), Some(intensity / distance_squared), 1.0) })
    };
    match light {
        Light::Point { position, intensity, .. } => towards(*position, *intensity),
        Light::Spot { position, direction, intensity, inner_rad, outer_rad, falloff, .. } => {
            let sample = towards(*position, *intensity)?;
            let falloff = spot_falloff(*falloff, (-sample.wi).dot(*direction), *inner_rad, *outer_rad);
            (falloff > 0.0).then(|| LightSample { radiance: sample.radiance.map(|r| r * falloff), ..sample })
        }
        Light::Profile { position, web_from_world, intensity, web, .. } => {
            let sample = towards(*position, *intensity)?;
            let candela = web.candela(*web_from_world * -sample.wi);
            (candela > 0.0).then(|| LightSample { radiance: sample.radiance.map(|r| r * candela), ..sample })
        }
        Light::Directional { direction, irradiance, angular_radius_rad, .. } => {
            if *angular_radius_rad <= 0.0 {
                return Some(LightSample { is_delta: true, ..LightSample::new(-*direction, None, Some(*irradiance), 1.0) });
            }
            let limit = one_minus_cos_of(*angular_radius_rad);
            let wi = Onb::from_z(-*direction).to_world(warp::cone(u, limit)).normalize();
            let pdf = warp::cone_pdf(limit);
            Some(LightSample::new(wi, None, Some(disk_radiance(*irradiance, limit)), pdf))
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
    (*angular_radius_rad > 0.0 && one_minus_cos <= limit).then(|| (disk_radiance(*irradiance, limit), warp::cone_pdf(limit)))
}

/// Radiance of a disk around a direction that gives this irradiance to a surface facing it. `limit` is 1 − cos of its angular radius; what
/// is beyond the horizon gives none.
fn disk_radiance(irradiance: Rgb, limit: f32) -> Rgb {
    let limit = limit.min(1.0);
    irradiance / (std::f32::consts::PI * limit * (2.0 - limit))
}

/// The fraction of a spot light's intensity at an angle from its axis: all within the inner angle, none beyond the outer.
fn spot_falloff(falloff: SpotFalloff, cos: f32, inner_rad: f32, outer_rad: f32) -> f32 {
    let (inner, outer) = (inner_rad.cos(), outer_rad.cos());
    if inner <= outer {
        return if cos >= outer { 1.0 } else { 0.0 };
    }
    let by_cosine = || ((cos - outer) / (inner - outer)).clamp(0.0, 1.0);
    let by_angle = || ((outer_rad - angle::acos(cos)) / (outer_rad - inner_rad)).clamp(0.0, 1.0);
    let smooth = |x: f32| x * x * (3.0 - 2.0 * x);
    match falloff {
        SpotFalloff::CosineSquare => by_cosine().powi(2),
        SpotFalloff::Angle => by_angle(),
        SpotFalloff::SmoothCosine => smooth(by_cosine()),
        SpotFalloff::SmoothAngle => smooth(by_angle()),
    }
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
        for falloff in [SpotFalloff::CosineSquare, SpotFalloff::Angle, SpotFalloff::SmoothCosine, SpotFalloff::SmoothAngle] {
            assert_eq!(spot_falloff(falloff, 1.0, 0.2, 0.5), 1.0);
            assert_eq!(spot_falloff(falloff, 0.6f32.cos(), 0.2, 0.5), 0.0);
        }
    }

    #[test]
    fn spot_dims_by_its_law_between_the_angles() {
        let fraction = |falloff, cos: f32| spot_falloff(falloff, cos, 0.2, 0.6);
        assert!((fraction(SpotFalloff::Angle, 0.3f32.cos()) - 0.75).abs() < 1e-5);
        let halfway = 0.5 * (0.2f32.cos() + 0.6f32.cos());
        assert!((fraction(SpotFalloff::CosineSquare, halfway) - 0.25).abs() < 1e-5);
        // A quarter of the way: 3/16 − 2/64.
        let quarter = 0.75 * 0.6f32.cos() + 0.25 * 0.2f32.cos();
        assert!((fraction(SpotFalloff::SmoothCosine, quarter) - 0.15625).abs() < 1e-5);
        assert!((fraction(SpotFalloff::SmoothAngle, 0.5f32.cos()) - 0.15625).abs() < 1e-5);
    }
}

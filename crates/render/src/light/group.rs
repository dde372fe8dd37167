//! One light source: the emissive triangles of a part, or a light without surface.

use super::LightSample;
use crate::prepared::{Cutout, RenderScene};
use enfilade_geometry::Hit;
use enfilade_math::{Distribution1, Onb, Rgb, Vec3, offset_origin, warp};
use enfilade_scene::{Alpha, Image, Light};

/// A source, or the emissive triangles of one part.
#[derive(Debug)]
pub(super) enum Group {
    Mesh { first_triangle: u32, by_power: Distribution1, center: Vec3, radius: f32, strength: f32 },
    Light { light: Light, strength: f32 },
}

impl Group {
    /// Irradiance at unit distance (or at any, for directional light), luminance.
    pub(super) fn strength(&self) -> f32 {
        match self {
            Self::Mesh { strength, .. } | Self::Light { strength, .. } => *strength,
        }
    }

    /// About the irradiance that the group could cast on `p`; positive.
    pub(super) fn importance(&self, p: Vec3) -> f32 {
        match self {
            Self::Mesh { strength, center, radius, .. } => strength / p.distance_squared(*center).max(radius * radius),
            Self::Light { light: Light::Point { position, .. } | Light::Spot { position, .. }, strength } => {
                strength / p.distance_squared(*position).max(1e-4)
            }
            Self::Light { light: Light::Directional { .. }, strength } => *strength,
        }
    }

    /// Samples the group's light at `p`.
    pub(super) fn sample(&self, scene: &RenderScene<'_>, p: Vec3, u: [f32; 2], wanted: impl Fn(Vec3) -> bool) -> Option<LightSample> {
        match self {
            Self::Mesh { first_triangle, by_power, .. } => sample_mesh(scene, *first_triangle, by_power, p, u, wanted),
            Self::Light { light, .. } => sample_light(light, p, u).filter(|sample| wanted(sample.wi)),
        }
    }
}

/// A point on the emissive triangles of a part, chosen by power, uniform within the triangle.
fn sample_mesh(
    scene: &RenderScene<'_>,
    first_triangle: u32,
    by_power: &Distribution1,
    p: Vec3,
    u: [f32; 2],
    wanted: impl Fn(Vec3) -> bool,
) -> Option<LightSample> {
    let (index, pmf, renewed) = by_power.sample(u[0]);
    let triangle = first_triangle + index as u32;
    let data = &scene.triangles[triangle as usize];
    let b = warp::triangle([renewed, u[1]]);
    let q = data.position([1.0 - b.x - b.y, b.x, b.y]);
    let area = data.area();
    let to_light = q - p;
    let distance_squared = to_light.length_squared();
    if area <= 0.0 || distance_squared <= 0.0 {
        return None;
    }
    let wi = to_light / distance_squared.sqrt();
    if !wanted(wi) {
        return None;
    }
    let hit = Hit { t: distance_squared.sqrt(), triangle, u: b.x, v: b.y };
    let surface = scene.surface(&hit, wi);
    let mut radiance = surface.emission(scene);
    match surface.material.alpha {
        Alpha::Opaque => {}
        Alpha::Mask { .. } => radiance *= if scene.is_present(&hit, Cutout::Half) { 1.0 } else { 0.0 },
        Alpha::Blend { opacity } => radiance *= crate::surface::scalar_at(scene.scene, &opacity, surface.uv).clamp(0.0, 1.0),
    }
    if radiance.is_black() {
        return None;
    }
    let cos = surface.ng.dot(wi).abs();
    if cos <= 0.0 {
        return None;
    }
    let pdf = pmf / area * distance_squared / cos;
    Some(LightSample { wi, target: Some(offset_origin(q, surface.ng)), radiance: Some(radiance), pdf, is_delta: false })
}

/// Light from a source without surface.
fn sample_light(light: &Light, p: Vec3, u: [f32; 2]) -> Option<LightSample> {
    let towards = |position: Vec3, intensity: Rgb| {
        let to_light = position - p;
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

/// Full within the inner angle, none beyond the outer, glTF's smooth square between (KHR_lights_punctual).
fn spot_falloff(cos: f32, inner_rad: f32, outer_rad: f32) -> f32 {
    let (inner, outer) = (inner_rad.cos(), outer_rad.cos());
    if inner <= outer {
        return if cos >= outer { 1.0 } else { 0.0 };
    }
    ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2)
}

/// 1 − cos(angle), precise for small angles.
pub(super) fn one_minus_cos_of(angle_rad: f32) -> f32 {
    let s = (0.5 * angle_rad).sin();
    2.0 * s * s
}

/// Mean luminance of a texture, at most a thousand texels each way.
pub(super) fn mean_luminance(image: &Image) -> f32 {
    let step = (image.width.max(image.height) / 512).max(1) as usize;
    let mut sum = 0.0f64;
    let mut count = 0u32;
    for y in (0..image.height as usize).step_by(step) {
        for x in (0..image.width as usize).step_by(step) {
            sum += f64::from(image.texel(x, y).0.luminance());
            count += 1;
        }
    }
    (sum / f64::from(count.max(1))) as f32
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

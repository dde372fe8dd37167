//! All light sources of a scene, behind one `sample`/`pdf` pair.
//!
//! Sources come in groups: the emissive triangles of a part, or one light without surface. A group is chosen in proportion to
//! the irradiance that it could cast on the point, unoccluded; the environment has a fixed share beside them.

mod environment;

use environment::EnvironmentLight;

use crate::prepared::{Cutout, RenderScene};
use crate::triangle::Triangle;
use enfilade_geometry::Hit;
use enfilade_math::{Distribution1, Onb, Rgb, Vec3, offset_origin, warp};
use enfilade_scene::{Alpha, Image, Light, Scene};

/// Probability of sampling the environment where there are other lights too.
const ENVIRONMENT_SHARE: f32 = 0.5;

/// Beyond this many groups, groups are chosen by strength alone: weighing them all at each point would cost too much.
const MAX_WEIGHED_GROUPS: usize = 64;

/// Light arriving at a point from a sampled direction.
pub(crate) struct LightSample {
    /// Unit direction to the light.
    pub wi: Vec3,
    /// Where the shadow ray ends, moved off the emitter's surface; `None` for infinitely far lights.
    pub target: Option<Vec3>,
    /// Radiance (finite lights) or radiance × density (delta lights, whose `pdf` is then only the choice's probability).
    pub radiance: Rgb,
    /// Density per solid angle, choice included.
    pub pdf: f32,
    /// True when no other technique can find this light.
    pub is_delta: bool,
}

/// A source, or the emissive triangles of one part.
#[derive(Debug)]
enum Group {
    Mesh { first_triangle: u32, by_power: Distribution1, center: Vec3, radius: f32, strength: f32 },
    Light { light: Light, strength: f32 },
}

/// The light sources of a scene.
#[derive(Debug)]
pub(crate) struct Lights {
    groups: Vec<Group>,
    by_strength: Option<Distribution1>,
    /// Group of each part, `u32::MAX` for parts that do not emit.
    group_of_part: Vec<u32>,
    environment: Option<EnvironmentLight>,
}

impl Lights {
    /// Collects every source.
    pub fn new(scene: &Scene, triangles: &[Triangle]) -> Self {
        let mut lights = Self {
            groups: Vec::new(),
            by_strength: None,
            group_of_part: vec![u32::MAX; scene.parts.len()],
            environment: scene.environment.as_ref().and_then(|e| EnvironmentLight::new(e, &scene.images)),
        };
        lights.add_emissive_parts(scene, triangles);
        for light in &scene.lights {
            let strength = match light {
                Light::Point { intensity, .. } | Light::Spot { intensity, .. } => intensity.luminance(),
                Light::Directional { irradiance, .. } => irradiance.luminance(),
            };
            if strength > 0.0 {
                lights.groups.push(Group::Light { light: light.clone(), strength });
            }
        }
        let strengths: Vec<f32> = lights.groups.iter().map(Group::strength).collect();
        lights.by_strength = Distribution1::new(&strengths);
        lights
    }

    fn add_emissive_parts(&mut self, scene: &Scene, triangles: &[Triangle]) {
        let mut first = 0usize;
        for (part_id, part) in scene.parts.iter().enumerate() {
            let count = scene.meshes[part.mesh as usize].triangles.len();
            let range = first..first + count;
            let first_triangle = first as u32;
            first += count;
            let emission = &scene.materials[part.material as usize].emission;
            let texture_mean = emission.texture.map_or(1.0, |t| mean_luminance(&scene.images[t.image as usize]));
            let radiance = emission.factor.luminance() * texture_mean;
            if radiance <= 0.0 {
                continue;
            }
            let powers: Vec<f32> = triangles[range.clone()].iter().map(|t| radiance * t.area()).collect();
            let Some(by_power) = Distribution1::new(&powers) else { continue };
            let corners = || triangles[range.clone()].iter().flat_map(|t| &t.corners);
            let center = enfilade_math::Bounds3::from_points(corners().copied()).center();
            let radius = corners().fold(0.0f32, |r, p| r.max(p.distance(center)));
            self.group_of_part[part_id] = self.groups.len() as u32;
            self.groups.push(Group::Mesh {
                first_triangle,
                strength: by_power.total() as f32,
                by_power,
                center,
                radius,
            });
        }
    }

    /// True when there is no source at all.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty() && self.environment.is_none()
    }

    fn environment_share(&self) -> f32 {
        match (&self.environment, self.groups.is_empty()) {
            (None, _) => 0.0,
            (Some(_), true) => 1.0,
            (Some(_), false) => ENVIRONMENT_SHARE,
        }
    }

    /// Samples light arriving at the point `p`, before any shadow. `u` is uniform on [0,1)³. `None` when the sampled light sends
    /// nothing, or from a direction that is not `wanted`.
    pub fn sample(&self, scene: &RenderScene<'_>, p: Vec3, u: [f32; 3], wanted: impl Fn(Vec3) -> bool) -> Option<LightSample> {
        let share = self.environment_share();
        if u[2] < share {
            let mut sample = self.environment.as_ref()?.sample([u[0], u[1]], wanted)?;
            sample.pdf *= share;
            return Some(sample);
        }
        let choice = (u[2] - share) / (1.0 - share);
        let (index, probability) = self.choose_group(p, choice)?;
        let mut sample = self.groups[index].sample(scene, p, [u[0], u[1]], wanted)?;
        sample.pdf *= probability * (1.0 - share);
        Some(sample)
    }

    /// Density per solid angle with which [`Lights::sample`] from `from` finds the emissive surface at `hit`, whose geometric
    /// normal is `ng` and which lies in the unit direction `wi`.
    pub fn surface_pdf(&self, scene: &RenderScene<'_>, from: Vec3, wi: Vec3, hit: &Hit, p: Vec3, ng: Vec3) -> f32 {
        let triangle = &scene.triangles[hit.triangle as usize];
        let group = self.group_of_part[triangle.part as usize];
        let Some(Group::Mesh { by_power, first_triangle, .. }) = self.groups.get(group as usize) else { return 0.0 };
        let area = triangle.area();
        let cos = ng.dot(wi).abs();
        if area <= 0.0 || cos <= 0.0 {
            return 0.0;
        }
        let in_group = by_power.pmf((hit.triangle - first_triangle) as usize);
        let probability = self.group_probability(from, group as usize) * (1.0 - self.environment_share());
        probability * in_group / area * p.distance_squared(from) / cos
    }

    /// Radiance from beyond the scene in the unit direction `d`.
    pub fn background(&self, d: Vec3) -> Rgb {
        self.environment.as_ref().map_or(Rgb::BLACK, |e| e.radiance(d)) + self.disks(d).map(|(_, radiance, _)| radiance).sum::<Rgb>()
    }

    /// [`Lights::background`], each source weighted against its light samples by the power heuristic. `pdf` is the density with
    /// which the direction was sampled at `from`.
    pub fn background_weighted(&self, from: Vec3, d: Vec3, pdf: f32) -> Rgb {
        let mut radiance = Rgb::BLACK;
        if let Some(environment) = &self.environment {
            radiance += environment.radiance(d) * power_heuristic(pdf, environment.pdf(d) * self.environment_share());
        }
        for (group, disk, disk_pdf) in self.disks(d) {
            let light_pdf = disk_pdf * self.group_probability(from, group) * (1.0 - self.environment_share());
            radiance += disk * power_heuristic(pdf, light_pdf);
        }
        radiance
    }

    /// Directional lights whose disk covers the direction: group, radiance, density within the group.
    fn disks(&self, d: Vec3) -> impl Iterator<Item = (usize, Rgb, f32)> + '_ {
        self.groups.iter().enumerate().filter_map(move |(index, group)| {
            let Group::Light { light: Light::Directional { direction, irradiance, angular_radius_rad, .. }, .. } = group else {
                return None;
            };
            // 1 − cos of the angle between, without cancellation.
            let one_minus_cos = 0.5 * (d + *direction).length_squared();
            let limit = one_minus_cos_of(*angular_radius_rad);
            (*angular_radius_rad > 0.0 && one_minus_cos <= limit).then(|| {
                let pdf = warp::cone_pdf(limit);
                (index, *irradiance * pdf, pdf)
            })
        })
    }

    fn choose_group(&self, p: Vec3, u: f32) -> Option<(usize, f32)> {
        if self.groups.len() > MAX_WEIGHED_GROUPS {
            let (index, probability, _) = self.by_strength.as_ref()?.sample(u);
            return Some((index, probability));
        }
        let total: f32 = self.groups.iter().map(|g| g.importance(p)).sum();
        let mut rest = u * total;
        for (index, group) in self.groups.iter().enumerate() {
            let importance = group.importance(p);
            if rest < importance || index + 1 == self.groups.len() {
                return Some((index, importance / total));
            }
            rest -= importance;
        }
        None
    }

    fn group_probability(&self, p: Vec3, index: usize) -> f32 {
        if self.groups.len() > MAX_WEIGHED_GROUPS {
            return self.by_strength.as_ref().map_or(0.0, |d| d.pmf(index));
        }
        let total: f32 = self.groups.iter().map(|g| g.importance(p)).sum();
        self.groups[index].importance(p) / total
    }
}

impl Group {
    /// Irradiance at unit distance (or at any, for directional light), luminance.
    fn strength(&self) -> f32 {
        match self {
            Self::Mesh { strength, .. } | Self::Light { strength, .. } => *strength,
        }
    }

    /// About the irradiance that the group could cast on `p`; positive.
    fn importance(&self, p: Vec3) -> f32 {
        match self {
            Self::Mesh { strength, center, radius, .. } => strength / p.distance_squared(*center).max(radius * radius),
            Self::Light { light: Light::Point { position, .. } | Light::Spot { position, .. }, strength } => {
                strength / p.distance_squared(*position).max(1e-4)
            }
            Self::Light { light: Light::Directional { .. }, strength } => *strength,
        }
    }

    /// Samples the group's light at `p`.
    fn sample(&self, scene: &RenderScene<'_>, p: Vec3, u: [f32; 2], wanted: impl Fn(Vec3) -> bool) -> Option<LightSample> {
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
    Some(LightSample { wi, target: Some(offset_origin(q, surface.ng)), radiance, pdf, is_delta: false })
}

/// Light from a source without surface.
fn sample_light(light: &Light, p: Vec3, u: [f32; 2]) -> Option<LightSample> {
    let towards = |position: Vec3, intensity: Rgb| {
        let to_light = position - p;
        let distance_squared = to_light.length_squared();
        let wi = to_light.try_normalize()?;
        Some(LightSample { wi, target: Some(position), radiance: intensity / distance_squared, pdf: 1.0, is_delta: true })
    };
    match light {
        Light::Point { position, intensity, .. } => towards(*position, *intensity),
        Light::Spot { position, direction, intensity, inner_rad, outer_rad, .. } => {
            let sample = towards(*position, *intensity)?;
            let falloff = spot_falloff((-sample.wi).dot(*direction), *inner_rad, *outer_rad);
            (falloff > 0.0).then(|| LightSample { radiance: sample.radiance * falloff, ..sample })
        }
        Light::Directional { direction, irradiance, angular_radius_rad, .. } => {
            if *angular_radius_rad <= 0.0 {
                return Some(LightSample { wi: -*direction, target: None, radiance: *irradiance, pdf: 1.0, is_delta: true });
            }
            let limit = one_minus_cos_of(*angular_radius_rad);
            let wi = Onb::from_z(-*direction).to_world(warp::cone(u, limit)).normalize();
            let pdf = warp::cone_pdf(limit);
            Some(LightSample { wi, target: None, radiance: *irradiance * pdf, pdf, is_delta: false })
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
fn one_minus_cos_of(angle_rad: f32) -> f32 {
    let s = (0.5 * angle_rad).sin();
    2.0 * s * s
}

/// Mean luminance of a texture, at most a thousand texels each way.
fn mean_luminance(image: &Image) -> f32 {
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

/// Weight of a sample of density `a` where another technique has density `b` (Veach 1997, β = 2).
#[inline]
pub(crate) fn power_heuristic(a: f32, b: f32) -> f32 {
    // In ratio form, so that large densities do not overflow when squared.
    if a <= 0.0 {
        return 0.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heuristic_weights_sum_to_one() {
        for (a, b) in [(1.0, 2.0), (1e30, 1e-3), (0.5, 0.0)] {
            assert!((power_heuristic(a, b) + power_heuristic(b, a) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn spot_is_full_inside_and_dark_outside() {
        assert_eq!(spot_falloff(1.0, 0.2, 0.5), 1.0);
        assert_eq!(spot_falloff(0.6f32.cos(), 0.2, 0.5), 0.0);
        let between = spot_falloff(0.35f32.cos(), 0.2, 0.5);
        assert!(between > 0.0 && between < 1.0);
    }
}

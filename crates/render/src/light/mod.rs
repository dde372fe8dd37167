//! All light sources of a scene, behind one `sample`/`pdf` pair.
//!
//! A *source* is the emissive triangles of a part, a light without surface, or the environment. Which source a point samples is
//! decided by [`LightChoice`], which has learned where each one's light arrives.

mod choice;
mod environment;
mod group;
mod portal;

pub(crate) use choice::LightChoice;

use crate::prepared::RenderScene;
use crate::triangle::Triangle;
use enfilade_geometry::Hit;
use enfilade_math::{Bounds3, Distribution1, Rgb, Vec3, warp};
use enfilade_scene::{Light, Scene};
use environment::EnvironmentLight;
use group::{Group, mean_luminance, one_minus_cos_of};

/// Beyond this many groups all of them count as one source, within which they are chosen by strength.
const MAX_SOURCES: usize = 64;

/// Light arriving at a point from a sampled direction.
pub(crate) struct LightSample {
    /// Unit direction to the light.
    pub wi: Vec3,
    /// Where the shadow ray ends, moved off the emitter's surface; `None` for infinitely far lights.
    pub target: Option<Vec3>,
    /// Radiance (finite lights) or radiance × density (delta lights, whose `pdf` is then only the choice's probability).
    /// `None` for the environment, which is looked up once it is known to be seen: see [`Lights::radiance_of`].
    pub radiance: Option<Rgb>,
    /// Density per solid angle, choice included.
    pub pdf: f32,
    /// True when no other technique can find this light.
    pub is_delta: bool,
}

/// The light sources of a scene.
#[derive(Debug)]
pub(crate) struct Lights<'s> {
    groups: Vec<Group>,
    by_strength: Option<Distribution1>,
    /// Group of each part, `u32::MAX` for parts that do not emit.
    group_of_part: Vec<u32>,
    environment: Option<EnvironmentLight<'s>>,
}

impl<'s> Lights<'s> {
    /// Collects every source.
    pub fn new(scene: &'s Scene, triangles: &[Triangle]) -> Self {
        let portals = portal::find(scene, triangles);
        let mut lights = Self {
            groups: Vec::new(),
            by_strength: None,
            group_of_part: vec![u32::MAX; scene.parts.len()],
            environment: scene.environment.as_ref().and_then(|e| EnvironmentLight::new(e, &scene.images, portals)),
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
            let center = Bounds3::from_points(corners().copied()).center();
            let radius = corners().fold(0.0f32, |r, p| r.max(p.distance(center)));
            self.group_of_part[part_id] = self.groups.len() as u32;
            self.groups.push(Group::Mesh { first_triangle, strength: by_power.total() as f32, by_power, center, radius });
        }
    }

    /// True when there is no source at all.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty() && self.environment.is_none()
    }

    /// Number of sources.
    fn source_count(&self) -> usize {
        self.group_sources() + usize::from(self.environment.is_some())
    }

    /// Number of sources that are groups; the environment comes after them.
    fn group_sources(&self) -> usize {
        if self.groups.len() > MAX_SOURCES { 1 } else { self.groups.len() }
    }

    /// About the irradiance that a source could cast on `p`, unoccluded.
    fn prior(&self, source: usize, p: Vec3) -> f32 {
        if source >= self.group_sources() {
            return self.environment.as_ref().map_or(0.0, EnvironmentLight::irradiance);
        }
        if self.groups.len() > MAX_SOURCES {
            return self.groups.iter().map(|g| g.importance(p)).sum();
        }
        self.groups[source].importance(p)
    }

    /// Samples light arriving at the point `p`, before any shadow. `u` is uniform on [0,1)³. `None` when the sampled light sends
    /// nothing, or from a direction that is not `wanted`.
    pub fn sample(
        &self,
        scene: &RenderScene<'_>,
        choice: &LightChoice,
        p: Vec3,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
    ) -> Option<LightSample> {
        let (source, probability, renewed) = choice.sample(p, u[2])?;
        let mut sample = self.sample_source(scene, source, p, [u[0], u[1], renewed], wanted)?;
        sample.pdf *= probability;
        Some(sample)
    }

    /// Samples light of one source; the density is given that source.
    fn sample_source(
        &self,
        scene: &RenderScene<'_>,
        source: usize,
        p: Vec3,
        u: [f32; 3],
        wanted: impl Fn(Vec3) -> bool,
    ) -> Option<LightSample> {
        if source >= self.group_sources() {
            return self.environment.as_ref()?.sample(p, u, wanted);
        }
        if self.groups.len() > MAX_SOURCES {
            let (group, pmf, _) = self.by_strength.as_ref()?.sample(u[2]);
            let mut sample = self.groups[group].sample(scene, p, [u[0], u[1]], wanted)?;
            sample.pdf *= pmf;
            return Some(sample);
        }
        self.groups[source].sample(scene, p, [u[0], u[1]], wanted)
    }

    /// Probability that [`Lights::sample`] at `from` chooses `group`.
    fn group_probability(&self, choice: &LightChoice, from: Vec3, group: usize) -> f32 {
        if self.groups.len() > MAX_SOURCES {
            return choice.probability(from, 0) * self.by_strength.as_ref().map_or(0.0, |d| d.pmf(group));
        }
        choice.probability(from, group)
    }

    /// Density per solid angle with which [`Lights::sample`] from `from` finds the emissive surface at `hit`, whose geometric
    /// normal is `ng` and which lies in the unit direction `wi`.
    pub fn surface_pdf(&self, scene: &RenderScene<'_>, choice: &LightChoice, from: Vec3, wi: Vec3, hit: &Hit, p: Vec3, ng: Vec3) -> f32 {
        let triangle = &scene.triangles[hit.triangle as usize];
        let group = self.group_of_part[triangle.part as usize];
        let Some(Group::Mesh { by_power, first_triangle, .. }) = self.groups.get(group as usize) else { return 0.0 };
        let area = triangle.area();
        let cos = ng.dot(wi).abs();
        if area <= 0.0 || cos <= 0.0 {
            return 0.0;
        }
        let in_group = by_power.pmf((hit.triangle - first_triangle) as usize);
        self.group_probability(choice, from, group as usize) * in_group / area * p.distance_squared(from) / cos
    }

    /// Radiance of the environment in the unit direction `d`.
    fn sky(&self, d: Vec3) -> Rgb {
        self.environment.as_ref().map_or(Rgb::BLACK, |e| e.radiance(d))
    }

    /// The radiance of a sample.
    pub fn radiance_of(&self, sample: &LightSample) -> Rgb {
        sample.radiance.unwrap_or_else(|| self.sky(sample.wi))
    }

    /// Radiance from beyond the scene in the unit direction `d`.
    pub fn background(&self, d: Vec3) -> Rgb {
        self.sky(d) + self.disks(d).map(|(_, radiance, _)| radiance).sum::<Rgb>()
    }

    /// [`Lights::background`], each source weighted against its light samples by the power heuristic. `pdf` is the density with
    /// which the direction was sampled at `from`.
    pub fn background_weighted(&self, choice: &LightChoice, from: Vec3, d: Vec3, pdf: f32) -> Rgb {
        let mut radiance = Rgb::BLACK;
        if let Some(environment) = &self.environment {
            let light_pdf = environment.pdf(from, d) * choice.probability(from, self.group_sources());
            radiance += environment.radiance(d) * power_heuristic(pdf, light_pdf);
        }
        for (group, disk, disk_pdf) in self.disks(d) {
            radiance += disk * power_heuristic(pdf, disk_pdf * self.group_probability(choice, from, group));
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
}

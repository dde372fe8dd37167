//! Glints: sunlit glossy surfaces as sources of their own.
//!
//! The sun on a chair's metal frame lights the floor around it, and no light sample finds that: the floor's light samples reach for the sun
//! itself, and only the few directions that happen to meet the frame where its lobe points back see how bright it is. So the triangles of
//! glossy materials that the sun reaches are emitters here. A point samples one by its importance and a place on it, and the light is what
//! the surface there reflects of the sun: a connection to a path that begins at the light, of one surface (Veach 1997, chapter 10),
//! weighted by the power heuristic against paths that arrive there by sampled directions.
//!
//! What is not found here — other surfaces, other lights, places seen through panes — is left to sampled directions alone.

use super::lights::Lights;
use super::sample::{Glint, LightPoint, LightSample, power_heuristic};
use super::tree::{Emitters, LightTree};
use crate::prepared::RenderScene;
use crate::surface::Surface;
use crate::texture::Cone;
use crate::triangle::Triangle;
use crate::vertex::{sides_agree, viewing};
use enfilade_geometry::Hit;
use enfilade_math::{Bounds3, Ray, Rgb, Vec3, offset_origin, warp};
use enfilade_scene::{Alpha, Light};
use rayon::prelude::*;
use std::f32::consts::PI;

/// A glossy reflection this many times as bright at its peak as a white diffuse one is a glint.
const MIN_PEAK: f32 = 2.0;
/// Rays that look for the sun from a triangle.
const RAYS: u32 = 8;
/// The most triangles that are looked at; scenes with more have no glints.
const MAX_TRIANGLES: usize = 1 << 22;
/// The most clusters of glints, and the size below which none is divided, as a fraction of the diagonal around all.
const MAX_CLUSTERS: usize = 8;
const SMALLEST_CLUSTER: f32 = 0.05;

/// The sunlit glossy triangles of a scene. The default has none.
#[derive(Debug, Default)]
pub(super) struct Glints {
    /// In ascending order; their places are the numbers of the emitters.
    triangles: Vec<u32>,
    areas: Vec<f32>,
    tree: LightTree<GlintBounds>,
    /// Nodes of the tree that are clusters.
    clusters: Vec<u32>,
    cluster_of_emitter: Vec<u32>,
}

/// What a node of the hierarchy knows of the glints below it: sums, each weighted by power, from which the mean lobe follows.
#[derive(Clone, Copy, Debug)]
struct GlintBounds {
    bounds: Bounds3,
    /// Irradiance × area × reflectance at normal incidence, luminance.
    power: f32,
    /// The same for what the reflectance lacks to one: it is reached at grazing angles.
    grazing: f32,
    /// Of unit normals.
    normals: Vec3,
    /// Of squared GGX roughness.
    alpha_2: f32,
    /// Unit vector to the sun.
    to_sun: Vec3,
}

impl Emitters for GlintBounds {
    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn power(&self) -> f32 {
        self.power
    }

    fn union(&self, other: &Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            power: self.power + other.power,
            grazing: self.grazing + other.grazing,
            normals: self.normals + other.normals,
            alpha_2: self.alpha_2 + other.alpha_2,
            to_sun: self.to_sun,
        }
    }

    /// The lobe is that of GGX about the mean normal, made wider by how much the normals and the direction of the point vary within the
    /// node: both move the half vector. (Heitz 2014 for the lobe; variances add as in Toksvig 2005, "Mipmapping Normal Maps".)
    #[inline]
    fn importance(&self, at: &LightPoint) -> f32 {
        let to = self.bounds.center() - at.p;
        let radius_2 = 0.25 * self.bounds.extent().length_squared();
        let distance_2 = to.length_squared().max(radius_2);
        let wi = to.normalize_or(self.to_sun);
        let half = self.to_sun - wi;
        // Twice the cosine between the half vector and either direction.
        let twice_cos = half.length();
        let half = half / twice_cos.max(f32::MIN_POSITIVE);
        let box_spread = radius_2 / (3.0 * distance_2 * (twice_cos * twice_cos).max(0.01));
        let width = self.spread() + box_spread;
        let cos = half.dot(self.normals) / self.normals.length().max(f32::MIN_POSITIVE);
        let lobe = ggx(if cos > 0.0 { cos * cos } else { 0.0 }, width.min(1.0));
        let schlick = (1.0 - 0.5 * twice_cos).max(0.0).powi(5);
        let mut importance = 0.25 * (self.power + self.grazing * schlick) * lobe / distance_2;
        if at.n != Vec3::ZERO {
            let slack = (radius_2 / distance_2).sqrt();
            importance *= (at.n.dot(wi) + slack).clamp(0.0, 1.0);
        }
        importance
    }

    fn orientation_measure(&self) -> f32 {
        PI * self.spread().min(1.0)
    }
}

impl GlintBounds {
    /// Variance of the half vector about the mean normal: of the lobes, and of the normals about their mean.
    #[inline]
    fn spread(&self) -> f32 {
        let scale = 1.0 / self.power;
        self.alpha_2 * scale + 2.0 * (1.0 - self.normals.length() * scale).max(0.0)
    }
}

/// The GGX density of normals at an angle of squared cosine `cos_2`, of squared roughness `alpha_2`.
#[inline]
fn ggx(cos_2: f32, alpha_2: f32) -> f32 {
    let t = cos_2 * alpha_2 + (1.0 - cos_2);
    alpha_2 / (PI * t * t)
}

impl Glints {
    /// The glints of a scene whose only distant light is the sun.
    pub fn find(scene: &RenderScene<'_>) -> Self {
        let [Light::Directional { direction, irradiance, .. }] = &scene.lights.distant[..] else { return Self::default() };
        let count = scene.triangle_count();
        if count > MAX_TRIANGLES {
            return Self::default();
        }
        let eligible: Vec<bool> = (scene.scene.materials.iter())
            .map(|m| m.alpha == Alpha::Opaque && !m.bsdf.transmits() && m.emission.factor.is_black())
            .collect();
        let found: Vec<(u32, f32, GlintBounds)> = (0..count as u32)
            .into_par_iter()
            .filter(|&number| eligible[scene.triangles.material(number) as usize])
            .filter_map(|number| glint(scene, number, -*direction, irradiance.luminance()).map(|(area, bounds)| (number, area, bounds)))
            .collect();
        let emitters: Vec<GlintBounds> = found.iter().map(|(.., bounds)| *bounds).collect();
        let tree = LightTree::new(&emitters);
        let diagonal = emitters.iter().fold(Bounds3::EMPTY, |all, one| all.union(one.bounds)).extent().length();
        let clusters = tree.cut(MAX_CLUSTERS, SMALLEST_CLUSTER * diagonal);
        let cluster_of_emitter = tree.cluster_of_emitter(&clusters);
        let (triangles, areas) = found.iter().map(|(number, area, _)| (*number, *area)).unzip();
        Self { triangles, areas, tree, clusters, cluster_of_emitter }
    }

    /// Number of clusters.
    #[inline]
    pub fn len(&self) -> usize {
        self.clusters.len()
    }

    /// About the irradiance of a cluster at a point if nothing were in the way.
    pub fn importance(&self, cluster: usize, at: &LightPoint) -> f32 {
        self.tree.importance(self.clusters[cluster], at)
    }

    /// Samples a place of a cluster that is seen from `at`. Its light is still to be found: [`Lights::radiance_of`].
    pub fn sample(&self, scene: &RenderScene<'_>, cluster: usize, at: &LightPoint, u: [f32; 3]) -> Option<LightSample> {
        let (emitter, pmf, u_left) = self.tree.sample(self.clusters[cluster], at, u[2])?;
        let (number, area) = (self.triangles[emitter as usize], self.areas[emitter as usize]);
        let place = warp::triangle([u[0], u[1]]);
        let triangle = scene.triangles.get(number);
        let to = triangle.position([1.0 - place.x - place.y, place.x, place.y]) - at.p;
        let (distance, wi) = (to.length(), to.try_normalize()?);
        let hit = Hit { t: distance, triangle: number, u: place.x, v: place.y };
        let cosine = triangle.winding.dot(wi);
        let target = offset_origin(at.p + to, if cosine > 0.0 { -triangle.winding } else { triangle.winding });
        let pdf = pmf * distance * distance / (area * cosine.abs());
        pdf.is_finite().then_some(LightSample { wi, target: Some(target), radiance: None, pdf, is_delta: false, glint: Some(Glint { hit, u: u_left }) })
    }

    /// Density per solid angle with which [`Glints::sample`] at `from` finds the place `p` of a triangle in the unit direction `wi`, and the
    /// cluster there, given that.
    fn pdf(&self, from: &LightPoint, wi: Vec3, triangle: u32, p: Vec3, ng: Vec3) -> Option<(usize, f32)> {
        let emitter = self.triangles.binary_search(&triangle).ok()?;
        let cluster = self.cluster_of_emitter[emitter] as usize;
        let node = *self.clusters.get(cluster)?;
        let pmf = self.tree.pmf(node, from, emitter as u32);
        Some((cluster, pmf * from.p.distance_squared(p) / (self.areas[emitter] * ng.dot(wi).abs())))
    }
}

impl Lights<'_> {
    /// Weight by the power heuristic of the sun's light that `surface` reflects, where a direction sampled with some density met it: the
    /// rest is left to glints. `sampled` as in [`Lights::background_weighted`].
    pub fn glint_weight(&self, choice: &super::LightChoice, sampled: Option<&(LightPoint, f32)>, surface: &Surface<'_>) -> f32 {
        if self.glints.len() == 0 {
            return 1.0;
        }
        let Some((from, pdf)) = sampled else { return 1.0 };
        let Some((cluster, found)) = self.glints.pdf(from, -surface.wo, surface.triangle, surface.p, surface.ng) else { return 1.0 };
        power_heuristic(*pdf, choice.row(from).probability(self.first_glint() + cluster) * found)
    }

    /// What the surface at `hit` reflects of the sun against the unit direction `wi` of a ray that met it; `u` is uniform on [0,1)².
    pub(super) fn reflected_sun(&self, scene: &RenderScene<'_>, hit: &Hit, wi: Vec3, cone: &Cone, u: [f32; 2]) -> Rgb {
        let surface = scene.surface(hit, wi, cone);
        let bsdf = surface.bsdf(scene);
        let onb = surface.onb();
        let at = surface.light_point();
        let Some(sun) = self.distant.first().and_then(|light| super::delta::sample(light, &at, u)) else { return Rgb::BLACK };
        let to_sun = onb.to_local(sun.wi);
        if !sides_agree(to_sun.z, sun.wi.dot(surface.ng)) {
            return Rgb::BLACK;
        }
        let value = bsdf.eval_pdf(viewing(&onb, surface.wo), to_sun).0.total(bsdf.reflectance);
        if value.is_black() {
            return Rgb::BLACK;
        }
        value * sun.radiance.unwrap_or_default() * scene.transmittance(&surface.shadow_ray(sun.wi, None)) * (1.0 / sun.pdf)
    }
}

/// What a triangle is as a glint, and its area; `None` where it is none: not glossy, turned away from the sun, or in shadow.
fn glint(scene: &RenderScene<'_>, number: u32, to_sun: Vec3, irradiance: f32) -> Option<(f32, GlintBounds)> {
    let triangle = scene.triangles.get(number);
    let area = 0.5 * triangle.cross().length();
    let normal = triangle.normals.iter().sum::<Vec3>().try_normalize()?;
    let material = &scene.scene.materials[triangle.material as usize];
    let normal = if material.two_sided && normal.dot(to_sun) < 0.0 { -normal } else { normal };
    if area <= 0.0 || triangle.normals.iter().all(|n| n.dot(to_sun) * n.dot(normal) <= 0.0) {
        return None;
    }

    // The reflection straight back tells roughness and reflectance, whatever the model: its value is F·D/4, and D is 1/(π·α²).
    let surface = scene.surface(&Hit { t: 0.0, triangle: number, u: 1.0 / 3.0, v: 1.0 / 3.0 }, -normal, &Cone::POINT);
    let bsdf = surface.bsdf(scene);
    let albedo = bsdf.albedo(1.0);
    let reflectance = (albedo.glossy + albedo.sharp).luminance();
    let peak = bsdf.eval_pdf(Vec3::Z, Vec3::Z).0.specular.luminance();
    if peak * PI < MIN_PEAK || reflectance <= 0.0 {
        return None;
    }
    let alpha_2 = (reflectance / (4.0 * PI * peak)).min(1.0);

    let power = irradiance * area * reflectance * sunlit(scene, &triangle, to_sun);
    let grazing = power * (1.0 / reflectance - 1.0).max(0.0);
    let bounds = Bounds3::from_points(triangle.corners);
    (power > 0.0).then_some((area, GlintBounds { bounds, power, grazing, normals: normal * power, alpha_2: alpha_2 * power, to_sun }))
}

/// The fraction of some places of a triangle that the sun reaches.
fn sunlit(scene: &RenderScene<'_>, triangle: &Triangle, to_sun: Vec3) -> f32 {
    let side = if triangle.winding.dot(to_sun) < 0.0 { -triangle.winding } else { triangle.winding };
    // The golden ratio's and the plastic number's sequence covers the square evenly (Roberts 2018).
    let place = |k: u32| [0.754_877_7, 0.569_840_3].map(|step: f32| (0.5 + step * k as f32).fract());
    let lit = (0..RAYS).filter(|&k| {
        let place = warp::triangle(place(k));
        let p = triangle.position([1.0 - place.x - place.y, place.x, place.y]);
        let ray = Ray::new(offset_origin(p, side) + side * triangle.slack, to_sun);
        !scene.transmittance(&ray).is_black()
    });
    lit.count() as f32 / RAYS as f32
}
